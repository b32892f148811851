"""The paper's closed forms that simulations are compared with, corrected where a misprint is known."""

import math

from mjbeer.scene import Scene


def printed_55(scene: Scene) -> float:
    """Eq. (55) as printed [rad/s]: its denominator lacks the factor 2 in 2ab cos(phi_0)."""
    a, b, phi = scene.can.radius, scene.load.offset, scene.equilibrium()
    return math.sqrt(scene.gravity * b * math.cos(scene.incline + phi) / (1.5 * a**2 - a * b * math.cos(phi)))


def eq_10(scene: Scene) -> float:
    """Eq. (10) [rad/s], with the factor 1/a that its middle form lacks."""
    squared = 24 * math.pi * scene.gravity * math.cos(scene.incline) / ((9 * math.pi**2 - 32) * scene.can.radius)
    return math.sqrt(squared)


def corrected_55(scene: Scene) -> float:
    """Eq. (55) with the denominator that eq. (52) gives [rad/s]."""
    a, b, phi = scene.can.radius, scene.load.offset, scene.equilibrium()
    return math.sqrt(scene.gravity * b * math.cos(scene.incline + phi) / (1.5 * a**2 - 2 * a * b * math.cos(phi)))


def eq_53(scene: Scene) -> float:
    """Eq. (53) with the masses of both: sin(alpha + phi_0) = (m + m_can) a sin(alpha) / (m b) [rad]."""
    sine = scene.mass * scene.can.radius * math.sin(scene.incline) / (scene.load.mass * scene.load.offset)
    return math.asin(sine) - scene.incline
