"""Models as people usually write them: MuJoCo's defaults wherever one need not decide."""

import mujoco

from mjbeer.model.build import compile_model, specify
from mjbeer.theory.scene import Scene

USUAL = {"equality, slide first": "equality", "equality, hinge first": "equality", "contact, defaults": "contact"}
"""The usual ways of writing, each with the way of rolling that it is a twin of. In a joint equality, either joint
may be named first; MuJoCo then constrains a distance or an angle, which are softened by different shares."""
_SOLREF, _SOLIMP = [0.02, 1], [0.9, 0.95, 0.001, 0.5, 2]


def build_usual(scene: Scene, written: str, integrator: str = "Euler", timestep: float = 2e-3) -> mujoco.MjModel:
    """A compiled model of a scene, written in one of the ways of `USUAL`.

    Masses, inertias and geometry are the scene's, and stages that it does not need are left out; solref, solimp,
    cone, impratio, solver and flags of the constraint are MuJoCo's defaults.

    Raises:
      UnsupportedError: if MuJoCo has no such model.
    """
    rolling = USUAL[written]
    spec = specify(scene, rolling, integrator=integrator, timestep=timestep)
    option = spec.option
    option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    option.cone, option.impratio, option.tolerance = mujoco.mjtCone.mjCONE_PYRAMIDAL, 1.0, 1e-8
    constraint = spec.equality("rolling") if rolling == "equality" else spec.pair("rolling")
    constraint.solref, constraint.solimp = _SOLREF, _SOLIMP
    if written == "equality, hinge first":
        constraint.name1, constraint.name2 = constraint.name2, constraint.name1
        constraint.data[:5] = [0, 1 / scene.can.radius, 0, 0, 0]
    return compile_model(spec)
