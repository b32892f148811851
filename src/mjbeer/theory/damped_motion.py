"""The motion of a damped sliding scene to rounding, step by step: no first integral makes it a quadrature.

With rolling built in, the variables are phi, its rate, and the slip rate w = roll_dot - phi_dot, which keeps its digits
where the damping is strong and w small. Divided by M a^2, with M = m + m_can + I_can/a^2, only rates remain:

    roll_ddot = drive - beta (sin(phi) phi_dot^2 - cos(phi) phi_ddot) - torque(w) - drag roll_dot |roll_dot|,
    inertia(phi) phi_ddot = -depth sin(phi - bottom) - beta^2 sin(phi) cos(phi) phi_dot^2
                            + (1 - beta cos(phi)) torque(w) - beta cos(phi) drag roll_dot |roll_dot|.

Each step is a collocation polynomial whose last terms are below rounding, through the equations at the Radau points of
the step, whose last one is its end: the Radau IIA method of order 2s - 1. It is L-stable: what decays at once, however
fast, takes no small steps once it is gone. Polynomials are kept as sums of Legendre polynomials over the step, x = -1
to 1. (E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, IV.5.)

Where w or roll_dot passes zero, its absolute value has a corner: a step that would pass one is taken again up to there.
"""

import functools
import itertools
import math
from collections.abc import Callable

import numpy as np
from numpy.polynomial import legendre

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.damping import Damping
from mjbeer.theory.motion import EPS, ROUNDINGS, UNCERTAIN, Start
from mjbeer.theory.oscillator import reduced, root
from mjbeer.theory.scene import Scene

_STAGES = 24
"""Number of stages s. The method is of order 47, and a swing takes some five steps a period to rounding."""
_WORK = 6_000
"""Most corrections of Newton's method in all steps, those included that are taken again, a tenth of a millisecond each:
a can of beer that swings by 1 rad takes them in 40 s."""
_FIRST = _WORK // 8
"""Corrections after which it is first looked at how far the motion has come."""
_ITERATIONS = 12
"""Most corrections of Newton's method in a step."""
_QUADRATIC = 1e-9
"""Relative size of a correction after which one more leaves only rounding, as each squares the error."""
_TAIL = 1e-14
"""Size of the terms of a step's polynomials that may be missing, relative to the rates."""
_GROWTH = 10.0
"""Largest ratio of a step to the one before."""
_BESIDE = 1e-6
"""Share of a step that a corner may be from its ends. The torque beside the corner is the square of that, or less."""
_CANCELLED = 256 * EPS
"""Size up to which w or phi_dot + w is rounding, relative to the largest |phi_dot| + |w| of a step: the sum has an eps,
and the polynomial through the stages, whose sums each processor has in another order, up to 72 in trials."""


_RADAU = np.array([0.0] * (_STAGES - 1) + [-1.0, 1.0])
_ROUGH = np.sort(legendre.legroots(_RADAU).real)
_POINTS = _ROUGH - legendre.legval(_ROUGH, _RADAU) / legendre.legval(_ROUGH, legendre.legder(_RADAU))
_POINTS[-1] = 1.0
"""The Radau points, the roots of P_s - P_(s-1)."""
_INTEGRALS = legendre.legint(np.linalg.inv(legendre.legvander(_POINTS, _STAGES - 1)), lbnd=-1) / 2
"""The coefficients P_0 to P_s of the integral, over a step of length 1, of the polynomial through values at stages."""
_MATRIX = legendre.legvander(_POINTS, _STAGES) @ _INTEGRALS
"""That integral at the stages, a_ij of the method."""
_NODES = np.append(-1.0, _POINTS)
_TO_SERIES = np.linalg.inv(legendre.legvander(_NODES, _STAGES))
"""The coefficients P_0 to P_s of the polynomial through values at the start and the stages."""
_EYE = np.eye(2 * _STAGES)

Rates = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def _equations(scene: Scene) -> Rates:
    """Return a function of phi, phi_dot and w, arrays of one shape.

    Its values are phi_ddot and w_dot [rad/s^2], of shape (2, ...), and their derivatives by those three, (2, 3, ...).
    """
    radius, oscillator, mass = scene.can.radius, scene.oscillator, scene.effective_mass
    unit = mass * radius**2
    push, beta = scene.downhill_weight / mass / radius, scene.load.moment / mass / radius
    base, depth, bottom = oscillator.base / unit, oscillator.depth / unit, oscillator.bottom
    law, air = Damping(*(each / unit for each in scene.damping_law.coefficients)), scene.drag * radius / mass

    def rates(phi: np.ndarray, phi_dot: np.ndarray, slip: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        torque, steep, roll_dot = law.torque(slip), law.derivative(slip), phi_dot + slip
        drag, steep_drag = air * roll_dot * np.abs(roll_dot), 2 * air * np.abs(roll_dot)
        arm, lean, square, turned = beta * np.cos(phi), beta * np.sin(phi), phi_dot * phi_dot, phi - bottom
        inertia, open_arm = base + lean * lean, 1 - arm
        phi_ddot = (-depth * np.sin(turned) - lean * arm * square + open_arm * torque - arm * drag) / inertia
        slip_dot = push - lean * square - torque - drag - open_arm * phi_ddot
        by_phi = -depth * np.cos(turned) - (arm * arm - lean * lean) * square + lean * (torque + drag)
        steeps = by_phi - 2 * lean * arm * phi_ddot, -2 * lean * arm * phi_dot - arm * steep_drag
        swing = np.array([*steeps, open_arm * steep - arm * steep_drag]) / inertia
        slide = np.array([-arm * square - lean * phi_ddot, -2 * lean * phi_dot - steep_drag, -steep - steep_drag])
        return np.array([phi_ddot, slip_dot]), np.array([swing, slide - open_arm * swing])

    return rates


def solve(scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, ...]:
    """Return phi [rad], phi_dot [rad/s], u [m] and u_dot [m/s] at the times `time` [s], none of them negative.

    Raises:
      ToleranceError: if rounding of start and scene changes phi or u/a by more than 1e-4 rad, relative beyond 1 rad, or
        if the motion takes too many steps, or too short ones.
    """
    radius, (u0, u_dot0) = scene.can.radius, scene.start(phi0, phi_dot0)
    if scene.incline == 0 and Start.at(scene.oscillator, phi0, phi_dot0).stays(phi0):
        still = np.zeros_like(time)
        return phi0 + still, still, u0 + still, still
    order = np.argsort(time)
    pace = math.sqrt(scene.oscillator.depth / scene.oscillator.base)
    start = np.array([reduced(phi0), phi_dot0, u_dot0 / radius - phi_dot0])
    kinks = np.array([[0.0, 1.0]] * (scene.damping_law.quadratic > 0) + [[1.0, 1.0]] * (scene.drag > 0)).reshape(-1, 2)
    followed = _follow(_equations(scene), time[order], start, pace, kinks)
    turned, rolled, phi_dot, slip = followed[:, np.argsort(order)]
    return phi0 + turned, phi_dot, u0 + radius * rolled, radius * (phi_dot + slip)


def _follow(rates: Rates, time: np.ndarray, state: np.ndarray, pace: float, kinks: np.ndarray) -> np.ndarray:
    """Return how far phi and roll have turned [rad], phi_dot and w [rad/s] at sorted times, of shape (4, times).

    The `state` is phi, phi_dot and w at time 0, `pace` is that of a swing [rad/s], and `kinks` are the sums of phi_dot
    and w, of shape (sums, 2), whose absolute values count.
    """
    now, latest, turned, farthest = 0.0, float(time[-1]), np.zeros(2), np.ones(2)
    done = int(np.searchsorted(time, 0.0, "right"))
    samples = np.repeat(np.array([[0.0, 0.0, *state[1:]]]).T, len(time), axis=1)
    # What rounding of start and scene does to phi, phi_dot, w and roll: an angle of 0 stands for that of the incline.
    sensitivity = ROUNDINGS * np.array([abs(state[0]) + 1, *np.abs(state[1:]), 0.0])
    values, slopes = rates(*state)
    fastest = abs(slopes[1, 2]) + abs(slopes[0, 1]) + abs(state[1]) + pace + math.sqrt(np.abs(values).sum())
    length = 1 / fastest if fastest > 0 else latest  # short beside every time that the motion has
    work, look, before = 0, _FIRST, 0.0
    while now < latest:
        if work >= look:
            _require_end(work, before, now, latest)
            look, before = 2 * look, now
        length, scale = min(length, latest - now), max(pace, abs(state[1])) + np.finfo(float).tiny
        if now + length == now:
            raise ToleranceError(
                f"the motion cannot be followed later than {now:.6g} s of {latest:.6g} s: there it changes within the "
                "rounding of the time"
            )
        used, solved = _newton(rates, state, length, scale, sensitivity)
        work += used
        if solved is None:
            length /= 4
            continue
        stages, changes = solved
        nodes = np.vstack([state[1:], stages.T])
        if (corner := _corner(nodes, kinks)) is not None:
            length *= corner
            continue
        series = _TO_SERIES @ nodes
        sizes = (np.abs(series[:-1]) / np.maximum(scale, np.abs(stages).max(axis=1))).max(axis=1)
        needed = 1 + int(np.max(np.flatnonzero(sizes > _TAIL), initial=0))
        if needed == _STAGES:
            length /= 2
            continue
        angles, then = length * _INTEGRALS @ np.array([stages[0], stages.sum(axis=0)]).T, now + length
        until = int(np.searchsorted(time, then, "right"))
        if until > done:
            x = 2 * (time[done:until] - now) / length - 1
            samples[:, done:until] = (legendre.legvander(x, _STAGES) @ np.hstack([angles, series])).T
            samples[:2, done:until] += turned[:, np.newaxis]
        sensitivity[[0, 3]] += length * _MATRIX[-1] @ np.array([changes[0], changes.sum(axis=0)]).T
        ends = angles.sum(axis=0)
        turned, state = turned + ends, np.array([reduced(state[0] + ends[0]), *stages[:, -1]])
        sensitivity[1:3] = changes[:, -1]
        sensitivity[:3] += np.copysign(ROUNDINGS * np.abs(state), sensitivity[:3])
        farthest = np.maximum(farthest, np.abs(turned))
        effect = float((np.abs(sensitivity[[0, 3]]) / farthest).max())
        if not effect <= UNCERTAIN:
            raise ToleranceError(
                f"phi is not known later than at {then:.6g} s: rounding of start and scene changes it by {effect:.2g} "
                f"rad (relative beyond 1 rad), where at most {UNCERTAIN:g} is allowed"
            )
        now, done, length = then, until, length * min(_GROWTH, 0.95 * _STAGES / needed)
    return samples


def _require_end(work: int, before: float, now: float, latest: float) -> None:
    """Check that the motion ends within the work allowed, from the times when half of the `work` and all was done.

    It goes on as fast as in the second half, or it is braked: then the work per time falls in proportion to the work
    if a turn is braked in proportion to its rate, and as its root if a swing dies away, which ends in half the work.
    """
    recent = max(now - before, math.ulp(now))
    ahead = (latest - now) / recent
    if recent > before:
        ahead = min(ahead, before / (recent - before) / 2)
    if work < _WORK and work * (1 + ahead / 2) <= _WORK:
        return
    # Half the work that is allowed, at the faster pace: so a motion that gets ever faster is followed until then, too.
    known = 0.9 * (now + max(_WORK / work - 2, 0.0) * min(before, recent))
    raise ToleranceError(
        f"the motion takes too many steps: it is too fast, or too long, to be followed until {latest:.6g} s; it can be "
        f"followed until {known:.3g} s"
    )


def _corner(nodes: np.ndarray, kinks: np.ndarray) -> float | None:
    """Return the share of a step at which the first of the sums whose absolute values count passes zero inside.

    The `nodes` are phi_dot and w at the start and the stages, of shape (stages + 1, 2).
    """
    sums, found = nodes @ kinks.T, []
    floor = _CANCELLED * np.abs(nodes).sum(axis=1).max()
    signs = np.where(np.abs(sums) > floor, np.sign(sums), 0.0)
    for which in np.flatnonzero(signs.min(axis=0) * signs.max(axis=0) < 0):
        (signed,) = np.nonzero(signs[:, which])
        series = (_TO_SERIES @ sums[:, which]).tolist()
        for low, high in itertools.pairwise(signed):
            if signs[low, which] != signs[high, which]:
                rising = functools.partial(_value, series, float(signs[high, which]))
                found.append((1 + root(rising, float(_NODES[low]), float(_NODES[high]))) / 2)
    return min((share for share in found if _BESIDE < share < 1 - _BESIDE), default=None)


def _value(series: list[float], sign: float, x: float) -> float:
    """Return a sum of Legendre polynomials times `sign`, by Clenshaw's recurrence: NumPy's takes 20 times as long."""
    one = two = 0.0
    for k in range(len(series) - 1, 0, -1):
        one, two = series[k] + (2 * k + 1) / (k + 1) * x * one - (k + 1) / (k + 2) * two, one
    return sign * (series[0] + x * one - two / 2)


def _newton(
    rates: Rates, state: np.ndarray, length: float, scale: float, sensitivity: np.ndarray
) -> tuple[int, tuple[np.ndarray, np.ndarray] | None]:
    """Return the number of corrections, phi_dot and w at the stages of a step, and their changes by the `sensitivity`.

    Newton's method solves for all stages at once, (2, stages), from values that stay as they begin, and may fail:
    None. Corrections are small beside the largest phi_dot or w, or `scale` [rad/s].
    """
    s, reach, begin, last = _STAGES, length * _MATRIX, state[1:, np.newaxis], math.inf
    stages, matrix, sides = np.repeat(begin, s, axis=1), np.empty((2 * s, 2 * s)), np.empty((2, s, 2))
    for used in range(1, _ITERATIONS + 1):
        values, slopes = rates(state[0] + reach @ stages[0], *stages)
        through_phi = (reach * slopes[:, :1]) @ reach
        matrix[:s, :s] = reach * slopes[0, 1] + through_phi[0]
        matrix[:s, s:] = reach * slopes[0, 2]
        matrix[s:, :s] = reach * slopes[1, 1] + through_phi[1]
        matrix[s:, s:] = reach * slopes[1, 2]
        sides[..., 0] = begin + values @ reach.T - stages
        sides[..., 1] = sensitivity[0] * slopes[:, 0] @ reach.T + sensitivity[1:3, np.newaxis]
        try:
            solved = np.linalg.solve(_EYE - matrix, sides.reshape(2 * s, 2)).reshape(2, s, 2)
        except np.linalg.LinAlgError:
            return used, None
        change, changes = solved[..., 0], solved[..., 1]
        stages = stages + change
        size = float((np.abs(change).max(axis=1) / np.maximum(scale, np.abs(stages).max(axis=1))).max())
        if last < _QUADRATIC:
            return used, (stages, changes)
        if not size < 1e6:
            return used, None
        last = size
    return used, None
