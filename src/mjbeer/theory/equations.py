"""The equations of motion of a scene: its accelerations, the forces of the incline, its energy.

The accelerations are those of eqs. (46) and (47), with damping and drag added. The normal force N
and the friction force F of the incline follow from them. If N < 0 the incline would have to pull at
the can, and if |F| > mu N the can would slip. The formulas themselves are in `formulas`.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mjbeer.theory import formulas
from mjbeer.theory.formulas import SceneNumbers
from mjbeer.theory.scene import Scene


@dataclass(frozen=True, eq=False, kw_only=True)
class Coordinates:
    """A motion in the coordinates of the paper's Fig. 3; every array has shape (samples,)."""

    time: np.ndarray
    """Time [s]."""
    u: np.ndarray
    """Place of the axis along the incline [m], positive downhill.

    At time 0 it is as `Scene.initial_axis` says."""
    phi: np.ndarray
    """Angle of the load [rad]: 0 where its centre of mass is nearest to the incline.

    It grows with the roll of a can that rolls down with a frozen load."""
    u_dot: np.ndarray
    """Velocity of the axis down the incline [m/s]."""
    phi_dot: np.ndarray
    """Rate of phi [rad/s]."""
    roll: np.ndarray
    """Angle by which the can has rolled [rad]; u/a where it does not slip."""
    roll_dot: np.ndarray
    """Rate of roll [rad/s]."""
    lift: np.ndarray
    """Height of the can above the incline [m]; slightly negative in a soft contact."""
    lift_dot: np.ndarray
    """Velocity of the can away from the incline [m/s]."""


def select_samples(motion: Coordinates, samples: np.ndarray | list[int] | slice) -> Coordinates:
    """Return some of the samples of a motion."""
    names = Coordinates.__dataclass_fields__
    return Coordinates(**{name: getattr(motion, name)[samples] for name in names})


@dataclass(frozen=True, eq=False)
class Forces:
    """Forces of the incline on the can along a motion; both arrays have shape (samples,)."""

    normal: np.ndarray
    """N [N], positive away from the incline."""
    friction: np.ndarray
    """F [N], positive up the incline."""

    @property
    def needed_friction(self) -> np.ndarray:
        """Return the friction coefficient |F|/N that rolling needs.

        It is infinite where the incline would have to pull.
        """
        ratio = np.full_like(self.normal, np.inf)
        return np.divide(np.abs(self.friction), self.normal, out=ratio, where=self.normal > 0)


def scene_numbers(scene: Scene) -> SceneNumbers:
    """Return the numbers of a scene that the formulas need."""
    swing = scene.oscillator
    moment = scene.load.moment
    effective_mass = scene.effective_mass
    return SceneNumbers(
        base=swing.base,
        chord=swing.chord,
        coupling=swing.coupling,
        ramp=swing.ramp,
        depth=swing.depth,
        bottom=swing.bottom,
        frozen=scene.attachment == "frozen",
        radius=scene.can.radius,
        can_mass=scene.can.mass,
        can_inertia=scene.can.inertia,
        load_mass=scene.load.mass,
        load_inertia=scene.load.inertia,
        offset=scene.load.offset,
        moment=moment,
        total_mass=scene.mass,
        effective_mass=effective_mass,
        arm=moment / effective_mass,
        along=scene.gravity * math.sin(scene.incline),
        across=scene.gravity * math.cos(scene.incline),
    )


class Accelerations(NamedTuple):
    """Second derivatives of the coordinates in a state, or in several at once."""

    u_ddot: np.ndarray
    """[m/s^2]"""
    phi_ddot: np.ndarray
    """[rad/s^2]"""


def accelerations(
    scene: Scene,
    phi: np.ndarray | float,
    phi_dot: np.ndarray | float,
    u_dot: np.ndarray | float,
    slip_rate: np.ndarray | float | None = None,
) -> Accelerations:
    """Return the accelerations of rolling without slipping.

    The state is `phi` [rad], `phi_dot` [rad/s] and `u_dot` [m/s], of which the last matters to
    damping and drag alone. Give the `slip_rate` u_dot/a - phi_dot [rad/s] where it has more digits
    than the difference.

    With the damping's torque T and the force D of the air, the right side of eq. (46) has
    -(T/a + D), the `braking`, besides, and that of eq. (47) has T. Where u_ddot in eq. (47) is
    replaced by eq. (46), the braking adds -(m b cos(phi)/M_e) (T/a + D) to it.
    """
    if scene.attachment == "frozen":
        phi_ddot = scene.oscillator.acceleration(phi, phi_dot)
        return Accelerations(scene.can.radius * phi_ddot, phi_ddot)
    torque = 0.0
    braking = 0.0
    if scene.dissipates:
        if slip_rate is None:
            slip_rate = slip_rate_of(scene, phi_dot, u_dot)
        damping = scene.damping_law.torque(slip_rate)
        braking = damping / scene.can.radius + scene.drag * u_dot * np.abs(u_dot)
        torque = damping - scene.load.moment * np.cos(phi) / scene.effective_mass * braking
    phi_ddot = scene.oscillator.acceleration(phi, phi_dot, torque)
    u_ddot = formulas.axis_acceleration(scene_numbers(scene), phi, phi_dot, phi_ddot, braking)
    return Accelerations(u_ddot, phi_ddot)


class InitialState(NamedTuple):
    """The state in which a motion begins."""

    phi: float
    """[rad]"""
    phi_dot: float
    """[rad/s]"""
    u: float
    """[m]"""
    u_dot: float
    """[m/s]"""


def initial_state(scene: Scene, phi0: float, phi_dot0: float) -> InitialState:
    """Return the state of a start at `phi0` [rad] with `phi_dot0` [rad/s].

    `Scene.initial_axis` has that of the axis.
    """
    u0, u_dot0 = scene.initial_axis(phi0, phi_dot0)
    return InitialState(phi0, phi_dot0, u0, u_dot0)


class AxisMotion(NamedTuple):
    """The motion of the axis at some times."""

    u: np.ndarray
    """[m]"""
    u_dot: np.ndarray
    """[m/s]"""


def axis_motion(
    scene: Scene, time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, start: InitialState
) -> AxisMotion:
    """Return the motion of the axis without damping and drag, from phi at times [s] since `start`.

    A frozen load has u = a phi, eq. (50). A sliding load conserves the integral of eq. (46),

        M_e u_dot - m b cos(phi) phi_dot - m_t g sin(alpha) t.
    """
    if scene.attachment == "frozen":
        return AxisMotion(scene.can.radius * phi, scene.can.radius * phi_dot)
    arm = scene.load.moment / scene.effective_mass
    steady = scene.downhill_weight / scene.effective_mass
    mean_u = start.u - arm * math.sin(start.phi)
    mean_u_dot = start.u_dot - arm * math.cos(start.phi) * start.phi_dot
    u = arm * np.sin(phi) + (mean_u + mean_u_dot * time + steady * time**2 / 2)
    u_dot = arm * np.cos(phi) * phi_dot + (mean_u_dot + steady * time)
    return AxisMotion(u, u_dot)


def slip_rate_of(
    scene: Scene,
    phi_dot: np.ndarray | float,
    u_dot: np.ndarray | float,
) -> np.ndarray | float:
    """Return how much faster a rolling can turns than its load, w = u_dot/a - phi_dot [rad/s]."""
    return u_dot / scene.can.radius - phi_dot


def resting_tilt(
    scene: Scene,
    phi_dot: np.ndarray,
    u_dot: np.ndarray,
) -> np.ndarray:
    """Return the phi [rad] at which a sliding load would hang still at the present rates.

    Without damping and drag it is the equilibrium, and at the terminal speed the `terminal_tilt`.
    With T, D and the braking of `accelerations`, and `depth` and `bottom` of `Oscillator`, it
    solves

        depth sin(phi - bottom) + (m b/M_e) cos(phi) (T/a + D) = T.

    If the load cannot exert T, it is where its torque is the largest.
    """
    torque = scene.damping_law.torque(slip_rate_of(scene, phi_dot, u_dot))
    braking = torque / scene.can.radius + scene.drag * u_dot * np.abs(u_dot)
    swing = scene.oscillator
    of_sine = swing.depth * math.cos(swing.bottom)
    of_cosine = scene.load.moment / scene.effective_mass * braking
    of_cosine -= swing.depth * math.sin(swing.bottom)
    sine = torque / np.hypot(of_sine, of_cosine)
    return np.arcsin(np.clip(sine, -1, 1)) - np.arctan2(of_cosine, of_sine)


def rolling_forces(
    scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float, u_dot: np.ndarray | float
) -> Forces:
    """Return N and F [N] that rolling without slipping needs in a state.

    The state is that of `accelerations`.
    """
    numbers = scene_numbers(scene)
    u_ddot, phi_ddot = accelerations(scene, phi, phi_dot, u_dot)
    normal = formulas.normal_force(numbers, phi, phi_dot, phi_ddot)
    if scene.attachment == "frozen":
        return Forces(normal, formulas.friction_of_frozen(numbers, phi, phi_dot, phi_ddot))
    damping = scene.damping_law.torque(slip_rate_of(scene, phi_dot, u_dot))
    return Forces(normal, formulas.friction_of_sliding(numbers, u_ddot, damping))


def potential_energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return the potential energy [J] of can and load at each sample.

    It is 0 with all mass at u = 0 on the axis.
    """
    return formulas.potential_energy(scene_numbers(scene), motion.phi, motion.u, motion.lift)


def kinetic_energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return the kinetic energy [J] of can and load at each sample.

    It is that of eqs. (39) and (44), with slip and lift added.
    """
    return formulas.kinetic_energy(
        scene_numbers(scene),
        motion.phi,
        motion.phi_dot,
        motion.u_dot,
        motion.roll_dot,
        motion.lift_dot,
    )
