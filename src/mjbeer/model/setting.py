"""Settings: how a can is made to roll, and how it is stepped."""

import math
import os
import pathlib
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory.scene import Scene

Rolling = Literal["reduced", "equality", "contact"]
MujocoIntegrator = Literal["Euler", "implicit", "implicitfast", "discrete", "RK4"]
MjbeerIntegrator = Literal["DOP853", "GaussJackson"]
Integrator = Literal[MujocoIntegrator, MjbeerIntegrator]
ROLLINGS: tuple[Rolling, ...] = get_args(Rolling)
"""The ways in which a can is made to roll; see `Setting.rolling`."""
MUJOCO_INTEGRATORS: tuple[MujocoIntegrator, ...] = get_args(MujocoIntegrator)
"""The names of MuJoCo's own integrators, as in MJCF."""
MJBEER_INTEGRATORS: tuple[MjbeerIntegrator, ...] = get_args(MjbeerIntegrator)
"""The names of mjbeer's own integrators, which step by themselves and have samples at any time."""
Looks = Literal["plain", "full"]
LOOKS: tuple[Looks, ...] = get_args(Looks)
"""How an exported can may look: in a few geoms, or with all its meshes."""
FRICTION = 1.0
"""Default friction coefficient of a contact, which is MuJoCo's default too."""
LEAST_FRICTION = 1e-5
"""MuJoCo raises a smaller friction coefficient to this (mjMINMU), without a warning."""


@dataclass(frozen=True)
class Setting:
    """How a scene is made to roll and how it is stepped; the fields are parameters of `simulate`.

    Raises:
      ParameterError: if a name is unknown, or a number is invalid.
    """

    rolling: Rolling = "reduced"
    """"reduced" (no constraint), "equality" (a joint equality) or "contact" (a cylinder on a
    plane)."""
    integrator: Integrator = "RK4"
    """One of MuJoCo's or mjbeer's; "GaussJackson" only with "reduced". With a tolerance this is not
    used, because `simulate` then chooses the integrator."""
    timestep: float = 1e-3
    """Timestep [s]. With a tolerance it is only the interval between samples."""
    tolerance: float | None = None
    """Largest error of phi and u/a [rad], relative beyond 1 rad. None for a fixed timestep."""
    friction: float = FRICTION
    """Friction coefficient of a contact."""
    mjcf: str | os.PathLike[str] | None = None
    """A folder of MJCF that is read instead of mjbeer's, if one is given."""
    folder: pathlib.Path = field(init=False, repr=False)
    """The folder of MJCF that is read: `mjcf`, that of the environment, or mjbeer's own."""

    def __post_init__(self) -> None:
        require.choice("rolling", self.rolling, ROLLINGS)
        require.choice("integrator", self.integrator, (*MUJOCO_INTEGRATORS, *MJBEER_INTEGRATORS))
        tolerance = self.tolerance
        if tolerance is not None:
            tolerance = require.positive("tolerance", tolerance, "rad")
        require.set_fields(
            self,
            timestep=require.within("timestep", self.timestep, *require.TIMESTEP, "s"),
            friction=require.within("friction", self.friction, LEAST_FRICTION, math.inf),
            tolerance=tolerance,
            folder=mjcf_folder(self.mjcf),
        )
        if self.integrator == "GaussJackson" and self.rolling != "reduced":
            raise ParameterError(
                "GaussJackson takes no constraint: rolling must be 'reduced' with it, "
                f"got {self.rolling!r}; DOP853 takes any"
            )
        if self.tolerance is not None and self.rolling == "contact":
            raise ParameterError(
                "a contact is soft, and no tolerance covers this error: "
                "rolling must be 'reduced' or 'equality' with one, "
                f"got 'contact' and {self.tolerance!r} rad; "
                "take a short timestep, and see error_estimate"
            )

    @classmethod
    def of(cls, integrator: Integrator | None, tolerance: float | None, **fields: Any) -> "Setting":
        """Return the setting of a call in which one of `integrator` and `tolerance` is None, or
        both are."""
        if integrator is None:
            return cls(tolerance=tolerance, **fields)
        setting = cls(integrator=integrator, tolerance=tolerance, **fields)
        if tolerance is not None:
            raise ParameterError(
                "with a tolerance mjbeer chooses the integrator: give only one of the two, "
                f"got {integrator!r} too"
            )
        return setting


def supported(scene: Scene, rolling: str) -> bool:
    """Return whether MuJoCo can roll a scene in this way: it cannot move a body without inertia."""
    return rolling == "reduced" or scene.can.inertia > 0 or scene.attachment == "frozen"


def mjcf_folder(given: str | os.PathLike[str] | None = None) -> pathlib.Path:
    """Return the folder of MJCF: the one that is `given`, or the environment's, or mjbeer's own."""
    folder = os.environ.get("MJBEER_MJCF") if given is None else given
    if folder is None:
        return MJBEER_FOLDER
    if not isinstance(folder, (str, os.PathLike)) or not os.path.isdir(folder):
        value = require.format_value(folder)
        raise ParameterError(f"mjcf must be a folder of mechanics and looks, got {value}")
    # Its files are read later, when the working folder may have changed.
    return pathlib.Path(folder).absolute()


def _find_mjbeer_folder() -> pathlib.Path:
    """Return mjbeer's own folder of MJCF: a wheel has it inside, a checkout at its top."""
    package = pathlib.Path(__file__).parents[1]
    inside = package / "mjcf"
    return inside if inside.is_dir() else package.parents[1] / "mjcf"


MJBEER_FOLDER = _find_mjbeer_folder()
"""mjbeer's own folder of MJCF."""
