"""The motion of a sliding load with damping or drag, to rounding.

**The problem.** Damping and drag take energy, so that the time is no longer an integral over phi,
as it is in `motion`. The equations are integrated step by step instead.

**The equations** are those of `damped_equations`, for phi, phi_dot and the slip rate w.

**The method.** In each step, phi_dot and w are polynomials in x = -1 to 1 that obey the equations
at the Radau points. This method, Radau IIA with 24 stages, has the order 47. It is L-stable: a
fast decay takes small steps only as long as it lasts. (E. Hairer and G. Wanner, Solving Ordinary
Differential Equations II, IV.5.) The coefficients of the polynomials in Legendre's tell whether the
step is resolved to rounding. The same series give the motion between the ends of the step.

**Corners.** A damping may contain w |w|, and drag contains roll_dot |roll_dot|. The slope of x |x|
is 2 |x|, which has a corner at x = 0 that no polynomial follows. A step that would pass a corner
ends there instead.

**Rounding.** The derivatives that Newton's method needs also tell how errors of the start grow.
These are carried along, and a motion that rounding may change noticeably is refused.
"""

import itertools
import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.damped_equations import Equations
from mjbeer.theory.equations import AxisMotion, InitialState, slip_rate_of
from mjbeer.theory.launch import ROUNDINGS, Launch
from mjbeer.theory.motion import UNCERTAIN, SwingMotion
from mjbeer.theory.oscillator import reduced, root
from mjbeer.theory.scene import Scene
from mjbeer.theory.travel_time import EPS

_STAGES = 24
"""s in formulas; a swing then takes some five steps a period."""
_MOST_CORRECTIONS = 6_000
"""Corrections of Newton's method in all: enough for beer that swings 1 rad for 40 s."""
_MOST_CORRECTIONS_A_STEP = 12
"""Where Newton's method converges, each correction soon squares the error: a step that needs more
than these is too long."""
_DIVERGED = 1e6
"""Size of a correction, relative to the rates, from which Newton's method does not come back."""
_MOST_GROWTH = 10.0
"""Largest length of a step divided by that of the last one. It holds where two coefficients are
enough: so few do not tell how long the next step may be."""
_CAUTION = 0.95
"""Length of the next step divided by that at which all coefficients would be needed."""
_ANGLES = [0, 3]
"""Rows of phi and roll in the errors of `Progress`."""
_RATES = slice(1, 3)
"""Rows of phi_dot and w."""
_STATE = slice(0, 3)
"""Rows of phi, phi_dot and w."""


def solve(scene: Scene, time: np.ndarray, start: InitialState) -> tuple[SwingMotion, AxisMotion]:
    """Return the motion of a scene with damping or drag at increasing times [s], none negative.

    Raises:
      ToleranceError: as `exact`.
    """
    radius = scene.can.radius
    if scene.incline == 0 and Launch.of(scene.oscillator, start.phi, start.phi_dot).stays:
        zeros = np.zeros_like(time)
        return SwingMotion(start.phi + zeros, zeros), AxisMotion(start.u + zeros, zeros)
    slip_rate = slip_rate_of(scene, start.phi_dot, start.u_dot)
    state = np.array([reduced(start.phi), start.phi_dot, slip_rate])
    samples = _integrate(Equations(scene), time, state)
    swing = SwingMotion(start.phi + samples.delta_phi, samples.phi_dot)
    roll_dot = samples.phi_dot + samples.slip_rate
    return swing, AxisMotion(start.u + radius * samples.delta_roll, radius * roll_dot)


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

    rates: np.ndarray
    """phi_dot and w [rad/s], of shape (2, stages)."""
    errors: np.ndarray
    """By how much errors of the start change them, of the same shape."""


class Step(NamedTuple):
    """A step that was solved, as Legendre series over its length."""

    length: float
    """Its length [s]."""
    stages: Stages
    rates: np.ndarray
    """The series of phi_dot and w, of shape (1 + stages, 2)."""
    angles: np.ndarray
    """The series of the angles by which phi and roll turn, of the same shape."""

    def sample(self, since: np.ndarray) -> np.ndarray:
        """Return how far phi and roll turn [rad], phi_dot and w [rad/s] at times [s] within it."""
        basis = legendre.legvander(2 * since / self.length - 1, _STAGES)
        return (basis @ np.hstack([self.angles, self.rates])).T


class Trial(NamedTuple):
    """What has come of trying a step."""

    corrections: int
    """How many Newton's method made."""
    next_length: float
    """The length to try next [s]."""
    step: Step | None
    """The step that was solved; None if it must be shorter."""


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
        """Go on to the end of a step.

        Raises:
          ToleranceError: if rounding may have changed phi or roll too much by then.
        """
        phi_dot_errors, slip_errors = step.stages.errors
        roll_dot_errors = phi_dot_errors + slip_errors
        # The last row of the matrix integrates up to the end of the step.
        turned_errors = step.length * _MATRIX[-1] @ np.array([phi_dot_errors, roll_dot_errors]).T
        self.errors[_ANGLES] += turned_errors
        self.errors[_RATES] = step.stages.errors[:, -1]
        angles = step.angles.sum(axis=0)  # at the end, where each P_k is 1
        self.state = np.array([reduced(self.state[0] + angles[0]), *step.stages.rates[:, -1]])
        rounding = ROUNDINGS * np.abs(self.state)
        self.errors[_STATE] += np.copysign(rounding, self.errors[_STATE])
        self.time += step.length
        self.turned = self.turned + angles
        self.farthest = np.maximum(self.farthest, np.abs(self.turned))
        effect = float((np.abs(self.errors[_ANGLES]) / self.farthest).max())
        if not effect <= UNCERTAIN:
            raise ToleranceError(
                f"phi is not known later than at {self.time:.6g} s: rounding of start and scene "
                f"changes it by {effect:.2g} rad (relative beyond 1 rad), where at most "
                f"{UNCERTAIN:g} is allowed"
            )


class Samples(NamedTuple):
    """A motion at some times."""

    delta_phi: np.ndarray
    """How far phi has turned [rad]."""
    delta_roll: np.ndarray
    """How far roll has turned [rad]."""
    phi_dot: np.ndarray
    """[rad/s]"""
    slip_rate: np.ndarray
    """[rad/s]"""


def _integrate(equations: Equations, times: np.ndarray, state: np.ndarray) -> Samples:
    """Return the motion at increasing times; the `state` is phi, phi_dot and w at time 0."""
    latest = float(times[-1])
    samples = np.empty((4, len(times)))
    sampled = int(np.searchsorted(times, 0.0, "right"))
    samples[:, :sampled] = np.array([[0.0, 0.0, *state[1:]]]).T
    # The rounding of the scene, of its incline for one, counts as that of an angle of 1 rad.
    errors = ROUNDINGS * np.array([abs(state[0]) + 1, *np.abs(state[1:]), 0.0])
    progress = Progress(state, errors)
    corrections = 0
    length = _first_length(equations, state, latest)
    while progress.time < latest:
        length = min(length, latest - progress.time)
        if corrections >= _MOST_CORRECTIONS or progress.time + length == progress.time:
            raise ToleranceError(
                "the motion takes too many steps: it is too fast, or too long, to be followed "
                f"until {latest:.6g} s; it can be followed until {0.99 * progress.time:.3g} s"
            )
        trial = _try_step(equations, progress, length)
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
    return Samples(*samples)


def _first_length(equations: Equations, state: np.ndarray, latest: float) -> float:
    """Return a length [s] of the first step that is below every time scale of the start."""
    values, jacobian = equations.accelerations(*state)
    fastest = abs(jacobian[1, 2]) + abs(jacobian[0, 1]) + abs(state[1])
    fastest += equations.swing_rate + math.sqrt(np.abs(values).sum())
    return 1 / fastest if fastest > 0 else latest


def _try_step(equations: Equations, progress: Progress, length: float) -> Trial:
    """Try a step of a `length` [s]: it must be solved to rounding, and may pass no corner."""
    state = progress.state
    # Errors of a rate are relative to the rate, or to this where the rate is smaller.
    scale = max(equations.swing_rate, abs(state[1])) + np.finfo(float).tiny
    corrections, stages = _solve_stages(equations, state, progress.errors, length, scale)
    if stages is None:
        return Trial(corrections, length / 4, None)
    nodes = np.vstack([state[1:], stages.rates.T])
    share = _share_to_corner(nodes, equations.corners)
    if share is not None:
        return Trial(corrections, share * length, None)
    series = _TO_SERIES @ nodes
    largest = np.maximum(scale, np.abs(stages.rates).max(axis=1))
    sizes = (np.abs(series[:-1]) / largest).max(axis=1)
    # From the number `needed` on, all coefficients that are looked at are only rounding. If none
    # of them is, the series may go on beyond them, and the step is too long.
    needed = 1 + int(np.max(np.flatnonzero(sizes > 1e-14), initial=0))
    if needed == _STAGES:
        return Trial(corrections, length / 2, None)
    phi_dot, slip_rate = stages.rates
    angles = length * _TO_INTEGRAL @ np.array([phi_dot, phi_dot + slip_rate]).T
    step = Step(length, stages, series, angles)
    growth = min(_MOST_GROWTH, _CAUTION * _STAGES / needed)
    return Trial(corrections, length * growth, step)


def _share_to_corner(nodes: np.ndarray, corners: np.ndarray) -> float | None:
    """Return the share of a step at which the first corner is passed, or None if none is.

    `nodes` are phi_dot and w at the start and the stages, of shape (1 + stages, 2); `corners` are
    those of `Equations`.
    """
    rates = nodes @ corners.T
    # A rate smaller than this has no sign. In trials the rounding of the polynomial was up to
    # 72 eps, and differed between processors, which add in different orders.
    noise = 256 * EPS * np.abs(nodes).sum(axis=1).max()
    signs = np.where(np.abs(rates) > noise, np.sign(rates), 0.0)
    shares = []
    for sign, series in zip(signs.T, (_TO_SERIES @ rates).T, strict=True):
        for before, after in itertools.pairwise(np.flatnonzero(sign)):
            if sign[before] == sign[after]:
                continue
            rising = sign[after] * series
            x = root(lambda x, c=rising: legendre.legval(x, c), _NODES[before], _NODES[after])
            shares.append((1 + x) / 2)
    # A corner nearer than this to an end may stay inside: the torque beside it is the square of
    # that share, or less.
    return min((share for share in shares if 1e-6 < share < 1 - 1e-6), default=None)


def _solve_stages(
    equations: Equations,
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

    Let G be the matrix of these derivatives. A correction of Newton's method changes the y_i by the
    solution of

        (1 - G) change = right side - y.

    If phi_0 and y_0 have `errors`, those of the y_i solve equations with the same matrix,

        (1 - G) error = error of y_0 + h sum_j a_ij df_j/d(phi) (error of phi_0).

    A change of a rate is relative to its largest size, or to `scale` [rad/s] if that is larger.
    """
    reach = length * _MATRIX  # h a_ij
    begin = state[1:, np.newaxis]
    stages = np.repeat(begin, _STAGES, axis=1)
    unknowns = 2 * _STAGES  # phi_dot at all stages, and then w
    identity = np.eye(unknowns)
    derivatives = np.empty((unknowns, unknowns))  # G
    sides = np.empty((2, _STAGES, 2))  # the right sides for the changes and for the errors
    last_size = math.inf
    for corrections in range(1, _MOST_CORRECTIONS_A_STEP + 1):
        values, jacobian = equations.accelerations(state[0] + reach @ stages[0], *stages)
        for rate in range(2):  # phi_ddot, and then w_dot
            by_phi, by_phi_dot, by_w = jacobian[rate]
            rows = slice(rate * _STAGES, (rate + 1) * _STAGES)
            derivatives[rows, :_STAGES] = reach * by_phi_dot + (reach * by_phi) @ reach
            derivatives[rows, _STAGES:] = reach * by_w
        sides[..., 0] = begin + values @ reach.T - stages
        sides[..., 1] = errors[0] * jacobian[:, 0] @ reach.T + errors[_RATES, np.newaxis]
        try:
            solved = np.linalg.solve(identity - derivatives, sides.reshape(unknowns, 2))
        except np.linalg.LinAlgError:
            return corrections, None
        change = solved[:, 0].reshape(stages.shape)
        stages = stages + change
        largest = np.maximum(scale, np.abs(stages).max(axis=1))
        size = float((np.abs(change).max(axis=1) / largest).max())
        if last_size < 1e-9:  # each correction squares the error, and this one left rounding
            return corrections, Stages(stages, solved[:, 1].reshape(stages.shape))
        if not size < _DIVERGED:
            return corrections, None
        last_size = size
    return corrections, None
