"""Steady rolling of a can whose load is damped: the load stands still, tilted, and the can turns around it.

Then nothing accelerates, and the torque T(w) at the slip rate w = u_dot/a has two balances to hold,

    T(w)/a + drag u_dot |u_dot| = m_t g sin(alpha),        m g b sin(alpha + phi) = T(w).

Without drag T(w) is m_t g a sin(alpha) whatever the law, and the tilt is that of eq. (53) for the whole mass m_t.

Small motions about it have three modes exp(s t). With P = m b cos(phi), k = m g b cos(alpha + phi), N = M I - P^2 and
J_f = M a^2 + I - 2 P a at the tilt phi, the slopes c of the damping and d of the drag at the terminal speed, and
M = m + m_can + I_can/a^2,

    N s^3 + (c J_f/a^2 + d I) s^2 + (M k + c d) s + k (c/a^2 + d) = 0.

For c to 0 the swing is that of a sliding load, for c to infinity that of a frozen one, each at this tilt.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mjbeer.exceptions import DissipationError, NoEquilibriumError, ParameterError
from mjbeer.theory import liquid
from mjbeer.theory.oscillator import Oscillator, root

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
    radius, weight = scene.can.radius, scene.load.moment * scene.gravity
    torque = scene.drive * radius
    linear, quadratic, cubic = scene.damping_law.coefficients
    slip = liquid.root((linear, quadratic + scene.drag * radius**3, cubic), torque)
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
    radius, weight = scene.can.radius, scene.load.moment * scene.gravity
    sine = scene.load.moment / (scene.mass * radius)
    if scene.drag > 0 and scene.gravity > 0:
        slip = liquid.root(scene.damping_law.coefficients, weight)
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
    return scene.drive * scene.can.radius / law.linear


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


def modes(scene: "Scene") -> np.ndarray:
    """Return the three roots s [1/s], sorted by their real and then their imaginary parts.

    Raises:
      DissipationError: if the scene has neither damping nor drag.
      NoEquilibriumError: if it has no steady rolling.
      ParameterError: if the roots are beyond double precision.
    """
    steady, can, load = steady_rolling(scene), scene.can, scene.load
    mass, moment = scene.effective_mass, load.moment * math.cos(steady.tilt)
    inertia, k = load.axis_inertia, steady.stiffness
    rub = float(scene.damping_law.slope(steady.slip))
    drag = 2 * scene.drag * abs(steady.speed)
    swinging = mass * float(scene.oscillator.inertia(steady.tilt))  # N, without a difference
    frozen = Oscillator.frozen(can=can, load=load, incline=scene.incline, gravity=scene.gravity)
    along = rub / can.radius**2
    square = (float(frozen.inertia(steady.tilt)) * along + inertia * drag) / swinging
    scale = math.sqrt(mass * k / swinging) or square or 1.0
    square /= scale
    linear = (mass * k + rub * drag) / swinging / scale**2
    constant = k * (along + drag) / swinging / scale**3
    # A B - C of s^3 + A s^2 + B s + C, by M J_f - N = (M a - P)^2 and M I - N = P^2 a sum in which nothing cancels.
    excess = k * along * (mass * can.radius - moment) ** 2 / swinging / swinging / scale**3
    excess += k * drag * moment**2 / swinging / swinging / scale**3 + rub * drag / swinging * square / scale**2
    if not all(math.isfinite(each) for each in (square**2, linear, constant, excess * square)):
        raise ParameterError(f"the modes of this scene are beyond double precision: {scene!r}")
    return np.sort_complex(scale * _roots(square, linear, constant, excess))


def _roots(square: float, linear: float, constant: float, excess: float) -> np.ndarray:
    """Return the roots of s^3 + A s^2 + B s + C with none negative, and with A B - C = `excess` given to all digits.

    The sum of the two slow roots, -pair, obeys pair^3 - 2 A pair^2 + (A^2 + B) pair = A B - C. It keeps its digits,
    which those of the coefficients would hide where the decay is slow.
    """

    def gap(pair: float) -> float:
        return ((pair - 2 * square) * pair + square**2 + linear) * pair - excess

    bend = square**2 - 3 * linear  # where positive, the cubic has a largest value before its last root
    highest = (2 * square - math.sqrt(bend)) / 3 if bend > 0 else square
    end = highest if gap(highest) >= 0 else square
    unit = excess / (square**2 + linear) if excess > 0 else 1.0  # the root's size where it is small
    pair = unit * root(lambda share: gap(unit * share), 0.0, end / unit) if excess > 0 else 0.0
    single = pair - square
    if -single < square / 16:  # a small difference: the root of pair s^2 + B s + C next to it has its digits
        both = linear + math.sqrt(max(linear**2 - 4 * pair * constant, 0.0))
        if both > 0:
            single = min(-2 * constant / both, -both / (2 * pair), key=lambda root: abs(root - (pair - square)))
    product = -constant / single if single else linear
    half, spread = pair / 2, pair**2 / 4 - product
    if spread < 0:
        swing = complex(-half, math.sqrt(-spread))
        return np.array([single, swing, swing.conjugate()])
    fast = -(half + math.sqrt(spread))
    return np.array([single, fast, product / fast if fast else 0.0], complex)
