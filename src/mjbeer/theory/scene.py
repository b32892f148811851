"""A scene: can, load, incline and how the load is attached. One family covers the whole paper."""

import math
from dataclasses import dataclass, field

from mjbeer import require
from mjbeer.exceptions import NoEquilibriumError, ParameterError
from mjbeer.theory import motion
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.load import BEER, Load
from mjbeer.theory.oscillator import Oscillator

ATTACHMENTS = ("sliding", "frozen")
INCLINE = math.radians(10)
"""Default incline [rad]: the paper's, footnote 8."""
GRAVITY = 9.81
"""Acceleration of gravity [m/s^2]; the paper's footnote 8 has 9.8."""


@dataclass(frozen=True)
class Scene:
    """A can with a load on an incline.

    Raises:
      ParameterError: on an incline outside (-pi/2, pi/2), a load outside the can, an unknown
        attachment, negative gravity, or a scene that has no inertia at phi = 0.
    """

    can: Can
    load: Load
    incline: float = INCLINE
    """Angle alpha of the incline to the horizontal [rad]; positive is downhill along u."""
    attachment: str = "sliding"
    """"sliding": the load slides without friction about the axis; "frozen": it is rigidly attached."""
    gravity: float = GRAVITY
    """Acceleration of gravity g [m/s^2]."""
    oscillator: Oscillator = field(init=False, repr=False, compare=False)
    """The scene's one degree of freedom."""

    def __post_init__(self) -> None:
        require.number("incline", self.incline, "rad")
        if not abs(self.incline) < math.pi / 2:
            raise ParameterError(f"incline must be between -pi/2 and pi/2 [rad] (90 degrees), got {self.incline!r}")
        require.choice("attachment", self.attachment, ATTACHMENTS)
        require.non_negative("gravity", self.gravity, "m/s^2")
        require.store_floats(self, "incline", "gravity")
        if self.load.offset > self.can.radius:
            raise ParameterError(
                f"the load must be inside the can: its offset must be at most the radius {self.can.radius!r} m, "
                f"got {self.load.offset!r} m"
            )
        reduce = Oscillator.sliding if self.attachment == "sliding" else Oscillator.frozen
        object.__setattr__(self, "oscillator", reduce(self.can, self.load, self.incline, self.gravity))
        if self.oscillator.base <= 0:
            raise ParameterError(
                "nothing resists rotation at phi = 0: a point load needs an offset and a can with mass "
                f"(attachment {self.attachment!r}, load inertia {self.load.inertia!r} kg m^2, load offset "
                f"{self.load.offset!r} m, can mass {self.can.mass!r} kg)"
            )

    @property
    def mass(self) -> float:
        """Mass of can and load together [kg]."""
        return self.can.mass + self.load.mass

    @property
    def centre_of_mass(self) -> float:
        """Distance of the centre of mass of both from the axis, d = m b/(m + m_can) [m]: eq. (38)."""
        return self.load.mass * self.load.offset / self.mass

    def equilibrium(self) -> float:
        """Angle phi of stable equilibrium [rad]: eq. (53) for a frozen load, with the can's mass included.

        For a sliding load it is the tilt at which the can accelerates steadily, tan phi =
        (A - g sin(alpha)) / (g cos(alpha)) with A of footnote 4; zero for a massless can.

        Raises:
          NoEquilibriumError: if there is none; for a frozen load the message names the limit angle.
        """
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
        """Largest incline with an equilibrium [rad]: below eq. (53). A sliding load has one on every incline."""
        if self.attachment == "sliding":
            return math.pi / 2
        return math.asin(self.load.mass * self.load.offset / (self.mass * self.can.radius))

    def frequency(self) -> float:
        """Angular frequency of small oscillations about the equilibrium [rad/s]: eq. (10), corrected eq. (55)."""
        self.equilibrium()
        return self.oscillator.frequency()

    def period(self, amplitude: float) -> float:
        """Period [s] of the swing released from rest `amplitude` [rad] away from the equilibrium.

        Raises:
          NoLibrationError: at or beyond the separatrix.
        """
        require.number("amplitude", amplitude, "rad")
        self.equilibrium()
        return motion.period(self.oscillator, amplitude)

    def separatrix(self) -> tuple[float, float]:
        """The angles phi between which the largest swing about the equilibrium stays [rad]."""
        self.equilibrium()
        return self.oscillator.separatrix()

    def start(self, phi0: float, phi_dot0: float) -> tuple[float, float]:
        """u [m] and u_dot [m/s] of the axis when a motion starts: s = 0 and s_dot = 0 if the load slides
        (eq. 12), no slip if it is frozen (eq. 50)."""
        if self.attachment == "frozen":
            return self.can.radius * phi0, self.can.radius * phi_dot0
        return self.load.offset * math.sin(phi0), self.load.offset * math.cos(phi0) * phi_dot0

    def acceleration(self) -> float:
        """Steady acceleration of the axis down the incline [m/s^2].

        Sliding: footnote 4 (eq. 1 for a massless can), at the equilibrium. Frozen: that of the balanced
        can, (2/3) g sin(alpha) for a massless one (A.3). A load off the axis rolls down faster in the long run,
        by the mean inertia over the square of the mean of its root.
        """
        drive = self.mass * self.gravity * math.sin(self.incline)
        can = self.can.mass + self.can.inertia / self.can.radius**2
        if self.attachment == "sliding":
            return drive / (self.load.mass + can)
        axial = self.load.inertia + self.load.mass * self.load.offset**2
        return drive / (self.load.mass + can + axial / self.can.radius**2)


def sliding(
    incline: float = INCLINE, fill: float = 0.5, can: Can | None = None, density: float = BEER, gravity: float = GRAVITY
) -> Scene:
    """Beer that slides without friction in a can: sections 2 (massless can, the default) and 3.

    `incline` [rad], `fill` h/2a of eq. (32), `density` of the beer [kg/m^3].
    """
    can = Can.massless() if can is None else can
    return Scene(can, Load.segment(can.radius, can.length, fill, density), incline, "sliding", gravity)


def frozen(
    incline: float = INCLINE, fill: float = 0.5, can: Can | None = None, density: float = BEER, gravity: float = GRAVITY
) -> Scene:
    """Beer frozen to the can: appendix A (massless can, the default).

    `incline` [rad], `fill` h/2a of eq. (32), `density` of the beer [kg/m^3].
    """
    can = Can.massless() if can is None else can
    return Scene(can, Load.segment(can.radius, can.length, fill, density), incline, "frozen", gravity)


def pendulum(
    incline: float = INCLINE,
    wheel_mass: float = 0.2,
    load_mass: float = 0.1,
    offset: float = 0.025,
    radius: float = RADIUS,
    length: float = LENGTH,
    gravity: float = GRAVITY,
) -> Scene:
    """A hoop wheel with a simple pendulum on its axle: appendix B.

    `incline` [rad], masses M and m [kg], length b of the pendulum `offset` [m]. The paper gives no
    numbers: the defaults are ours, a wheel of the can's size and a bob that weighs half as much.
    """
    return Scene(Can.hoop(radius, length, wheel_mass), Load.point(load_mass, offset), incline, "sliding", gravity)


def hoop(
    incline: float = 0.0,
    hoop_mass: float = 0.01,
    load_mass: float = 0.2,
    radius: float = RADIUS,
    length: float = LENGTH,
    gravity: float = GRAVITY,
) -> Scene:
    """A hoop with a point load on its rim, the hopping hoop: appendix A.4.

    `incline` [rad], masses M and m [kg]. The default M/m = 1/20 is light enough to hop (below 1/13).
    """
    return Scene(Can.hoop(radius, length, hoop_mass), Load.point(load_mass, radius), incline, "frozen", gravity)
