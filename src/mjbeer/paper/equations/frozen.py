"""Appendix A of the paper: beer frozen to a massless can. Equations (50)-(55), printed and right.

The functions return terms as those of `sliding` do. The load has the I_axis = m a^2/2 of a half can, and any b.
"""

import math
from typing import Any

import numpy as np

from mjbeer.paper.letters import Letters, Quantities, Terms
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.scene import Scene


def eq_50(q: Quantities) -> tuple[Terms, ...]:
    """Return the terms of u = a phi, and of s = a phi - b sin(phi)."""
    return (q.u, -q.a * q.phi), (q.s, -q.a * q.phi, q.b * q.sin_phi)


def kinetic_51(q: Quantities) -> Terms:
    """Return the terms of T in eq. (51) [J]."""
    return q.m / 2 * 1.5 * q.a**2 * q.phi_dot**2, -q.m * q.a * q.b * q.cos_phi * q.phi_dot**2


def potential_51(q: Quantities) -> Terms:
    """Return the terms of V in eq. (51) [J]."""
    return -q.m * q.g * q.a * q.phi * q.sin_alpha, -q.m * q.g * q.b * q.cos_theta


def eq_52(q: Quantities) -> Terms:
    """Return the terms of eq. (52).

    (3a^2/2 - 2ab cos phi) phi_ddot + a b sin phi phi_dot^2 = g (a sin(alpha) - b sin(alpha + phi)).
    """
    return (
        1.5 * q.a**2 * q.phi_ddot,
        -2 * q.a * q.b * q.cos_phi * q.phi_ddot,
        q.a * q.b * q.sin_phi * q.phi_dot**2,
        -q.g * q.a * q.sin_alpha,
        q.g * q.b * q.sin_theta,
    )


def footnote_8(q: Quantities) -> Terms:
    """Return the terms of eq. (52) as footnote 8 types it into a computer, with lengths in cm.

    Its "3(0.5)" is half of a b = 3 cm^2; the whole of it would be right.
    """
    centi = 100
    a, b, g = centi * q.a, centi * q.b, centi * q.g
    return (
        1.5 * a**2 * q.phi_ddot,
        -2 * a * b * q.cos_phi * q.phi_ddot,
        a * b / 2 * q.sin_phi * q.phi_dot**2,
        -g * a * q.sin_alpha,
        g * b * q.sin_theta,
    )


def equilibrium_53(scene: Scene) -> float:
    """Return phi_0 [rad] by eq. (53), extended to a can with mass.

    That is sin(alpha + phi_0) = (m + m_can) a sin(alpha) / (m b).

    Raises:
      ValueError: if the incline is too steep for an equilibrium.
    """
    sine = scene.mass * scene.can.radius * math.sin(scene.incline) / scene.load.moment
    return math.asin(sine) - scene.incline


def cosine_54(sin_phi: Any, swing: Any) -> Any:
    """Return the change of cos(phi) over a small `swing` epsilon cos(wt) [rad], to first order."""
    return -swing * sin_phi


def sine_54(cos_theta: Any, swing: Any) -> Any:
    """Return the change of sin(alpha + phi) over a small `swing` [rad], to first order; corrected."""
    return swing * cos_theta


def printed_54(cos_theta: Any, swing: Any) -> Any:
    """Return the same with a minus, as printed."""
    return -swing * cos_theta


def eq_55(c: Letters, cos_phi: Any, cos_theta: Any) -> Any:
    """Return omega^2 = g b cos(alpha + phi_0) / (3a^2/2 - 2ab cos(phi_0)) [1/s^2]; corrected."""
    return c.g * c.b * cos_theta / (1.5 * c.a**2 - 2 * c.a * c.b * cos_phi)


def printed_55(c: Letters, cos_phi: Any, cos_theta: Any) -> Any:
    """Return the same with a b cos(phi_0) in the denominator, as printed."""
    return c.g * c.b * cos_theta / (1.5 * c.a**2 - c.a * c.b * cos_phi)


def frequency_55(scene: Scene) -> float:
    """Return omega [rad/s] by eq. (55) with the denominator that eq. (52) gives."""
    phi = scene.equilibrium()
    return math.sqrt(eq_55(Letters.of(scene), math.cos(phi), math.cos(scene.incline + phi)))


def printed_frequency_55(scene: Scene) -> float:
    """Return omega [rad/s] by eq. (55) as printed, whose denominator lacks the factor 2 in 2ab cos(phi_0)."""
    phi = scene.equilibrium()
    return math.sqrt(printed_55(Letters.of(scene), math.cos(phi), math.cos(scene.incline + phi)))


def long_run(form: Oscillator) -> float:
    """Return the mean phi_ddot [rad/s^2] of a long roll-down: the slope over (mean of sqrt(J) over a turn)^2.

    Energy gives J phi_dot^2/2 = slope phi + terms that stay bounded. Far down, therefore, dt = sqrt(J/(2 slope phi))
    dphi. The trapezoid rule for the mean converges geometrically, since J is smooth and periodic.
    """
    turn = 2 * np.pi * np.arange(64) / 64
    return form.slope / float(np.mean(np.sqrt(form.inertia(turn)))) ** 2
