"""Settings: how a can is made to roll, how it is stepped, and how soft the constraint is that makes it roll."""

from dataclasses import dataclass, replace
from typing import Literal, get_args

from mjbeer import require
from mjbeer.theory.scene import Scene

Rolling = Literal["reduced", "equality", "contact"]
MujocoIntegrator = Literal["Euler", "implicit", "implicitfast", "discrete", "RK4"]
Integrator = Literal[MujocoIntegrator, "DOP853"]
ROLLINGS: tuple[str, ...] = get_args(Rolling)
"""The ways in which a can is made to roll; see `Setting.rolling`."""
INTEGRATORS: tuple[str, ...] = get_args(MujocoIntegrator)
"""The names of MuJoCo's own integrators, as in MJCF."""
DOP853 = "DOP853"
"""The name of mjbeer's integrator of eighth order."""
FRICTION = 1.0
"""Default friction coefficient of a contact, which is MuJoCo's default too."""


@dataclass(frozen=True)
class Softness:
    """How soft the rolling constraint is, in MuJoCo's terms; None means as hard as is stable under the integrator."""

    solref: tuple[float, float] | None = None
    """Time constant [s] and damping ratio; or, both negated, stiffness [1/s^2] and damping [1/s]."""
    impedance: tuple[float, float] | None = None
    """dmin and dmax of solimp."""
    impratio: float | None = None
    """Hardness of a contact's friction over that of its normal force."""
    refsafe: bool = False
    """Whether MuJoCo raises a time constant to two timesteps."""
    exact_diagonal: bool = True
    """Whether softness is proportional to the exact inverse inertia of the constraint (MuJoCo's `diagexact`)."""
    elliptic: bool = True
    """Whether the friction cone of a contact is elliptic instead of MuJoCo's default, a pyramid."""
    first: Literal["slide", "hinge"] = "slide"
    """The joint that the equality names first: MuJoCo then constrains a distance ("slide") or an angle ("hinge")."""


TUNED = Softness()
"""The default: as hard as is stable under the integrator, and a joint equality is solved exactly."""


@dataclass(frozen=True)
class Setting:
    """How a scene is made to roll and how it is stepped; the fields are parameters of `simulate`.

    Raises:
      ParameterError: if a name is unknown or a number is not allowed.
    """

    rolling: str = "reduced"
    """"reduced" (no constraint), "equality" (a joint equality) or "contact" (a cylinder on a plane)."""
    integrator: str = "RK4"
    """One of `INTEGRATORS`, or "DOP853"; with a tolerance it is not used."""
    timestep: float = 1e-3
    """Timestep [s]; with a tolerance it is the sampling interval."""
    tolerance: float | None = None
    """Largest error of phi and u/a [rad], relative beyond 1 rad; None for a fixed timestep."""
    friction: float = FRICTION
    """Friction coefficient of a contact."""
    softness: Softness = TUNED

    def __post_init__(self) -> None:
        require.choice("rolling", self.rolling, ROLLINGS)
        require.choice("integrator", self.integrator, (*INTEGRATORS, DOP853))
        require.positive("timestep", self.timestep, "s")
        require.positive("friction", self.friction)
        if self.tolerance is not None:
            require.positive("tolerance", self.tolerance, "rad")


_DEFAULTS = Softness(solref=(0.02, 1), impedance=(0.9, 0.95), refsafe=True, exact_diagonal=False)
USUAL = {
    "equality, slide first": Setting("equality", "Euler", 2e-3, softness=_DEFAULTS),
    "equality, hinge first": Setting("equality", "Euler", 2e-3, softness=replace(_DEFAULTS, first="hinge")),
    "contact, defaults": Setting("contact", "Euler", 2e-3, softness=replace(_DEFAULTS, impratio=1, elliptic=False)),
}
"""Settings as people usually write them, with MuJoCo's defaults wherever there are any. The order of the two joints in
a joint equality matters: MuJoCo's default diagonal softens the two by different factors."""


def supported(scene: Scene, rolling: str) -> bool:
    """Return whether MuJoCo can model a scene with this way of rolling: it cannot move a massless body."""
    return rolling == "reduced" or scene.can.mass > 0 or scene.attachment == "frozen"
