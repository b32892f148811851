"""Compares a model that was read back from MJCF with the one that was written."""

from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np

from mjbeer.exceptions import MjbeerError

_INERTIALS = ("body_mass", "body_inertia", "body_ipos", "body_iquat")
"""Arrays that a body without mass may lack in a portable model."""
_BODIES = ("body_pos", "body_quat")
"""Arrays that depend on which body a body is in."""
_EXACT = (
    "jnt_axis", "dof_armature", "dof_damping", "dof_dampingpoly", "tendon_armature", "tendon_damping",
    "tendon_dampingpoly", "wrap_prm", "actuator_gainprm", "actuator_biasprm", "eq_data", "eq_solref", "eq_solimp",
    "pair_friction", "pair_solref", "pair_solimp", "key_qpos", "key_qvel",
)  # fmt: skip
"""Arrays that are the same in whatever bodies the model has."""
_OPTIONS = ("timestep", "integrator", "gravity", "cone", "impratio", "enableflags", "disableflags")
_LEFT_OUT = float(np.finfo(float).eps)
"""Largest difference that is allowed. MuJoCo does not write a number that is this near to its default, such as a force
of 1e-16 N. The numbers that it writes are read back to the last bit, except quaternions, which it normalizes again."""
_POSES = (
    "geom_xpos", "geom_xmat", "site_xpos", "site_xmat", "cam_xpos", "cam_xmat", "light_xpos", "light_xdir",
)  # fmt: skip
"""Arrays of positions and orientations in the world."""
_ROUNDING = 1e-14
"""Largest difference of two poses, relative to the largest number among them. A pose is the product of at most five
others, each rounded a few times by 1e-16."""


def require_same(built: mujoco.MjModel, reread: mujoco.MjModel) -> None:
    """Check that the model that was read back is the one that was built.

    Raises:
      MjbeerError: if it is not; the message has the first number that differs.
    """
    _compare(_numbers(built, (*_INERTIALS, *_BODIES, *_EXACT)), _numbers(reread, (*_INERTIALS, *_BODIES, *_EXACT)))
    _compare(_options(built), _options(reread))


def require_same_motion(reread: mujoco.MjModel, portable: mujoco.MjModel) -> None:
    """Check that a portable model, which has fewer bodies, moves as the other one does, and looks like it.

    Its bodies have the same inertias, and no mass is missing. Its joints, constraints and options are the same, and
    everything is at the same place in two positions of the joints.

    Raises:
      MjbeerError: if it is not so; the message has the first number that differs.
    """
    kept = [reread.body(portable.body(body).name).id for body in range(portable.nbody)]
    before = {name: getattr(reread, name)[kept] for name in _INERTIALS}
    _compare(before.items(), _numbers(portable, _INERTIALS))
    _compare([("mass", reread.body_mass.sum())], [("mass", portable.body_mass.sum())])
    _compare(_numbers(reread, _EXACT), _numbers(portable, _EXACT))
    _compare(_options(reread), _options(portable))
    for qpos in (reread.qpos0, reread.qpos0 + 0.5):
        _compare(_poses(reread, qpos), _poses(portable, qpos), _ROUNDING)


def _numbers(model: mujoco.MjModel, names: Iterable[str]) -> list[tuple[str, Any]]:
    return [(name, getattr(model, name)) for name in names]


def _options(model: mujoco.MjModel) -> list[tuple[str, Any]]:
    return [(f"option {name}", getattr(model.opt, name)) for name in _OPTIONS]


def _poses(model: mujoco.MjModel, qpos: np.ndarray) -> list[tuple[str, Any]]:
    """Return where everything is that belongs to a body, at joint positions `qpos` of shape (nq,)."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    return [(name, getattr(data, name)) for name in _POSES]


def _compare(before: Iterable[tuple[str, Any]], after: Iterable[tuple[str, Any]], rounding: float = 0.0) -> None:
    """Raise an MjbeerError for the first number that differs by more than `rounding` times the largest one."""
    for (name, old), (_, new) in zip(before, after, strict=True):
        allowed = _LEFT_OUT + rounding * np.abs(old).max(initial=0.0)
        if np.shape(old) != np.shape(new) or not np.allclose(old, new, rtol=0, atol=allowed):
            raise MjbeerError(f"the MJCF written is not the model: {name} is {new}, not {old}")
