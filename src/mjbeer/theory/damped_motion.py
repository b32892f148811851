"""The motion of a damped sliding scene to rounding, step by step: no first integral makes it a quadrature.

With rolling built in, the variables are phi, its rate, and the slip rate w = roll_dot - phi_dot, which keeps its digits
where the damping is strong and w small. Divided by M a^2, with M = m + m_can + I_can/a^2, only rates remain:

    roll_ddot = drive - beta (sin(phi) phi_dot^2 - cos(phi) phi_ddot) - torque(w) - drag roll_dot |roll_dot|,
    inertia(phi) phi_ddot = -depth sin(phi - bottom) - beta^2 sin(phi) cos(phi) phi_dot^2
                            + (1 - beta cos(phi)) torque(w) - beta cos(phi) drag roll_dot |roll_dot|.

Each step is a series of Legendre polynomials, x = -1 to 1, that obeys the equations at its Radau points: Radau IIA of
order 2s - 1, which is L-stable, so that what has decayed takes no small steps. (E. Hairer and G. Wanner, Solving
Ordinary Differential Equations II, IV.5.) A step that would pass a corner, where w or roll_dot is zero, ends there.
"""

import itertools
import math
from collections.abc import Callable

import numpy as np
from numpy.polynomial import legendre

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.equations import accelerations
from mjbeer.theory.motion import ROUNDINGS, UNCERTAIN, Launch
from mjbeer.theory.oscillator import reduced, root
from mjbeer.theory.scene import Scene
from mjbeer.theory.travel_time import EPS

_STAGES = 24  # s: of order 47, a swing takes some five steps a period to rounding
_WORK = 6_000  # most corrections of Newton's method in all: a can of beer that swings by 1 rad takes them in 40 s

Rates = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


_RADAU_POINTS = np.sort(legendre.legroots([0.0] * (_STAGES - 1) + [-1.0, 1.0]).real)  # of P_s - P_(s-1); the last is 1
_NODES = np.array([-1.0, *_RADAU_POINTS[:-1], 1.0])  # the start and the stages of a step
_INTEGRALS = legendre.legint(np.linalg.inv(legendre.legvander(_NODES[1:], _STAGES - 1)), lbnd=-1) / 2
"""The coefficients P_0 to P_s of the integral, over a step of length 1, of the polynomial through values at stages."""
_MATRIX = legendre.legvander(_NODES[1:], _STAGES) @ _INTEGRALS  # that integral at the stages, a_ij of the method
_TO_SERIES = np.linalg.inv(legendre.legvander(_NODES, _STAGES))
"""The coefficients P_0 to P_s of the polynomial through values at the start and the stages."""


def _rates_of(scene: Scene) -> Rates:
    """Return a function of phi, phi_dot and w: phi_ddot and w_dot [rad/s^2], and their derivatives, (2, 3, ...)."""
    oscillator, law, radius, mass = scene.oscillator, scene.damping_law, scene.can.radius, scene.effective_mass
    unit, beta, air = mass * radius**2, scene.load.moment / mass / radius, scene.drag * radius / mass

    def rates(phi: np.ndarray, phi_dot: np.ndarray, slip: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        roll_dot = phi_dot + slip
        u_ddot, phi_ddot = accelerations(scene, phi, phi_dot, radius * roll_dot, slip)
        arm, lean, square = beta * np.cos(phi), beta * np.sin(phi), phi_dot * phi_dot
        d_torque, d_drag, open_arm = law.derivative(slip) / unit, 2 * air * np.abs(roll_dot), 1 - arm
        braking = law.torque(slip) / unit + d_drag * roll_dot / 2
        by_phi = -oscillator.depth / unit * np.cos(phi - oscillator.bottom) - (arm * arm - lean * lean) * square
        by_phi += lean * braking - 2 * lean * arm * phi_ddot
        swing = np.array([by_phi, -2 * lean * arm * phi_dot - arm * d_drag, open_arm * d_torque - arm * d_drag])
        swing /= oscillator.inertia(phi) / unit
        slide = np.array([-arm * square - lean * phi_ddot, -2 * lean * phi_dot - d_drag, -d_torque - d_drag])
        return np.array([phi_ddot, u_ddot / radius - phi_ddot]), np.array([swing, slide - open_arm * swing])

    return rates


def solve(scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, ...]:
    """Return phi [rad], phi_dot [rad/s], u [m] and u_dot [m/s] at times [s], with the errors of `exact`."""
    radius, (u0, u_dot0) = scene.can.radius, scene.start(phi0, phi_dot0)
    if scene.incline == 0 and Launch.of(scene.oscillator, phi0, phi_dot0).stays:
        still = np.zeros_like(time)
        return phi0 + still, still, u0 + still, still
    order = np.argsort(time)
    swing_rate = math.sqrt(scene.oscillator.depth / scene.oscillator.base)
    start = np.array([reduced(phi0), phi_dot0, u_dot0 / radius - phi_dot0])
    corners = [[0.0, 1.0]] * (scene.damping_law.quadratic > 0) + [[1.0, 1.0]] * (scene.drag > 0)
    followed = _integrate(_rates_of(scene), time[order], start, swing_rate, np.reshape(corners, (-1, 2)))
    delta_phi, delta_roll, phi_dot, slip = followed[:, np.argsort(order)]
    return phi0 + delta_phi, phi_dot, u0 + radius * delta_roll, radius * (phi_dot + slip)


def _integrate(rates: Rates, time: np.ndarray, state: np.ndarray, swing_rate: float, corners: np.ndarray) -> np.ndarray:
    """Return how far phi and roll have turned [rad], phi_dot and w [rad/s] at sorted times, of shape (4, times).

    The `state` is phi, phi_dot and w at time 0; a row of `corners` is a sum of phi_dot and w with an absolute value.
    """
    now, latest, deltas, largest = 0.0, float(time[-1]), np.zeros(2), np.ones(2)
    done = int(np.searchsorted(time, 0.0, "right"))
    samples = np.repeat(np.array([[0.0, 0.0, *state[1:]]]).T, len(time), axis=1)
    # What rounding of start and scene does to phi, phi_dot, w and roll: an angle of 0 stands for that of the incline.
    sensitivity = ROUNDINGS * np.array([abs(state[0]) + 1, *np.abs(state[1:]), 0.0])
    values, jacobian = rates(*state)
    fastest = abs(jacobian[1, 2]) + abs(jacobian[0, 1]) + abs(state[1]) + swing_rate + math.sqrt(np.abs(values).sum())
    length = 1 / fastest if fastest > 0 else latest  # short beside every time that the motion has
    work = 0
    while now < latest:
        length, scale = min(length, latest - now), max(swing_rate, abs(state[1])) + np.finfo(float).tiny
        if work >= _WORK or now + length == now:
            raise ToleranceError(
                f"the motion takes too many steps: it is too fast, or too long, to be followed until {latest:.6g} s; "
                f"it can be followed until {0.99 * now:.3g} s"
            )
        used, solved = _solve_stages(rates, state, length, scale, sensitivity)
        work += used
        if solved is None:
            length /= 4
            continue
        stages, changes = solved
        nodes = np.vstack([state[1:], stages.T])
        if (corner := _share_to_corner(nodes, corners)) is not None:
            length *= corner
            continue
        series = _TO_SERIES @ nodes
        sizes = (np.abs(series[:-1]) / np.maximum(scale, np.abs(stages).max(axis=1))).max(axis=1)
        needed = 1 + int(np.max(np.flatnonzero(sizes > 1e-14), initial=0))
        if needed == _STAGES:
            length /= 2
            continue
        angles, then = length * _INTEGRALS @ np.array([stages[0], stages.sum(axis=0)]).T, now + length
        until = int(np.searchsorted(time, then, "right"))
        if until > done:
            x = 2 * (time[done:until] - now) / length - 1
            samples[:, done:until] = (legendre.legvander(x, _STAGES) @ np.hstack([angles, series])).T
            samples[:2, done:until] += deltas[:, np.newaxis]
        sensitivity[[0, 3]] += length * _MATRIX[-1] @ np.array([changes[0], changes.sum(axis=0)]).T
        step_angles = angles.sum(axis=0)
        deltas, state = deltas + step_angles, np.array([reduced(state[0] + step_angles[0]), *stages[:, -1]])
        sensitivity[1:3] = changes[:, -1]
        sensitivity[:3] += np.copysign(ROUNDINGS * np.abs(state), sensitivity[:3])
        largest = np.maximum(largest, np.abs(deltas))
        effect = float((np.abs(sensitivity[[0, 3]]) / largest).max())
        if not effect <= UNCERTAIN:
            raise ToleranceError(
                f"phi is not known later than at {then:.6g} s: rounding of start and scene changes it by {effect:.2g} "
                f"rad (relative beyond 1 rad), where at most {UNCERTAIN:g} is allowed"
            )
        now, done, length = then, until, length * min(10.0, 0.95 * _STAGES / needed)
    return samples


def _share_to_corner(nodes: np.ndarray, corners: np.ndarray) -> float | None:
    """Return the share of a step, with phi_dot and w at its `nodes`, at which the first corner is passed, if one is."""
    sums, shares = nodes @ corners.T, []
    # The polynomial through the stages is off by up to 72 eps in trials: each processor sums in another order.
    signs = np.where(np.abs(sums) > 256 * EPS * np.abs(nodes).sum(axis=1).max(), np.sign(sums), 0.0)
    for sign, series in zip(signs.T, (_TO_SERIES @ sums).T, strict=True):
        for low, high in itertools.pairwise(np.flatnonzero(sign)):
            if sign[low] != sign[high]:
                towards = sign[high] * series
                shares.append((1 + root(lambda x, c=towards: legendre.legval(x, c), _NODES[low], _NODES[high])) / 2)
    # A corner that near an end may stay: the torque beside it is the square of that, or less.
    return min((share for share in shares if 1e-6 < share < 1 - 1e-6), default=None)


def _solve_stages(
    rates: Rates, state: np.ndarray, length: float, scale: float, sensitivity: np.ndarray
) -> tuple[int, tuple[np.ndarray, np.ndarray] | None]:
    """Return the number of corrections, phi_dot and w at the stages of a step, and their changes by the `sensitivity`.

    Newton's method solves for all stages at once, and may fail: None. Errors are relative to `scale` [rad/s] at least.
    """
    s, reach, begin, last = _STAGES, length * _MATRIX, state[1:, np.newaxis], math.inf
    stages, matrix, sides = np.repeat(begin, s, axis=1), np.empty((2 * s, 2 * s)), np.empty((2, s, 2))
    for used in range(1, 13):
        values, jacobian = rates(state[0] + reach @ stages[0], *stages)
        through_phi = (reach * jacobian[:, :1]) @ reach
        matrix[:s, :s] = reach * jacobian[0, 1] + through_phi[0]
        matrix[:s, s:] = reach * jacobian[0, 2]
        matrix[s:, :s] = reach * jacobian[1, 1] + through_phi[1]
        matrix[s:, s:] = reach * jacobian[1, 2]
        sides[..., 0] = begin + values @ reach.T - stages
        sides[..., 1] = sensitivity[0] * jacobian[:, 0] @ reach.T + sensitivity[1:3, np.newaxis]
        try:
            solved = np.linalg.solve(np.eye(2 * s) - matrix, sides.reshape(2 * s, 2)).reshape(2, s, 2)
        except np.linalg.LinAlgError:
            return used, None
        change, changes = solved[..., 0], solved[..., 1]
        stages = stages + change
        size = float((np.abs(change).max(axis=1) / np.maximum(scale, np.abs(stages).max(axis=1))).max())
        if last < 1e-9:  # each correction squares the error, and the last one left rounding
            return used, (stages, changes)
        if not size < 1e6:
            return used, None
        last = size
    return used, None
