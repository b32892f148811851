"""The scene: can, load, incline, gravity, and how the load is attached and damped; and the scenes that have a name."""

import dataclasses
import functools
import inspect
import math
from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from typing import Any, Literal, ParamSpec, get_args

import numpy as np

from mjbeer import require
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError, warn_of_liquid
from mjbeer.theory import motion, steady
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.liquid import LIQUIDS, NAMES, Damping, Liquid, about_scene, liquid_law
from mjbeer.theory.load import BEER, Load
from mjbeer.theory.oscillator import Oscillator

Parameters = ParamSpec("Parameters")
Attachment = Literal["sliding", "frozen"]
ATTACHMENTS: tuple[Attachment, ...] = get_args(Attachment)
"""The ways in which a load can be attached; see `Scene.attachment`."""
INCLINE = math.radians(10)
"""Default incline [rad]: 10 degrees, as in the paper's footnote 8."""
DURATION = 2.0
"""Default duration of a motion [s]."""
PHI0 = math.radians(60)
"""Default angle at its start [rad]."""
GRAVITY = 9.81
"""Default acceleration of gravity [m/s^2]; the paper's footnote 8 has 9.8."""
_LEAST_OFFSET = 1e-14
"""Smallest offset of a load that is not balanced, over the radius: less than with a billionth of the height empty."""
_LEAST_RATE = 1e-12
"""Smallest rate of damping that is not 0 [1/s]: nobody lives to see it brake."""
_views: list[Callable[[], Any]] = []


def register_views(load: Callable[[], Any]) -> None:
    """Register what returns the module that draws scenes and trajectories: theory knows no pictures."""
    _views[:] = [load]


def views() -> Any:
    """Return the module that was registered."""
    return _views[0]()


@dataclass(frozen=True, repr=False)
class Scene:
    """A can with a load on an incline.

    Raises:
      ParameterError: if a parameter is outside the domain, the load outside the can, a frozen load damped, or nothing
        has inertia at phi = 0.
    """

    can: Can
    load: Load
    incline: float = INCLINE
    """Angle alpha of the incline to the horizontal [rad]; if positive, u grows downhill."""
    attachment: Attachment = "sliding"
    """"sliding": the load slides about the axis, without friction unless there is `damping`; "frozen": it is rigidly
    attached."""
    gravity: float = GRAVITY
    """Acceleration of gravity g [m/s^2]."""
    damping: float | Damping = 0.0
    """Torque between can and load per slip rate roll_dot - phi_dot, c [N m s], or a `Damping` whose torque does not
    grow in proportion. Only a sliding load has it."""
    drag: float = 0.0
    """Force of the air against the motion of the axis, over the square of its speed, C_d rho A / 2 [kg/m]. Only a scene
    with a sliding load has it."""
    damping_law: Damping = field(init=False, compare=False)
    """The torque between can and load as a `Damping`, also where it was given as a number."""
    oscillator: Oscillator = field(init=False, compare=False)
    """The scene without damping and drag as one degree of freedom, phi; it follows from the other fields."""
    made_by: tuple[Callable[..., "Scene"], dict[str, Any]] | None = field(default=None, init=False, compare=False)
    """The function that made the scene, as `mjbeer.sliding`, and the arguments that it was given; None if none did."""

    def __post_init__(self) -> None:
        can, load = require.instance("can", self.can, Can), require.instance("load", self.load, Load)
        incline = require.number("incline", self.incline, "rad")
        if not abs(incline) < math.pi / 2:
            raise ParameterError(
                f"incline must be between -pi/2 and pi/2 [rad] (90 degrees), got {require.shown(self.incline)}"
            )
        require.choice("attachment", self.attachment, ATTACHMENTS)
        damping = self.damping
        if not isinstance(damping, Damping):
            damping = require.non_negative("damping", damping, "N m s")
        require.store(
            self,
            incline=incline,
            gravity=require.within("gravity", self.gravity, *require.GRAVITY, "m/s^2", zero=True),
            drag=require.non_negative("drag", self.drag, "kg/m"),
            damping=damping,
            damping_law=damping if isinstance(damping, Damping) else Damping(damping),
        )
        if self.dissipates and self.attachment == "frozen":
            raise ParameterError(
                f"a frozen load moves as one with its can, which leaves nothing to damp: damping and drag must be 0, "
                f"got damping={require.shown(damping)} and drag={require.shown(self.drag)}"
            )
        self._check_masses()
        reduced = Oscillator.sliding if self.attachment == "sliding" else Oscillator.frozen
        require.store(self, oscillator=reduced(can=can, load=load, incline=self.incline, gravity=self.gravity))
        if not self.oscillator.base > float(self.oscillator.inertia(math.pi / 2)) / (2 * require.RATIO):
            raise ParameterError(
                "next to nothing resists rotation at phi = 0: a point load needs an offset and a can with mass "
                f"(attachment {self.attachment!r}, load inertia {load.inertia!r} kg m^2, load offset "
                f"{load.offset!r} m, can mass {can.mass!r} kg)"
            )
        if self.dissipates:
            self._check_rates()

    def _check_masses(self) -> None:
        """Check that the load is inside the can, and that masses and inertias are of comparable sizes."""
        can, load, largest = self.can, self.load, require.RATIO * (1 + 1e-12)  # a ratio of 1e6 may round up
        with require.from_given(**{"radius of the can": can.radius}):
            require.within("load offset", load.offset, _LEAST_OFFSET * can.radius, can.radius, "m", zero=True)
        with require.from_given(**{"can mass": can.mass, "load mass": load.mass}):
            ratio = can.mass / load.mass
            require.within("mass of the can over that of the load", ratio, 1 / largest, largest, zero=True)
        with require.from_given(**{"load mass": load.mass, "radius of the can": can.radius}):
            require.within("load inertia", load.inertia, 0, largest * load.mass * can.radius**2, "kg m^2")

    def _check_rates(self) -> None:
        """Check how fast damping and drag brake where the load resists least, phi = pi, at a slip rate of 1 rad/s."""
        a, total, moment = self.can.radius, self.effective_mass, self.load.moment
        slipping = (self.load.axis_inertia / a**2 + 2 * moment / a + total) / (total * self.oscillator.base)
        limits = _LEAST_RATE, require.DAMPING_RATE
        with require.from_given(damping=self.damping):
            rate = float(self.damping_law.slope(1.0)) * slipping
            require.within("rate of damping", rate, *limits, "1/s", zero=True)
        with require.from_given(drag=self.drag):
            require.within("rate of drag", 2 * self.drag * a / total, *limits, "1/s", zero=True)

    def __repr__(self) -> str:
        """Return the call that makes the scene, without what it would have anyway."""
        parameters = {
            each.name: (getattr(self, each.name), each.default) for each in dataclasses.fields(self) if each.init
        }
        name = type(self).__name__
        if self.made_by is not None:
            make, given = self.made_by
            defaults, name = inspect.signature(make).parameters, getattr(make, "__name__", name)
            parameters = {each: (value, defaults[each].default) for each, value in given.items()}
        plain = {each: getattr(value, "item", lambda value=value: value)() for each, (value, _) in parameters.items()}
        told = (f"{each}={value!r}" for each, value in plain.items() if value != parameters[each][1])
        return f"{name}({', '.join(told)})"

    def _repr_html_(self) -> str:
        """Return the parameters of the scene as a table, for a notebook."""
        return views().scene_html(self)

    def replace(self, **changes: Any) -> "Scene":
        """Return the scene with some of its fields changed, or of the arguments of the function that made it.

        `sliding().replace(fill=0.4)` is `sliding(fill=0.4)`: the load is made anew, and so is a liquid's damping.

        Raises:
          ParameterError: if nothing has such a name, or a value is not allowed.
        """
        make, given = self.made_by or (type(self), {})
        own = inspect.signature(make).parameters if self.made_by else {}
        names = dict.fromkeys((*own, *(each.name for each in dataclasses.fields(self) if each.init)))
        for name in changes:
            require.choice("what is replaced in a scene", name, names)
        again = {name: value for name, value in changes.items() if name in own}
        others = {name: value for name, value in changes.items() if name not in own}
        scene = make(**given | again) if again else self
        return dataclasses.replace(scene, **others) if others else scene

    @property
    def dissipates(self) -> bool:
        """Return whether damping or drag takes energy from the motion."""
        return bool(self.damping_law) or self.drag > 0

    @property
    def mass(self) -> float:
        """Return the mass of can and load together, m_t [kg]."""
        return self.can.mass + self.load.mass

    @property
    def effective_mass(self) -> float:
        """Return the mass against a force along the incline when the can rolls, M = m + m_can + I_can/a^2 [kg]."""
        return self.load.mass + self.can.effective_mass

    @property
    def drive(self) -> float:
        """Return the weight along the incline, m_t g sin(alpha) [N]."""
        return self.mass * self.gravity * math.sin(self.incline)

    @property
    def centre_of_mass(self) -> float:
        """Return the distance of their common centre of mass from the axis, d = m b/(m + m_can) [m]: eq. (38)."""
        return self.load.moment / self.mass

    def equilibrium(self) -> float:
        """Return the angle phi of stable equilibrium [rad]: eq. (53) for a frozen load, with the can's mass included.

        For a sliding load it is the angle at which the can accelerates steadily, tan phi =
        (A - g sin(alpha)) / (g cos(alpha)) with A of footnote 4. With damping or drag it is `terminal_tilt`.

        Raises:
          NoEquilibriumError: if there is none; the message names the largest incline that has one.
        """
        if self.dissipates:
            return self.terminal_tilt()
        try:
            return self.oscillator.equilibrium()
        except NoEquilibriumError as error:
            if self.oscillator.depth == 0:
                raise
            raise NoEquilibriumError(
                f"no equilibrium at an incline of {math.degrees(self.incline):.4g} degrees: a frozen load holds the "
                f"can only up to {math.degrees(self.largest_incline()):.1f} degrees, where sin(alpha) = m b / "
                "((m + m_can) a)"
            ) from error

    def largest_incline(self) -> float:
        """Return the largest incline with an equilibrium [rad]: the text below eq. (53); pi/2 for a sliding load.

        With damping it is that with steady rolling: that of a frozen load, which drag makes larger.
        """
        if self.dissipates:
            return steady.largest_incline(self)
        if self.attachment == "sliding":
            return math.pi / 2
        return math.asin(self.load.moment / (self.mass * self.can.radius))  # in this order no more than 1

    def frequency(self) -> float:
        """Return the angular frequency of small swings about the equilibrium [rad/s]: eq. (10), eq. (55) corrected.

        With damping or drag it is the imaginary part of the swing's `modes`, whose real part is the decay.

        Raises:
          NoEquilibriumError: if there is no equilibrium.
          NoLibrationError: if the damping is such that the load creeps back without a swing.
        """
        if self.dissipates:
            roots = self.modes()
            if not (fastest := float(roots.imag.max())) > 0:
                decays = ", ".join(f"{root:.4g}" for root in roots.real)
                raise NoLibrationError(f"no frequency: the load creeps back without a swing, with rates {decays} 1/s")
            return fastest
        self.equilibrium()
        return self.oscillator.frequency()

    def period(self, amplitude: float) -> float:
        """Return the period [s] of the swing released from rest `amplitude` [rad] away from the equilibrium.

        Raises:
          NoEquilibriumError: if there is no equilibrium.
          NoLibrationError: if `amplitude` is at or beyond the separatrix, or within the rounding of it.
          ToleranceError: if sizes, masses and gravity are of too many different orders of magnitude.
          DissipationError: if the scene has damping or drag, so that no swing is like the one before.
        """
        amplitude = require.number("amplitude", amplitude, "rad")
        steady.require_no_dissipation(self, "no period")
        self.equilibrium()
        return motion.period(self.oscillator, amplitude)

    def separatrix(self) -> tuple[float, float]:
        """Return the two angles phi between which the largest swing about the equilibrium stays [rad].

        Raises:
          NoEquilibriumError: if there is no equilibrium.
          DissipationError: if the scene has damping or drag, so that no swing lasts.
        """
        steady.require_no_dissipation(self, "no largest swing")
        self.equilibrium()
        return self.oscillator.separatrix()

    def terminal_speed(self) -> float:
        """Return the speed of the axis down the incline [m/s] at which a can with damping or drag rolls steadily.

        Its load then stands still at `terminal_tilt`. With linear damping alone it is m_t g sin(alpha) a^2/c.

        Raises:
          DissipationError: if the scene has neither damping nor drag.
          NoEquilibriumError: if there is no steady rolling; above the largest incline the message names that.
        """
        return steady.steady_rolling(self).speed

    def terminal_tilt(self) -> float:
        """Return the angle phi [rad] at which the load of a can with damping or drag stands still, once it does.

        Without drag it is that of eq. (53) with the can's mass included, whatever the damping.

        Raises:
          DissipationError: if the scene has neither damping nor drag.
          NoEquilibriumError: if there is no steady rolling; above the largest incline the message names that.
        """
        return steady.steady_rolling(self).tilt

    def modes(self) -> np.ndarray:
        """Return the roots s [1/s] of the three modes exp(s t) of small motions about steady rolling.

        They are complex, of shape (3,), and sorted by their real parts: what decays fastest is first. Damping and drag
        that are not linear count with their slopes at the terminal speed.

        Raises:
          DissipationError: if the scene has neither damping nor drag.
          NoEquilibriumError: if there is no steady rolling.
          ParameterError: if the roots are beyond double precision.
        """
        return steady.modes(self)

    def slip_rate(self) -> float:
        """Return the mean slip rate of can and load, D = m_t g a sin(alpha)/c [rad/s], of any motion that is steady.

        The load may stand still, or loop with a rate that is periodic in phi; then the variance of the slip rate is D
        times the load's mean rate.

        Raises:
          DissipationError: if the damping is not linear, or there is none, or there is drag.
        """
        return steady.slip_rate(self)

    def start(self, phi0: float, phi_dot0: float) -> tuple[float, float]:
        """Return u [m] and u_dot [m/s] of the axis for a start at `phi0` [rad] with `phi_dot0` [rad/s].

        A sliding load starts with s = 0 and s_dot = 0 (eq. 12), a frozen one without slip from u = a phi (eq. 50).

        Raises:
          ParameterError: if the start is not allowed, as in `exact`.
        """
        phi0, phi_dot0 = require.start(phi0, phi_dot0)
        if self.attachment == "frozen":
            return self.can.radius * phi0, self.can.radius * phi_dot0
        return self.load.offset * math.sin(phi0), self.load.offset * math.cos(phi0) * phi_dot0

    def acceleration(self) -> float:
        """Return the acceleration of the axis down the incline [m/s^2] when it is steady: footnote 4, or eq. (1).

        A frozen load has none; returned is that of a load that is balanced with the same inertia about the axis,
        (2/3) g sin(alpha) for half a massless can of beer (A.3). In the long run the unbalanced one rolls down faster,
        by the factor mean(J) / mean(sqrt(J))^2. With damping or drag the speed is bounded and the acceleration 0, but
        for a balanced load without drag, which ends as a frozen one.
        """
        if self.dissipates and (self.load.offset > 0 or self.drag > 0):
            return 0.0
        if self.attachment == "sliding" and not self.dissipates:
            return self.drive / self.effective_mass
        return self.drive / (self.effective_mass + self.load.axis_inertia / self.can.radius**2)


def _named(make: Callable[Parameters, Scene]) -> Callable[Parameters, Scene]:
    """Return a function that makes a scene, and has it remember by which arguments."""
    signature = inspect.signature(make)

    @functools.wraps(make)
    def named(*arguments: Parameters.args, **named_arguments: Parameters.kwargs) -> Scene:
        scene = make(*arguments, **named_arguments)
        require.store(scene, made_by=(named, signature.bind(*arguments, **named_arguments).arguments))
        return scene

    return named


@_named
def sliding(
    incline: float = INCLINE,
    fill: float = 0.5,
    can: Can | None = None,
    density: float = BEER,
    gravity: float = GRAVITY,
    damping: float | Damping = 0.0,
    drag: float = 0.0,
) -> Scene:
    """Return the scene of beer that slides in a can: sections 2 (massless can, the default) and 3 of the paper.

    `incline` is in [rad], `fill` is h/2a of eq. (32), and `density` is the beer's [kg/m^3]. The beer slides without
    friction unless `damping` [N m s] is given; `drag` [kg/m] is that of the air. Both are fields of `Scene`.

    Raises:
      ParameterError: as `Scene`.
    """
    can, load = _of_beer(can, fill, density)
    return Scene(can, load, incline, "sliding", gravity, damping, drag)


@_named
def frozen(
    incline: float = INCLINE, fill: float = 0.5, can: Can | None = None, density: float = BEER, gravity: float = GRAVITY
) -> Scene:
    """Return the scene of beer frozen to the can: appendix A (massless can, the default).

    `incline` is in [rad], `fill` is h/2a of eq. (32), and `density` is the beer's [kg/m^3].

    Raises:
      ParameterError: as `Scene`.
    """
    can, load = _of_beer(can, fill, density)
    return Scene(can, load, incline, "frozen", gravity)


@_named
def pendulum(
    incline: float = INCLINE,
    wheel_mass: float = 0.2,
    load_mass: float = 0.1,
    offset: float = 0.025,
    radius: float = RADIUS,
    length: float = LENGTH,
    gravity: float = GRAVITY,
) -> Scene:
    """Return the scene of a hoop wheel with a simple pendulum on its axle: appendix B.

    `incline` is in [rad]; `wheel_mass` and `load_mass` are M and m [kg], and `offset` is the pendulum's length b [m].
    The paper gives no numbers: the defaults are a wheel of the can's size and a bob of half its mass.

    Raises:
      ParameterError: as `Scene`.
    """
    return Scene(Can.hoop(radius, length, wheel_mass), Load.point(load_mass, offset), incline, "sliding", gravity)


@_named
def hoop(
    incline: float = 0.0,
    hoop_mass: float = 0.01,
    load_mass: float = 0.2,
    radius: float = RADIUS,
    length: float = LENGTH,
    gravity: float = GRAVITY,
) -> Scene:
    """Return the scene of a hoop with a point load on its rim, the hopping hoop: appendix A.4.

    `incline` is in [rad]; `hoop_mass` and `load_mass` are M and m [kg]. The default M/m = 1/20 is light enough to hop,
    for which M/m must be below 1/13.

    Raises:
      ParameterError: as `Scene`.
    """
    return Scene(Can.hoop(radius, length, hoop_mass), Load.point(load_mass, radius), incline, "frozen", gravity)


@_named
def liquid(
    name: str = "water",
    incline: float = INCLINE,
    fill: float = 0.5,
    can: Can | None = None,
    density: float | None = None,
    viscosity: float | None = None,
    gravity: float = GRAVITY,
    drag: float = 0.0,
) -> Scene:
    """Return the scene of a can with a real liquid in it, whose damping follows from viscosity and geometry.

    `name` is "water", "beer", "olive oil", "glycerol" or "honey", at 20 degrees Celsius; `density` [kg/m^3] and
    kinematic `viscosity` [m^2/s] replace its own. `incline` is in [rad], `fill` is h/2a of eq. (32), less than 1;
    `drag` [kg/m] is that of the air. `liquid_in` tells what was used; the laws are those of the module `liquid`.

    A `LiquidWarning` says where the damping is an order of magnitude only: where the liquid is no lump at the terminal
    speed, as its film on the wall can hold a third of it or the wall's centrifugal acceleration exceeds g cos(alpha),
    and where that speed is beyond the slip rates for which the damping is.

    Raises:
      ParameterError: if a parameter is not allowed, the can is full, or the layers would be turbulent.
    """
    used = liquid_in(name, incline, fill, can, density, viscosity, gravity)
    with require.from_given(viscosity=used.viscosity):
        scene = sliding(incline, fill, can, used.density, gravity, used.damping, drag)
    try:
        reason = about_scene(used, scene.terminal_speed(), scene)
    except NoEquilibriumError:  # no terminal speed on so steep an incline
        reason = about_scene(used, 0.0, scene)
    if reason is not None:
        warn_of_liquid(reason, stacklevel=3)
    return scene


def liquid_in(
    name: str = "water",
    incline: float = INCLINE,
    fill: float = 0.5,
    can: Can | None = None,
    density: float | None = None,
    viscosity: float | None = None,
    gravity: float = GRAVITY,
) -> Liquid:
    """Return what `liquid` uses for the same arguments: density, viscosity, law and damping.

    Raises:
      ParameterError: as `liquid`.
    """
    own = LIQUIDS[require.choice("liquid", name, NAMES)]
    density = own.density if density is None else require.positive("density", density, "kg/m^3")
    viscosity = own.viscosity if viscosity is None else require.positive("viscosity", viscosity, "m^2/s")
    return liquid_law(name, viscosity, density, sliding(incline, fill, can, density, gravity))


def _of_beer(can: Can | None, fill: float, density: float) -> tuple[Can, Load]:
    can = Can.massless() if can is None else require.instance("can", can, Can)
    return can, Load.segment(can.radius, can.length, fill=fill, density=density)


_FILLS = {0.25: "quarter-full", 0.5: "half-full", 0.75: "three-quarters-full", 1.0: "full"}


def in_words(scene: Scene, varied: Collection[str] = ()) -> str:
    """Return what a scene is, as "half-full massless can, beer frozen, incline 10°".

    `varied` names what differs between the scenes of a plot and is therefore left out: "fill", "can" (its mass),
    "load" (how it is attached, or the masses of a hoop or a pendulum), "incline", "damping" (and the drag).
    """
    can, load = scene.can, scene.load
    if load.inertia > 0:
        full = "" if load.fill is None or "fill" in varied else _FILLS.get(load.fill, f"{100 * load.fill:.3g} % full")
        kind = "can" if "can" in varied else "massless can" if can.mass == 0 else f"can of {1e3 * can.mass:.3g} g"
        parts = [f"{full} {kind}".strip()]
        parts.append("" if "load" in varied else f"{'load' if load.fill is None else 'beer'} {scene.attachment}")
        parts.append(f"its centre of mass {1e3 * load.offset:.3g} mm from the axis" if load.fill is None else "")
    else:  # a load without size: a pendulum's bob or a weight on a hoop
        body = "wheel with a pendulum" if scene.attachment == "sliding" else "hoop with a weight on its rim"
        parts = [body, "" if "load" in varied else f"M = {1e3 * can.mass:.3g} g, m = {1e3 * load.mass:.3g} g"]
    if scene.dissipates and "damping" not in varied:
        law = scene.damping_law
        parts.append("" if not law else f"damping {law.linear:.3g} N m s" if law == Damping(law.linear) else "damped")
        parts.append(f"drag {scene.drag:.3g} kg/m" if scene.drag else "")
    if "incline" not in varied:
        parts.append(f"incline {in_degrees(scene.incline)}" if scene.incline else "level ground")
    return ", ".join(part for part in parts if part)


def in_degrees(angle: float) -> str:
    """Return an angle [rad] in degrees with their sign, to a tenth of a degree."""
    return f"{round(math.degrees(angle), 1):g}°".replace("-", "\N{MINUS SIGN}")


def damping_in_words(scene: Scene) -> str:
    """Return the torque between can and load over their slip rate w, as "0.001 N m s"; "0" if there is none."""
    units = ("N m s", "N m s^2 |w|", "N m s^3 w^2")
    shares = zip(scene.damping_law.coefficients, units, strict=True)
    return " + ".join(f"{share:.4g} {unit}" for share, unit in shares if share) or "0"
