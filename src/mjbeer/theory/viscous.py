"""The motion of a damped sliding scene to rounding, step by step: no first integral makes it a quadrature.

Each step is a collocation polynomial whose last terms are below rounding. Steps end where |w| or |u_dot| has a corner,
if the law has them. The effect of rounding is carried along as a covariance; where it is too large there is an error.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import legendre

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.certainty import UNCERTAIN
from mjbeer.theory.collocation import FRACTIONS, STAGES
from mjbeer.theory.crest import past_zero
from mjbeer.theory.place import ROUNDINGS, Place
from mjbeer.theory.scene import Scene
from mjbeer.theory.viscous_equations import ViscousEquations
from mjbeer.theory.viscous_step import State, Step, attempt

_TAIL = 1e-14
"""Size of the terms of a step's polynomials that may be missing, relative to the rates. The step's end is far better
than that, as the method's order is twice the degree."""
_GROWTH = 10.0
"""Largest ratio of a step to the one before."""
_REJECTED = 0.8
"""A step is taken again if it should have been shorter by more than this factor; its terms are then below 1e-12."""
_UNSTABLE = 3.0
"""Largest growth, as the exponent, of what is below rounding in a step. The method would damp it in a longer one."""
_STEPS = 10_000
"""Largest number of steps."""
_CORNER = 1e-10
"""How far w or roll_dot may pass zero within a step, relative to itself. The error that this makes is its square."""
_TINY = np.finfo(float).tiny
_GRID = np.linspace(-1, 1, 4 * STAGES + 1)
_GRID_VALUES = legendre.legvander(_GRID, STAGES)


@dataclass
class _Sum:
    """A sum that carries what rounding leaves of each term (Kahan's)."""

    value: float
    rest: float = 0.0

    def add(self, term: float) -> None:
        term += self.rest
        value = self.value + term
        self.rest = (self.value - value) + term if abs(self.value) >= abs(term) else (term - value) + self.value
        self.value = value


def solve(
    scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return phi [rad], phi_dot [rad/s], u [m] and u_dot [m/s] at the times `time` [s], none of them negative.

    Raises:
      ToleranceError: if rounding of start and scene changes phi or u/a by more than 1e-4 rad, relative beyond 1 rad, or
        if the motion takes too many steps.
    """
    radius, (u0, u_dot0) = scene.can.radius, scene.start(phi0, phi_dot0)
    if scene.incline == 0 and phi_dot0 == 0 and Place.of(scene.oscillator.crest, phi0).on_top(phi0):
        still = np.zeros_like(time)
        return phi0 + still, still, u0 + still, still
    order = np.argsort(time)
    walk = _Walk(ViscousEquations.of(scene), time[order], phi0, phi_dot0, u_dot0 / radius - phi_dot0)
    walk.run()
    turned, rolled, phi_dot, slip = np.empty((4, len(time)))
    turned[order], rolled[order], phi_dot[order], slip[order] = walk.samples.T
    return phi0 + turned, phi_dot, u0 + radius * rolled, radius * (phi_dot + slip)


@dataclass
class _Walk:
    """A motion on its way through the sorted times `time` [s]."""

    equations: ViscousEquations
    time: np.ndarray
    phi0: float
    phi_dot0: float
    slip0: float
    samples: np.ndarray = field(init=False)
    """How far phi and roll have turned [rad], phi_dot and w [rad/s] at the times, of shape (times, 4)."""

    def __post_init__(self) -> None:
        self.samples = np.empty((len(self.time), 4))
        self._phi, self._phi_dot = _Sum(math.remainder(past_zero(self.phi0), 2 * math.pi)), _Sum(self.phi_dot0)
        self._slip, self._turned, self._rolled = self.slip0, _Sum(0.0), _Sum(0.0)
        self._farthest = 1.0
        self._natural = math.sqrt(self.equations.depth / self.equations.base)
        self._spread = self._rounding() + np.diag([ROUNDINGS, 0.0, 0.0, 0.0])

    @property
    def _state(self) -> State:
        return State(self._phi.value, self._phi_dot.value, self._slip)

    def run(self) -> None:
        """Take steps until the last time."""
        now, last, done, before = 0.0, float(self.time[-1]), int(np.searchsorted(self.time, 0.0, "right")), None
        self.samples[:done] = 0, 0, self.phi_dot0, self.slip0
        length = self._first_length()
        for _ in range(_STEPS):
            if now >= last:
                return
            step, length = self._step(now, min(length, last - now), before)
            then = now + step.length
            until = int(np.searchsorted(self.time, then, "right"))
            if until > done:
                self._sample(step, slice(done, until), 2 * (self.time[done:until] - now) / step.length - 1)
            self._take(step, then)
            now, done, before = then, until, step
        raise ToleranceError(
            f"the motion takes more than {_STEPS} steps, which end at {now:.6g} s of {last:.6g} s: it is too fast or "
            "too long to be followed"
        )

    def _first_length(self) -> float:
        """Return a first step [s] that is short beside every time the motion has."""
        state, (_, slopes) = self._state, self._rates(self._sides())
        fastest = abs(slopes[1, 2]) + abs(slopes[0, 1]) + abs(state.phi_dot) + self._natural
        fastest += math.sqrt(abs(self.equations.drive))
        return 1 / fastest if fastest > 0 else math.inf

    def _rates(self, sides: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
        state = self._state
        return self.equations.rates(state.phi, state.phi_dot, state.slip, sides)

    def _sides(self) -> tuple[float, float]:
        """Return the signs of w and roll_dot, or where they are zero, of those that follow."""
        roll_dot = self._phi_dot.value + self._slip
        if abs(roll_dot) <= ROUNDINGS * abs(self._slip):
            roll_dot = 0.0
        sides = math.copysign(1, self._slip), math.copysign(1, roll_dot)
        if all(self.equations.smooth) or (self._slip and roll_dot):
            return sides
        phi_ddot, slip_dot = self._rates(sides)[0]
        return (
            sides[0] if self._slip else math.copysign(1, slip_dot),
            sides[1] if roll_dot else math.copysign(1, phi_ddot + slip_dot),
        )

    def _step(self, now: float, length: float, before: Step | None) -> tuple[Step, float]:
        """Return the next step, and a length [s] for the one after it."""
        sides = self._sides()
        slopes, state = self._rates(sides)[1], self._state
        growth = _growth(slopes)
        steep = float(np.abs(slopes[1, 2]))
        forcing = self.equations.forcing(state.phi_dot)
        rate = max(self._natural, abs(state.phi_dot))
        scales = np.array([rate, min(rate, forcing / steep) if steep > 0 else rate])
        flipped = False
        while True:
            length = min(length, _UNSTABLE / growth) if growth > 0 else length
            if not now + length > now:
                raise ToleranceError(f"the motion is too fast to be followed at {now:.6g} s")
            then = now + length
            step = attempt(self.equations, state, then - now, sides, _guess(state, then - now, before), scales)
            if step is None:
                length, before = length / 4, None
                continue
            factor = _factor(step, scales)
            if factor < _REJECTED:
                length *= max(factor, 0.1)
                continue
            found = self._corner(step, sides)
            if found is None:
                return step, step.length * factor
            part, which = found
            if part == 0 and not flipped:
                sides = (-sides[0], sides[1]) if which == 0 else (sides[0], -sides[1])
                flipped = True
            elif part == 0:
                return step, step.length * factor
            else:
                cut = self._cut(step, part, which, sides, scales)
                if cut is None:
                    length *= part / 2
                    continue
                return cut, step.length * factor

    def _cut(self, step: Step, part: float, which: int, sides: tuple[float, float], scales: np.ndarray) -> Step | None:
        """Return the first `part` of a step, at whose end w (0) or roll_dot (1) vanishes; None if it is not found."""
        state, guess, length = self._state, _within(step, part), part * step.length
        for _ in range(3):  # the polynomial of the longer step has its root where this one has it, but for its tail
            cut = attempt(self.equations, state, length, sides, guess, scales)
            if cut is None:
                return None
            phi_dot, slip = cut.stages[:, -1]
            rates = self.equations.rates(state.phi + cut.ends[:1], phi_dot, slip, sides)[0][:, 0]
            value, rate = (slip, rates[1]) if which == 0 else (phi_dot + slip, rates.sum())
            late, guess = float(value / rate) if rate else 0.0, cut.stages
            if abs(late) <= ROUNDINGS * length or not 0 < length - late < step.length:
                break
            length -= late
        if which == 0:
            cut.ends[2] = -state.slip
        else:  # phi_dot bears what is left: w may be many orders smaller, and its digits matter
            cut.ends[1] = -slip - state.phi_dot
        return cut

    def _corner(self, step: Step, sides: tuple[float, float]) -> tuple[float, int] | None:
        """Return the share of the step after which w (0) or roll_dot (1) changes its sign, if there is a corner."""
        found = []
        for which, (smooth, side) in enumerate(zip(self.equations.smooth, sides, strict=True)):
            if smooth:
                continue
            series = side * (step.series[:, 1] if which == 0 else step.series.sum(axis=1))
            values = _GRID_VALUES @ series
            if values.min() >= -_CORNER * np.abs(values).max():
                continue
            after = int(np.argmax(values < -_CORNER * np.abs(values).max()))
            before = after - 1
            while before > 0 and values[before] <= 0:
                before -= 1
            if values[before] <= 0 or after == 0:
                found.append((0.0, which))
                continue
            low, high = _GRID[before], _GRID[after]
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if legendre.legval(middle, series) > 0 else (low, middle)
            found.append(((1 + float(high)) / 2, which))
        return min(found, default=None)

    def _sample(self, step: Step, which: slice, x: np.ndarray) -> None:
        """Note the motion at those of the times that are at `x`, from -1 to 1, in a step."""
        values = legendre.legvander(x, STAGES)
        self.samples[which, :2] = values @ step.angles() + [
            self._turned.value + self._turned.rest,
            self._rolled.value + self._rolled.rest,
        ]
        self.samples[which, 2:] = values @ step.series

    def _take(self, step: Step, then: float) -> None:
        """Go to the end of a step."""
        turned, rate, slip, rolled = (float(each) for each in step.ends)
        carried = step.transfer() @ self._spread
        self._phi.add(turned)
        if abs(self._phi.value) > math.pi:
            self._phi.value = past_zero(self._phi.value)
            self._phi.value = math.remainder(self._phi.value, 2 * math.pi)
        self._turned.add(turned)
        self._rolled.add(rolled)
        self._phi_dot.add(rate)
        self._slip += slip
        self._spread = np.linalg.qr(np.hstack([carried, self._rounding()]).T).R.T
        self._farthest = max(self._farthest, abs(self._turned.value))
        of_phi, _, _, of_roll = (float(each) for each in np.linalg.norm(self._spread, axis=1))
        effect = 2 * max(of_phi / self._farthest, of_roll / max(1.0, abs(self._rolled.value)))
        if not effect <= UNCERTAIN:
            raise ToleranceError(
                f"phi is not known later than at {then:.6g} s: rounding of start and scene changes it by {effect:.2g} "
                f"rad (relative beyond 1 rad), where at most {UNCERTAIN:g} is allowed"
            )

    def _rounding(self) -> np.ndarray:
        """Return what rounding does to the state, a column for each of its numbers."""
        state = self._state
        return np.diag(ROUNDINGS * np.array([state.phi, state.phi_dot, state.slip, 0.0]))


def _growth(slopes: np.ndarray) -> float:
    """Return a bound on the rate [1/s] at which what is below rounding may grow; 0 if it does not.

    The roots of s^3 + A s^2 + B s + C are not computed, which are of very different sizes where the damping is strong:
    a coefficient that is negative allows a positive root, which each that is positive holds down.
    """
    (phi_phi, phi_rate, phi_slip), (slip_phi, slip_rate, slip_slip) = slopes.tolist()
    square = -(phi_rate + slip_slip)
    linear = phi_rate * slip_slip - phi_slip * slip_rate - phi_phi
    constant = phi_phi * slip_slip - phi_slip * slip_phi
    growth = max(0.0, -square)
    if linear < 0:
        growth += min(math.sqrt(-linear), -linear / square if square > 0 else math.inf)
    if constant < 0:
        by_square = math.sqrt(-constant / square) if square > 0 else math.inf
        growth += min(math.cbrt(-constant), by_square, -constant / linear if linear > 0 else math.inf)
    return growth


def _guess(state: State, length: float, before: Step | None) -> np.ndarray:
    """Return phi_dot and w at the stages of a step, as the one before goes on, if this one is not much longer."""
    if before is None or length > 1.5 * before.length:
        return np.repeat([[state.phi_dot], [state.slip]], STAGES, axis=1)
    return legendre.legval(1 + 2 * FRACTIONS * (length / before.length), before.series)


def _within(step: Step, part: float) -> np.ndarray:
    """Return phi_dot and w at the stages of the step that is the first `part` of another one."""
    return legendre.legval(2 * FRACTIONS * part - 1, step.series)


def _factor(step: Step, scales: np.ndarray) -> float:
    """Return by what factor the step might be longer, from how fast the terms of its polynomials fall."""
    sizes = np.abs(step.series) / (np.maximum(scales, np.abs(step.stages).max(axis=1)) + _TINY)
    tails = np.maximum.accumulate(sizes[:STAGES].max(axis=1)[::-1])[::-1]
    small = np.flatnonzero(tails <= _TAIL)
    if not len(small):
        return 0.9 * float((_TAIL / tails[-1]) ** (1 / STAGES))
    return min(_GROWTH, 0.95 * STAGES / max(float(small[0]), 1.0))
