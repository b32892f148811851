"""The paper's closed forms that simulations are compared with, corrected where a misprint is known."""

import math

from mjbeer.paper.equations import frozen, sliding
from mjbeer.paper.letters import Letters, letters
from mjbeer.theory.scene import Scene


def constants(scene: Scene) -> Letters:
    """The letters of a scene."""
    return Letters(**letters(scene))


def printed_55(scene: Scene) -> float:
    """Eq. (55) as printed [rad/s]: its denominator lacks the factor 2 in 2ab cos(phi_0)."""
    phi = scene.equilibrium()
    return math.sqrt(frozen.printed_55(constants(scene), math.cos(phi), math.cos(scene.incline + phi)))


def eq_10(scene: Scene) -> float:
    """Eq. (10) [rad/s], with the factor 1/a that its middle form lacks."""
    return math.sqrt(sliding.eq_10(constants(scene), math.pi))


def corrected_55(scene: Scene) -> float:
    """Eq. (55) with the denominator that eq. (52) gives [rad/s]."""
    phi = scene.equilibrium()
    return math.sqrt(frozen.eq_55(constants(scene), math.cos(phi), math.cos(scene.incline + phi)))


def eq_53(scene: Scene) -> float:
    """Eq. (53) with the masses of both: sin(alpha + phi_0) = (m + m_can) a sin(alpha) / (m b) [rad]."""
    sine = scene.mass * scene.can.radius * math.sin(scene.incline) / (scene.load.mass * scene.load.offset)
    return math.asin(sine) - scene.incline
