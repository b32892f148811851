"""The letters in which the paper's equations are written: constants of a scene, and quantities of a motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from mjbeer.theory.scene import Scene

Terms = tuple[Any, ...]
"""The terms of an equation, all on one side: they sum to zero where it holds."""


@dataclass(frozen=True)
class Letters:
    """Constants of a scene: numbers, or symbols where an equation is derived."""

    a: Any
    """Radius of the can [m]."""
    b: Any
    """Distance of the load's centre of mass from the axis [m]."""
    m: Any
    """Mass of the load [kg]."""
    inertia: Any
    """Moment of inertia I_cm of the load about its centre of mass [kg m^2]."""
    can_mass: Any
    """Mass m_can of the can [kg]; M in appendix B."""
    can_inertia: Any
    """Moment of inertia I_can of the can about its axis [kg m^2]."""
    g: Any
    """Acceleration of gravity [m/s^2]."""
    sin_alpha: Any
    cos_alpha: Any
    """Sine and cosine of the incline's angle."""

    @classmethod
    def of(cls, scene: Scene, **motion: Any) -> Self:
        """Return the letters of a scene; `Quantities.of` takes the fields of the motion as keyword arguments."""
        can, load = scene.can, scene.load
        return cls(
            a=can.radius,
            b=load.offset,
            m=load.mass,
            inertia=load.inertia,
            can_mass=can.mass,
            can_inertia=can.inertia,
            g=scene.gravity,
            sin_alpha=math.sin(scene.incline),
            cos_alpha=math.cos(scene.incline),
            **motion,
        )

    @property
    def axial(self) -> Any:
        """Moment of inertia I_axis = I_cm + m b^2 of the load about the can's axis [kg m^2]."""
        return self.inertia + self.m * self.b**2

    @property
    def rolling(self) -> Any:
        """Effective mass m_can + I_can/a^2 [kg] of the rolling can: half of it times u_dot^2 is the kinetic energy."""
        return self.can_mass + self.can_inertia / self.a**2

    @property
    def spread(self) -> Any:
        """delta = (m b^2/2)/(m b^2/2 + I_cm): how much the inertia about C of eq. (3) varies over a turn."""
        return (self.m * self.b**2 / 2) / (self.m * self.b**2 / 2 + self.inertia)


@dataclass(frozen=True)
class Quantities(Letters):
    """Letters and a motion in the coordinates of Fig. 3: each field has one entry a sample, in SI units."""

    s: Any
    s_dot: Any
    s_ddot: Any
    u: Any
    u_dot: Any
    u_ddot: Any
    phi: Any
    phi_dot: Any
    phi_ddot: Any
    """Acceleration of phi [rad/s^2]. Rate and acceleration of theta = alpha + phi are those of phi."""
    sin_phi: Any
    cos_phi: Any
    sin_theta: Any
    cos_theta: Any
