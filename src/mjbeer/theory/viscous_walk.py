"""A damped motion on its way through its times: the sums of its steps, its samples, and what rounding does to it.

The effect of rounding is carried along as a factor of its covariance; where it is too large there is an error.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import legendre

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.certainty import UNCERTAIN
from mjbeer.theory.collocation import STAGES
from mjbeer.theory.crest import past_zero
from mjbeer.theory.place import ROUNDINGS
from mjbeer.theory.viscous_advance import advance, first_length
from mjbeer.theory.viscous_equations import ViscousEquations
from mjbeer.theory.viscous_step import State, Step

_STEPS = 10_000
"""Largest number of steps."""


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


@dataclass
class Walk:
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
        # Where phi starts at 0 the incline is rounded all the same.
        self._spread = self._rounding() + np.diag([ROUNDINGS, 0.0, 0.0, 0.0])

    @property
    def _state(self) -> State:
        return State(self._phi.value, self._phi_dot.value, self._slip)

    @property
    def unsure(self) -> tuple[float, float]:
        """Return by how much rounding of start and scene changes phi and roll so far [rad]: two standard deviations."""
        of_phi, _, _, of_roll = 2 * np.linalg.norm(self._spread, axis=1)
        return float(of_phi), float(of_roll)

    def run(self) -> None:
        """Take steps until the last time."""
        now, last, done, before = 0.0, float(self.time[-1]), int(np.searchsorted(self.time, 0.0, "right")), None
        self.samples[:done] = 0, 0, self.phi_dot0, self.slip0
        length = first_length(self.equations, self._state)
        for _ in range(_STEPS):
            if now >= last:
                return
            step, length = advance(self.equations, self._state, now, min(length, last - now), before)
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
        of_phi, of_roll = self.unsure
        effect = max(of_phi / self._farthest, of_roll / max(1.0, abs(self._rolled.value)))
        if not effect <= UNCERTAIN:
            raise ToleranceError(
                f"phi is not known later than at {then:.6g} s: rounding of start and scene changes it by {effect:.2g} "
                f"rad (relative beyond 1 rad), where at most {UNCERTAIN:g} is allowed"
            )

    def _rounding(self) -> np.ndarray:
        """Return what rounding does to the state, a column for each of its numbers."""
        state = self._state
        return np.diag(ROUNDINGS * np.array([state.phi, state.phi_dot, state.slip, 0.0]))
