"""What a motion has shown of itself over all its steps: running extremes, in memory that does not grow with it."""

import math

import numpy as np

from mjbeer.theory.balance import Balance
from mjbeer.theory.equations import Coordinates, kinetic_energy, potential_energy, rolling_forces
from mjbeer.theory.losses import followed
from mjbeer.theory.motion import energy_to_barrier
from mjbeer.theory.scene import Scene

_SMALL_SWING = 1e-2
"""Smallest energy with which a drift is compared, relative to the depth m g b of the potential well: that of a swing
of 0.14 rad. A motion that hardly swings would otherwise divide rounding by nearly nothing."""
_ROUNDING = 1e-11
"""Smallest energy with which a drift is compared, relative to the kinetic energy. A thousandth of it, the drift that
is trusted, is still many times the rounding of the kinetic energy."""


class Record:
    """The largest slip, lift, drift and rate of a motion so far, and when rolling stopped being possible.

    A motion is added in pieces, in the order of time. The first sample of the first piece is what later ones are
    compared with. The attributes are those of all pieces together.
    """

    def __init__(self, scene: Scene, friction: float = math.inf) -> None:
        """Begin the record of a motion whose can would slip where rolling needs more than a coefficient `friction`."""
        self.scene, self.friction = scene, friction
        self.slip = 0.0
        """Largest distance that the can has slid instead of rolled [m]."""
        self.lift = 0.0
        """Largest distance between can and incline, or depth of the can in it [m]."""
        self.turned = 0.0
        """Largest angle by which the load has turned from its start [rad]."""
        self.rolled = 0.0
        """Largest distance of the axis from its start [m]."""
        self.fastest = 0.0
        """Largest rate of the load, |phi_dot| [rad/s]."""
        self.lowest_normal = math.inf
        """Smallest normal force that rolling needed [N]; negative where the incline would have to pull."""
        self.needed = 0.0
        """Largest friction coefficient that rolling needed; infinite where the incline would have to pull."""
        self.fails_at = math.inf
        """Time [s] at which N < 0 or |F| > friction N for the first time, interpolated; infinity if it never was."""
        self.swing = 0.0
        """Largest kinetic energy of the swing, J phi_dot^2 / 2 [J]."""
        self._by_rates = self._by_angles = 0.0
        self._kinetic = self._energy_change = self._swing_change = self._axis_change = 0.0
        self._first: Coordinates | None = None
        self._at_first: tuple[float, float] | None = None
        self._last: Coordinates | None = None
        self._last_margin: tuple[float, float] | None = None
        self._balance = Balance(scene) if scene.dissipates else None

    @classmethod
    def of(cls, motion: Coordinates, scene: Scene, friction: float = math.inf) -> "Record":
        """Return the record of a motion whose samples are all there is; they may be in any order.

        With damping or drag, samples that are too far apart do not tell what the motion loses between them. Its drift
        is then not known, and taken for none.
        """
        record, order = cls(scene, friction), np.argsort(motion.time)
        ordered = Coordinates(**{name: getattr(motion, name)[order] for name in Coordinates.__dataclass_fields__})
        if record._balance is not None and not followed(scene, ordered):
            record._balance = None
        record.add(ordered)
        return record

    def add(self, motion: Coordinates) -> None:
        """Add the next piece of the motion, which begins after the last one ended."""
        self.add_conserved(motion)
        self.add_forces(motion.time, motion.phi, motion.phi_dot, motion.u_dot)

    def add_conserved(self, motion: Coordinates) -> None:
        """Add the next piece of the motion to everything but what rests on forces."""
        scene = self.scene
        if self._first is None:
            self._first = _piece(motion, 0)
        if self._last is None:
            self._last = self._first
        first, last = self._first, self._last
        slid = motion.u - scene.can.radius * motion.roll
        self.slip = _largest(self.slip, slid - (first.u - scene.can.radius * first.roll))
        self.lift = _largest(self.lift, motion.lift)
        self.turned = _largest(self.turned, motion.phi - first.phi)
        self.rolled = _largest(self.rolled, motion.u - first.u)
        rates = np.abs(motion.phi_dot)
        self.fastest = _largest(self.fastest, rates)
        time, phi = np.append(last.time, motion.time), np.append(last.phi, motion.phi)
        self._by_rates += float(np.trapezoid(np.append(np.abs(last.phi_dot), rates), time))
        self._by_angles += float(np.abs(np.diff(phi)).sum())
        self._add_energies(motion, first)
        if not scene.dissipates:
            self._axis_change = _largest(self._axis_change, axis_drift(scene, motion, first))
        elif self._balance is not None:
            self._balance.add(motion, last)
            self._energy_change, self._swing_change = self._balance.energy_change, self._balance.swing_change
            self._axis_change = self._balance.axis_change
        self._last = _piece(motion, -1)

    def add_forces(self, time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, u_dot: np.ndarray | float) -> None:
        """Add the normal and friction forces that rolling needs at times [s] in the states of the motion there.

        `u_dot` [m/s] matters to damping and drag alone.
        """
        forces = rolling_forces(self.scene, phi, phi_dot, u_dot)
        self.lowest_normal = float(np.minimum(self.lowest_normal, forces.normal.min()))
        self.needed = _largest(self.needed, forces.needed)
        if not math.isinf(self.fails_at):
            return
        margin = forces.normal
        if math.isfinite(self.friction):
            margin = np.minimum(margin, self.friction * forces.normal - np.abs(forces.friction))
        if margin.min() < 0:
            after = int(np.argmax(margin < 0))
            before = (float(time[after - 1]), float(margin[after - 1])) if after else self._last_margin
            self.fails_at = _crossing(before, (float(time[after]), float(margin[after])))
        self._last_margin = float(time[-1]), float(margin[-1])

    @property
    def path(self) -> float:
        """Return the angle that the load has covered, forth and back [rad]."""
        return float(np.maximum(self._by_rates, self._by_angles))

    @property
    def energy_drift(self) -> float:
        """Return the largest change of the total energy over the largest kinetic energy of the swing, J phi_dot^2 / 2.

        With damping or drag it is the change of the energy and the work that they have taken together.

        The total energy includes slip and lift, and is what users see. Warnings rest on `swing_drift` instead, where
        the energy of a can that runs away down the incline cannot hide a drift. The denominator is at least
        `_SMALL_SWING` of the well's depth, and at least `_ROUNDING` of the kinetic energy, which matters for a
        balanced load.
        """
        depth = self.scene.oscillator.depth
        return _ratio(self._energy_change, max(self.swing, _SMALL_SWING * depth, _ROUNDING * self._kinetic))

    @property
    def swing_drift(self) -> float:
        """Return the largest change of the swing's energy J phi_dot^2 / 2 + V over its largest kinetic energy.

        It is a change that damping and drag do not explain.
        """
        return _ratio(self._swing_change, max(self.swing, _SMALL_SWING * self.scene.oscillator.depth))

    @property
    def implied_error(self) -> float:
        """Return the error of phi or u/a [rad], relative beyond 1 rad, that the drift of energy and momentum implies.

        Unlike the error itself, neither drift grows where only the phase is off.
        """
        return max(self.swing_error, self.axis_error)

    @property
    def swing_error(self) -> float:
        """Return the error of phi [rad], relative beyond 1 rad, that the drift of the swing's energy implies at most.

        A relative error of the swing's energy is about as large a relative error of its speed or its period, and so of
        the path that phi has covered.
        """
        return self.swing_drift * self.path / max(1.0, self.turned)

    @property
    def to_barrier(self) -> float:
        """Return how far the energy of the motion is from that of the next barrier [J]; infinite if there is none.

        With damping or drag the energy falls, or is driven, and no barrier has a fixed distance from it.
        """
        if self.scene.dissipates:
            return math.inf
        assert self._first is not None, "a record without a motion"
        start = float(self._first.phi[0]), float(self._first.phi_dot[0])
        return energy_to_barrier(self.scene.oscillator, *start)

    @property
    def axis_error(self) -> float:
        """Return the error of u/a [rad], relative beyond 1 rad, that the drift of the momentum implies."""
        return self._axis_change / max(self.scene.can.radius, self.rolled)

    def _add_energies(self, motion: Coordinates, first: Coordinates) -> None:
        oscillator, kinetic = self.scene.oscillator, kinetic_energy(self.scene, motion)
        swing = oscillator.inertia(motion.phi) * motion.phi_dot**2 / 2
        self._kinetic = _largest(self._kinetic, kinetic)
        self.swing = _largest(self.swing, swing)
        if self.scene.dissipates:
            return
        total = kinetic + potential_energy(self.scene, motion)
        if self._at_first is None:  # this piece begins with the first sample
            self._at_first = float(total[0]), float(swing[0])
        self._energy_change = _largest(self._energy_change, total - self._at_first[0])
        change = swing - self._at_first[1] - oscillator.drop(motion.phi, float(first.phi[0]))
        self._swing_change = _largest(self._swing_change, change)


def axis_drift(scene: Scene, motion: Coordinates, start: Coordinates) -> np.ndarray:
    """Return u less the value that the momentum at the start implies [m], at each sample: eq. (46), integrated twice.

    With a sliding load M_e u - m b sin(phi) - (m + m_can) g sin(alpha) t^2 / 2 grows linearly in time, whatever the
    can. A frozen load conserves no such momentum: there u = a phi, the drift is 0, and slip shows an error instead.
    """
    if scene.attachment == "frozen":
        return np.zeros_like(motion.time)
    time = motion.time - start.time
    effective_mass = scene.mass + scene.can.inertia / scene.can.radius**2
    arm = scene.load.mass * scene.load.offset / effective_mass
    acceleration = scene.mass * scene.gravity * math.sin(scene.incline) / effective_mass
    speed = start.u_dot - arm * np.cos(start.phi) * start.phi_dot
    implied = start.u + arm * (np.sin(motion.phi) - np.sin(start.phi)) + speed * time + acceleration * time**2 / 2
    return motion.u - implied


def _piece(motion: Coordinates, place: int) -> Coordinates:
    """Return one sample of a motion, as a motion with one sample."""
    return Coordinates(**{name: getattr(motion, name)[[place]] for name in Coordinates.__dataclass_fields__})


def _largest(so_far: float, values: np.ndarray) -> float:
    """Return the largest magnitude; NaN if there is one, which `max` would hide."""
    return float(np.maximum(so_far, np.abs(values).max()))


def _ratio(change: float, scale: float) -> float:
    return change / scale if scale > 0 else 0.0


def _crossing(before: tuple[float, float] | None, after: tuple[float, float]) -> float:
    """Return the time at which a margin passes 0 between two times [s], on a straight line."""
    if before is None:
        return after[0]
    (earlier, above), (later, below) = before, after
    return earlier + above / (above - below) * (later - earlier)
