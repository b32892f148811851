"""What the command line lets one say about a scene and a run: angles in degrees, otherwise SI units."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import Integrator, Rolling
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.load import BEER
from mjbeer.theory.scene import GRAVITY, Scene, frozen, hoop, pendulum, sliding

if TYPE_CHECKING:
    from mjbeer.theory.trajectory import Trajectory

CaseName = Literal["sliding", "sliding-metal", "frozen", "pendulum", "hoop"]


def radians(name: str, value: float, unit: str = "degrees") -> float:
    """An angle or a rate in radians.

    Raises:
      ParameterError: if it is not finite; the message is in the unit that it came in.
    """
    return math.radians(require.number(name, value, unit))


@dataclass(frozen=True)
class Common:
    """What every scene has."""

    incline: float = 10.0
    """Angle of the incline to the horizontal [degrees], positive downhill."""
    radius: float = RADIUS
    """Radius of the can [m]."""
    length: float = LENGTH
    """Length of the can [m]."""
    gravity: float = GRAVITY
    """Acceleration of gravity [m/s^2]."""

    @property
    def alpha(self) -> float:
        """The incline [rad]."""
        if not abs(self.incline) < 90:
            raise ParameterError(f"incline must be between -90 and 90 [degrees], got {self.incline!r}")
        return math.radians(self.incline)


@dataclass(frozen=True)
class Filled(Common):
    """What a can of beer has besides."""

    fill: float = 0.5
    """Height of the beer over the can's diameter, in (0, 1]."""
    density: float = BEER
    """Density of the beer [kg/m^3]."""
    can: Literal["massless", "metal"] = "massless"
    """A can without mass (section 2 of the paper), or of 0.1 mm aluminium (section 3)."""

    def made(self) -> Can:
        """The can."""
        make = Can.massless if self.can == "massless" else Can.sheet_metal
        return make(self.radius, self.length)


@dataclass(frozen=True)
class Sliding(Filled):
    """Beer that slides without friction in its can (sections 2 and 3 of the paper)."""

    def scene(self) -> Scene:
        """The scene."""
        return sliding(self.alpha, self.fill, self.made(), self.density, self.gravity)


@dataclass(frozen=True)
class Frozen(Filled):
    """Beer frozen to its can (appendix A)."""

    def scene(self) -> Scene:
        """The scene."""
        return frozen(self.alpha, self.fill, self.made(), self.density, self.gravity)


@dataclass(frozen=True)
class Pendulum(Common):
    """A hoop wheel with a pendulum on its axle (appendix B)."""

    wheel_mass: float = 0.2
    """Mass of the wheel [kg]."""
    load_mass: float = 0.1
    """Mass of the bob [kg]."""
    offset: float = 0.025
    """Length of the pendulum [m]."""

    def scene(self) -> Scene:
        """The scene."""
        sizes = self.offset, self.radius, self.length, self.gravity
        return pendulum(self.alpha, self.wheel_mass, self.load_mass, *sizes)


@dataclass(frozen=True)
class Hoop(Common):
    """A hoop with a point load on its rim, which can hop (appendix A.4)."""

    incline: float = 0.0
    """Angle of the incline to the horizontal [degrees], positive downhill."""
    hoop_mass: float = 0.01
    """Mass of the hoop [kg]."""
    load_mass: float = 0.2
    """Mass of the load [kg]."""

    def scene(self) -> Scene:
        """The scene."""
        return hoop(self.alpha, self.hoop_mass, self.load_mass, self.radius, self.length, self.gravity)


AnyScene = (
    Annotated[Sliding, tyro.conf.subcommand("sliding")]
    | Annotated[Frozen, tyro.conf.subcommand("frozen")]
    | Annotated[Pendulum, tyro.conf.subcommand("pendulum")]
    | Annotated[Hoop, tyro.conf.subcommand("hoop")]
)


@dataclass(frozen=True)
class Motion:
    """How a scene is started and simulated."""

    scene: AnyScene
    phi0: float = 60.0
    """Start angle of the load to the incline, the paper's phi [degrees]."""
    phi_dot0: float = 0.0
    """Start rate of phi [degrees/s]."""
    duration: float = 2.0
    """Length of the run [s]."""
    rolling: Rolling = "reduced"
    """What makes the can roll: coordinates, a joint equality, or contact with friction."""
    integrator: Integrator = "RK4"
    """Integrator."""
    timestep: float = 1e-3
    """Timestep, or with a tolerance the sampling interval [s]."""
    tolerance: float | None = None
    """Largest error of phi and u/a [rad]; takes DOP853 with steps of its own."""
    friction: float = 1.0
    """Friction coefficient of a contact."""

    def simulate(self) -> "Trajectory":
        """Run it."""
        from mjbeer.simulation.simulate import simulate

        return simulate(
            self.scene.scene(),
            self.duration,
            radians("phi0", self.phi0),
            radians("phi_dot0", self.phi_dot0, "degrees/s"),
            self.rolling,
            self.integrator,
            self.timestep,
            self.tolerance,
            friction=self.friction,
        )
