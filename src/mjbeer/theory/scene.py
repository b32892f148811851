"""The scene: can, load, incline, gravity, and how the load is attached and damped."""

import functools
import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any, Literal, ParamSpec, get_args

import numpy as np

from mjbeer import require
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError
from mjbeer.theory import motion
from mjbeer.theory.can import BEER, LENGTH, RADIUS, Can, Damping, Load
from mjbeer.theory.oscillator import Oscillator

Parameters = ParamSpec("Parameters")
Attachment = Literal["sliding", "frozen"]
ATTACHMENTS: tuple[Attachment, ...] = get_args(Attachment)
# What scenes and motions have unless told otherwise.
INCLINE = math.radians(10)  # [rad], as in the paper's footnote 8
DURATION = 2.0  # [s]
PHI0 = math.radians(60)  # at the start [rad]
GRAVITY = 9.81  # [m/s^2]; the paper's footnote 8 has 9.8


@dataclass(frozen=True, repr=False)
class Scene:
    """A can with a load on an incline.

    Raises:
      ParameterError: if a parameter is outside the domain, the load outside the can, a frozen load damped, or nothing
        has inertia at phi = 0; and by what has a meaning only with damping or drag, or only without them.
      NoEquilibriumError: by what needs a load at rest, if the incline is too steep or nothing restores the load.
    """

    can: Can
    load: Load
    incline: float = INCLINE
    """Angle alpha of the incline to the horizontal [rad]; if positive, u grows downhill."""
    attachment: Attachment = "sliding"
    """"sliding": the load slides about the axis, with no friction but `damping`; "frozen": it turns with the can."""
    gravity: float = GRAVITY
    """Acceleration of gravity g [m/s^2]."""
    damping: float | Damping = 0.0
    """Torque between a sliding load and the can per slip rate roll_dot - phi_dot, c [N m s], or a `Damping` whose
    torque does not grow in proportion."""
    drag: float = 0.0
    """Force of the air on the axis over the square of its speed, C_d rho A / 2 [kg/m]; for a sliding load only."""
    made_by: tuple[Callable[..., "Scene"], dict[str, Any]] | None = field(default=None, init=False, compare=False)
    """The function that made the scene, as `mjbeer.sliding`, and the arguments that it was given; None if none did."""

    def __post_init__(self) -> None:
        can, load = require.instance("can", self.can, Can), require.instance("load", self.load, Load)
        require.choice("attachment", self.attachment, ATTACHMENTS)
        damped = isinstance(self.damping, Damping)
        vars(self).update(
            incline=require.within("incline", self.incline, *require.INCLINE, "rad"),
            gravity=require.within("gravity", self.gravity, *require.GRAVITY, "m/s^2", zero=True),
            drag=require.non_negative("drag", self.drag, "kg/m"),
            damping=self.damping if damped else require.non_negative("damping", self.damping, "N m s"),
        )
        if self.dissipates and self.attachment == "frozen":
            got = f"damping={require.format_value(self.damping)} and drag={require.format_value(self.drag)}"
            raise ParameterError(f"a frozen load moves as one with its can: damping and drag must be 0, got {got}")
        a, most = can.radius, require.RATIO * (1 + 1e-12)  # a ratio of 1e4 may round up
        # A smaller offset is that of a can that lacks less than a billionth of its height to be full.
        require.within("load offset", load.offset, 1e-14 * a, a, "m", zero=True)
        require.within("mass of the can over that of the load", can.mass / load.mass, 1 / most, most, zero=True)
        require.within("load inertia", load.inertia, 0, most * load.mass * a**2, "kg m^2")
        if not self.oscillator.base > float(self.oscillator.inertia(math.pi / 2)) / (2 * require.RATIO):
            raise ParameterError(
                "next to nothing resists rotation at phi = 0: a point load needs an offset and a can with mass, got "
                f"{load!r} and {can!r}"
            )
        if self.dissipates:  # how fast damping and drag brake where the load resists least, phi = pi, at 1 rad/s
            limits = 1e-12, 1e9  # a slower decay cannot be observed
            rate = float(relaxation_rate(self, math.pi, 1.0))
            require.within("rate of damping", rate, *limits, "1/s", zero=True)
            require.within("rate of drag", 2 * self.drag * a / self.effective_mass, *limits, "1/s", zero=True)

    def __repr__(self) -> str:
        """Return the call that makes the scene, without arguments that it has by default."""
        own = {each.name: getattr(self, each.name) for each in fields(self) if each.init}
        make, given = self.made_by or (type(self), own)
        usual = inspect.signature(make).parameters
        plain = {name: each.item() if isinstance(each, np.generic) else each for name, each in given.items()}
        arguments = (f"{name}={value!r}" for name, value in plain.items() if value != usual[name].default)
        return f"{getattr(make, '__name__', '')}({', '.join(arguments)})"

    @cached_property
    def damping_law(self) -> Damping:
        """Return the torque between can and load as a `Damping`, also where it was given as a number."""
        return self.damping if isinstance(self.damping, Damping) else Damping(self.damping)

    @cached_property
    def oscillator(self) -> Oscillator:
        """Return the scene without damping and drag as one degree of freedom, phi."""
        if self.attachment == "frozen":
            return self.frozen
        return Oscillator.sliding(self.can, self.load, self.incline, self.gravity)

    @cached_property
    def frozen(self) -> Oscillator:
        """Return the oscillator of a frozen load: its J is J_f, against which can and load turn as one."""
        return Oscillator.frozen(self.can, self.load, self.incline, self.gravity)

    @cached_property
    def dissipates(self) -> bool:
        """Return whether damping or drag takes energy from the motion."""
        return bool(self.damping_law) or self.drag > 0

    @cached_property
    def mass(self) -> float:
        """Return the mass of can and load together, m_t [kg]."""
        return self.can.mass + self.load.mass

    @cached_property
    def effective_mass(self) -> float:
        """Return the mass against a force along the incline when the can rolls, M = m + m_can + I_can/a^2 [kg]."""
        return self.load.mass + self.can.effective_mass

    @cached_property
    def downhill_weight(self) -> float:
        """Return the weight along the incline, m_t g sin(alpha) [N]."""
        return self.mass * self.gravity * math.sin(self.incline)

    def start(self, phi0: float, phi_dot0: float) -> tuple[float, float]:
        """Return u [m] and u_dot [m/s] of the axis for a start at `phi0` [rad] with `phi_dot0` [rad/s].

        A sliding load starts with s = 0 and s_dot = 0 (eq. 12), a frozen one with u = a phi (eq. 50).
        """
        phi0, phi_dot0 = require.start(phi0, phi_dot0)
        if self.attachment == "frozen":
            return self.can.radius * phi0, self.can.radius * phi_dot0
        return self.load.offset * math.sin(phi0), self.load.offset * math.cos(phi0) * phi_dot0

    def equilibrium(self) -> float:
        """Return the angle phi of stable equilibrium [rad]: eq. (53) for a frozen load, with the can's mass included.

        For a sliding load it is the angle at which the can accelerates steadily, tan phi =
        (A - g sin(alpha)) / (g cos(alpha)) with A of footnote 4. With damping or drag it is `terminal_tilt`.
        """
        if self.dissipates:
            return self.terminal_tilt()
        if abs(self.oscillator.ramp) > self.oscillator.depth > 0:
            raise self._too_steep()
        return self.oscillator.equilibrium()

    def largest_incline(self) -> float:
        """Return the largest incline with an equilibrium [rad]: the text below eq. (53); pi/2 for a sliding load.

        With damping it is that with steady rolling: that of a frozen load, which drag makes larger.
        """
        if self.attachment == "sliding" and not self.dissipates:
            return math.pi / 2
        sine = self.load.moment / (self.mass * self.can.radius)  # in this order no more than 1
        if self.drag > 0 and self.gravity > 0:
            speed = self.can.radius * self.damping_law.slip_rate(self.load.moment * self.gravity)
            sine += self.drag * speed**2 / (self.mass * self.gravity)
        return math.asin(min(sine, 1.0))

    def _too_steep(self) -> NoEquilibriumError:
        incline, most = math.degrees(self.incline), math.degrees(self.largest_incline())
        at = f"no equilibrium at an incline of {incline:.4g} degrees"
        return NoEquilibriumError(f"{at}: the load can hold the can only up to {most:.1f} degrees")

    def frequency(self) -> float:
        """Return the angular frequency of small swings about the equilibrium [rad/s]: eq. (10), eq. (55) corrected.

        With damping or drag it is the imaginary part of the swing's `modes`, whose real part is the decay.

        Raises:
          NoLibrationError: if the damping is such that the load creeps back without a swing.
        """
        if not self.dissipates:
            self.equilibrium()
            return self.oscillator.frequency()
        if not (fastest := float(self.modes().imag.max())) > 0:
            raise NoLibrationError("no frequency: the load creeps back without a swing; scene.modes() has the rates")
        return fastest

    def period(self, amplitude: float) -> float:
        """Return the period [s] of the swing released from rest `amplitude` [rad] away from the equilibrium.

        Raises:
          NoLibrationError: if `amplitude` is at or beyond the separatrix, or within the rounding of it.
          ToleranceError: if sizes, masses and gravity are of too many different orders of magnitude.
        """
        amplitude = require.number("amplitude", amplitude, "rad")
        self._require_swing("no period")
        return motion.period(self.oscillator, amplitude)

    def separatrix(self) -> tuple[float, float]:
        """Return the two angles phi between which the largest swing about the equilibrium stays [rad]."""
        self._require_swing("no largest swing")
        return self.oscillator.separatrix()

    def _require_swing(self, missing: str) -> None:
        """Check that the load has an equilibrium to swing about for ever."""
        if self.dissipates:
            raise ParameterError(
                f"{missing}: each swing of a load with damping or drag is smaller than the one before, got "
                f"damping={self.damping!r} and drag={self.drag!r}; scene.modes() has the rates"
            )
        self.equilibrium()

    def _steady_rolling(self) -> tuple[float, float, float]:
        """Return slip rate [rad/s], torque T on the load [N m] and stiffness k [N m] of steady rolling.

        Nothing accelerates where T(w)/a + drag u_dot |u_dot| = m_t g sin(alpha), with w = u_dot/a, and
        m g b sin(alpha + phi) = T(w). Without drag T is m_t g a sin(alpha), whatever the law.
        """
        if not self.dissipates:
            raise ParameterError("no steady rolling: damping and drag are 0, and nothing else brakes the can")
        self.oscillator.equilibrium()  # whether anything restores the load
        radius, weight = self.can.radius, self.load.moment * self.gravity
        torque, (linear, quadratic, cubic) = self.downhill_weight * radius, self.damping_law.coefficients
        slip = Damping(linear, quadratic + self.drag * radius**3, cubic).slip_rate(torque)
        if self.drag > 0:
            torque = float(self.damping_law.torque(slip))
        if abs(torque) > weight:
            raise self._too_steep()
        return slip, torque, math.sqrt(weight - abs(torque)) * math.sqrt(weight + abs(torque))

    def terminal_speed(self) -> float:
        """Return the speed of the axis down the incline [m/s] at which a can with damping or drag rolls steadily.

        Its load then stands still at `terminal_tilt`. Linear damping alone gives m_t g sin(alpha) a^2/c.
        """
        return self.can.radius * self._steady_rolling()[0]

    def terminal_tilt(self) -> float:
        """Return the angle phi [rad] at which the load of a can with damping or drag stands still, once it does.

        Without drag it is that of eq. (53) with the can's mass included, whatever the damping.
        """
        _, torque, stiffness = self._steady_rolling()
        return math.atan2(torque, stiffness) - self.incline

    def modes(self) -> np.ndarray:
        """Return the complex roots s [1/s] of the three modes exp(s t) of small motions about steady rolling, (3,).

        What decays fastest is first. With P = m b cos(phi), k = m g b cos(alpha + phi), N = M I - P^2 and J_f = M a^2 +
        I - 2 P a at the terminal tilt, and the slopes c of the damping and d of the drag at the terminal speed,

            N s^3 + (c J_f/a^2 + d I) s^2 + (M k + c d) s + k (c/a^2 + d) = 0.

        Raises:
          ParameterError, NoEquilibriumError: as `terminal_speed`.
        """
        (slip, _, k), tilt, a, mass = self._steady_rolling(), self.terminal_tilt(), self.can.radius, self.effective_mass
        damping, drag = float(self.damping_law.derivative(slip)) / a**2, 2 * self.drag * a * abs(slip)
        cubic = mass * float(self.oscillator.inertia(tilt))
        square = damping * float(self.frozen.inertia(tilt)) + drag * self.load.axis_inertia
        return np.sort_complex(np.roots([cubic, square, mass * k + damping * a**2 * drag, k * (damping + drag)]))

    def slip_rate(self) -> float:
        """Return the mean slip rate of can and load [rad/s] with linear damping: m_t g a sin(alpha)/c, in any motion.

        The motion must be steady, be it that the load stands still or loops; its rate varies, and so does the slip's.
        """
        linear, *others = self.damping_law.coefficients
        if not linear > 0 or any(others) or self.drag > 0:
            raise ParameterError(
                "no mean slip rate follows from the scene alone: it does from linear damping without drag, got "
                f"damping={self.damping!r} and drag={self.drag!r}"
            )
        return self.downhill_weight * self.can.radius / linear

    def acceleration(self) -> float:
        """Return the steady acceleration of the axis down the incline [m/s^2]: footnote 4, or eq. (1).

        For a frozen load it is that of a balanced one with the same inertia about the axis (A.3). With damping or drag
        it is 0, but for a balanced load without drag, which ends as a frozen one.
        """
        if self.dissipates and (self.load.offset > 0 or self.drag > 0):
            return 0.0
        if self.attachment == "sliding" and not self.dissipates:
            return self.downhill_weight / self.effective_mass
        return self.downhill_weight / (self.effective_mass + self.load.axis_inertia / self.can.radius**2)


def relaxation_rate(scene: Scene, phi: np.ndarray | float, slip: float) -> np.ndarray:
    """Return the rate [1/s] at which damping brings can and load together, torque'(`slip` [rad/s]) J_f/(a^2 M J)."""
    resists = scene.frozen.inertia(phi) / (scene.can.radius**2 * scene.effective_mass * scene.oscillator.inertia(phi))
    return scene.damping_law.derivative(slip) * resists


def remembers_call(make: Callable[Parameters, Scene]) -> Callable[Parameters, Scene]:
    """Return the function with scenes that remember it and its arguments."""

    @functools.wraps(make)
    def remembering(*arguments: Parameters.args, **others: Parameters.kwargs) -> Scene:
        scene = make(*arguments, **others)
        vars(scene).update(made_by=(remembering, inspect.signature(make).bind(*arguments, **others).arguments))
        return scene

    return remembering


@remembers_call
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

    `incline` is in [rad], `fill` is h/2a of eq. (32), and `density` is the beer's [kg/m^3]. `damping` [N m s] and the
    `drag` of the air [kg/m] are fields of `Scene`.

    Raises:
      ParameterError: as `Scene`.
    """
    can, load = _of_beer(can, fill, density)
    return Scene(can, load, incline, "sliding", gravity, damping, drag)


@remembers_call
def frozen(
    incline: float = INCLINE, fill: float = 0.5, can: Can | None = None, density: float = BEER, gravity: float = GRAVITY
) -> Scene:
    """Return the scene of beer frozen to the can, with parameters as of `sliding`: appendix A (massless can).

    Raises:
      ParameterError: as `Scene`.
    """
    can, load = _of_beer(can, fill, density)
    return Scene(can, load, incline, "frozen", gravity)


def _of_beer(can: Can | None, fill: float, density: float) -> tuple[Can, Load]:
    can = Can.massless() if can is None else require.instance("can", can, Can)
    return can, Load.segment(can.radius, can.length, fill=fill, density=density)


@remembers_call
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


@remembers_call
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
