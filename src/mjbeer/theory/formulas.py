"""The formulas of a can that rolls without slipping, each written once.

They take numbers and arrays alike: NumPy evaluates them for all samples of a motion, and a compiled
loop for one step after the other. Angles are in [rad], everything else in SI units. The first
argument has the numbers of a scene by name. The first five formulas, those of the swing, need only
the numbers that an `Oscillator` has, too.
"""

from typing import Any, NamedTuple, TypeAlias

import numpy as np

Value: TypeAlias = Any
"""A number, or an array of numbers."""


class SceneNumbers(NamedTuple):
    """What the formulas need to know of a scene."""

    base: float
    """Constant part of J [kg m^2]."""
    chord: float
    """Coefficient of sin^2(phi/2) in J [kg m^2]."""
    coupling: float
    """Coefficient of sin^2(phi) in J [kg m^2]."""
    ramp: float
    """Mean torque downhill [N m]."""
    depth: float
    """Amplitude of the cosine in V [J]."""
    bottom: float
    """Angle at which the cosine in V has its minimum [rad]."""
    frozen: bool
    """Whether the load turns with the can."""
    radius: float
    """Radius of the can, a [m]."""
    can_mass: float
    """m_can [kg]."""
    can_inertia: float
    """I_can [kg m^2]."""
    load_mass: float
    """m [kg]."""
    load_inertia: float
    """I_cm [kg m^2]."""
    offset: float
    """Distance of the load's centre of mass from the axis, b [m]."""
    moment: float
    """m b [kg m]."""
    total_mass: float
    """m + m_can [kg]."""
    effective_mass: float
    """M_e = m + m_can + I_can/a^2 [kg]."""
    arm: float
    """m b / M_e [m]."""
    along: float
    """g sin(alpha), the part of gravity down the incline [m/s^2]."""
    across: float
    """g cos(alpha), the part of gravity into the incline [m/s^2]."""


def inertia(swing: Any, phi: Value) -> Value:
    """Return J [kg m^2], the inertia of the swing."""
    by_chord = swing.chord * np.sin(phi / 2) ** 2
    return swing.base + by_chord + swing.coupling * np.sin(phi) ** 2


def swing_energy(swing: Any, phi: Value, phi_dot: Value) -> Value:
    """Return J phi_dot^2 / 2 [J], the kinetic energy of the swing."""
    return inertia(swing, phi) * phi_dot**2 / 2


def potential_drop(swing: Any, phi: Value, from_phi: Value) -> Value:
    """Return V(from_phi) - V(phi) [J] without the cancellation of the plain difference.

    A difference of cosines, cos(x) - cos(y), is -2 sin((x + y)/2) sin((x - y)/2).
    """
    turned = phi - from_phi
    middle = (phi + from_phi) / 2 - swing.bottom
    return swing.ramp * turned - 2 * swing.depth * np.sin(middle) * np.sin(turned / 2)


def swing_energy_change(
    swing: Any, energy: Value, phi: Value, from_energy: Value, from_phi: Value
) -> Value:
    """Return the change of J phi_dot^2 / 2 + V [J], which a motion without damping conserves.

    The kinetic energy of the swing is `energy` at phi, and was `from_energy` at `from_phi`.
    """
    return energy - (from_energy + potential_drop(swing, phi, from_phi))


def phi_acceleration(swing: Any, phi: Value, phi_dot: Value, torque: Value) -> Value:
    """Return phi_ddot [rad/s^2], with a `torque` [N m] beside those of inertia and weight.

    The equation of motion is J phi_ddot + J' phi_dot^2 / 2 + V' = torque, where J' and V' are
    derivatives by phi. It is (16) or (52) for a massless can.
    """
    half_slope = swing.chord / 4 * np.sin(phi) + swing.coupling / 2 * np.sin(2 * phi)  # J'/2
    weight = swing.ramp - swing.depth * np.sin(phi - swing.bottom)  # -V'
    return (weight + torque - half_slope * phi_dot**2) / inertia(swing, phi)


def sideways_pull(scene: Any, phi: Value, phi_dot: Value, phi_ddot: Value) -> Value:
    """Return m d2(b sin(phi))/dt2 [N], with which a load that moves in a can pulls it downhill."""
    return scene.moment * (np.cos(phi) * phi_ddot - np.sin(phi) * phi_dot**2)


def axis_acceleration(
    scene: Any,
    phi: Value,
    phi_dot: Value,
    phi_ddot: Value,
    braking: Value,
) -> Value:
    """Return u_ddot [m/s^2] of a can with a sliding load and a `braking` force [N]: eq. (46)."""
    pull = sideways_pull(scene, phi, phi_dot, phi_ddot)
    return (scene.total_mass * scene.along - braking + pull) / scene.effective_mass


def normal_force(scene: Any, phi: Value, phi_dot: Value, phi_ddot: Value) -> Value:
    """Return N [N], with which the incline presses on the can; below 0 it would have to pull.

    The load is b cos(phi) nearer to the incline than the axis, and its acceleration towards the
    incline takes m d2(b cos(phi))/dt2 from N.
    """
    push = scene.moment * (np.sin(phi) * phi_ddot + np.cos(phi) * phi_dot**2)
    return scene.total_mass * scene.across + push


def friction_of_frozen(scene: Any, phi: Value, phi_dot: Value, phi_ddot: Value) -> Value:
    """Return F [N], positive up the incline, of a can whose load turns with it.

    It is the weight along the incline less mass times acceleration, which is that of the axis for
    the can, and for the load that of the axis less d2(b sin(phi))/dt2.
    """
    of_axis = scene.total_mass * scene.radius * phi_ddot
    of_load = sideways_pull(scene, phi, phi_dot, phi_ddot)
    return scene.total_mass * scene.along - (of_axis - of_load)


def friction_of_sliding(scene: Any, u_ddot: Value, damping_torque: Value) -> Value:
    """Return F [N], positive up the incline, of a can with a sliding load.

    Friction and damping together turn the can: a F - T = I_can u_ddot / a.
    """
    return scene.can_inertia / scene.radius**2 * u_ddot + damping_torque / scene.radius


def rolling_margin(normal: Value, friction: Value, coefficient: float) -> Value:
    """Return the force [N] that keeps a can from leaving the incline or from slipping.

    It is the lesser of the two: N, and by how much F may still grow at this coefficient of
    friction. It is negative where the can cannot roll.
    """
    if coefficient == np.inf:
        return normal
    return np.minimum(normal, coefficient * normal - np.abs(friction))


def zero_crossing(time: Value, force: Value, later_time: Value, later_force: Value) -> Value:
    """Return the time [s] at which the line between a force and a `later_force` is 0."""
    share = force / (force - later_force)
    return time + share * (later_time - time)


def kinetic_energy(
    scene: Any,
    phi: Value,
    phi_dot: Value,
    u_dot: Value,
    roll_dot: Value,
    lift_dot: Value,
) -> Value:
    """Return the kinetic energy [J] of can and load: eqs. (39), (44), with slip and lift added."""
    load_along = u_dot - scene.offset * np.cos(phi) * phi_dot
    load_across = lift_dot + scene.offset * np.sin(phi) * phi_dot
    load_square = load_along**2 + load_across**2
    twice_can = scene.can_mass * (u_dot**2 + lift_dot**2) + scene.can_inertia * roll_dot**2
    twice_load = scene.load_mass * load_square + scene.load_inertia * phi_dot**2
    return (twice_can + twice_load) / 2


def potential_energy(scene: Any, phi: Value, u: Value, lift: Value) -> Value:
    """Return the potential energy [J] of can and load, 0 with all mass at u = 0 on the axis.

    That of the load is lower by m b g cos(alpha + phi).
    """
    lower = scene.moment * (scene.across * np.cos(phi) - scene.along * np.sin(phi))
    return scene.total_mass * (lift * scene.across - u * scene.along) - lower
