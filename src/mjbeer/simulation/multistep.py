"""What a multistep method knows between its steps: the angle of the load, the time that has passed, and the state.

The weights with which accelerations are added up come from rational arithmetic. With the backward difference z
(z a_n = a_n - a_(n-1)) and a step h, the time derivative is -ln(1 - z)/h, so that the velocity is h/(-ln(1 - z)) and
the position h^2/ln(1 - z)^2 times the acceleration. Their leading terms, 1/z and 1/z^2, are the first and the second
sum of all accelerations; the rest are differences of the last ones, and so weights for them. A factor (1 - z)^back
gives the value that many steps before the last acceleration: -1 predicts the next step.

Steps of uneven length are even in a time of the method's own, in which t' = sqrt(J): see `gauss_jackson`. What passes
of t in a step is integrated by Gauss's formula. That takes no evaluation of the dynamics, and as many points as J needs
there: it nearly vanishes where a heavy load passes the place of its least inertia.

A function of compiled code has the `form` of a scene, of which `Form` names the parts; a `line`, which has phi in a
step, as `_line` describes it; and a share of the step that has `passed`.
"""

import math
from collections import namedtuple
from fractions import Fraction

import numpy as np
from numba import njit
from numpy.polynomial import polynomial
from numpy.polynomial.legendre import leggauss

from mjbeer.simulation.kernels import FAILS_AT, forces, inner, see
from mjbeer.theory.scene import Scene

COUNT = 13
"""Number of accelerations that are kept: the method has differences up to the twelfth."""
BLOCK = 1024
"""Steps between two returns to Python, so that a long run can be interrupted."""
LAG = 2
"""Steps after which a state is read off; with more of them only the evaluations grow."""
_MOST_POINTS = 12
"""Largest number of points over which the time is integrated at once."""
_ROUNDEST = 20.0
"""Largest size of the ellipse of `_part`: with a larger one, points are too few where phi is no line in the step."""
_HIGHEST = 3.0
"""Largest height [rad] of the complex angle at which J vanishes that makes a difference."""
_SEEN = 0.06
"""Half of the largest angle [rad] between two looks at the forces, over its distance from that angle, or over 1 rad:
forces that are extreme between them are missed by 1e-3 of their change."""
_SHARP = 1e-3
"""Part of a step in which the moment is found, by a line, from when on rolling needs a pull or more friction."""
_FARTHEST, _SHORTEST = 2.0, 1e-9
"""Half of the angle [rad] by which a load may turn in a step, and the smallest part of a step. What needs more is no
motion that the steps are short enough for."""
_PUNCTUAL, _ATTEMPTS = 3e-5, 5
"""Distance of a sample from its time, over a part's, after which one more attempt has all digits, as it cubes that; and
the most attempts."""

Form = namedtuple("Form", "base chord swing uneven turns slope along across share height period push digits scale")
Form.__doc__ = """J = base + uneven sin^2(turns phi), -V' = slope + along cos(phi) - across sin(phi), and more.

The `share` of the swing in u is u's change with sin(phi) [m]. J vanishes at a complex angle of some `height` [rad], in
each `period` [rad]. The `push` [rad/s^2] is added to phi_ddot. `digits`, half of ln(1/precision), are those to which
the time in a step is known, or 0 if all steps are even. The method's own time goes as fast as time where J is `scale`.
"""
_Line = namedtuple("_Line", "curve first second step back")
_Line.__doc__ = """Coefficients of phi between the steps, both sums, the step [s], and how many steps back it begins."""


def form(scene: Scene, phi0: float, precision: float, push: float) -> Form:
    """Return the form of a scene that starts at `phi0` [rad]; with a `precision` of 0 all steps are even."""
    shape = scene.oscillator
    uneven, turns = (shape.swing, 1.0) if shape.swing > 0 else (shape.chord, 0.5)
    height = math.asinh(math.sqrt(shape.base / uneven)) / turns if uneven > 0 else _HIGHEST
    return Form(
        base=shape.base,
        chord=shape.chord,
        swing=shape.swing,
        uneven=uneven,
        turns=turns,
        slope=shape.slope,
        along=shape.depth * math.sin(shape.bottom),
        across=shape.depth * math.cos(shape.bottom),
        share=scene.load.moment / scene.effective_mass,
        height=min(height, _HIGHEST),
        period=math.pi / turns,
        push=push,
        digits=math.log(1 / precision) / 2 if precision else 0.0,
        scale=shape.base + uneven * math.sin(turns * phi0) ** 2,
    )


def series(power: int, back: int, terms: int) -> list[Fraction]:
    """Return the first coefficients of (z/(-ln(1 - z)))^power (1 - z)^back in powers of z.

    A `power` of 1 is for velocities, one of 2 for positions.
    """
    logarithm = [Fraction(1, j + 1) for j in range(terms)]  # -ln(1 - z)/z
    inverse, product = [Fraction(1)], [Fraction(1)]
    for k in range(1, terms):
        inverse.append(-sum((logarithm[k - j] * inverse[j] for j in range(k)), Fraction(0)))
        product.append(product[-1] * (k - 1 - back) / k)
    for _ in range(power):
        product = [sum((product[j] * inverse[k - j] for j in range(k + 1)), Fraction(0)) for k in range(terms)]
    return product


def weights(power: int, back: int) -> np.ndarray:
    """Return the weights of the last `COUNT` accelerations, the oldest first, shape (COUNT,).

    The velocity `back` steps before the last one is h times the first sum and the accelerations with the weights of
    `power` 1. The position is h^2 times the second sum, less 1 + `back` times the first sum, and the accelerations with
    the weights of `power` 2. Both sums include the last acceleration.
    """
    differences = series(power, back, COUNT + power)[power:]
    ordinates = [
        (-1) ** k * sum((math.comb(j, k) * differences[j] for j in range(k, COUNT)), Fraction(0)) for k in range(COUNT)
    ]
    return np.array([float(weight) for weight in reversed(ordinates)])


def _between() -> np.ndarray:
    """Return `weights` of places as polynomials of `back` - `LAG` - 1/2, the highest power first, shape (COUNT, terms).

    The velocity is their derivative, with the opposite sign, and the first sum.
    """
    inverse = [float(term) for term in series(2, 0, COUNT + 2)]
    shifts: list[np.ndarray] = [np.ones(1)]
    for j in range(1, COUNT + 2):
        shifts.append(polynomial.polymul(shifts[-1], [(j - 1.5 - LAG) / j, -1 / j]))
    ordinates = np.zeros((COUNT + 2, COUNT))
    for j in range(COUNT):
        difference = np.zeros(COUNT + 2)
        for k in range(j + 3):
            difference[: k + 1] += inverse[j + 2 - k] * shifts[k]
        for k in range(j + 1):
            ordinates[:, COUNT - 1 - k] += (-1) ** k * math.comb(j, k) * difference
    return ordinates[::-1].T.copy()


_BETWEEN = _between()
_POINTS, _WEIGHTS = np.zeros((2, _MOST_POINTS + 1, _MOST_POINTS))
"""Points between 0 and 1, and their weights, in Gauss's formula with so many points, in a row for each number."""
for _count in range(1, _MOST_POINTS + 1):
    _POINTS[_count, :_count], _WEIGHTS[_count, :_count] = leggauss(_count)
    _POINTS[_count, :_count] += 1
_POINTS, _WEIGHTS = _POINTS / 2, _WEIGHTS / 2


@njit(cache=True, error_model="numpy", forceinline=True)
def pace(form, phi):
    """Return how fast time passes in the method's own time."""
    if form.digits == 0:
        return 1.0
    sin = math.sin(form.turns * phi)
    return math.sqrt((form.base + form.uneven * sin * sin) / form.scale)


@inner
def _line(history, end, sums, step, back, curve):
    """Return phi around the step that many steps `back`, by the accelerations before index `end` of the `history`."""
    for row in range(COUNT + 2):
        curve[row] = 0.0
    for k in range(COUNT):
        gain = history[0, end - COUNT + k]
        for row in range(COUNT + 2):
            curve[row] += _BETWEEN[k, row] * gain
    return _Line(curve, sums[0, 0], sums[0, 1], step, back + 1.0)


@inner
def _angle(line, passed):
    """Return phi [rad] and its rate in the method's own time."""
    x, place, rate = line.back - passed - LAG - 0.5, 0.0, 0.0
    for row in range(COUNT + 2):
        rate = rate * x + place
        place = place * x + line.curve[row]
    place += line.second - (1 + line.back - passed) * line.first
    return line.step * line.step * place, line.step * (line.first - rate)


@inner
def _part(form, line, left, right, before, after, seen):
    """Return the end of the part of a step from `left` to `right`, phi and its rate there, and the points it needs.

    The error of Gauss's formula is the size of an ellipse to the power of minus twice the number of points. It has both
    ends as foci, and J vanishes at a complex angle on it. There are no points where there would be far too many.
    `before` and `after` are phi and its rate at both ends. A record takes parts that are `seen`.
    """
    if form.digits == 0:
        return right, after, 1
    while True:
        middle, fastest = (before[0] + after[0]) / 2, max(abs(before[1]), abs(after[1]))
        half = fastest * line.step * (right - left) / 2  # back and forth, at a turning point
        if not half < _FARTHEST or right - left < _SHORTEST:
            return right, after, 0
        aside = middle - form.period * np.rint(middle / form.period)
        reached = math.sqrt((aside - half) ** 2 + form.height**2) + math.sqrt((aside + half) ** 2 + form.height**2)
        axis = reached / max(2 * half, 1e-300)
        count = int(form.digits / math.log(min(axis + math.sqrt(axis * axis - 1), _ROUNDEST))) + 1
        if count <= _MOST_POINTS and half <= seen * min(reached / 2, 1.0):
            return right, after, count
        right = (left + right) / 2
        after = _angle(line, right)


@inner
def _duration(form, line, begin, end, count, work):
    """Return the time [s] that passes between two places in a step, by so many points; no number without points."""
    if count == 0:
        return np.nan
    total, length = 0.0, end - begin
    for k in range(count):  # all points at once, which a processor does in the time of one
        work[0, k], work[1, k] = line.back - begin - length * _POINTS[count, k] - LAG - 0.5, 0.0
    for row in range(COUNT + 2):
        for k in range(count):
            work[1, k] = work[1, k] * work[0, k] + line.curve[row]
    for k in range(count):
        place = line.second + work[1, k] - (LAG + 1.5 + work[0, k]) * line.first
        total += _WEIGHTS[count, k] * pace(form, line.step * line.step * place)
    return line.step * length * total


@inner
def _write(form, sums, angle, since, drawn, out):
    """Write the state at an angle and its rate, `since` [s] after the place of the `sums`, to `out`.

    The axis less its swing has the acceleration `drawn` [m/s^2].
    """
    phi, last = angle[0], out.size // 2 - 1
    rate = angle[1] / pace(form, phi)
    out[last], out[2 * last + 1] = phi, rate
    if last > 0:
        out[0] = sums[0, 3] + since * (sums[0, 4] + since * drawn / 2) + form.share * math.sin(phi)
        out[1 + last] = sums[0, 4] + since * drawn + form.share * math.cos(phi) * rate


@inner
def _find(form, line, part, count, since, work):
    """Return the share of a step that has passed `since` [s] after the beginning of a `part`.

    That is its begin and end, its duration [s], and the pace at both. The first guess is a cubic; an attempt takes the
    change of the pace into account, 1/2 J'/J phi' of it.
    """
    left, right, span, slower, faster = part
    length, share = right - left, since / span
    if form.digits == 0:
        return left + length * share
    unit = span / (line.step * length)
    first, last = unit / slower, unit / faster
    passed = left + length * share * (first + share * (3 - 2 * first - last + share * (first + last - 2)))
    for _ in range(_ATTEMPTS):
        if share < 0.5:
            late = since - _duration(form, line, left, passed, count, work)
        else:
            late = since - span + _duration(form, line, passed, right, count, work)
        phi, rate = _angle(line, passed)
        fast = pace(form, phi)
        grows = form.uneven * form.turns * math.sin(2 * form.turns * phi) * rate / (2 * fast * fast * form.scale)
        ahead = late / fast
        passed += ahead * (1 - grows * ahead / 2) / line.step
        if abs(late) <= _PUNCTUAL * span:
            break
    return passed


@inner
def add(sums, row, term):
    """Add a term to a sum, and the rounding of the addition before (Kahan)."""
    term -= sums[1, row]
    total = sums[0, row] + term
    sums[1, row] = (total - sums[0, row]) - term
    sums[0, row] = total


@inner
def _go_on(sums, span, drawn):
    """Add a `span` [s] to the time, and what it adds to the axis less its swing."""
    add(sums, 2, span)
    add(sums, 3, span * (sums[0, 4] + span * drawn / 2))
    add(sums, 4, span * drawn)


@inner
def _margin(numbers, phi, rate):
    """Return the force [N] that is left until rolling is no longer possible."""
    return forces(numbers, math.sin(phi), math.cos(phi), rate * rate)[2]


@inner
def read_off(form, sums, node, history, end, back, step, work, state, times, sample, samples, record):
    """Go on to the step that many steps `back`, in parts: fill in the samples and the `record` on the way.

    Return the next sample. `sums` and `history` are those of `gauss_jackson`; `node` is phi, its rate and the pace at
    the step before. `work` is space for points and coefficients, and `state` for a state.
    """
    numbers, found = record
    if sample == times.size:
        return sample
    if form.digits == 0 and found.size == 0 and times[sample] > (sums[0, 2] + step) * (1 + 1e-14):
        _go_on(sums, step, (history[1, end - 2 - back] + history[1, end - 1 - back]) / 2)
        return sample
    line = _line(history, end, sums, step, back, work[2])
    left, until, before, slower, at_end = 0.0, 1.0, (node[0], node[1]), node[2], _angle(line, 1.0)
    last, seen = pace(form, at_end[0]), _SEEN if found.size > 0 else np.inf
    # It hardly changes, but for rounding: most where the load is fastest, and so the pace is slowest.
    drawn = (slower * history[1, end - 2 - back] + last * history[1, end - 1 - back]) / (slower + last)
    while left < 1.0 and sample < times.size:
        right, after, count = _part(
            form, line, left, until, before, at_end if until == 1 else _angle(line, until), seen
        )
        span = _duration(form, line, left, right, count, work)
        faster = last if right == 1 else pace(form, after[0])
        earlier, part = sums[0, 2], (left, right, span, slower, faster)
        looking = found.size > 0 and found[FAILS_AT] == np.inf and right - left > _SHARP
        if looking and _margin(numbers, after[0], after[1] / faster) < 0:  # the moment is within a shorter part
            until = (left + right) / 2
            continue
        while sample < times.size and times[sample] <= (earlier + span) * (1 + 1e-14):
            since = times[sample] - earlier
            angle = _angle(line, _find(form, line, part, count, since, work))
            _write(form, sums, angle, since, drawn, samples[sample])
            sample += 1
        if found.size > 0 and sample < times.size:
            _write(form, sums, after, span, drawn, state)
            see(numbers, found, earlier + span, state)
        elif found.size > 0:  # the run ends within this part
            see(numbers, found, times[-1], samples[-1])
        _go_on(sums, span, drawn)
        left, until, before, slower = right, 1.0, after, faster
    node[0], node[1], node[2] = at_end[0], at_end[1], last
    return sample
