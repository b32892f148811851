"""The scene: can, load, incline, gravity, and how the load is attached and damped."""

import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from mjbeer import require
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError
from mjbeer.theory import motion
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.oscillator import Oscillator

Attachment = Literal["sliding", "frozen"]
ATTACHMENTS: tuple[Attachment, ...] = get_args(Attachment)
INCLINE = math.radians(10)
"""Slope of the incline [rad] unless another is given, as in the paper's footnote 8."""
DURATION = 2.0
"""Length of a motion [s] unless another is given."""
PHI0 = math.radians(60)
"""phi at the start [rad] unless another is given."""
GRAVITY = 9.81
"""Gravity [m/s^2] unless another is given; the paper's footnote 8 has 9.8."""


class Call(NamedTuple):
    """A call that makes a scene."""

    function: Callable[..., "Scene"]
    arguments: dict[str, Any]
    """The arguments that were given, by name."""


class SteadyRolling(NamedTuple):
    """A can that rolls at a constant speed, in which the load rests at a constant angle."""

    slip_rate: float
    """roll_dot - phi_dot, which is roll_dot [rad/s]."""
    torque: float
    """Torque T of the damping on the load [N m]."""
    stiffness: float
    """Derivative of the weight's torque by phi, k = m g b cos(alpha + phi) [N m]."""


@dataclass(frozen=True, repr=False)
class Scene:
    """A can with a load on an incline.

    The incline is at most 85 degrees, and a can with mass has 0.001 to 1000 times that of its load
    (`mjbeer.require` has the whole domain).

    Raises:
      ParameterError: if a parameter is outside the domain, the load is outside the can, a frozen
        load is damped, or nothing has inertia at phi = 0; if a load of `Load.liquid` is frozen, in
        another can, or without gravity. Methods raise it if what they return has a meaning only
        with damping or drag, or only without them.
      NoEquilibriumError: methods that need a load at rest raise it if the incline is too steep or
        nothing restores the load.
    """

    can: Can
    load: Load
    incline: float = INCLINE
    """Angle alpha of the incline to the horizontal [rad]; if positive, u grows downhill."""
    attachment: Attachment = "sliding"
    """"sliding": the load slides about the axis, with no friction but `damping`.
    "frozen": it turns with the can."""
    gravity: float = GRAVITY
    """Acceleration of gravity g [m/s^2]."""
    damping: float | Damping = 0.0
    """Torque between a sliding load and the can per slip rate roll_dot - phi_dot, c [N m s].

    A `Damping` if the torque is not proportional to the slip rate.
    """
    drag: float = 0.0
    """Force of the air on the axis divided by the square of its speed, C_d rho A / 2 [kg/m].

    Only a scene with a sliding load may have it.
    """
    made_by: Call | None = field(default=None, init=False, compare=False)
    """The call that made the scene, such as one of `mjbeer.sliding`; None for one of `Scene`."""

    def __post_init__(self) -> None:
        require.instance("can", self.can, Can)
        require.instance("load", self.load, Load)
        require.choice("attachment", self.attachment, ATTACHMENTS)
        damping = self.damping
        if not isinstance(damping, Damping):
            damping = require.non_negative("damping", damping, "N m s")
        require.set_fields(
            self,
            incline=require.within("incline", self.incline, *require.INCLINE, "rad"),
            gravity=require.within("gravity", self.gravity, *require.GRAVITY, "m/s^2", zero=True),
            damping=damping,
            drag=require.non_negative("drag", self.drag, "kg/m"),
        )
        self._require_load_in_domain()
        if self.load.sloshes_in is not None:
            self._require_slosh(self.load.sloshes_in)
        if self.dissipates:
            self._require_dissipation_in_domain()

    def _require_load_in_domain(self) -> None:
        """Check the place, the mass and the inertia of the load against those of its can."""
        can = self.can
        load = self.load
        radius = can.radius
        # With a smaller offset, less than a billionth of the can's height would be empty.
        require.within("load offset", load.offset, 1e-14 * radius, radius, "m", zero=True)
        lightest, heaviest = (ratio * load.mass for ratio in require.RATIO)
        name = f"mass of the can with a load of {load.mass:g} kg"
        require.within(name, can.mass, lightest, heaviest, "kg", zero=True)
        largest = require.LARGEST_INERTIA * load.mass * radius**2
        require.within("load inertia", load.inertia, 0, largest, "kg m^2")
        swing = self.oscillator
        inertia_at_0 = swing.base
        inertia_at_right_angle = swing.base + swing.chord / 2 + swing.coupling
        # With a point load that slides, their ratio is K/(m + K), with K = m_can + I_can/a^2. It is
        # a thousandth for the lightest can, and less than half of that only for a massless one.
        if not inertia_at_0 > inertia_at_right_angle / (2 * require.RATIO[1]):
            raise ParameterError(
                "next to nothing resists rotation at phi = 0: a point load needs an offset and "
                f"a can with mass, got {load!r} and {can!r}"
            )

    def _require_slosh(self, made_for: Can) -> None:
        """Check that a load of `Load.liquid` sloshes here as in the can that it was made for."""
        if self.attachment == "frozen":
            raise ParameterError(
                "a liquid that sloshes is not frozen: with attachment='frozen' take Load.segment, "
                f"which has the inertia of ice, got {self.load!r}"
            )
        if self.can != made_for:
            raise ParameterError(
                "the inertia of a load of Load.liquid depends on its can: "
                f"it was made for {made_for!r}, got {self.can!r}"
            )
        if self.gravity == 0:
            raise ParameterError("without gravity a liquid does not slosh, got a gravity of 0")

    def _require_dissipation_in_domain(self) -> None:
        """Check that the load slides, and that damping and drag brake at rates in the domain."""
        if self.attachment == "frozen":
            damping = require.format_value(self.damping)
            drag = require.format_value(self.drag)
            raise ParameterError(
                "a frozen load moves as one with its can: damping and drag must be 0, "
                f"got damping={damping} and drag={drag}"
            )
        # These are rates of decay at 1 rad/s. At phi = pi the load resists damping least.
        of_damping = float(relaxation_rate(self, math.pi, 1.0))
        of_drag = 2 * self.drag * self.can.radius / self.effective_mass
        slowest = 1e-12  # [1/s]; a slower decay cannot be observed
        fastest = 1e9
        require.within("rate of damping", of_damping, slowest, fastest, "1/s", zero=True)
        require.within("rate of drag", of_drag, slowest, fastest, "1/s", zero=True)

    def __repr__(self) -> str:
        """Return the call that makes the scene, without arguments that have their defaults."""
        if self.made_by is None:
            make = type(self)
            given = {item.name: getattr(self, item.name) for item in fields(self) if item.init}
        else:
            make, given = self.made_by
        defaults = inspect.signature(make).parameters
        arguments = []
        for name, value in given.items():
            plain = value.item() if isinstance(value, np.generic) else value
            if plain != defaults[name].default:
                arguments.append(f"{name}={plain!r}")
        return f"{getattr(make, '__name__', '')}({', '.join(arguments)})"

    @cached_property
    def damping_law(self) -> Damping:
        """Return the damping as a `Damping`, also if it was given as a number."""
        return self.damping if isinstance(self.damping, Damping) else Damping(self.damping)

    @cached_property
    def oscillator(self) -> Oscillator:
        """Return the scene without damping and drag as one degree of freedom, phi."""
        if self.attachment == "frozen":
            return self.rigid_oscillator
        return Oscillator.sliding(self.can, self.load, self.incline, self.gravity)

    @cached_property
    def rigid_oscillator(self) -> Oscillator:
        """Return the oscillator of can and load turning as one; its inertia is J_f."""
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
        """Return the inertia of can and load against a force along the incline [kg].

        For a can that rolls it is M_e = m + m_can + I_can/a^2.
        """
        return self.load.mass + self.can.effective_mass

    @cached_property
    def downhill_weight(self) -> float:
        """Return the weight along the incline, m_t g sin(alpha) [N]."""
        return self.mass * self.gravity * math.sin(self.incline)

    def initial_axis(self, phi0: float, phi_dot0: float) -> tuple[float, float]:
        """Return u [m] and u_dot [m/s] of the axis at the start, for phi [rad] and phi_dot [rad/s].

        A sliding load starts with s = 0 and s_dot = 0 (eq. 12), and a frozen one with u = a phi
        (eq. 50).
        """
        phi0, phi_dot0 = require.start(phi0, phi_dot0)
        if self.attachment == "frozen":
            return self.can.radius * phi0, self.can.radius * phi_dot0
        offset = self.load.offset
        return offset * math.sin(phi0), offset * math.cos(phi0) * phi_dot0

    def equilibrium(self) -> float:
        """Return the angle phi of stable equilibrium [rad].

        For a frozen load it is that of eq. (53), with the can's mass included. For a sliding load
        it is the angle at which the can accelerates steadily, tan(phi) =
        (A - g sin(alpha)) / (g cos(alpha)) with A of footnote 4. With damping or drag it is
        `terminal_tilt`.
        """
        if self.dissipates:
            return self.terminal_tilt()
        if abs(self.oscillator.ramp) > self.oscillator.depth > 0:
            raise self._too_steep()
        return self.oscillator.equilibrium()

    def largest_incline(self) -> float:
        """Return the largest incline with an equilibrium [rad]: the text below eq. (53).

        It is pi/2 for a sliding load without damping and drag. For a frozen load, and for steady
        rolling with damping, it is the one on which the load's centre of mass is level with the
        axis: its torque is then the largest, and m_t g a sin(alpha) = m g b. With drag it is
        larger, as the air holds drag u_dot^2 of the weight along the incline, m_t g sin(alpha).
        """
        if self.attachment == "sliding" and not self.dissipates:
            return math.pi / 2
        # m b/(m_t a), in an order of operations that rounds to 1 at most:
        sine = self.load.moment / (self.mass * self.can.radius)
        if self.drag > 0 and self.gravity > 0:
            slip_rate = self.damping_law.rate_at(self.load.moment * self.gravity)
            speed = self.can.radius * slip_rate
            sine += self.drag * speed**2 / (self.mass * self.gravity)
        return math.asin(min(sine, 1.0))

    def _too_steep(self) -> NoEquilibriumError:
        incline = math.degrees(self.incline)
        largest = math.degrees(self.largest_incline())
        return NoEquilibriumError(
            f"no equilibrium at an incline of {incline:.4g} degrees: "
            f"the load can hold the can only up to {largest:.1f} degrees"
        )

    def frequency(self) -> float:
        """Return the angular frequency of small swings about the equilibrium [rad/s].

        It is that of eq. (10), or of eq. (55) corrected. With damping or drag it is the imaginary
        part of those of the `modes` that swing; their real part is the rate of decay.

        Raises:
          NoLibrationError: if the damping is such that the load creeps back without a swing.
        """
        if not self.dissipates:
            self.equilibrium()
            return self.oscillator.frequency()
        fastest = float(self.modes().imag.max())
        if fastest > 0:
            return fastest
        missing = "no frequency: the load creeps back without a swing"
        raise NoLibrationError(f"{missing}; scene.modes() has the rates")

    def period(self, amplitude: float) -> float:
        """Return the period [s] of the swing from rest at `amplitude` [rad] from the equilibrium.

        Raises:
          NoLibrationError: if `amplitude` is at or beyond the separatrix, or so near to it that
            rounding decides.
          ToleranceError: if sizes, masses and gravity differ by too many orders of magnitude.
        """
        amplitude = require.number("amplitude", amplitude, "rad")
        self._require_swing("no period")
        return motion.period(self.oscillator, amplitude)

    def separatrix(self) -> tuple[float, float]:
        """Return the least and the largest phi of the largest swing about equilibrium [rad]."""
        self._require_swing("no largest swing")
        return self.oscillator.separatrix()

    def _require_swing(self, missing: str) -> None:
        """Check that the load has an equilibrium to swing about for ever."""
        if self.dissipates:
            raise ParameterError(
                f"{missing}: each swing of a load with damping or drag is smaller than the one "
                f"before, got damping={self.damping!r} and drag={self.drag!r}; "
                "scene.modes() has the rates"
            )
        self.equilibrium()

    def _steady_rolling(self) -> SteadyRolling:
        """Return how a can with damping or drag rolls in the end.

        Nothing accelerates if T(w)/a + drag u_dot |u_dot| = m_t g sin(alpha), where w = u_dot/a,
        and m g b sin(alpha + phi) = T(w). Without drag T is m_t g a sin(alpha) for any damping.

        Raises:
          ParameterError: without damping and drag.
          NoEquilibriumError: if the load cannot exert the torque, or nothing restores it.
        """
        if not self.dissipates:
            missing = "no steady rolling: damping and drag are 0"
            raise ParameterError(f"{missing}, and nothing else brakes the can")
        self.oscillator.equilibrium()  # raises the error if nothing restores the load
        radius = self.can.radius
        torque = self.downhill_weight * radius
        linear, quadratic, cubic = self.damping_law.coefficients
        # Times a, the equation is T(w) + drag a^3 w |w| = torque: drag adds to quadratic damping.
        slip_rate = Damping(linear, quadratic + self.drag * radius**3, cubic).rate_at(torque)
        if self.drag > 0:
            torque = float(self.damping_law.torque(slip_rate))
        largest = self.load.moment * self.gravity
        if abs(torque) > largest:
            raise self._too_steep()
        # m g b cos(alpha + phi) from its sine, without cancellation or overflow:
        stiffness = math.sqrt(largest - abs(torque)) * math.sqrt(largest + abs(torque))
        return SteadyRolling(slip_rate, torque, stiffness)

    def terminal_speed(self) -> float:
        """Return the speed down the incline [m/s] at which a can with damping or drag ends.

        Its load then rests at `terminal_tilt`. With linear damping alone the speed is
        m_t g sin(alpha) a^2/c.

        Raises:
          ParameterError: without damping and drag.
          NoEquilibriumError: if the load cannot exert the torque, or nothing restores it.
        """
        return self.can.radius * self._steady_rolling().slip_rate

    def terminal_tilt(self) -> float:
        """Return the angle phi [rad] at which the load of a can with damping or drag comes to rest.

        Without drag it is that of eq. (53), with the can's mass included, for any damping.

        Raises:
          ParameterError, NoEquilibriumError: as `terminal_speed`.
        """
        steady = self._steady_rolling()
        return math.atan2(steady.torque, steady.stiffness) - self.incline

    def modes(self) -> np.ndarray:
        """Return the complex rates s [1/s] of small motions about steady rolling, shape (3,).

        Each motion goes as exp(s t); the one that decays fastest is first. With the damping's
        derivative c, the drag's derivative d and the weight's k at the terminal speed and tilt,
        and P = m b cos(phi), they are the roots of

            M_e J s^3 + (c J_f/a^2 + d I_axis) s^2 + (M_e k + c d) s + k (c/a^2 + d) = 0,
            M_e J = M_e I_axis - P^2,    J_f = M_e a^2 + I_axis - 2 P a.

        Raises:
          ParameterError, NoEquilibriumError: as `terminal_speed`.
        """
        steady = self._steady_rolling()
        tilt = self.terminal_tilt()
        a = self.can.radius
        M_e = self.effective_mass
        J = float(self.oscillator.inertia(tilt))
        J_f = float(self.rigid_oscillator.inertia(tilt))
        I_axis = self.load.axis_inertia
        k = steady.stiffness
        c = float(self.damping_law.derivative(steady.slip_rate))
        d = 2 * self.drag * a * abs(steady.slip_rate)
        cubic = M_e * J
        quadratic = c * J_f / a**2 + d * I_axis
        linear = M_e * k + c * d
        constant = k * (c / a**2 + d)
        return np.sort_complex(np.roots([cubic, quadratic, linear, constant]))

    def mean_slip_rate(self) -> float:
        """Return the mean slip rate of can and load with linear damping [rad/s].

        It is m_t g a sin(alpha)/c in any steady motion, whether the load rests or loops.
        """
        linear, *others = self.damping_law.coefficients
        if not linear > 0 or any(others) or self.drag > 0:
            raise ParameterError(
                "no mean slip rate follows from the scene alone: it does from linear damping "
                f"without drag, got damping={self.damping!r} and drag={self.drag!r}"
            )
        return self.downhill_weight * self.can.radius / linear

    def acceleration(self) -> float:
        """Return the steady acceleration of the axis down the incline [m/s^2].

        It is that of footnote 4, or of eq. (1) for a massless can.
        For a frozen load it is that of a balanced one with the same inertia about the axis (A.3).
        With damping or drag it is 0, except for a balanced load without drag, which in the end
        turns with the can as a frozen one does.
        """
        if self.dissipates and (self.load.offset > 0 or self.drag > 0):
            return 0.0
        if self.attachment == "sliding" and not self.dissipates:
            return self.downhill_weight / self.effective_mass
        turning = self.load.axis_inertia / self.can.radius**2
        return self.downhill_weight / (self.effective_mass + turning)


def relaxation_rate(scene: Scene, phi: np.ndarray | float, slip_rate: float) -> np.ndarray:
    """Return the rate |s| [1/s] at which slip decays, as exp(-|s| t), near a slip rate [rad/s].

    It is T'(slip_rate) J_f/(a^2 M_e J), where T' is the derivative of the damping's torque.
    """
    J_f = scene.rigid_oscillator.inertia(phi)
    J = scene.oscillator.inertia(phi)
    inverse_inertia = J_f / (scene.can.radius**2 * scene.effective_mass * J)
    return scene.damping_law.derivative(slip_rate) * inverse_inertia
