"""How a scene is rolled and stepped, and how soft the constraint is that makes it roll."""

from dataclasses import dataclass, replace
from typing import Literal, get_args

from mjbeer import require
from mjbeer.theory.scene import Scene

Rolling = Literal["reduced", "equality", "contact"]
MujocoIntegrator = Literal["Euler", "implicit", "implicitfast", "discrete", "RK4"]
Integrator = Literal[MujocoIntegrator, "DOP853"]
ROLLINGS: tuple[str, ...] = get_args(Rolling)
INTEGRATORS: tuple[str, ...] = get_args(MujocoIntegrator)
"""MuJoCo's own integrators, by their names in MJCF."""
DOP853 = "DOP853"
FRICTION = 1.0
"""Default friction coefficient of a contact, MuJoCo's own default."""


@dataclass(frozen=True)
class Softness:
    """How soft the rolling constraint is, in MuJoCo's own terms; what is None is as hard as the integrator bears."""

    solref: tuple[float, float] | None = None
    """Time constant [s] and damping ratio, or minus a stiffness [1/s^2] and minus a damping [1/s]."""
    impedance: tuple[float, float] | None = None
    """dmin and dmax of solimp."""
    impratio: float | None = None
    """Hardness of a contact's friction over that of its normal force."""
    refsafe: bool = False
    """Whether MuJoCo raises a time constant to two timesteps."""
    exact_diagonal: bool = True
    """Whether softness is a share of the inverse inertia that the row really has (MuJoCo's `diagexact`)."""
    elliptic: bool = True
    """Whether the friction cone of a contact is elliptic, and not MuJoCo's default pyramid."""
    first: Literal["slide", "hinge"] = "slide"
    """Which joint the equality names first: MuJoCo then constrains a distance ("slide") or an angle ("hinge")."""


TUNED = Softness()
"""As hard as the integrator bears; a joint equality is then solved exactly."""


@dataclass(frozen=True)
class Setting:
    """How a scene is rolled and stepped; the fields are the parameters of `simulate`.

    Raises:
      ParameterError: on a name that does not exist or a number that is not allowed.
    """

    rolling: str = "reduced"
    integrator: str = "RK4"
    timestep: float = 1e-3
    """Timestep, or with a tolerance the sampling interval [s]."""
    tolerance: float | None = None
    """Largest error of phi and u/a [rad], relative beyond 1 rad; None where the timestep is fixed."""
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
"""Settings as people usually write them: MuJoCo's defaults wherever one need not decide. In a joint equality either
joint may be named first, and the constraint is softened by different shares."""


def supported(scene: Scene, rolling: str) -> bool:
    """Whether MuJoCo has a model of a scene: it moves no massless body."""
    return rolling == "reduced" or scene.can.mass > 0 or scene.attachment == "frozen"
