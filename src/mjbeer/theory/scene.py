"""The scene: can, load, incline, gravity, and how the load is attached and damped."""

import math
from dataclasses import dataclass, field
from importlib import import_module
from typing import Literal, get_args

import numpy as np

from mjbeer import require
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError
from mjbeer.theory import motion, steady_rolling, viscous_modes
from mjbeer.theory.can import Can
from mjbeer.theory.damping import Damping
from mjbeer.theory.load import Load
from mjbeer.theory.oscillator import Oscillator

Attachment = Literal["sliding", "frozen"]
ATTACHMENTS: tuple[Attachment, ...] = get_args(Attachment)
"""The ways in which a load can be attached; see `Scene.attachment`."""
INCLINE = math.radians(10)
"""Default incline [rad]: 10 degrees, as in the paper's footnote 8."""
_LEAST_OFFSET = 1e-14
"""Smallest offset of a load that is not balanced, over the radius: less than with a billionth of the height empty."""
GRAVITY = 9.81
"""Default acceleration of gravity [m/s^2]; the paper's footnote 8 has 9.8."""


@dataclass(frozen=True)
class Scene:
    """A can with a load on an incline.

    Raises:
      ParameterError: on an incline outside (-pi/2, pi/2), a load outside the can, an unknown
        attachment, negative gravity, damping or drag, either of them with a frozen load, or a scene that has no inertia
        at phi = 0.
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
    damping_law: Damping = field(init=False, repr=False, compare=False)
    """The torque between can and load as a `Damping`, also where it was given as a number."""
    oscillator: Oscillator = field(init=False, repr=False, compare=False)
    """The scene without damping and drag as one degree of freedom, phi; it follows from the other fields."""

    def __post_init__(self) -> None:
        require.instance("can", self.can, Can)
        require.instance("load", self.load, Load)
        incline = require.number("incline", self.incline, "rad")
        if not abs(incline) < math.pi / 2:
            raise ParameterError(
                f"incline must be between -pi/2 and pi/2 [rad] (90 degrees), got {require.shown(self.incline)}"
            )
        require.choice("attachment", self.attachment, ATTACHMENTS)
        require.store(
            self, incline=incline, gravity=require.within("gravity", self.gravity, *require.GRAVITY, "m/s^2", zero=True)
        )
        require.store(self, drag=require.non_negative("drag", self.drag, "kg/m"))
        if not isinstance(self.damping, Damping):
            require.store(self, damping=require.non_negative("damping", self.damping, "N m s"))
        law = self.damping if isinstance(self.damping, Damping) else Damping(self.damping)
        require.store(self, damping_law=law)
        if self.dissipates and self.attachment == "frozen":
            raise ParameterError(
                f"a frozen load moves as one with its can, which leaves nothing to damp: damping and drag must be 0, "
                f"got damping={require.shown(self.damping)} and drag={require.shown(self.drag)}"
            )
        self._check_masses()
        oscillator = Oscillator.sliding if self.attachment == "sliding" else Oscillator.frozen
        reduced = oscillator(can=self.can, load=self.load, incline=self.incline, gravity=self.gravity)
        object.__setattr__(self, "oscillator", reduced)
        if not self.oscillator.base > float(self.oscillator.inertia(math.pi / 2)) / (2 * require.RATIO):
            raise ParameterError(
                "next to nothing resists rotation at phi = 0: a point load needs an offset and a can with mass "
                f"(attachment {self.attachment!r}, load inertia {self.load.inertia!r} kg m^2, load offset "
                f"{self.load.offset!r} m, can mass {self.can.mass!r} kg)"
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
        """Check how fast damping and drag brake where the load resists least, at a slip rate of 1 rad/s."""
        a, total, moment = self.can.radius, self.effective_mass, self.load.moment
        slipping = (self.load.axis_inertia / a**2 + 2 * moment / a + total) / (total * self.oscillator.base)
        limits = 1 / (1e3 * require.DAMPING_RATE), require.DAMPING_RATE
        with require.from_given(damping=self.damping):
            rate = float(self.damping_law.slope(1.0)) * slipping
            require.within("rate of damping", rate, *limits, "1/s", zero=True)
        with require.from_given(drag=self.drag):
            require.within("rate of drag", 2 * self.drag * a / total, *limits, "1/s", zero=True)

    def _repr_html_(self) -> str:
        """Return the parameters of the scene as a table, for a notebook."""
        return import_module("mjbeer.drawing.views").scene_html(self)  # theory knows no pictures: not imported above

    @property
    def dissipates(self) -> bool:
        """Return whether damping or drag takes energy from the motion."""
        return bool(self.damping_law) or self.drag > 0

    @property
    def mass(self) -> float:
        """Return the mass of can and load together [kg]."""
        return self.can.mass + self.load.mass

    @property
    def effective_mass(self) -> float:
        """Return the mass against a force along the incline when the can rolls, M = m + m_can + I_can/a^2 [kg]."""
        return self.load.mass + self.can.effective_mass

    @property
    def centre_of_mass(self) -> float:
        """Return the distance of their common centre of mass from the axis, d = m b/(m + m_can) [m]: eq. (38)."""
        return self.load.mass * self.load.offset / self.mass

    def equilibrium(self) -> float:
        """Return the angle phi of stable equilibrium [rad]: eq. (53) for a frozen load, with the can's mass included.

        For a sliding load it is the angle at which the can accelerates steadily, tan phi =
        (A - g sin(alpha)) / (g cos(alpha)) with A of footnote 4; it is zero for a massless can. With damping or drag it
        is `terminal_tilt`.

        Raises:
          NoEquilibriumError: if there is none; for a frozen load, and with damping or drag, the message names the
            largest incline that has one.
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
        """Return the largest incline with an equilibrium [rad]: the text below eq. (53).

        A sliding load has an equilibrium on every incline, so that the limit is pi/2. With damping the limit is that of
        a frozen load, which drag makes larger: beyond it there is no steady rolling.
        """
        if self.dissipates:
            return steady_rolling.largest_incline(self)
        if self.attachment == "sliding":
            return math.pi / 2
        return math.asin(self.load.mass * self.load.offset / (self.mass * self.can.radius))

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
          ParameterError: if `amplitude` is not finite.
          NoEquilibriumError: if there is no equilibrium.
          NoLibrationError: if `amplitude` is at or beyond the separatrix, or within the rounding of it.
          ToleranceError: if sizes, masses and gravity are of too many different orders of magnitude.
          DissipationError: if the scene has damping or drag, so that no swing is like the one before.
        """
        amplitude = require.number("amplitude", amplitude, "rad")
        steady_rolling.require_no_dissipation(self, "no period")
        self.equilibrium()
        return motion.period(self.oscillator, amplitude)

    def separatrix(self) -> tuple[float, float]:
        """Return the two angles phi between which the largest swing about the equilibrium stays [rad].

        Raises:
          NoEquilibriumError: if there is no equilibrium.
          DissipationError: if the scene has damping or drag, so that no swing lasts.
        """
        steady_rolling.require_no_dissipation(self, "no largest swing")
        self.equilibrium()
        return self.oscillator.separatrix()

    def terminal_speed(self) -> float:
        """Return the speed of the axis down the incline [m/s] at which a can with damping or drag rolls steadily.

        Its load then stands still at `terminal_tilt`. With linear damping alone it is m_t g sin(alpha) a^2/c.

        Raises:
          DissipationError: if the scene has neither damping nor drag.
          NoEquilibriumError: if there is no steady rolling; above the largest incline the message names that.
        """
        return steady_rolling.steady_rolling(self).speed

    def terminal_tilt(self) -> float:
        """Return the angle phi [rad] at which the load of a can with damping or drag stands still, once it does.

        Without drag it is that of eq. (53) with the can's mass included, whatever the damping.

        Raises:
          DissipationError: if the scene has neither damping nor drag.
          NoEquilibriumError: if there is no steady rolling; above the largest incline the message names that.
        """
        return steady_rolling.steady_rolling(self).tilt

    def modes(self) -> np.ndarray:
        """Return the roots s [1/s] of the three modes exp(s t) of small motions about steady rolling.

        They are complex, of shape (3,), and sorted by their real parts: what decays fastest is first. Damping and drag
        that are not linear count with their slopes at the terminal speed.

        Raises:
          DissipationError: if the scene has neither damping nor drag.
          NoEquilibriumError: if there is no steady rolling.
          ParameterError: if the roots are beyond double precision.
        """
        return viscous_modes.modes(self)

    def slip_rate(self) -> float:
        """Return the mean slip rate of can and load, D = m_t g a sin(alpha)/c [rad/s], of any motion that is steady.

        It is steady in the mean if the load stands still, and also if it loops with a rate that is periodic in phi. The
        variance of the slip rate is then D times the load's mean rate.

        Raises:
          DissipationError: if the damping is not linear, or there is none, or there is drag.
        """
        return steady_rolling.slip_rate(self)

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
        """Return the acceleration of the axis down the incline [m/s^2] when it is steady.

        With a sliding load it is steady at the equilibrium: footnote 4, or eq. (1) for a massless can. A frozen load
        has none; what is returned is the acceleration as if the load were balanced about the axis with the same
        inertia, (2/3) g sin(alpha) for half a massless can of beer (A.3). In the long run the unbalanced load rolls
        down faster, by the factor mean(J) / mean(sqrt(J))^2. With damping or drag the speed is bounded, and the
        acceleration 0, in the long run; only a balanced load without drag lets the can go ever faster, as a frozen one.
        """
        force = self.mass * self.gravity * math.sin(self.incline)
        effective_can_mass = self.can.mass + self.can.inertia / self.can.radius**2
        if self.dissipates and (self.load.offset > 0 or self.drag > 0):
            return 0.0
        if self.attachment == "sliding" and not self.dissipates:
            return force / (self.load.mass + effective_can_mass)
        load_inertia = self.load.inertia + self.load.mass * self.load.offset**2
        return force / (self.load.mass + effective_can_mass + load_inertia / self.can.radius**2)
