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

|w| and |roll_dot| have a corner at zero: they are taken as w and roll_dot times a sign that a step keeps, so that it is
smooth, and ends where that is wrong.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.motion import ROUNDINGS, UNCERTAIN, Start
from mjbeer.theory.oscillator import reduced
from mjbeer.theory.scene import Scene

_STAGES = 19
"""Number of stages s. The method is of order 37, and a swing takes some five steps a period to rounding."""
_STEPS = 10_000
"""Largest number of steps."""
_ITERATIONS = 12
"""Most corrections of Newton's method."""
_QUADRATIC = 1e-9
"""Relative size of a correction after which one more leaves only rounding, as each squares the error."""
_TAIL = 1e-14
"""Size of the terms of a step's polynomials that may be missing, relative to the rates."""
_GROWTH = 10.0
"""Largest ratio of a step to the one before."""
_REJECTED = 0.8
"""A step is taken again if it should have been shorter by more than this factor; its terms are then below 1e-12."""
_CORNER = 1e-10
"""How far w or roll_dot may pass zero within a step, relative to itself. The error that this makes is its square."""
_TINY = np.finfo(float).tiny


def _points() -> np.ndarray:
    """Return the Radau points, the roots of P_s - P_(s-1), of which the last is 1."""
    series = np.zeros(_STAGES + 1)
    series[-2:] = -1, 1
    rough = np.sort(legendre.legroots(series).real)
    points = rough - legendre.legval(rough, series) / legendre.legval(rough, legendre.legder(series))
    points[-1] = 1.0
    return points


_POINTS = _points()
_FRACTIONS = (1 + _POINTS) / 2
"""Where in the step the stages are, from 0 to 1."""
_COEFFICIENTS = np.linalg.inv(legendre.legvander(_POINTS, _STAGES - 1))
"""The coefficients P_0 to P_(s-1) of the polynomial through the values at the stages."""
_INTEGRALS = legendre.legint(_COEFFICIENTS, lbnd=-1) / 2
"""The coefficients P_0 to P_s of the integral of that polynomial, from the start of a step of length 1."""
_MATRIX = legendre.legvander(_POINTS, _STAGES) @ _INTEGRALS
"""That integral at the stages, a_ij of the method."""
_AT_START = (-1.0) ** np.arange(_STAGES)
_VANISHING = np.zeros(_STAGES + 1)
_VANISHING[-2:] = np.array([-1, 1]) * (-1) ** _STAGES / 2


def _series(start: np.ndarray, stages: np.ndarray) -> np.ndarray:
    """Return the coefficients P_0 to P_s of the polynomials through values at the start, (n,), and stages, (s, n)."""
    coefficients = np.zeros((_STAGES + 1, stages.shape[1]))
    coefficients[:_STAGES] = _COEFFICIENTS @ stages
    # A multiple of P_s - P_(s-1), which vanishes at the stages, brings the polynomial to its start.
    return coefficients + np.outer(_VANISHING, start - _AT_START @ coefficients[:_STAGES])


_EYE = np.eye(_STAGES)
_GRID = np.linspace(-1, 1, 4 * _STAGES + 1)
_GRID_VALUES = legendre.legvander(_GRID, _STAGES)

Sides = tuple[float, float]
"""The signs of w and of roll_dot."""


@dataclass(frozen=True)
class Equations:
    """The coefficients of the equations above, over M a^2."""

    drive: float
    beta: float
    base: float
    depth: float
    bottom: float
    torques: tuple[float, float, float]
    drag: float

    @classmethod
    def of(cls, scene: Scene) -> "Equations":
        """Return the equations of a scene with a sliding load."""
        radius, oscillator, mass = scene.can.radius, scene.oscillator, scene.effective_mass
        unit = mass * radius**2
        linear, quadratic, cubic = (each / unit for each in scene.damping_law.coefficients)
        return cls(
            drive=scene.drive / mass / radius,
            beta=scene.load.moment / mass / radius,
            base=oscillator.base / unit,
            depth=oscillator.depth / unit,
            bottom=oscillator.bottom,
            torques=(linear, quadratic, cubic),
            drag=scene.drag * radius / mass,
        )

    def rates(
        self, phi: np.ndarray, phi_dot: np.ndarray, slip: np.ndarray, sides: Sides
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return phi_ddot and w_dot [rad/s^2], of shape (2, n), and their derivatives, of shape (2, 3, n).

        The derivatives are by phi, phi_dot and w, which is `slip`.
        """
        beta, (linear, quadratic, cubic) = self.beta, self.torques
        sin, cos, square, roll_dot = np.sin(phi), np.cos(phi), phi_dot * phi_dot, phi_dot + slip
        quadratic, drag = sides[0] * quadratic, sides[1] * self.drag
        torque = slip * (linear + slip * (quadratic + slip * cubic))
        steep = linear + slip * (2 * quadratic + slip * 3 * cubic)
        air, air_slope = drag * roll_dot * roll_dot, 2 * drag * roll_dot
        arm, lean = beta * cos, beta * sin
        inertia, open_arm = self.base + lean * lean, 1 - arm
        turned = phi - self.bottom
        phi_ddot = (-self.depth * np.sin(turned) - lean * arm * square + open_arm * torque - arm * air) / inertia
        slip_dot = self.drive - lean * square - torque - air - open_arm * phi_ddot
        slopes = np.empty((2, 3, *np.shape(phi)))
        by_phi = -self.depth * np.cos(turned) - (arm * arm - lean * lean) * square + lean * (torque + air)
        slopes[0, 0] = (by_phi - 2 * lean * arm * phi_ddot) / inertia
        slopes[0, 1] = (-2 * lean * arm * phi_dot - arm * air_slope) / inertia
        slopes[0, 2] = (open_arm * steep - arm * air_slope) / inertia
        slopes[1, 0] = -arm * square - lean * phi_ddot - open_arm * slopes[0, 0]
        slopes[1, 1] = -2 * lean * phi_dot - air_slope - open_arm * slopes[0, 1]
        slopes[1, 2] = -steep - air_slope - open_arm * slopes[0, 2]
        return np.array([phi_ddot, slip_dot]), slopes

    def sides(self, phi: float, phi_dot: float, slip: float) -> Sides:
        """Return the signs of w and roll_dot, or where they are zero, of those that follow."""
        sides = math.copysign(1, slip), math.copysign(1, phi_dot + slip)
        phi_ddot, slip_dot = self.rates(np.array(phi), np.array(phi_dot), np.array(slip), sides)[0]
        return (
            sides[0] if slip else math.copysign(1, slip_dot),
            sides[1] if phi_dot + slip else math.copysign(1, phi_ddot + slip_dot),
        )


def solve(scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, ...]:
    """Return phi [rad], phi_dot [rad/s], u [m] and u_dot [m/s] at the times `time` [s], none of them negative.

    Raises:
      ToleranceError: if rounding of start and scene changes phi or u/a by more than 1e-4 rad, relative beyond 1 rad, or
        if the motion takes too many steps.
    """
    radius, (u0, u_dot0) = scene.can.radius, scene.start(phi0, phi_dot0)
    if scene.incline == 0 and Start.at(scene.oscillator, phi0, phi_dot0).stays(phi0):
        still = np.zeros_like(time)
        return phi0 + still, still, u0 + still, still
    order = np.argsort(time)
    turned, rolled, phi_dot, slip = np.empty((4, len(time)))
    turned[order], rolled[order], phi_dot[order], slip[order] = _follow(
        Equations.of(scene), time[order], phi0, phi_dot0, u_dot0 / radius - phi_dot0
    )
    return phi0 + turned, phi_dot, u0 + radius * rolled, radius * (phi_dot + slip)


def _follow(equations: Equations, time: np.ndarray, phi0: float, phi_dot: float, slip: float) -> np.ndarray:
    """Return how far phi and roll have turned [rad], phi_dot and w [rad/s] at sorted times, of shape (4, times)."""
    samples, phi = np.empty((4, len(time))), reduced(phi0)
    now, latest, turned, farthest = 0.0, float(time[-1]), np.zeros(2), np.ones(2)
    done = int(np.searchsorted(time, 0.0, "right"))
    samples[:, :done] = np.array([[0.0], [0.0], [phi_dot], [slip]])
    # What rounding of start and scene does to phi, phi_dot, w and roll: an angle of 0 stands for that of the incline.
    spread = ROUNDINGS * np.array([abs(phi) + 1, abs(phi_dot), abs(slip), 0.0])
    length, before = _first_length(equations, phi, phi_dot, slip), None
    for _ in range(_STEPS):
        if now >= latest:
            return samples
        step, longer = _advance(equations, (phi, phi_dot, slip), now, min(length, latest - now), before)
        then = now + step.length
        until = int(np.searchsorted(time, then, "right"))
        if until > done:
            values = legendre.legvander(2 * (time[done:until] - now) / step.whole - 1, _STAGES)
            samples[:, done:until] = (values @ step.series).T + np.array([[*turned, 0.0, 0.0]]).T
        phi, phi_dot, slip = reduced(phi + step.ends[0]), *step.ends[2:].tolist()
        turned = turned + step.ends[:2]
        spread = step.transfer(spread)
        spread[:3] += np.copysign(ROUNDINGS * np.abs([phi, phi_dot, slip]), spread[:3])
        farthest = np.maximum(farthest, np.abs(turned))
        effect = float((np.abs(spread[[0, 3]]) / farthest).max())
        if not effect <= UNCERTAIN:
            raise ToleranceError(
                f"phi is not known later than at {then:.6g} s: rounding of start and scene changes it by {effect:.2g} "
                f"rad (relative beyond 1 rad), where at most {UNCERTAIN:g} is allowed"
            )
        now, done, before, length = then, until, step, longer
    raise ToleranceError(
        f"the motion takes more than {_STEPS} steps, which end at {now:.6g} s of {latest:.6g} s: it is too fast or "
        "too long to be followed"
    )


@dataclass(frozen=True)
class _Step:
    """A step that satisfies the equations at all of its stages, up to its end or to a corner."""

    whole: float
    """Duration of the polynomials [s]."""
    stages: np.ndarray
    """phi_dot and w [rad/s] at the stages, of shape (2, stages)."""
    series: np.ndarray
    """How far phi and roll turn, phi_dot and w as sums of Legendre polynomials, of shape (stages + 1, 4)."""
    slopes: np.ndarray
    """Derivatives of phi_ddot and w_dot by phi, phi_dot and w at the stages, of shape (2, 3, stages)."""
    matrix: np.ndarray
    """The last of Newton's matrices."""
    end: float = 1.0
    """Where the step ends, from -1 to 1."""
    corner: int | None = None
    """What vanishes at the end: w (0) or roll_dot (1)."""

    @property
    def length(self) -> float:
        """Return the duration of the step [s]."""
        return self.whole * (1 + self.end) / 2

    @property
    def ends(self) -> np.ndarray:
        """Return how far phi and roll turn, and phi_dot and w at the end."""
        ends = legendre.legval(self.end, self.series)
        if self.corner == 0:
            ends[3] = 0.0
        elif self.corner == 1:  # phi_dot bears what is left: w may be many orders smaller, and its digits matter
            ends[2] = -ends[3]
        return ends

    def transfer(self, change: np.ndarray) -> np.ndarray:
        """Return the change of phi, phi_dot, w and roll at the end that follows from one at the start."""
        given = self.whole * change[0] * self.slopes[:, 0] @ _MATRIX.T + change[1:3, np.newaxis]
        by_start = np.linalg.solve(self.matrix, given.ravel()).reshape(2, _STAGES).T
        turned, slipped = legendre.legval(self.end, self.whole * _INTEGRALS @ by_start)
        rates = legendre.legval(self.end, _series(change[1:3], by_start))
        return np.array([change[0] + turned, *rates, change[3] + turned + slipped])


def _first_length(equations: Equations, phi: float, phi_dot: float, slip: float) -> float:
    """Return a first step [s] that is short beside every time the motion has."""
    sides = equations.sides(phi, phi_dot, slip)
    slopes = equations.rates(np.array(phi), np.array(phi_dot), np.array(slip), sides)[1]
    fastest = abs(slopes[1, 2]) + abs(slopes[0, 1]) + abs(phi_dot) + math.sqrt(equations.depth / equations.base)
    fastest += math.sqrt(abs(equations.drive))
    return float(1 / fastest) if fastest > 0 else math.inf


def _advance(
    equations: Equations, state: tuple[float, float, float], now: float, length: float, before: _Step | None
) -> tuple[_Step, float]:
    """Return the next step from phi, phi_dot and w, and a length [s] for the one after it."""
    sides, flipped = equations.sides(*state), False
    phi, phi_dot, slip = (np.array(each) for each in state)
    steep = abs(float(equations.rates(phi, phi_dot, slip, sides)[1][1, 2]))
    rate = max(math.sqrt(equations.depth / equations.base), abs(state[1]))
    forcing = abs(equations.drive) + equations.depth + equations.beta * state[1] ** 2  # which the damping balances
    scales = np.array([rate, min(rate, forcing / steep) if steep > 0 else rate]) + _TINY
    while True:
        if not now + length > now:
            raise ToleranceError(f"the motion is too fast to be followed at {now:.6g} s")
        step = _attempt(equations, state, length, sides, before, scales)
        if step is None:
            length, before = length / 4, None
            continue
        factor = _factor(step, scales)
        if factor < _REJECTED:
            length *= max(factor, 0.1)
            continue
        corner = _corner(equations, step, sides)
        if corner is None or (corner[0] == -1 and flipped):
            return step, length * factor
        end, which = corner
        if end > -1:
            return replace(step, end=end, corner=which), length * factor
        sides, flipped = (-sides[0], sides[1]) if which == 0 else (sides[0], -sides[1]), True


def _attempt(
    equations: Equations,
    state: tuple[float, float, float],
    length: float,
    sides: Sides,
    before: _Step | None,
    scales: np.ndarray,
) -> _Step | None:
    """Return the step of so many seconds, by Newton's method for all stages at once; None if that does not find it.

    `scales` has the rates [rad/s] beside which corrections of phi_dot and w are small.
    """
    s, reach, begin, last = _STAGES, length * _MATRIX, np.array(state[1:])[:, np.newaxis], math.inf
    if before is None or length > 1.5 * before.whole:
        stages = np.repeat(begin, s, axis=1)
    else:  # as the step before goes on
        stages = legendre.legval(before.end + 2 * _FRACTIONS * (length / before.whole), before.series[:, 2:])
    matrix = np.empty((2 * s, 2 * s))
    for _ in range(_ITERATIONS):
        rates, slopes = equations.rates(state[0] + reach @ stages[0], stages[0], stages[1], sides)
        through_phi = (reach * slopes[:, :1]) @ reach
        matrix[:s, :s] = _EYE - reach * slopes[0, 1] - through_phi[0]
        matrix[:s, s:] = -reach * slopes[0, 2]
        matrix[s:, :s] = -reach * slopes[1, 1] - through_phi[1]
        matrix[s:, s:] = _EYE - reach * slopes[1, 2]
        try:
            change = np.linalg.solve(matrix, (begin + rates @ reach.T - stages).ravel()).reshape(2, s)
        except np.linalg.LinAlgError:
            return None
        stages = stages + change
        size = float((np.abs(change).max(axis=1) / np.maximum(scales, np.abs(stages).max(axis=1))).max())
        if not size < 1e6:
            return None
        if last < _QUADRATIC:
            turned = length * _INTEGRALS @ stages.T
            rates = _series(begin[:, 0], stages.T)
            return _Step(length, stages, np.column_stack([turned[:, 0], turned.sum(axis=1), rates]), slopes, matrix)
        last = size
    return None


def _factor(step: _Step, scales: np.ndarray) -> float:
    """Return by what factor the step might be longer, from how fast the terms of its polynomials fall."""
    sizes = np.abs(step.series[:_STAGES, 2:]) / np.maximum(scales, np.abs(step.stages).max(axis=1))
    tails = np.maximum.accumulate(sizes.max(axis=1)[::-1])[::-1]
    small = np.flatnonzero(tails <= _TAIL)
    if not len(small):
        return 0.9 * float((_TAIL / tails[-1]) ** (1 / _STAGES))
    return min(_GROWTH, 0.95 * _STAGES / max(float(small[0]), 1.0))


def _corner(equations: Equations, step: _Step, sides: Sides) -> tuple[float, int] | None:
    """Return where in the step, from -1 to 1, w (0) or roll_dot (1) gets another sign than its own, if it has one."""
    found = []
    rates = step.series[:, 2:]
    for which, (strength, rate) in enumerate(
        [(equations.torques[1], rates[:, 1]), (equations.drag, rates.sum(axis=1))]
    ):
        if strength == 0:
            continue
        values = _GRID_VALUES @ rate * sides[which]
        wrong = values < -_CORNER * np.abs(values).max()
        if not wrong.any():
            continue
        after = int(np.argmax(wrong))
        right = np.flatnonzero(values[:after] > 0)
        if not len(right):
            found.append((-1.0, which))
            continue
        low, high = _GRID[right[-1]], _GRID[after]
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if legendre.legval(middle, rate) * sides[which] > 0 else (low, middle)
        found.append((float(high), which))
    return min(found, default=None)
