"""The extremes of a motion over all its steps, and the reasons not to trust it that follow.

A `RecordMaker` makes a `Record`, and `diagnose` says what the record has against its motion.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mjbeer.theory import equations, formulas, slosh
from mjbeer.theory.equations import Coordinates, InitialState, select_samples
from mjbeer.theory.liquid import centrifugal_ratio, lump_warning
from mjbeer.theory.scene import Scene

ERROR = 1e-2
"""Largest estimated error of phi and u/a that is trusted [rad], relative beyond 1 rad.

It is half a degree."""
SLIP = 1e-3
"""Largest slip that is trusted, in radii: a milliradian of roll angle."""
LIFT = 1e-3
"""Largest gap or penetration between can and incline that is trusted, in radii."""
_SMALL_SWING = 1e-2
"""Least energy with which a drift is compared, divided by the depth m g b of the well.

It is that of a swing of 0.14 rad."""
_LEAST_SHARE = 1e-11
"""Least energy with which a change of all energy is compared, divided by the kinetic energy.

That is the largest one. Rounding changes all energy by some 2e-16 of it, which is then at most some
2e-5 of what it is compared with."""


@dataclass
class Record:
    """The extremes of a motion, over all of its steps."""

    scene: Scene
    friction: float = math.inf
    """Coefficient of friction with which `rolling_ends_at` was looked for."""
    slip: float = 0.0
    """Largest distance that the can has slid instead of rolled [m]."""
    lift: float = 0.0
    """Largest distance between can and incline, or depth of the can in it [m]."""
    largest_turn: float = 0.0
    """Largest angle by which the load has turned from its start [rad]."""
    largest_distance: float = 0.0
    """Largest distance of the axis from its start [m]."""
    largest_rate: float = 0.0
    """Largest rate of the load, |phi_dot| [rad/s]."""
    swing_energy: float = 0.0
    """Largest kinetic energy of the swing, J phi_dot^2 / 2 [J]."""
    kinetic_energy: float = 0.0
    """Largest kinetic energy of all that moves [J]."""
    energy_change: float = 0.0
    """Largest change of the total energy [J]; damping and drag change it, too."""
    swing_drift: float = 0.0
    """Largest integral of the error of the swing's energy over the angle covered [J rad].

    The error is the change of J phi_dot^2 / 2 + V since the start, and the angle covered counts
    forth and back. 0 with damping or drag."""
    axis_drift: float = 0.0
    """Largest distance of the axis from where its momentum has it [m]; 0 with damping or drag."""
    largest_slip_rate: float = 0.0
    """Largest |u_dot/a - phi_dot| of can and load with damping or drag [rad/s]."""
    no_lump_at: float = math.inf
    """When the wall of a can with a liquid is first too fast for a lump [s]."""
    largest_tilt: float = 0.0
    """Largest angle of the surface of a liquid that sloshes against its rest [rad].

    The rest is that of the present rates, `equations.resting_tilt`."""
    lowest_normal: float = math.inf
    """Smallest N that rolling needed [N]; below 0 the incline would have to pull."""
    needed_friction: float = 0.0
    """Largest friction coefficient that rolling needed; infinite where N < 0."""
    rolling_ends_at: float = math.inf
    """When N < 0 or |F| > friction N for the first time, interpolated [s]."""

    @classmethod
    def of(cls, motion: Coordinates, scene: Scene, friction: float = math.inf) -> "Record":
        """Return the record of a motion whose samples are all there is."""
        maker = RecordMaker(scene, friction)
        maker.add(motion)
        return maker.record

    @property
    def energy_drift(self) -> float:
        """Return the largest change of the total energy divided by the swing's kinetic energy.

        That is the largest kinetic energy of the swing. For a balanced load it is that of all that
        moves. The change includes what damping and drag take.
        """
        balanced = self.scene.load.offset == 0
        share = 1.0 if balanced else _LEAST_SHARE
        return self.energy_change / max(self._swing_scale, share * self.kinetic_energy)

    @property
    def swing_error(self) -> float:
        """Return the error of phi [rad], relative beyond 1 rad, that the swing's energy implies.

        An energy that is off by a share of itself makes phi_dot, and the angle covered meanwhile,
        off by half that share in a rotation or a small swing, and by up to twice the share in a
        swing that nearly reaches the crest. The share itself stands for all of them. Errors of
        opposite sign cancel. Hence `swing_drift` is divided by the energy. With damping or drag
        there is none.
        """
        return self.swing_drift / self._swing_scale / max(1.0, self.largest_turn)

    @property
    def axis_error(self) -> float:
        """Return the error of u/a [rad], relative beyond 1 rad, that the momentum implies."""
        return self.axis_drift / max(self.scene.can.radius, self.largest_distance)

    @property
    def _swing_scale(self) -> float:
        """Return the energy by which errors of the swing's energy are divided [J]."""
        least = _SMALL_SWING * self.scene.oscillator.depth
        return max(self.swing_energy, least, np.finfo(float).tiny)


class RecordMaker:
    """Makes the record of a motion that is added in pieces, in the order of time."""

    def __init__(self, scene: Scene, friction: float = math.inf) -> None:
        """Begin the record of a can that slips where rolling needs more than `friction`."""
        self.record = Record(scene, friction)
        self._first: Coordinates | None = None
        self._last_phi = math.nan
        self._initial_energy = math.nan
        self._swing_drift = 0.0
        self._last_margin = Margin(math.nan, math.nan)

    def add(self, motion: Coordinates) -> None:
        """Add the next piece of the motion, which begins after the last one ended."""
        self.add_states(motion)
        self.add_forces(motion.time, motion.phi, motion.phi_dot, motion.u_dot)

    def add_states(self, motion: Coordinates) -> None:
        """Add the next piece of the motion to everything except what rests on forces."""
        record = self.record
        scene = record.scene
        kinetic = equations.kinetic_energy(scene, motion)
        energy = kinetic + equations.potential_energy(scene, motion)
        if self._first is None:
            self._first = select_samples(motion, [0])
            self._last_phi = float(motion.phi[0])
            self._initial_energy = float(energy[0])
        first = self._first

        distance = motion.u - first.u
        rolled = scene.can.radius * (motion.roll - first.roll)
        record.slip = _largest(record.slip, distance - rolled)
        record.lift = _largest(record.lift, motion.lift)
        record.largest_turn = _largest(record.largest_turn, motion.phi - first.phi)
        record.largest_distance = _largest(record.largest_distance, distance)
        record.largest_rate = _largest(record.largest_rate, motion.phi_dot)

        swing = scene.oscillator.kinetic_energy(motion.phi, motion.phi_dot)
        record.kinetic_energy = _largest(record.kinetic_energy, kinetic)
        record.swing_energy = _largest(record.swing_energy, swing)
        record.energy_change = _largest(record.energy_change, energy - self._initial_energy)

        if scene.load.sloshes_in is not None:
            self._add_tilt(motion, first)
        if scene.dissipates:
            self._add_slip_rate(motion)
            return
        self._add_swing_drift(motion, first, swing)
        if scene.attachment == "sliding":
            self._add_axis_drift(motion, first)

    def _add_tilt(self, motion: Coordinates, first: Coordinates) -> None:
        """Add how far the surface of a liquid tilts against its rest."""
        record = self.record
        rest = equations.resting_tilt(record.scene, motion.phi_dot, motion.u_dot)
        turns = math.tau * round(float(first.phi[0]) / math.tau)
        record.largest_tilt = _largest(record.largest_tilt, motion.phi - turns - rest)

    def _add_slip_rate(self, motion: Coordinates) -> None:
        """Add how fast can and load slip past each other with damping or drag."""
        record = self.record
        slip_rate = equations.slip_rate_of(record.scene, motion.phi_dot, motion.u_dot)
        record.largest_slip_rate = _largest(record.largest_slip_rate, slip_rate)
        if record.scene.damping_law.valid_rates is not None and record.no_lump_at == math.inf:
            spread = np.flatnonzero(centrifugal_ratio(record.scene, motion.u_dot) > 1)
            if len(spread) > 0:
                record.no_lump_at = float(motion.time[spread[0]])

    def _add_swing_drift(self, motion: Coordinates, first: Coordinates, swing: np.ndarray) -> None:
        """Add how the energy of the swing changes, which should be conserved.

        `swing` is its kinetic energy [J].
        """
        oscillator = self.record.scene.oscillator
        initial_swing = oscillator.kinetic_energy(first.phi, first.phi_dot)
        change = formulas.swing_energy_change(
            oscillator, swing, motion.phi, initial_swing, first.phi
        )
        covered = np.abs(np.diff(motion.phi, prepend=self._last_phi))
        drift = self._swing_drift + np.cumsum(change * covered)
        self._last_phi = float(motion.phi[-1])
        self._swing_drift = float(drift[-1])
        self.record.swing_drift = _largest(self.record.swing_drift, drift)

    def _add_axis_drift(self, motion: Coordinates, first: Coordinates) -> None:
        """Add how far the axis of a sliding load's can is from where conserved momentum has it."""
        record = self.record
        start = InitialState(
            phi=float(first.phi[0]),
            phi_dot=float(first.phi_dot[0]),
            u=float(first.u[0]),
            u_dot=float(first.u_dot[0]),
        )
        since_start = motion.time - first.time
        expected = equations.axis_motion(
            record.scene,
            since_start,
            motion.phi,
            motion.phi_dot,
            start,
        )
        record.axis_drift = _largest(record.axis_drift, motion.u - expected.u)

    def add_forces(
        self,
        time: np.ndarray,
        phi: np.ndarray,
        phi_dot: np.ndarray,
        u_dot: np.ndarray,
    ) -> None:
        """Add the forces that rolling needs at times [s] in the states there.

        `u_dot` matters to damping and drag alone.
        """
        record = self.record
        forces = equations.rolling_forces(record.scene, phi, phi_dot, u_dot)
        record.lowest_normal = float(np.minimum(record.lowest_normal, forces.normal.min()))
        record.needed_friction = _largest(record.needed_friction, forces.needed_friction)
        if math.isfinite(record.rolling_ends_at):
            return
        margin = formulas.rolling_margin(forces.normal, forces.friction, record.friction)
        if margin.min() < 0:
            index = int(np.argmax(margin < 0))
            after = Margin(float(time[index]), float(margin[index]))
            before = self._last_margin
            if index > 0:
                before = Margin(float(time[index - 1]), float(margin[index - 1]))
            record.rolling_ends_at = zero_crossing(before, after)
        self._last_margin = Margin(float(time[-1]), float(margin[-1]))


class Margin(NamedTuple):
    """The force by which a can is kept from leaving the incline or from slipping.

    It is the lesser of the two.
    """

    time: float
    """[s]"""
    force: float
    """[N]; negative where the can cannot roll."""


def zero_crossing(before: Margin, after: Margin) -> float:
    """Return the time [s] at which the line between two margins is 0.

    It is that of the later one if there is no earlier one.
    """
    if not before.time < after.time:
        return after.time
    return formulas.zero_crossing(before.time, before.force, after.time, after.force)


class Diagnosis(NamedTuple):
    """The reasons not to trust a motion, one sentence for each."""

    solver: tuple[str, ...]
    """Why the equations of motion may not have been solved."""
    rolling: tuple[str, ...]
    """Where a can did not, or could not, roll without slipping."""
    liquid: tuple[str, ...]
    """Where a liquid is no lump, slips at other rates than its damping is for, or tilts too far."""


def diagnose(record: Record, rolling: str, friction: float = math.inf) -> Diagnosis:
    """Return what a record says against its motion.

    A contact slips at its coefficient of `friction`.
    """
    return Diagnosis(
        solver=failed_checks(record, rolling),
        rolling=rolling_failures(record, rolling, friction),
        liquid=_no_lump(record) + _too_steep(record),
    )


def failed_checks(record: Record, rolling: str) -> tuple[str, ...]:
    """Return the reasons to doubt that the equations of a motion were solved, a sentence each.

    In "contact" the can may slip and part, as `rolling_failures` says. Friction and impacts then
    take energy, so that a drift tells nothing.
    """
    reasons = _slip_reasons(record)
    if rolling == "contact" and reasons:
        return ()
    error = float(np.maximum(record.swing_error, record.axis_error))  # NaN if one is
    if error <= ERROR:
        return reasons
    reason = (
        f"energy or momentum drifts as with an error of {error:.3g} rad of phi or u/a "
        f"(trusted up to {ERROR:g}): take a smaller timestep or a better integrator"
    )
    return (*reasons, reason)


def rolling_failures(record: Record, rolling: str, friction: float = math.inf) -> tuple[str, ...]:
    """Return where a can did not, or could not, roll without slipping, one sentence for each.

    In "contact" it slips at its coefficient of `friction`, and leaves the incline. Otherwise it
    rolls on where N < 0, and a real can would leave.
    """
    if rolling != "contact":
        if not math.isfinite(record.rolling_ends_at):
            return ()
        at = f"from t = {record.rolling_ends_at:.6g} s"
        reason = "the incline would have to pull at the can (N < 0): a real one leaves it there"
        return (f"{at} {reason}",)
    reasons = _slip_reasons(record)
    if record.needed_friction <= friction:
        return reasons
    needed = f"a friction coefficient of {record.needed_friction:.3g}"
    return (*reasons, f"rolling needs {needed}, and the contact has {friction:g}: it slides")


def _slip_reasons(record: Record) -> tuple[str, ...]:
    """Return how far a can slipped, and parted from the incline, where this is too far."""
    reasons = []
    slip = record.slip / record.scene.can.radius
    lift = record.lift / record.scene.can.radius
    if not slip <= SLIP:
        reasons.append(f"the can slips by {slip:.3g} radii (trusted up to {SLIP:g})")
    if not lift <= LIFT:
        parts = f"the can parts from the incline, or sinks in, by {lift:.3g} radii"
        reasons.append(f"{parts} (trusted up to {LIFT:g})")
    return tuple(reasons)


def _no_lump(record: Record) -> tuple[str, ...]:
    """Return, in one sentence, why the liquid does not move as a lump; empty if it does."""
    if record.scene.damping_law.valid_rates is None:
        return ()
    spread = f"from t = {record.no_lump_at:.6g} s on" if record.no_lump_at < math.inf else ""
    turns = record.largest_distance / (math.tau * record.scene.can.radius)
    warning = lump_warning("the liquid", record.scene, record.largest_slip_rate, spread, turns)
    return (warning,) if warning else ()


def _too_steep(record: Record) -> tuple[str, ...]:
    """Return, in one sentence, how far a surface tilts beyond linear theory; empty if it does not.

    That is of a load that stands for slosh.
    """
    tilt = record.largest_tilt
    if tilt <= slosh.LARGEST_TILT:
        return ()
    if tilt > math.pi:
        return ("the load stands for a liquid that sloshes, and turns round, as no liquid does",)
    tilts = f"the surface tilts by up to {tilt:.2g} rad against its rest"
    return (f"{tilts}: linear theory of slosh holds up to {slosh.LARGEST_TILT:g} rad",)


def _largest(so_far: float, values: np.ndarray | float) -> float:
    """Return the largest magnitude; NaN if there is one, which `max` would hide."""
    return float(np.maximum(so_far, np.abs(values).max()))
