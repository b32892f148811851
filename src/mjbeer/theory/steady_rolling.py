"""Steady rolling of a can whose load is damped: the load stands still, tilted, and the can turns around it.

Then nothing accelerates, and the torque T(w) at the slip rate w = u_dot/a has two balances to hold,

    T(w)/a + drag u_dot |u_dot| = m_t g sin(alpha),        m g b sin(alpha + phi) = T(w).

Without drag T(w) is m_t g a sin(alpha) whatever the law, and the tilt is that of eq. (53) for the whole mass m_t.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mjbeer.exceptions import DissipationError, NoEquilibriumError
from mjbeer.theory.liquid import root

if TYPE_CHECKING:
    from mjbeer.theory.scene import Scene


@dataclass(frozen=True)
class SteadyRolling:
    """The motion in which the load of a damped scene stands still."""

    speed: float
    """Speed of the axis down the incline [m/s]."""
    tilt: float
    """Angle phi of the load [rad]."""
    slip: float
    """Slip rate of can and load [rad/s], speed/a."""
    stiffness: float
    """Torque that restores the load, per angle from the tilt: m g b cos(alpha + phi) [N m]."""


def steady_rolling(scene: "Scene") -> SteadyRolling:
    """Return the steady rolling of a scene.

    Raises:
      DissipationError: if the scene has neither damping nor drag.
      NoEquilibriumError: if the load is balanced, there is no gravity, or the incline is steeper than the load can
        hold.
    """
    require_dissipation(scene, "no steady rolling")
    scene.oscillator.equilibrium()  # whether anything restores the load
    radius, weight = scene.can.radius, scene.load.mass * scene.gravity * scene.load.offset
    torque = scene.mass * scene.gravity * radius * math.sin(scene.incline)
    linear, quadratic, cubic = scene.damping_law.coefficients
    slip = root((linear, quadratic + scene.drag * radius**3, cubic), torque)
    if scene.drag > 0:
        torque = float(scene.damping_law.torque(slip))
    if abs(torque) > weight:
        raise NoEquilibriumError(
            f"no steady rolling at an incline of {math.degrees(scene.incline):.4g} degrees: the load, which the "
            f"damping drags along, can hold the can only up to {math.degrees(largest_incline(scene)):.1f} degrees"
        )
    stiffness = math.sqrt(weight - abs(torque)) * math.sqrt(weight + abs(torque))
    return SteadyRolling(radius * slip, math.atan2(torque, stiffness) - scene.incline, slip, stiffness)


def largest_incline(scene: "Scene") -> float:
    """Return the largest incline on which a dissipating scene rolls steadily [rad]; pi/2 if it does on every one."""
    radius, weight = scene.can.radius, scene.load.mass * scene.gravity * scene.load.offset
    sine = scene.load.mass * scene.load.offset / (scene.mass * radius)
    if scene.drag > 0 and scene.gravity > 0:
        slip = root(scene.damping_law.coefficients, weight)
        sine += scene.drag * (radius * slip) ** 2 / (scene.mass * scene.gravity)
    return math.asin(min(sine, 1.0))


def slip_rate(scene: "Scene") -> float:
    """Return the mean slip rate [rad/s] of every motion whose load turns steadily, m_t g a sin(alpha)/c.

    Raises:
      DissipationError: if the scene has no damping, or drag, or damping that is not linear.
    """
    law = scene.damping_law
    if not law.linear > 0 or law.quadratic > 0 or law.cubic > 0 or scene.drag > 0:
        raise DissipationError(
            "no mean slip rate follows from the scene alone: it does from linear damping without drag, got "
            f"damping={scene.damping!r} and drag={scene.drag!r}"
        )
    return scene.mass * scene.gravity * scene.can.radius * math.sin(scene.incline) / law.linear


def require_dissipation(scene: "Scene", what: str) -> None:
    """Check that something takes energy from the motion.

    Raises:
      DissipationError: if nothing does; the message begins with `what` is missing for that reason.
    """
    if not scene.dissipates:
        raise DissipationError(
            f"{what}: damping and drag are 0, so that nothing brakes the can, which rolls ever faster or swings on"
        )


def require_no_dissipation(scene: "Scene", what: str) -> None:
    """Check that nothing takes energy from the motion.

    Raises:
      DissipationError: if something does; the message begins with `what` is missing for that reason.
    """
    if scene.dissipates:
        raise DissipationError(
            f"{what}: each swing of a load with damping or drag is smaller than the one before, got "
            f"damping={scene.damping!r} and drag={scene.drag!r}; scene.modes() has the rates"
        )
