"""The accelerations of a compiled model beside those of theory, which those of an edited file may not be."""

import copy
import functools
import hashlib
import math
import pathlib
import xml.etree.ElementTree as ET

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError
from mjbeer.model import mjcf_file
from mjbeer.model.joints import joint_addresses, rolling_coordinates, to_coordinates, to_states
from mjbeer.model.mechanics import Mechanics
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import Rolling, Setting
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.equations import Coordinates, accelerations, select_samples
from mjbeer.theory.scene import Attachment, Scene

_ALLOWED = 1e-13
"""Largest difference of phi_ddot from theory's that a model may have, over the accelerations at those rates times what
makes rounding large, see `model_fault`. In random scenes of all sizes, at 448 starts and in 408 runs, rounding takes up
to 5e-15 of that."""
_STATES = 1000
"""Number of states of a run, evenly spread, at which an edited file is checked, if it has more samples and checkpoints:
it takes some 10 ms, or 20 in contact. What stops a can, or pushes it back, acts for longer than a thousandth of most
runs."""
_SHIPPED = {
    "frozen_contact": "7bb554856f4a037e9126f54c184bda5ecc493d0921542e3b6acddc3b09eaa0a9",
    "frozen_equality": "6b195dcc5bd739842db20f267ae5ea12f630c44899aee667b726310d9620fd5e",
    "frozen_reduced": "f8b6d4b3281d43fcd43884397a1d22aacbabadbaddc0e8ecd9a45c0d2ddacee3",
    "sliding_contact": "76728d244dfe95fd0f53eebac4ca31992782aab5eac7a1330fc4a5235e4de5fd",
    "sliding_equality": "5d3d03dd456f29ff115e96aa04c17909542066612767552a608b0c847f3aadee",
    "sliding_reduced": "f8f3133e7c58da07662f762ac34f834d5eaf21ac404f2ec8afa42ffc2d56a2cd",
}
"""The SHA-256 of mjbeer's own mechanics files, whose motions are compared with theory in tests and searches, so that
their runs need not be checked. To run another file, with a comment more, takes longer, and is no less right."""


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
    if fault := model_fault(_compiled(root, path), probe, setting):
        return f"{path} {fault}"
    if edited:
        return f"{path} has other numbers than the paper; mjbeer writes a scene's own numbers into {', '.join(edited)}"
    return None


def is_edited(mechanics: Mechanics) -> bool:
    """Return whether the mechanics file of a scene is another one than mjbeer's own, wherever it lies.

    Raises:
      TemplateError: if the file is missing or not readable.
    """
    return digest(mechanics) != _SHIPPED[mechanics.path.stem]


def digest(mechanics: Mechanics) -> str:
    """Return the SHA-256 of the content of a scene's mechanics file, and of what it includes."""
    return hashlib.sha256(b"".join(mjcf_file.content(mechanics.path))).hexdigest()


def check_run(mechanics: Mechanics, motion: Coordinates) -> None:
    """Compare a file that `is_edited` with theory at the states of a run: what acts there alone no other check meets.

    Of the motion, which must be in the order of time, the last state is among those that are compared, and so are the
    ends of its range, in positions and rates. The file is taken whole, with what is left out of a model to be stepped.

    Raises:
      TemplateError: if it does not move as theory says; the message names the file and the difference.
    """
    last = len(motion.time) - 1
    chosen = set(np.linspace(0, last, min(last + 1, _STATES)).astype(int).tolist())
    for values in (motion.u, motion.phi, motion.u_dot, motion.phi_dot):
        chosen |= {int(values.argmin()), int(values.argmax())}
    root = mjcf_file.read(mechanics.path)
    mjcf_file.write(root, mechanics.parameters, mechanics.path)
    mjcf_file.remove(root, "keyframe")  # of the file's own scene
    model = _compiled(root, mechanics.path)
    if fault := model_fault(model, mechanics.scene, mechanics.setting, select_samples(motion, sorted(chosen))):
        raise TemplateError(f"{mechanics.path} {fault}, in a state of this run")


def _compiled(root: ET.Element, path: pathlib.Path) -> mujoco.MjModel:
    """Return the model in the tree of the file at a path."""
    try:
        return mjcf_file.to_spec(root, path).compile()
    except ValueError as error:
        raise TemplateError(f"{path} is refused by MuJoCo: {'; '.join(str(error).splitlines())}") from error


def model_fault(model: mujoco.MjModel, scene: Scene, setting: Setting, motion: Coordinates | None = None) -> str | None:
    """Return how a model moves otherwise than its scene, None if it does not.

    It must have the scene's joints, no constraint but that of rolling, and theory's accelerations at the states of a
    motion, taken as ones of rolling without slipping, or at a few others.
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
    if motion is None:
        phi = np.array([-2.6, -0.7, 0.3, 1.1, 2.2])  # no two are each other's mirror image, or a quarter turn apart
        phi_dot = rate * np.array([2.0, -1.0, 0.5, 3.0, -2.0])
        roll, roll_dot = phi[::-1], phi_dot[::-1]
    else:
        phi, phi_dot = motion.phi, motion.phi_dot
        roll, roll_dot = motion.u / radius, motion.u_dot / radius
    if not sliding:
        roll, roll_dot = phi, phi_dot
    states = to_states(model, rolling_coordinates(radius, radius * roll, radius * roll_dot, phi, phi_dot))
    # The rates of all joints in motions that roll without slipping: of the can, and of the load; or of both as one.
    can, load = np.eye(2) if sliding else np.ones((2, 1))
    rolls = to_states(model, rolling_coordinates(radius, 0 * can, radius * can, 0 * load, load))[:, model.nq :]
    data = mujoco.MjData(model)
    inertias, torques = np.empty((len(states), model.nv, model.nv)), np.empty((len(states), model.nv))
    touching = set(model.pair("rolling").geom1) | set(model.pair("rolling").geom2) if rolling == "contact" else set()
    with quiet():
        for state, inertia, torque in zip(states, inertias, torques, strict=True):
            data.qpos[:] = state[: model.nq]
            data.qvel[:] = state[model.nq :]
            mujoco.mj_forward(model, data)
            if (data.ne, data.ncon > 0, data.nf + data.nl) != (int(rolling == "equality"), rolling == "contact", 0):
                return f"gives {data.nefc} rows of constraints, not only those of rolling"
            if not touching.issuperset(data.contact.geom.ravel()):
                return "lets other geoms touch than the can and the incline"
            mujoco.mj_fullM(model, data, inertia)
            torque[:] = data.qfrc_smooth
    # MuJoCo's own qacc is that of a soft constraint, which is allowed; these are without any slip.
    found = np.linalg.solve(rolls @ inertias @ rolls.T, (torques @ rolls.T)[..., None])[..., 0] @ rolls
    slopes = np.concatenate([states[:, model.nq :], found], axis=1)
    _, right = accelerations(scene, phi, phi_dot, radius * roll_dot)
    difference = np.abs(to_coordinates(model, scene, slopes, phi).phi_dot - right)
    size = np.abs(right).max() + rate**2
    # MuJoCo computes torques from places in the world: the farther the can is from the origin, and the heavier beside
    # the inertia that they turn, the more digits of them are lost.
    inertia_of_phi = scene.oscillator.inertia(phi)
    rounding = size * (1 + np.abs(roll)) * (1 + scene.mass * radius**2 / inertia_of_phi)
    if scene.oscillator.chord > 0 and rolling == "reduced":
        # The direction of the chord tendon, which has no length at phi = pi.
        rounding /= np.abs(np.cos(phi / 2))
    # Damping takes the difference of two rates.
    rates = np.abs(roll_dot) + np.abs(phi_dot)
    rounding += scene.damping_law.derivative(roll_dot - phi_dot) * rates / inertia_of_phi
    if not np.all(difference <= _ALLOWED * rounding):
        return f"accelerates phi by up to {difference.max():.3g} rad/s^2 (of {size:.3g}) otherwise than theory"
    return "makes MuJoCo warn of a state of rolling" if np.any(data.warning.number) else None
