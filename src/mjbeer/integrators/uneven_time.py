"""The time that a multistep method with uneven steps has passed, and the states at times that are asked for.

Steps of uneven length are even in a time s of the method's own, in which the caller's pace, dt/ds, is any positive
function of phi. What passes of t in a step is integrated by Gauss's formula. That takes no evaluation of the dynamics,
and as many points as the pace needs there: its square nearly vanishes where a heavy load passes the place of its least
inertia. Most steps are gone over as a whole: the points are at the same shares of each, where phi is a sum of
accelerations with fixed weights. In a step with samples, or of several parts, phi is a polynomial.

The weights with which accelerations are added up come from rational arithmetic. With the backward difference z
(z a_n = a_n - a_(n-1)) and a step h, the time derivative is -ln(1 - z)/h, so that the velocity is h/(-ln(1 - z)) and
the position h^2/ln(1 - z)^2 times the acceleration. Their leading terms, 1/z and 1/z^2, are the first and the second
sum of all accelerations; the rest are differences of the last ones, and so weights for them. A factor (1 - z)^back
gives the value that many steps before the last acceleration: -1 predicts the next step.

A function of compiled code has the method's `own` time, of which `OwnTime` names the parts; the `line` of phi in a
step, of which `_Line` does; and a share of the step that has `passed`. A `node` is phi, its rate in the method's own
time, and the pace.
"""

import functools
import math
from collections import namedtuple
from fractions import Fraction

import numpy as np
from numpy.polynomial import polynomial
from numpy.polynomial.legendre import leggauss

from mjbeer.integrators.dynamics import copy, inline, inner

COUNT = 13
"""Number of accelerations that are kept: the method has differences up to the twelfth."""
BLOCK = 1024
"""Steps between two returns to Python, so that a long run can be interrupted."""
LAG = 2
"""Steps after which a state is read off; with more of them only the evaluations grow."""
_MOST_POINTS = 12
"""Largest number of points over which the time is integrated at once."""
_ROUNDEST = 20.0
"""Largest size of the ellipse of `_bounds`: with a larger one, points are too few where phi is no line in the step."""
_HIGHEST = 3.0
"""Largest height [rad] of the complex angle at which the pace vanishes that makes a difference."""
_SEEN = 0.06**2
"""Square of half of the largest angle [rad] between two states that are kept, over its distance from the angle at which
the pace vanishes, or over 1 rad: a force that is extreme between them is missed by 1e-3 of its change."""
SPARE = 512
"""Rows of what is kept that are left free for the parts of one step: a load that turns by 4 rad past the place where a
wheel of 1e-8 of its inertia leaves hardly any takes 400."""
_FARTHEST, _SHORTEST = 2.0, 1e-9
"""Half of the angle [rad] by which a load may turn in a step, and the smallest part of a step. What needs more is no
motion that the steps are short enough for."""
_PUNCTUAL, _ATTEMPTS = 3e-5, 5
"""Distance of a sample from its time, over a part's, after which one more attempt has all digits, as it cubes that; and
the most attempts."""

OwnTime = namedtuple("OwnTime", "even uneven turns height period bounds")
OwnTime.__doc__ = """The pace is dt/ds = sqrt(even + uneven sin^2(turns phi)).

It vanishes at a complex angle of some `height` [rad] in each `period` [rad]. `bounds` are those of `_bounds`.
"""
_Line = namedtuple("_Line", "curve first second step back")
_Line.__doc__ = """Coefficients of phi between the steps, both sums, the step [s], and how many steps back it begins."""


def own_time(even: float, uneven: float, turns: float, precision: float) -> OwnTime:
    """Return a method's own time s with dt/ds = sqrt(even + uneven sin^2(turns phi)), which must be positive.

    The time that passes in a step is known to some `precision`, a share of it. Whatever the pace, the motion is the
    same; the nearer its square is to that of the load's inertia, the longer the steps may be.
    """
    height = math.asinh(math.sqrt(even / uneven)) / turns if uneven > 0 else _HIGHEST
    return OwnTime(even, uneven, turns, min(height, _HIGHEST), math.pi / turns, _bounds(precision))


@functools.lru_cache(maxsize=32)
def _bounds(precision: float) -> np.ndarray:
    """Return how far away the pace must vanish for each number of points, from 0, to have a `precision`.

    That is the square of a complex angle's distance from the middle, over half of the angle between the ends. The error
    of Gauss's formula is the size of an ellipse to the power of minus twice the number of points. It has both ends as
    foci, and the pace vanishes at an angle on it.
    """
    size = precision ** (-1 / (2 * np.arange(1, _MOST_POINTS + 1)))
    return np.append(np.inf, np.where(size > _ROUNDEST, np.inf, (size + 1 / size) ** 2 / 4))


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
for _number in range(1, _MOST_POINTS + 1):
    _POINTS[_number, :_number], _WEIGHTS[_number, :_number] = leggauss(_number)
    _POINTS[_number, :_number] += 1
_POINTS, _WEIGHTS = _POINTS / 2, _WEIGHTS / 2
_WITHIN = (np.vander(0.5 - _POINTS.ravel(), COUNT + 2) @ _BETWEEN.T).reshape(*_POINTS.shape, COUNT)
"""`weights` of places at these points of the step that ends `LAG` steps before the last one."""
_END_RATE, _END_PLACE = weights(1, LAG), weights(2, LAG)


@inline
def weighted(weights, accelerations, end):
    """Return the weighted sum of the `COUNT` accelerations before index `end`, four by four, so that terms overlap.

    The order is written out. A compiler that may choose it gives other digits where it reads a function from its cache.
    """
    last = accelerations[end - COUNT : end]
    first, second, third, fourth = weights[COUNT - 1] * last[COUNT - 1], 0.0, 0.0, 0.0
    for k in range(0, COUNT - 1, 4):
        first += weights[k] * last[k]
        second += weights[k + 1] * last[k + 1]
        third += weights[k + 2] * last[k + 2]
        fourth += weights[k + 3] * last[k + 3]
    return (first + second) + (third + fourth)


@inline
def pace(own, phi):
    """Return dt/ds, how fast time passes in the method's own time, at an angle."""
    sin = math.sin(own.turns * phi)
    return math.sqrt(own.even + own.uneven * sin * sin)


@inner
def _bend(line, history, end):
    """Write the coefficients of phi in the step of a `line`, by the accelerations before index `end`."""
    for row in range(COUNT + 2):
        line.curve[row] = 0.0
    for k in range(COUNT):
        gain = history[0, end - COUNT + k]
        for row in range(COUNT + 2):
            line.curve[row] += _BETWEEN[k, row] * gain


@inner
def _node(own, line, passed):
    """Return the node in a step."""
    x, place, rate = line.back - passed - LAG - 0.5, 0.0, 0.0
    for row in range(COUNT + 2):
        rate = rate * x + place
        place = place * x + line.curve[row]
    phi = line.step * line.step * (place + line.second - (1 + line.back - passed) * line.first)
    return phi, line.step * (line.first - rate), pace(own, phi)


@inline
def _count(own, before, after, duration, seen):
    """Return how many points a part needs, between two nodes some `duration` apart in the method's own time.

    There are 0 if too many would be needed, or if shorter parts are to be kept, and -1 if the steps are not short
    enough for the motion.
    """
    middle, half = (before[0] + after[0]) / 2, max(abs(before[1]), abs(after[1])) * duration / 2
    if not half < _FARTHEST:
        return -1
    aside = middle - own.period * np.rint(middle / own.period)
    away, half = aside * aside + own.height * own.height, half * half
    if half > seen * min(away, 1.0):
        return 0
    for count in range(1, _MOST_POINTS + 1):
        if away >= own.bounds[count] * half:
            return count
    return 0


@inline
def _whole(own, history, end, line, count):
    """Return the time [s] that passes in the step that ends `LAG` steps before the last one, by so many points."""
    passed = 0.0
    for k in range(count):
        place = line.second - (LAG + 2 - _POINTS[count, k]) * line.first + weighted(_WITHIN[count, k], history[0], end)
        passed += _WEIGHTS[count, k] * pace(own, line.step * line.step * place)
    return line.step * passed


@inner
def _duration(own, line, begin, end, count, work):
    """Return the time [s] that passes between two shares of a step, by so many points; no number without points."""
    if count <= 0:
        return np.nan
    passed, length = 0.0, end - begin
    for k in range(count):
        x = line.back - begin - length * _POINTS[count, k] - LAG - 0.5
        place = 0.0
        for row in range(COUNT + 2):
            place = place * x + line.curve[row]
        work[k] = line.second + place - (LAG + 1.5 + x) * line.first
    for k in range(count):
        passed += _WEIGHTS[count, k] * pace(own, line.step * line.step * work[k])
    return line.step * length * passed


@inner
def _write(share, sums, node, since, pulled, out):
    """Write the state at a node, `since` [s] after that of the `sums`, to `out`.

    The slide less a `share` of sin(phi) has the acceleration `pulled` [m/s^2].
    """
    phi, rate, last = node[0], node[1] / node[2], out.size // 2 - 1
    out[last], out[2 * last + 1] = phi, rate
    if last > 0:
        out[0] = sums[0, 3] + since * (sums[0, 4] + since * pulled / 2) + share * math.sin(phi)
        out[1 + last] = sums[0, 4] + since * pulled + share * math.cos(phi) * rate


@inner
def _find(own, line, part, count, since, work):
    """Return the node `since` [s] after the beginning of a `part`.

    That is the begin and the end of it, its duration [s], and the pace at both. The first guess is a cubic; an attempt
    takes the change of the pace into account.
    """
    left, right, span, slower, faster = part
    length, share = right - left, since / span
    unit = span / (line.step * length)
    first, last = unit / slower, unit / faster
    passed = left + length * share * (first + share * (3 - 2 * first - last + share * (first + last - 2)))
    for _ in range(_ATTEMPTS):
        if share < 0.5:
            late = since - _duration(own, line, left, passed, count, work)
        else:
            late = since - span + _duration(own, line, passed, right, count, work)
        phi, rate, fast = _node(own, line, passed)
        grows = own.uneven * own.turns * math.sin(2 * own.turns * phi) * rate / (2 * fast * fast)
        ahead = late / fast
        passed += ahead * (1 - grows * ahead / 2) / line.step
        if abs(late) <= _PUNCTUAL * span:
            break
    return _node(own, line, passed)


@inline
def kahan_add(sums, row, term):
    """Add a term to a sum, and the rounding of the addition before."""
    term -= sums[1, row]
    total = sums[0, row] + term
    sums[1, row] = (total - sums[0, row]) - term
    sums[0, row] = total


@inner
def _go_on(sums, span, pulled):
    """Add a `span` [s] to the time, and what it adds to the slide less its share of sin(phi)."""
    kahan_add(sums, 2, span)
    kahan_add(sums, 3, span * (sums[0, 4] + span * pulled / 2))
    kahan_add(sums, 4, span * pulled)


@inline
def dense_output(own, share, sums, node, history, end, back, step, work, times, sample, samples, kept, row):
    """Go on to the step that many steps `back`: fill in the samples on the way, and keep states of it.

    Return the next sample and the next row of what is kept. `sums` and `history` are those of `gauss_jackson`; `node`
    is that of the step before. `work` is space for points and coefficients.
    """
    if sample == times.size:
        return sample, row
    line, before = _Line(work[1], sums[0, 0], sums[0, 1], step, back + 1.0), (node[0], node[1], node[2])
    span, seen = np.nan, _SEEN if kept[0].size > 0 else np.inf
    if back == LAG:
        phi = step * step * (line.second - line.back * line.first + weighted(_END_PLACE, history[0], end))
        after = phi, step * (line.first + weighted(_END_RATE, history[0], end)), pace(own, phi)
        count = _count(own, before, after, step, seen)
        if count > 0:
            span = _whole(own, history, end, line, count)
    else:
        _bend(line, history, end)
        after = _node(own, line, 1.0)
    # It hardly changes, but for rounding: most where the load is fastest, and so the pace is slowest.
    pulled = (before[2] * history[1, end - 2 - back] + after[2] * history[1, end - 1 - back]) / (before[2] + after[2])
    if times[sample] > (sums[0, 2] + span) * (1 + 1e-14):
        if kept[0].size > 0:
            kept[0][row] = sums[0, 2] + span
            _write(share, sums, after, span, pulled, kept[1][row])
            row += 1
        _go_on(sums, span, pulled)
    else:
        if back == LAG:
            _bend(line, history, end)
        motion = span, pulled, seen
        sample, row = _by_parts(
            own, share, sums, line, before, after, motion, work[0], times, sample, samples, kept, row
        )
    node[0], node[1], node[2] = after
    return sample, row


@inner
def _by_parts(own, share, sums, line, before, at_end, motion, work, times, sample, samples, kept, row):
    """Go on through a step in parts, from one node to another; see `dense_output`.

    The `motion` is the duration of the step [s], if it is known, the slide's acceleration, and the size of what is
    kept.
    """
    span, pulled, seen = motion
    left, right = 0.0, 1.0
    while left < 1.0 and sample < times.size:
        after = at_end if right == 1.0 else _node(own, line, right)
        count = _count(own, before, after, line.step * (right - left), seen)
        if count == 0 and right - left > _SHORTEST:
            right = (left + right) / 2
            continue
        if not (right - left == 1.0 and span > 0):
            span = _duration(own, line, left, right, count, work)
        earlier, part = sums[0, 2], (left, right, span, before[2], after[2])
        while sample < times.size and times[sample] <= (earlier + span) * (1 + 1e-14):
            since = times[sample] - earlier
            _write(share, sums, _find(own, line, part, count, since, work), since, pulled, samples[sample])
            sample += 1
        if row < kept[0].size:
            if sample < times.size:
                kept[0][row] = earlier + span
                _write(share, sums, after, span, pulled, kept[1][row])
            else:  # the run ends within this part
                kept[0][row] = times[-1]
                copy(samples[-1], kept[1][row])
            row += 1
        _go_on(sums, span, pulled)
        left, right, before = right, 1.0, after
    return sample, row
