"""The accelerations of a compiled model beside those of theory, which those of an edited file may not be."""

import copy
import functools
import math
import pathlib

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError
from mjbeer.model import mjcf_file
from mjbeer.model.joints import joint_addresses, rolling_coordinates, to_coordinates, to_states
from mjbeer.model.mechanics import Mechanics
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import Rolling, Setting
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.equations import accelerations
from mjbeer.theory.scene import Attachment, Scene

_ALLOWED = 1e-9
"""Largest difference of phi_ddot from theory's that a model may have, over the accelerations at those rates. With
the can above the origin and a board that is tilted, rounding takes up to 1e-13 in random scenes of all sizes."""


def file_fault(folder: pathlib.Path, attachment: Attachment, rolling: Rolling) -> str | None:
    """Return what is wrong with a mechanics file, None if nothing is: as it stands, and with other numbers in it.

    As it stands it must be the paper's can. The other numbers are those of a scene that needs all that is in it.
    """
    metal = Can.sheet_metal() if attachment == "sliding" and rolling != "reduced" else Can.massless()
    paper = Mechanics(Scene(metal, Load.segment(), attachment=attachment), Setting(rolling, mjcf=folder), visuals=True)
    return _file_fault(paper, mjcf_file.content(paper.path))


@functools.lru_cache(maxsize=64)
def _file_fault(paper: Mechanics, content: tuple[bytes, ...]) -> str | None:
    """Return what is wrong with the file of the paper's can, which has this content."""
    attachment, setting = paper.scene.attachment, paper.setting
    damping = (Damping(1e-3, 1e-4, 1e-5), 0.5) if attachment == "sliding" else ()
    probe = Scene(Can(0.05, 0.1, 4.0, 6e-3), Load(0.3, 0.02, 1e-4), 0.3, attachment, 5.0, *damping)
    path, root = paper.path, mjcf_file.read(paper.path)
    edited = mjcf_file.differences(root, paper.parameters)
    mjcf_file.write(root, Mechanics(probe, setting, visuals=True).parameters, path)
    try:
        model = mjcf_file.to_spec(root, path).compile()
    except ValueError as error:
        raise TemplateError(f"{path} is refused by MuJoCo: {'; '.join(str(error).splitlines())}") from error
    if fault := model_fault(model, probe, setting):
        return f"{path} {fault}"
    if edited:
        return f"{path} has other numbers than the paper; mjbeer writes a scene's own numbers into {', '.join(edited)}"
    return None


def model_fault(model: mujoco.MjModel, scene: Scene, setting: Setting) -> str | None:
    """Return how a model moves otherwise than its scene, None if it does not.

    It must have the scene's joints, no constraint but that of rolling, and theory's accelerations at a few states.
    """
    rolling, sliding, radius = setting.rolling, scene.attachment == "sliding", scene.can.radius
    if rolling == "reduced":
        joints = ("slide", "phi") if sliding else ("phi",)
    else:
        joints = ("slide", *(("lift",) if rolling == "contact" else ()), "roll", *(("swing",) if sliding else ()))
    if (there := tuple(joint_addresses(model))) != joints:
        return f"gives the joints {', '.join(there)}, not {', '.join(joints)}"
    model = copy.copy(model)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4  # "discrete" has changes over a whole step
    rate = math.sqrt(max(scene.gravity, 1.0) / radius)
    phi = np.array([-2.6, -0.7, 0.3, 1.1, 2.2])  # no two are each other's mirror image, or a quarter turn apart
    phi_dot = rate * np.array([2.0, -1.0, 0.5, 3.0, -2.0])
    roll, roll_dot = (phi[::-1], phi_dot[::-1]) if sliding else (phi, phi_dot)
    states = to_states(model, rolling_coordinates(radius, radius * roll, radius * roll_dot, phi, phi_dot))
    # The rates of all joints in motions that roll without slipping: of the can, and of the load; or of both as one.
    can, load = np.eye(2) if sliding else np.ones((2, 1))
    rolls = to_states(model, rolling_coordinates(radius, 0 * can, radius * can, 0 * load, load))[:, model.nq :]
    found, data, inertia = [], mujoco.MjData(model), np.empty((model.nv, model.nv))
    for state in states:
        data.qpos[:], data.qvel[:] = np.split(state, 2)
        with quiet():
            mujoco.mj_forward(model, data)
        if (data.ne, data.ncon > 0, data.nf + data.nl) != (int(rolling == "equality"), rolling == "contact", 0):
            return f"gives {data.nefc} rows of constraints, not only those of rolling"
        mujoco.mj_fullM(model, data, inertia)
        # MuJoCo's own qacc is that of a soft constraint, which is allowed; these are without any slip.
        found.append(np.linalg.solve(rolls @ inertia @ rolls.T, rolls @ data.qfrc_smooth) @ rolls)
    slopes = np.concatenate([states[:, model.nq :], found], axis=1)
    _, right = accelerations(scene, phi, phi_dot, radius * roll_dot)
    difference = np.abs(to_coordinates(model, scene, slopes, phi).phi_dot - right).max()
    size = np.abs(right).max() + rate**2
    if not difference <= _ALLOWED * size:
        return f"accelerates phi by up to {difference:.3g} rad/s^2 (of {size:.3g}) otherwise than theory"
    return "makes MuJoCo warn of a state of rolling" if np.any(data.warning.number) else None
