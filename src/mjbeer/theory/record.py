"""What a motion has shown of itself over all its steps, and whether that is a reason not to trust it."""

import math

import numpy as np

from mjbeer import require
from mjbeer.theory import equations
from mjbeer.theory.equations import Coordinates, accelerations, select_samples, slip_rate
from mjbeer.theory.liquid import centrifugal_ratio
from mjbeer.theory.scene import Scene

ERROR = 1e-2
"""Largest estimated error of phi and u/a [rad], relative beyond 1 rad, that is trusted: half a degree."""
SLIP = 1e-3
"""Largest slip, in radii, that is trusted: a milliradian of roll angle."""
LIFT = 1e-3
"""Largest gap or penetration between can and incline, in radii, that is trusted."""
_SMALL_SWING = 1e-2
"""Smallest energy with which a drift is compared, relative to the depth m g b of the potential well: that of a swing
of 0.14 rad. A motion that hardly swings would otherwise divide rounding by nearly nothing."""
_ROUNDING = 1e-11
"""Smallest energy with which a drift is compared, relative to the kinetic energy. A thousandth of it, the drift that
is trusted, is still many times the rounding of the kinetic energy."""


class Record:
    """The largest slip, lift, drift and rate of a motion so far, and when rolling stopped being possible.

    A motion is added in pieces, in the order of time. Its first sample is what later ones are compared with.
    """

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
        self.largest_slip_rate = (
            0.0  # largest rate between can and load with damping or drag, |u_dot/a - phi_dot| [rad/s]
        )
        self.no_lump_at = math.inf  # when the wall of a can with a liquid is first too fast for a lump [s]
        self.lowest_normal = math.inf  # smallest N that rolling needed [N]; below 0 the incline would have to pull
        self.needed_friction = 0.0  # largest friction coefficient that rolling needed; infinite where N < 0
        self.rolling_ends_at = math.inf  # when N < 0 or |F| > friction N for the first time, interpolated [s]
        self._kinetic = self._energy = self._energy_change = self._work = 0.0
        self._swing_drift = self._largest_swing_drift = self._swing_change = 0.0
        self._first: Coordinates | None = None
        self._last: Coordinates | None = None
        self._before: tuple[float, float] | None = None
        self._all_steps = True

    @classmethod
    def of(cls, motion: Coordinates, scene: Scene, friction: float = math.inf) -> "Record":
        """Return the record of a motion whose samples are all there is; they may be in any order.

        They do not tell what damping and drag take between them, so that the energy is then not looked at.
        """
        record = cls(scene, friction)
        record._all_steps = False
        record.add(select_samples(motion, np.argsort(motion.time)))
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
            self._first, self._last, self._energy = (
                select_samples(motion, [0]),
                select_samples(motion, [0]),
                float(energy[0]),
            )
        first, last, self._last = self._first, self._last, select_samples(motion, [-1])
        self.slip = _largest(self.slip, motion.u - first.u - scene.can.radius * (motion.roll - first.roll))
        self.lift = _largest(self.lift, motion.lift)
        self.largest_turn = _largest(self.largest_turn, motion.phi - first.phi)
        self.largest_distance = _largest(self.largest_distance, motion.u - first.u)
        self.largest_rate = _largest(self.largest_rate, motion.phi_dot)
        covered, swing = (
            np.abs(np.diff(motion.phi, prepend=last.phi)),
            oscillator.inertia(motion.phi) * motion.phi_dot**2 / 2,
        )
        self.angle_covered += float(covered.sum())
        self._kinetic, self.swing_energy = _largest(self._kinetic, kinetic), _largest(self.swing_energy, swing)
        if scene.dissipates:
            self.largest_slip_rate = _largest(self.largest_slip_rate, slip_rate(scene, motion.phi_dot, motion.u_dot))
            if scene.damping_law.holds is not None:
                fast = np.flatnonzero(centrifugal_ratio(scene, motion.u_dot) > 1)
                self.no_lump_at = min(self.no_lump_at, *motion.time[fast[:1]].tolist(), math.inf)
            if self._all_steps:
                work = self._work + np.cumsum(_work(scene, motion, last))
                self._work = float(work[-1])
                self._energy_change = _largest(self._energy_change, energy - self._energy + work)
            return
        self._energy_change = _largest(self._energy_change, energy - self._energy)
        swing -= oscillator.inertia(first.phi) * first.phi_dot**2 / 2 + oscillator.drop(motion.phi, first.phi)
        self._swing_change = _largest(self._swing_change, swing)
        drift = self._swing_drift + np.cumsum(swing * covered)
        self._swing_drift, self._largest_swing_drift = float(drift[-1]), _largest(self._largest_swing_drift, drift)
        self.axis_drift = _largest(self.axis_drift, axis_drift(scene, motion, first))

    def add_forces(self, time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, u_dot: np.ndarray | float) -> None:
        """Add the normal and friction forces that rolling needs at times [s] in the states of the motion there.

        `u_dot` [m/s] matters to damping and drag alone.
        """
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

        With damping or drag it is the change of the energy and of the work that they have taken, and needs a record of
        all steps. Unlike the implied error it includes slip and lift. The denominator is at least `_SMALL_SWING` of the
        well's depth; a balanced load has no well, and there it is the largest kinetic energy of all that moves.
        """
        balanced = self.scene.load.offset == 0
        scale = self._kinetic if balanced else max(self._least_swing, _ROUNDING * self._kinetic)
        return _ratio(self._energy_change, scale)

    @property
    def implied_error(self) -> float:
        """Return the error of phi or u/a [rad], relative beyond 1 rad, that the drift of energy and momentum implies.

        Unlike the error itself, neither drift grows where only the phase is off. With damping or drag it is 0.
        """
        return float(np.maximum(self.swing_error, self.axis_error))

    @property
    def swing_error(self) -> float:
        """Return the error of phi [rad], relative beyond 1 rad, that the drift of the swing's energy implies.

        A relative error of the energy is about that of the speed or the period, and so of the path of phi meanwhile.
        """
        return _ratio(self._largest_swing_drift, self._least_swing) / max(1.0, self.largest_turn)

    @property
    def swing_error_at_most(self) -> float:
        """Return `swing_error` as it would be if the largest drift, whatever its sign, had been there all the time.

        A step that misses a brief event may bring a drift that the next one takes away, and leave the phase wrong.
        """
        return _ratio(self._swing_change, self._least_swing) * self.angle_covered / max(1.0, self.largest_turn)

    @property
    def _least_swing(self) -> float:
        return max(self.swing_energy, _SMALL_SWING * self.scene.oscillator.depth)

    @property
    def axis_error(self) -> float:
        """Return the error of u/a [rad], relative beyond 1 rad, that the drift of the momentum implies."""
        return self.axis_drift / max(self.scene.can.radius, self.largest_distance)


def failed_checks(record: Record, rolling: str) -> list[str]:
    """Return the reasons in its record to doubt that the equations of a motion were solved, one sentence for each.

    `rolling` says how the can was made to roll. Only in "contact" may it slip and part, as `rolling_failures` says, and
    then friction and impacts take energy.
    """
    slipped = _slipped(record)
    if rolling == "contact" and slipped:
        return []
    reasons = slipped
    if not record.implied_error <= ERROR:
        reasons.append(
            f"energy or momentum drift like an error of {require.format_above(record.implied_error, ERROR)} rad of phi "
            f"or u/a (trusted up to {ERROR:g}): take a smaller timestep or a better integrator"
        )
    return reasons


def rolling_failures(record: Record, rolling: str, friction: float = math.inf) -> list[str]:
    """Return where a can did not, or could not, roll as the model of rolling without slipping does.

    In "contact" it slips at its coefficient of `friction`, and leaves the incline. Where it could not, a normal force
    below 0 says that a real can would have left.
    """
    if rolling != "contact":
        pulls = (
            f"from t = {record.rolling_ends_at:.6g} s the incline would have to pull at the can (N < 0): a real one "
            "leaves it there"
        )
        return [pulls] if math.isfinite(record.rolling_ends_at) else []
    reasons = _slipped(record)
    if not record.needed_friction <= friction:
        needed = require.format_above(record.needed_friction, friction, digits=3)
        reasons.append(f"rolling needs a friction coefficient of {needed}, and the contact has {friction:g}: it slides")
    return reasons


def _slipped(record: Record) -> list[str]:
    reasons, slip, lift = [], record.slip / record.scene.can.radius, record.lift / record.scene.can.radius
    if not slip <= SLIP:
        reasons.append(f"the can slips by {require.format_above(slip, SLIP)} radii (trusted up to {SLIP:g})")
    if not lift <= LIFT:
        by = require.format_above(lift, LIFT)
        reasons.append(f"the can parts from the incline, or sinks in, by {by} radii (trusted up to {LIFT:g})")
    return reasons


def axis_drift(scene: Scene, motion: Coordinates, start: Coordinates) -> np.ndarray:
    """Return u less the value that the momentum at the start implies [m], at each sample.

    A frozen load conserves no such momentum: there the drift is 0, and slip shows an error instead.
    """
    if scene.attachment == "frozen":
        return np.zeros_like(motion.time)
    begin = tuple(float(each[0]) for each in (start.phi, start.phi_dot, start.u, start.u_dot))
    return motion.u - equations.axis_motion(scene, motion.time - start.time, motion.phi, motion.phi_dot, begin)[0]


def _work(scene: Scene, motion: Coordinates, last: Coordinates) -> np.ndarray:
    """Return what damping and drag take in each step of a motion that goes on from its `last` sample [J].

    It is a trapezoid, corrected by the derivatives of the power at its ends.
    """
    time, phi, phi_dot, u_dot = (
        np.append(getattr(last, name), getattr(motion, name)) for name in ("time", "phi", "phi_dot", "u_dot")
    )
    (torque, along), slip = equations.dissipative_forces(scene, phi_dot, u_dot), slip_rate(scene, phi_dot, u_dot)
    u_ddot, phi_ddot = accelerations(scene, phi, phi_dot, u_dot)
    power = -along * u_dot - torque * phi_dot
    change = (torque + slip * scene.damping_law.derivative(slip)) * slip_rate(scene, phi_ddot, u_ddot)
    change = change + 3 * scene.drag * np.abs(u_dot) * u_dot * u_ddot
    step = np.diff(time)
    return step * (power[:-1] + power[1:]) / 2 - step**2 * np.diff(change) / 12


def _largest(so_far: float, values: np.ndarray | float) -> float:
    """Return the largest magnitude; NaN if there is one, which `max` would hide."""
    return float(np.maximum(so_far, np.abs(values).max()))


def _ratio(change: float, scale: float) -> float:
    return 0.0 if scale == 0 else change / scale  # NaN stays
