"""The motion of a sliding load with damping or drag, to rounding.

**The problem.** Damping and drag take energy, so that no integral of energy makes the time a
quadrature, as it does in `motion`. The equations are integrated step by step instead.

**The equations** are (46) and (47) with the torque T(w) of the damping and the drag
d u_dot |u_dot|. The variables are phi, phi_dot and the slip rate w = roll_dot - phi_dot, with
roll = u/a. Where the damping is strong, w is small, and as a difference it would lose its digits.
With M_e = m + m_can + I_can/a^2, (46) is divided by M_e a and (47) by M_e a^2. With u_ddot
eliminated from (47) they are

    roll_ddot = drive - beta (sin(phi) phi_dot^2 - cos(phi) phi_ddot) - B,
    j(phi) phi_ddot = -delta sin(phi - bottom) - beta^2 sin(phi) cos(phi) phi_dot^2
                      + tau(w) - beta cos(phi) B,
    B = tau(w) + kappa roll_dot |roll_dot|.

Here B brakes the can, drive = m_t g sin(alpha)/(M_e a), beta = m b/(M_e a), tau = T/(M_e a^2) and
kappa = d a/M_e. j = J/(M_e a^2) and delta = depth/(M_e a^2) have J, `depth` and `bottom` of
`Oscillator`.

**The method.** In each step, phi_dot and w are polynomials in x = -1 to 1 that obey the equations
at the Radau points. This is Radau IIA with s stages, of order 2 s - 1. It is L-stable: what has
decayed, however fast it did, takes no small steps. (E. Hairer and G. Wanner, Solving Ordinary
Differential Equations II, IV.5.) As Legendre series the polynomials show whether they have reached
rounding, and give the motion between the ends of the step.

**Corners.** The slopes of w |w|, which a damping may contain, and of roll_dot |roll_dot| have
corners where w or roll_dot is zero. No polynomial follows them. A step that would pass a corner
ends there instead.

**Rounding.** The derivatives that Newton's method needs also tell how errors of the start grow.
These are carried along, and a motion that rounding may change noticeably is refused.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.equations import accelerations
from mjbeer.theory.motion import ROUNDINGS, UNCERTAIN, Launch
from mjbeer.theory.oscillator import reduced, root
from mjbeer.theory.scene import Scene
from mjbeer.theory.travel_time import EPS

_STAGES = 24  # s: a swing takes some five steps a period to rounding
_MOST_CORRECTIONS = 6_000  # of Newton's method in all: enough for beer that swings 1 rad for 40 s

_SLIP_RATE = (0.0, 1.0)
_ROLL_DOT = (1.0, 1.0)
"""The rates that may have corners, as factors of phi_dot and w whose products are added."""


def solve(
    scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return phi [rad], phi_dot [rad/s], u [m] and u_dot [m/s] at times [s].

    Raises:
      ToleranceError: as `exact`.
    """
    radius = scene.can.radius
    u0, u_dot0 = scene.start(phi0, phi_dot0)
    if scene.incline == 0 and Launch.of(scene.oscillator, phi0, phi_dot0).stays:
        zeros = np.zeros_like(time)
        return phi0 + zeros, zeros, u0 + zeros, zeros
    corners = []
    if scene.damping_law.quadratic > 0:
        corners.append(_SLIP_RATE)
    if scene.drag > 0:
        corners.append(_ROLL_DOT)
    order = np.argsort(time)
    samples = _integrate(
        _rates_of(scene),
        time[order],
        state=np.array([reduced(phi0), phi_dot0, u_dot0 / radius - phi_dot0]),
        swing_rate=math.sqrt(scene.oscillator.depth / scene.oscillator.base),
        corners=np.reshape(corners, (-1, 2)),
    )
    delta_phi, delta_roll, phi_dot, slip_rate = samples[:, np.argsort(order)]
    return phi0 + delta_phi, phi_dot, u0 + radius * delta_roll, radius * (phi_dot + slip_rate)


# The equations and their derivatives


class Rates(NamedTuple):
    """phi_ddot and w_dot in a state, or in several at once."""

    values: np.ndarray  # phi_ddot and w_dot [rad/s^2], of shape (2, ...)
    jacobian: np.ndarray  # their derivatives by phi, phi_dot and w, of shape (2, 3, ...)


RatesFunction = Callable[[np.ndarray, np.ndarray, np.ndarray], Rates]
"""A function of phi, phi_dot and w."""


def _rates_of(scene: Scene) -> RatesFunction:
    """Return the function that evaluates the equations of a scene and their derivatives.

    With c = beta cos(phi) and s = beta sin(phi), of which the derivatives by phi are -s and c,

        j phi_ddot = -delta sin(phi - bottom) - s c phi_dot^2 + tau - c B,
        roll_ddot = drive - s phi_dot^2 + c phi_ddot - B,
        w_dot = roll_ddot - phi_ddot.

    j = J/(M_e a^2) has the derivative 2 s c, as J = base + coupling sin^2(phi) with coupling = (m
    b)^2/M_e = beta^2 M_e a^2. Since roll_dot = phi_dot + w, D = 2 kappa |roll_dot| is the
    derivative of kappa roll_dot |roll_dot| by phi_dot as well as by w. Hence B has the derivatives
    0 by phi, D by phi_dot and tau' + D by w. The product rule on the first equation gives

        j d(phi_ddot)/d(phi) = -delta cos(phi - bottom) - (c^2 - s^2) phi_dot^2 + s B
                               - 2 s c phi_ddot,
        j d(phi_ddot)/d(phi_dot) = -2 s c phi_dot - c D,
        j d(phi_ddot)/d(w) = tau' - c (tau' + D) = (1 - c) tau' - c D,

    and the other two together, as w_dot = drive - s phi_dot^2 - B - (1 - c) phi_ddot,

        d(w_dot)/d(phi) = -c phi_dot^2 - s phi_ddot - (1 - c) d(phi_ddot)/d(phi),
        d(w_dot)/d(phi_dot) = -2 s phi_dot - D - (1 - c) d(phi_ddot)/d(phi_dot),
        d(w_dot)/d(w) = -tau' - D - (1 - c) d(phi_ddot)/d(w).
    """
    oscillator = scene.oscillator
    law = scene.damping_law
    radius = scene.can.radius
    unit = scene.effective_mass * radius**2  # M_e a^2
    beta = scene.load.moment / scene.effective_mass / radius
    kappa = scene.drag * radius / scene.effective_mass
    delta = oscillator.depth / unit

    def rates(phi: np.ndarray, phi_dot: np.ndarray, slip_rate: np.ndarray) -> Rates:
        roll_dot = phi_dot + slip_rate
        u_ddot, phi_ddot = accelerations(scene, phi, phi_dot, radius * roll_dot, slip_rate)
        c = beta * np.cos(phi)
        s = beta * np.sin(phi)
        square = phi_dot * phi_dot
        d_tau = law.derivative(slip_rate) / unit
        d_drag = 2 * kappa * np.abs(roll_dot)
        braking = law.torque(slip_rate) / unit + d_drag * roll_dot / 2
        gravity = delta * np.cos(phi - oscillator.bottom)
        phi_ddot_by = np.array(
            [
                -gravity - (c * c - s * s) * square + s * braking - 2 * s * c * phi_ddot,
                -2 * s * c * phi_dot - c * d_drag,
                (1 - c) * d_tau - c * d_drag,
            ]
        )
        phi_ddot_by /= oscillator.inertia(phi) / unit
        w_dot_by = np.array(
            [
                -c * square - s * phi_ddot,
                -2 * s * phi_dot - d_drag,
                -d_tau - d_drag,
            ]
        )
        w_dot_by -= (1 - c) * phi_ddot_by
        values = np.array([phi_ddot, u_ddot / radius - phi_ddot])
        return Rates(values, np.array([phi_ddot_by, w_dot_by]))

    return rates


# Polynomials on a step, in x = -1 to 1


_RADAU_POINTS = np.sort(legendre.legroots([0.0] * (_STAGES - 1) + [-1.0, 1.0]).real)
"""The stages: the roots of P_s - P_(s-1), the last of which is 1."""
_NODES = np.array([-1.0, *_RADAU_POINTS[:-1], 1.0])
"""The start and the stages of a step."""
_TO_SERIES = np.linalg.inv(legendre.legvander(_NODES, _STAGES))
"""This matrix, times values at the start and the stages, gives the Legendre series through them."""
_STAGES_TO_SERIES = np.linalg.inv(legendre.legvander(_NODES[1:], _STAGES - 1))
"""This one takes the values at the stages alone."""
_TO_INTEGRAL = legendre.legint(_STAGES_TO_SERIES, lbnd=-1) / 2
"""This one gives the series of their integral from the start on, if the step has the length 1."""
_MATRIX = legendre.legvander(_NODES[1:], _STAGES) @ _TO_INTEGRAL
"""This one gives that integral at the stages: the a_ij of the method."""


class Stages(NamedTuple):
    """What is known at the stages of a step that was solved."""

    rates: np.ndarray  # phi_dot and w [rad/s], of shape (2, stages)
    errors: np.ndarray  # by how much errors of the start change them, of the same shape


class Step(NamedTuple):
    """A step that was solved, as Legendre series over its length."""

    length: float  # [s]
    stages: Stages
    rates: np.ndarray  # the series of phi_dot and w, of shape (1 + stages, 2)
    angles: np.ndarray  # those of the angles by which phi and roll turn, of the same shape

    def sample(self, since: np.ndarray) -> np.ndarray:
        """Return how far phi and roll turn [rad], phi_dot and w [rad/s] at times [s] within it."""
        basis = legendre.legvander(2 * since / self.length - 1, _STAGES)
        return (basis @ np.hstack([self.angles, self.rates])).T


class Trial(NamedTuple):
    """What has come of trying a step."""

    corrections: int  # of Newton's method
    next_length: float  # to try next [s]
    step: Step | None  # None if the step must be shorter


# From step to step


@dataclass
class Progress:
    """How far a motion has been followed."""

    state: np.ndarray
    """phi less whole turns [rad], phi_dot and w [rad/s]."""
    errors: np.ndarray
    """By how much rounding may have changed phi, phi_dot, w and roll."""
    time: float = 0.0
    """Time since the start of the motion [s]."""
    turned: np.ndarray = field(default_factory=lambda: np.zeros(2))
    """How far phi and roll have turned since then [rad]."""
    farthest: np.ndarray = field(default_factory=lambda: np.ones(2))
    """How far each has been from the start [rad], at least 1."""

    def advance(self, step: Step) -> None:
        """Go on to the end of a step."""
        phi_dot_errors, slip_errors = step.stages.errors
        roll_dot_errors = phi_dot_errors + slip_errors
        # The last row of the matrix integrates up to the end of the step.
        turned_errors = step.length * _MATRIX[-1] @ np.array([phi_dot_errors, roll_dot_errors]).T
        self.errors[[0, 3]] += turned_errors
        self.errors[1:3] = step.stages.errors[:, -1]
        angles = step.angles.sum(axis=0)  # at the end, where each P_k is 1
        self.state = np.array([reduced(self.state[0] + angles[0]), *step.stages.rates[:, -1]])
        self.errors[:3] += np.copysign(ROUNDINGS * np.abs(self.state), self.errors[:3])
        self.time += step.length
        self.turned = self.turned + angles
        self.farthest = np.maximum(self.farthest, np.abs(self.turned))
        effect = float((np.abs(self.errors[[0, 3]]) / self.farthest).max())
        if not effect <= UNCERTAIN:
            raise ToleranceError(
                f"phi is not known later than at {self.time:.6g} s: rounding of start and scene "
                f"changes it by {effect:.2g} rad (relative beyond 1 rad), where at most "
                f"{UNCERTAIN:g} is allowed"
            )


def _integrate(
    rates: RatesFunction,
    times: np.ndarray,
    state: np.ndarray,
    swing_rate: float,
    corners: np.ndarray,
) -> np.ndarray:
    """Return how far phi and roll have turned [rad], phi_dot and w [rad/s] at sorted times.

    The result has shape (4, times). The `state` is phi, phi_dot and w at time 0, `swing_rate` the
    frequency [rad/s] of the load's swings. A row of `corners` is `_SLIP_RATE` or `_ROLL_DOT`.
    """
    latest = float(times[-1])
    samples = np.empty((4, len(times)))
    sampled = int(np.searchsorted(times, 0.0, "right"))
    samples[:, :sampled] = np.array([[0.0, 0.0, *state[1:]]]).T
    # An angle of 0 stands for that of the incline, which is rounded as one of 1 rad.
    errors = ROUNDINGS * np.array([abs(state[0]) + 1, *np.abs(state[1:]), 0.0])
    progress = Progress(state, errors)
    corrections = 0
    length = _first_length(rates(*state), state, swing_rate, latest)
    while progress.time < latest:
        length = min(length, latest - progress.time)
        if corrections >= _MOST_CORRECTIONS or progress.time + length == progress.time:
            raise ToleranceError(
                "the motion takes too many steps: it is too fast, or too long, to be followed "
                f"until {latest:.6g} s; it can be followed until {0.99 * progress.time:.3g} s"
            )
        trial = _try_step(rates, progress, length, swing_rate, corners)
        corrections += trial.corrections
        length = trial.next_length
        if trial.step is None:
            continue
        end = progress.time + trial.step.length
        until = int(np.searchsorted(times, end, "right"))
        if until > sampled:
            samples[:, sampled:until] = trial.step.sample(times[sampled:until] - progress.time)
            samples[:2, sampled:until] += progress.turned[:, np.newaxis]
            sampled = until
        progress.advance(trial.step)
    return samples


def _first_length(rates: Rates, state: np.ndarray, swing_rate: float, latest: float) -> float:
    """Return the length [s] of the first step, short beside every time that the motion has."""
    values, jacobian = rates
    fastest = abs(jacobian[1, 2]) + abs(jacobian[0, 1]) + abs(state[1])
    fastest += swing_rate + math.sqrt(np.abs(values).sum())
    return 1 / fastest if fastest > 0 else latest


def _try_step(
    rates: RatesFunction,
    progress: Progress,
    length: float,
    swing_rate: float,
    corners: np.ndarray,
) -> Trial:
    """Return the step of a `length` [s], if it can be solved to rounding and passes no corner."""
    state = progress.state
    # Errors of rates are relative to the rates, or to this where they are smaller.
    scale = max(swing_rate, abs(state[1])) + np.finfo(float).tiny
    corrections, stages = _solve_stages(rates, state, progress.errors, length, scale)
    if stages is None:
        return Trial(corrections, length / 4, None)
    nodes = np.vstack([state[1:], stages.rates.T])
    share = _share_to_corner(nodes, corners)
    if share is not None:
        return Trial(corrections, share * length, None)
    series = _TO_SERIES @ nodes
    largest = np.maximum(scale, np.abs(stages.rates).max(axis=1))
    sizes = (np.abs(series[:-1]) / largest).max(axis=1)
    needed = 1 + int(np.max(np.flatnonzero(sizes > 1e-14), initial=0))
    if needed == _STAGES:
        return Trial(corrections, length / 2, None)
    phi_dot, slip_rate = stages.rates
    angles = length * _TO_INTEGRAL @ np.array([phi_dot, phi_dot + slip_rate]).T
    longer = min(10.0, 0.95 * _STAGES / needed)
    return Trial(corrections, longer * length, Step(length, stages, series, angles))


def _share_to_corner(nodes: np.ndarray, corners: np.ndarray) -> float | None:
    """Return the share of a step at which the first corner is passed, or None if none is.

    `nodes` are phi_dot and w at the start and the stages, of shape (1 + stages, 2).
    """
    shares = []
    rates = nodes @ corners.T
    # A rate smaller than this has no sign. In trials the polynomial was off by up to 72 eps, by
    # another amount on each processor, as each sums in another order.
    noise = 256 * EPS * np.abs(nodes).sum(axis=1).max()
    signs = np.where(np.abs(rates) > noise, np.sign(rates), 0.0)
    for sign, series in zip(signs.T, (_TO_SERIES @ rates).T, strict=True):
        for low, high in itertools.pairwise(np.flatnonzero(sign)):
            if sign[low] != sign[high]:
                rising = sign[high] * series
                x = root(lambda x, c=rising: legendre.legval(x, c), _NODES[low], _NODES[high])
                shares.append((1 + x) / 2)
    # A corner that near an end may stay: the torque beside it is the square of that, or less.
    return min((share for share in shares if 1e-6 < share < 1 - 1e-6), default=None)


def _solve_stages(
    rates: RatesFunction,
    state: np.ndarray,
    errors: np.ndarray,
    length: float,
    scale: float,
) -> tuple[int, Stages | None]:
    """Return the number of corrections, and the stages of a step, or None if Newton's method fails.

    The unknowns are y_i = (phi_dot_i, w_i) at all stages i. With f = (phi_ddot, w_dot), h for the
    `length` and the index 0 for the start, they obey

        y_i = y_0 + h sum_j a_ij f(phi_j, y_j),    phi_j = phi_0 + h sum_k a_jk phi_dot_k.

    f_j = f(phi_j, y_j) depends on phi_dot_j and w_j directly, and through phi_j on all phi_dot_k.
    Hence the right side for y_i has the derivatives

        by phi_dot_k:  h a_ik df_k/d(phi_dot) + h sum_j a_ij df_j/d(phi) h a_jk,
        by w_k:        h a_ik df_k/d(w).

    Let G be the matrix of these derivatives. The change of y by a correction solves

        (1 - G) change = right side - y.

    If phi_0 and y_0 have `errors`, the errors of the y_i solve

        (1 - G) error = error of y_0 + h sum_j a_ij df_j/d(phi) (error of phi_0),

    so that both are solved together. All errors of rates are relative to `scale` [rad/s] at least.
    """
    reach = length * _MATRIX  # h a_ij
    begin = state[1:, np.newaxis]
    stages = np.repeat(begin, _STAGES, axis=1)
    derivatives = np.empty((2, _STAGES, 2, _STAGES))  # G: of phi_dot_i or w_i by phi_dot_k or w_k
    sides = np.empty((2, _STAGES, 2))  # the right sides for the changes and for the errors
    unknowns = 2 * _STAGES
    last_size = math.inf
    for corrections in range(1, 13):
        values, jacobian = rates(state[0] + reach @ stages[0], *stages)
        by_phi = jacobian[:, [0]]
        by_phi_dot = jacobian[:, [1]]
        by_w = jacobian[:, [2]]
        derivatives[:, :, 0] = reach * by_phi_dot + (reach * by_phi) @ reach
        derivatives[:, :, 1] = reach * by_w
        sides[..., 0] = begin + values @ reach.T - stages
        sides[..., 1] = errors[0] * jacobian[:, 0] @ reach.T + errors[1:3, np.newaxis]
        matrix = np.eye(unknowns) - derivatives.reshape(unknowns, unknowns)
        try:
            solved = np.linalg.solve(matrix, sides.reshape(unknowns, 2)).reshape(sides.shape)
        except np.linalg.LinAlgError:
            return corrections, None
        change = solved[..., 0]
        stages = stages + change
        largest = np.maximum(scale, np.abs(stages).max(axis=1))
        size = float((np.abs(change).max(axis=1) / largest).max())
        if last_size < 1e-9:  # each correction squares the error, and the last one left rounding
            return corrections, Stages(stages, solved[..., 1])
        if not size < 1e6:
            return corrections, None
        last_size = size
    return corrections, None
