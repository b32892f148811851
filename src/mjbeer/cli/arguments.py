"""The options for scenes and simulations: angles in degrees, everything else in SI units."""

import math
from collections.abc import Iterable
from dataclasses import KW_ONLY, Field, dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, cast, get_args

import tyro

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import Integrator, Rolling
from mjbeer.output.terminal import say
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.liquid import NAMES, Name, liquid, liquid_in
from mjbeer.theory.load import BEER
from mjbeer.theory.named import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import DURATION, GRAVITY, PHI0, Scene

if TYPE_CHECKING:
    from mjbeer.theory.trajectory import Trajectory

CaseName = Literal["sliding", "sliding-metal", "frozen", "pendulum", "hoop", "stiff", "stiffer"]


def if_given(kind: Any, otherwise: str) -> object:
    """Return how tyro reads an option that may be left out: as a value of some kind, with a word for what is then."""
    return tyro.conf.arg(constructor=kind, help_behavior_hint=f"(default: {otherwise})")


def otherwise(field: Field[Any]) -> str:
    """Return what is taken where an option is left out that has no default: the word of its `if_given`."""
    (how,) = cast("Any", field.type).__metadata__
    return how.help_behavior_hint.removeprefix("(default: ").removesuffix(")")


def one_of(name: str, allowed: Iterable[str]) -> object:
    """Return how tyro reads an option that takes one of some names; an error asks after one that is spelled alike."""
    return tyro.constructors.PrimitiveConstructorSpec(
        nargs=1,
        metavar="NAME",
        instance_from_str=lambda words: require.choice(name, words[0], allowed),
        is_instance=lambda value: isinstance(value, str),
        str_from_instance=lambda value: [value],
    )


_SHARES = (1 / 6, 1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4, 1, 3 / 2, 2)
"""Shares of pi at which an angle looks like radians."""


def degrees(name: str, value: float) -> float:
    """Convert an angle from degrees to radians as `radians` does, and say so if it looks like radians, as 3.14159."""
    _, _, decimals = str(abs(value)).partition(".")
    if len(decimals) >= 3 and any(abs(abs(value) - share * math.pi) < 1e-3 for share in _SHARES):
        say(
            f"note: {name} = {value:g} is taken as degrees; in degrees, that many radians are {math.degrees(value):.6g}"
        )
    return radians(name, value)


def radians(name: str, value: float, unit: str = "degrees") -> float:
    """Convert an angle from degrees to radians, or a rate from degrees/s to radians/s, and return it.

    Raises:
      ParameterError: if it is not finite; the message has the `name` of the option and the `unit` of its value.
    """
    return math.radians(require.number(name, value, unit))


@dataclass(frozen=True)
class Common:
    """The options of every scene."""

    incline: float = 10.0
    """Angle of the incline to the horizontal [degrees]; if positive, u grows downhill."""
    radius: float = RADIUS
    """Radius of the can [m]."""
    length: float = LENGTH
    """Length of the can [m]."""
    gravity: float = GRAVITY
    """Acceleration of gravity [m/s^2]."""

    @property
    def alpha(self) -> float:
        """The angle of the incline [rad].

        Raises:
          ParameterError: if it is not between -90 and 90 degrees.
        """
        if not abs(self.incline) < 90:
            raise ParameterError(f"incline must be between -90 and 90 [degrees], got {self.incline!r}")
        return math.radians(self.incline)

    def scene(self) -> Scene:
        """Return the scene of these options."""
        return self.at(self.alpha)

    def told_scene(self) -> Scene:
        """Return the scene of these options, and say what it takes that was not given."""
        if told := self.told(self.alpha):
            say(told)
        return self.scene()

    def at(self, alpha: float) -> Scene:
        """Return the scene of these options on an incline of `alpha` [rad], whatever their own incline is."""
        raise NotImplementedError

    def told(self, alpha: float) -> str:
        """Return what the scene takes that was not given, in one line; empty if there is nothing of that kind."""
        return ""


@dataclass(frozen=True)
class Filled(Common):
    """The further options of a scene with a load that fills a can."""

    fill: float = 0.5
    """Height of the load as a fraction of the can's diameter, in (0, 1]."""
    can: Literal["massless", "metal"] = "massless"
    """The can: massless (section 2 of the paper), or metal, of aluminium sheet 0.1 mm thick (section 3)."""

    def build_can(self) -> Can:
        """Return the can of these options."""
        make = Can.massless if self.can == "massless" else Can.sheet_metal
        return make(self.radius, self.length)


@dataclass(frozen=True)
class Sliding(Filled):
    """Beer that slides inside its can, without friction unless there is damping (sections 2 and 3 of the paper)."""

    density: float = BEER
    """Density of the beer [kg/m^3]."""
    damping: float = 0.0
    """Torque between can and beer over the rate at which the can turns faster than the beer [N m s]."""
    drag: float = 0.0
    """Force of the air against the motion over the square of the speed [kg/m]."""

    def at(self, alpha: float) -> Scene:
        return sliding(
            incline=alpha,
            fill=self.fill,
            can=self.build_can(),
            density=self.density,
            gravity=self.gravity,
            damping=self.damping,
            drag=self.drag,
        )


@dataclass(frozen=True)
class Liquid(Filled):
    """A real liquid, which is neither free nor frozen: its damping follows from its viscosity and the can."""

    liquid: Annotated[Name, one_of("liquid", NAMES)] = "water"
    """The liquid: water, beer, "olive oil", glycerol or honey, at 20 degrees Celsius."""
    density: Annotated[float | None, if_given(float, "the liquid's own")] = None
    """Density [kg/m^3]."""
    viscosity: Annotated[float | None, if_given(float, "the liquid's own")] = None
    """Kinematic viscosity [m^2/s]; water has 1e-6."""
    drag: float = 0.0
    """Force of the air against the motion over the square of the speed [kg/m]."""

    def at(self, alpha: float) -> Scene:
        return liquid(**self._given(alpha), drag=self.drag)

    def told(self, alpha: float) -> str:
        return str(liquid_in(**self._given(alpha)))

    def _given(self, alpha: float) -> dict[str, Any]:
        return {
            "name": self.liquid,
            "incline": alpha,
            "fill": self.fill,
            "can": self.build_can(),
            "density": self.density,
            "viscosity": self.viscosity,
            "gravity": self.gravity,
        }


@dataclass(frozen=True)
class Frozen(Filled):
    """Beer frozen to its can (appendix A of the paper)."""

    density: float = BEER
    """Density of the beer [kg/m^3]."""

    def at(self, alpha: float) -> Scene:
        return frozen(incline=alpha, fill=self.fill, can=self.build_can(), density=self.density, gravity=self.gravity)


@dataclass(frozen=True)
class Pendulum(Common):
    """A wheel with a pendulum on its axle (appendix B of the paper)."""

    wheel_mass: float = 0.2
    """Mass of the wheel [kg]."""
    load_mass: float = 0.1
    """Mass of the pendulum's bob [kg]."""
    offset: float = 0.025
    """Length of the pendulum, from the axle to the bob [m]."""

    def at(self, alpha: float) -> Scene:
        return pendulum(
            incline=alpha,
            wheel_mass=self.wheel_mass,
            load_mass=self.load_mass,
            offset=self.offset,
            radius=self.radius,
            length=self.length,
            gravity=self.gravity,
        )


@dataclass(frozen=True)
class Hoop(Common):
    """A hoop with a point load on its rim, which can hop (appendix A.4 of the paper)."""

    incline: float = 0.0
    """Angle of the incline to the horizontal [degrees]; if positive, u grows downhill."""
    hoop_mass: float = 0.01
    """Mass of the hoop [kg]."""
    load_mass: float = 0.2
    """Mass of the load [kg]."""

    def at(self, alpha: float) -> Scene:
        return hoop(
            incline=alpha,
            hoop_mass=self.hoop_mass,
            load_mass=self.load_mass,
            radius=self.radius,
            length=self.length,
            gravity=self.gravity,
        )


AnyScene = Sliding | Liquid | Frozen | Pendulum | Hoop
SCENES: dict[str, type[Common]] = {scene.__name__.lower(): scene for scene in get_args(AnyScene)}
"""The classes of the scenes, by the names that they have on the command line."""


@dataclass(frozen=True)
class Start:
    """The options of a motion's start: the scene and its initial state."""

    scene: AnyScene
    _: KW_ONLY
    phi0: float = round(math.degrees(PHI0), 9)
    """Initial phi, the angle of the load [degrees]: 0 where its centre of mass is nearest to the incline, 180 where it
    is farthest, and growing as the load turns with a can that rolls downhill."""
    phi_dot0: float = 0.0
    """Initial rate of change of phi [degrees/s]."""

    @property
    def state(self) -> dict[str, Any]:
        """The initial phi0 [rad] and phi_dot0 [rad/s]."""
        return {
            "phi0": degrees("phi0", self.phi0),
            "phi_dot0": radians("phi_dot0", self.phi_dot0, "degrees/s"),
        }


@dataclass(frozen=True)
class Motion(Start):
    """The options of a simulation: the scene, the start of its motion, and how it is integrated."""

    duration: float = DURATION
    """Duration of the motion [s]."""
    rolling: Rolling = "reduced"
    """What makes the can roll: reduced coordinates, a joint equality, or contact with friction."""
    integrator: Annotated[Integrator | None, if_given(Integrator, "RK4, or what keeps a tolerance")] = None
    """Integrator: one of MuJoCo's, by its name in MJCF, DOP853 (Runge-Kutta, order 8) or GaussJackson (multistep)."""
    timestep: float = 1e-3
    """Timestep; if a tolerance is given, the interval between samples [s]."""
    tolerance: Annotated[float | None, if_given(float, "none")] = None
    """Largest error allowed in phi and u/radius [rad]. If given, the integrator and its timesteps are chosen for it."""
    friction: float = 1.0
    """Coefficient of friction. A contact slips beyond it; other ways of rolling only say when a real can would."""

    def simulate(self) -> "Trajectory":
        """Simulate the scene and return its trajectory.

        Raises:
          MjbeerError: if an option is not allowed, or the simulation fails.
        """
        from mjbeer.simulation.simulate import simulate

        return simulate(
            self.scene.told_scene(),
            self.duration,
            **self.state,
            rolling=self.rolling,
            integrator=self.integrator,
            timestep=self.timestep,
            tolerance=self.tolerance,
            friction=self.friction,
        )
