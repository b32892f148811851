"""The extremes of a motion over all its steps, and the reasons not to trust it that follow from them."""

import math

import numpy as np

from mjbeer.theory import equations
from mjbeer.theory.equations import Coordinates, select_samples, slip_rate
from mjbeer.theory.liquid import centrifugal_ratio
from mjbeer.theory.scene import Scene

# The largest values that are trusted.
ERROR = 1e-2  # estimated error of phi and u/a [rad], relative beyond 1 rad: half a degree
SLIP = 1e-3  # in radii: a milliradian of roll angle
LIFT = 1e-3  # gap or penetration between can and incline, in radii
_SMALL_SWING = 1e-2  # of the depth m g b of the well: a drift is compared with no less than a swing of 0.14 rad


class Record:
    """The largest slip, lift, drift and rate of a motion so far, which is added in pieces, in the order of time."""

    def __init__(self, scene: Scene, friction: float = math.inf) -> None:
        """Begin the record of a can that slips where rolling needs more than a coefficient of `friction`."""
        self.scene, self.friction = scene, friction
        self.slip = 0.0  # largest distance that the can has slid instead of rolled [m]
        self.lift = 0.0  # largest distance between can and incline, or depth of the can in it [m]
        self.largest_turn = 0.0  # largest angle by which the load has turned from its start [rad]
        self.largest_distance = 0.0  # largest distance of the axis from its start [m]
        self.angle_covered = 0.0  # angle that the load has covered, forth and back [rad]
        self.largest_rate = 0.0  # largest rate of the load, |phi_dot| [rad/s]
        self.swing_energy = 0.0  # largest kinetic energy of the swing, J phi_dot^2 / 2 [J]
        self.axis_drift = 0.0  # largest distance of the axis from where its momentum has it [m]; 0 with damping or drag
        self.largest_slip_rate = 0.0  # largest |u_dot/a - phi_dot| of can and load with damping or drag [rad/s]
        self.no_lump_at = math.inf  # when the wall of a can with a liquid is first too fast for a lump [s]
        self.lowest_normal = math.inf  # smallest N that rolling needed [N]; below 0 the incline would have to pull
        self.needed_friction = 0.0  # largest friction coefficient that rolling needed; infinite where N < 0
        self.rolling_ends_at = math.inf  # when N < 0 or |F| > friction N for the first time, interpolated [s]
        self._kinetic = self._energy = self._energy_change = 0.0
        self._swing_drift = self._largest_swing_drift = self._swing_change = 0.0
        self._first: Coordinates | None = None
        self._last: Coordinates | None = None
        self._before: tuple[float, float] | None = None

    @classmethod
    def of(cls, motion: Coordinates, scene: Scene, friction: float = math.inf) -> "Record":
        """Return the record of a motion whose samples are all there is."""
        record = cls(scene, friction)
        record.add(motion)
        return record

    def add(self, motion: Coordinates) -> None:
        """Add the next piece of the motion, which begins after the last one ended."""
        self.add_conserved(motion)
        self.add_forces(motion.time, motion.phi, motion.phi_dot, motion.u_dot)

    def add_conserved(self, motion: Coordinates) -> None:
        """Add the next piece of the motion to everything but what rests on forces."""
        scene, oscillator = self.scene, self.scene.oscillator
        kinetic = equations.kinetic_energy(scene, motion)
        energy = kinetic + equations.potential_energy(scene, motion)
        if self._first is None or self._last is None:
            self._first = self._last = select_samples(motion, [0])
            self._energy = float(energy[0])
        first, last, self._last = self._first, self._last, select_samples(motion, [-1])
        self.slip = _largest(self.slip, motion.u - first.u - scene.can.radius * (motion.roll - first.roll))
        self.lift = _largest(self.lift, motion.lift)
        self.largest_turn = _largest(self.largest_turn, motion.phi - first.phi)
        self.largest_distance = _largest(self.largest_distance, motion.u - first.u)
        self.largest_rate = _largest(self.largest_rate, motion.phi_dot)
        covered = np.abs(np.diff(motion.phi, prepend=last.phi))
        in_swing = oscillator.kinetic_energy(motion.phi, motion.phi_dot)
        self.angle_covered += float(covered.sum())
        self._kinetic, self.swing_energy = _largest(self._kinetic, kinetic), _largest(self.swing_energy, in_swing)
        self._energy_change = _largest(self._energy_change, energy - self._energy)
        if scene.dissipates:
            self.largest_slip_rate = _largest(self.largest_slip_rate, slip_rate(scene, motion.phi_dot, motion.u_dot))
            if scene.damping_law.valid_rates is not None:
                fast = np.flatnonzero(centrifugal_ratio(scene, motion.u_dot) > 1)
                self.no_lump_at = min(self.no_lump_at, *motion.time[fast[:1]].tolist(), math.inf)
            return
        begun = oscillator.kinetic_energy(first.phi, first.phi_dot)
        excess = in_swing - (begun + oscillator.drop(motion.phi, first.phi))
        self._swing_change = _largest(self._swing_change, excess)
        drift = self._swing_drift + np.cumsum(excess * covered)
        self._swing_drift, self._largest_swing_drift = float(drift[-1]), _largest(self._largest_swing_drift, drift)
        if scene.attachment == "sliding":  # a frozen load conserves no momentum
            begin = tuple(float(each[0]) for each in (first.phi, first.phi_dot, first.u, first.u_dot))
            expected, _ = equations.axis_motion(scene, motion.time - first.time, motion.phi, motion.phi_dot, begin)
            self.axis_drift = _largest(self.axis_drift, motion.u - expected)

    def add_forces(self, time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, u_dot: np.ndarray | float) -> None:
        """Add the forces that rolling needs at times [s] in the states there; `u_dot` matters to damping and drag."""
        forces = equations.rolling_forces(self.scene, phi, phi_dot, u_dot)
        self.lowest_normal = float(np.minimum(self.lowest_normal, forces.normal.min()))
        self.needed_friction = _largest(self.needed_friction, forces.needed_friction)
        if math.isfinite(self.rolling_ends_at):
            return
        margin = forces.normal
        if math.isfinite(self.friction):
            margin = np.minimum(margin, self.friction * forces.normal - np.abs(forces.friction))
        if margin.min() < 0:
            after = int(np.argmax(margin < 0))
            later, below = float(time[after]), float(margin[after])
            before = (float(time[after - 1]), float(margin[after - 1])) if after else self._before
            earlier, above = before or (later, 0.0)
            self.rolling_ends_at = earlier + above / (above - below) * (later - earlier)
        self._before = float(time[-1]), float(margin[-1])

    @property
    def energy_drift(self) -> float:
        """Return the largest change of the total energy over the largest kinetic energy of the swing, J phi_dot^2 / 2.

        It includes what damping and drag take. A balanced load's is over the largest kinetic energy of all that moves.
        """
        balanced = self.scene.load.offset == 0
        # A thousandth of 1e-11 of the kinetic energy is still many times its rounding.
        return self._energy_change / max(self._least_swing, (1.0 if balanced else 1e-11) * self._kinetic)

    @property
    def swing_error(self) -> float:
        """Return the error of phi [rad], relative beyond 1 rad, that the drift of the swing's energy implies.

        A relative error of the energy is about that of the angle covered meanwhile. With damping or drag there is none.
        """
        return self._largest_swing_drift / self._least_swing / max(1.0, self.largest_turn)

    @property
    def swing_error_at_most(self) -> float:
        """Return `swing_error` as it would be if the largest drift had been there all the time.

        A step that misses a brief event may bring a drift that the next one takes away, and leave the phase wrong.
        """
        return self._swing_change / self._least_swing * self.angle_covered / max(1.0, self.largest_turn)

    @property
    def axis_error(self) -> float:
        """Return the error of u/a [rad], relative beyond 1 rad, that the drift of the momentum implies."""
        return self.axis_drift / max(self.scene.can.radius, self.largest_distance)

    @property
    def _least_swing(self) -> float:
        return max(self.swing_energy, _SMALL_SWING * self.scene.oscillator.depth, np.finfo(float).tiny)


def failed_checks(record: Record, rolling: str) -> list[str]:
    """Return the reasons to doubt that the equations of a motion were solved, one sentence for each.

    In "contact" the can may slip and part, as `rolling_failures` says, and then friction and impacts take energy.
    """
    reasons = _slip_reasons(record)
    if rolling == "contact" and reasons:
        return []
    error = float(np.maximum(record.swing_error, record.axis_error))  # NaN if one is
    if not error <= ERROR:
        reasons.append(
            f"energy or momentum drift like an error of {error:.3g} rad of phi or u/a (trusted up to {ERROR:g}): "
            "take a smaller timestep or a better integrator"
        )
    return reasons


def rolling_failures(record: Record, rolling: str, friction: float = math.inf) -> list[str]:
    """Return where a can did not, or could not, roll without slipping, one sentence for each.

    In "contact" it slips at its coefficient of `friction`, and leaves the incline. Else a real can does so where N < 0.
    """
    if rolling != "contact":
        at = f"from t = {record.rolling_ends_at:.6g} s"
        pulls = f"{at} the incline would have to pull at the can (N < 0): a real one leaves it there"
        return [pulls] if math.isfinite(record.rolling_ends_at) else []
    reasons = _slip_reasons(record)
    if not record.needed_friction <= friction:
        needed = f"a friction coefficient of {record.needed_friction:.3g}"
        reasons.append(f"rolling needs {needed}, and the contact has {friction:g}: it slides")
    return reasons


def _slip_reasons(record: Record) -> list[str]:
    reasons, slip, lift = [], record.slip / record.scene.can.radius, record.lift / record.scene.can.radius
    if not slip <= SLIP:
        reasons.append(f"the can slips by {slip:.3g} radii (trusted up to {SLIP:g})")
    if not lift <= LIFT:
        reasons.append(f"the can parts from the incline, or sinks in, by {lift:.3g} radii (trusted up to {LIFT:g})")
    return reasons


def _largest(so_far: float, values: np.ndarray | float) -> float:
    """Return the largest magnitude; NaN if there is one, which `max` would hide."""
    return float(np.maximum(so_far, np.abs(values).max()))
