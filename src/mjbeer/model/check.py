"""Compares the accelerations of a model with those of theory: a file may be edited."""

import copy
import functools
import hashlib
import math
import pathlib
import xml.etree.ElementTree as ET
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError
from mjbeer.model import mjcf_file
from mjbeer.model.joints import joint_addresses, rolling_coordinates, to_coordinates, to_states
from mjbeer.model.model_numbers import ModelNumbers
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import Rolling, Setting
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.equations import Coordinates, accelerations, select_samples
from mjbeer.theory.scene import Attachment, Scene

SHIPPED = pathlib.Path(__file__).with_name("shipped.sha256")
"""The SHA-256 of mjbeer's own mechanics files, which `make templates` writes. Their motions are
compared with theory in tests and searches, so that their runs need not be checked. Any other
file, even one with only another comment, is checked in every run, which takes longer."""
_ALLOWED = 1e-13
"""Largest difference of phi_ddot from theory that a model may have, divided by what `_rounding`
returns. In random scenes of all sizes, at 448 starts and in 408 runs, rounding takes up to 5e-15 of
that."""
_STATES = 1000
"""Number of states of a run, evenly spread, at which an edited file is checked, if it has more
samples and checkpoints: it takes some 10 ms, or 20 in contact. What stops a can, or pushes it back,
acts for longer than a thousandth of most runs."""


def check_file(folder: pathlib.Path, attachment: Attachment, rolling: Rolling) -> str | None:
    """Return what is wrong with a mechanics file, None if nothing is.

    As it stands it must have the numbers of the paper's can. With other numbers, those of a scene
    that needs all of its elements, it must have theory's accelerations.
    """
    massless = attachment == "frozen" or rolling == "reduced"
    can = Can.massless() if massless else Can.sheet_metal()
    scene = Scene(can, Load.segment(), attachment=attachment)
    paper = ModelNumbers(scene, Setting(rolling, mjcf=folder), visuals=True)
    return _check_content(paper, paper.structure.content)


@functools.lru_cache(maxsize=64)
def _check_content(paper: ModelNumbers, content: tuple[bytes, ...]) -> str | None:
    """Return what is wrong with the file of the paper's can.

    `content` is not read here: it makes the cache notice an edited file.
    """
    attachment = paper.scene.attachment
    damping = Damping(1e-3, 1e-4, 1e-5) if attachment == "sliding" else 0.0
    drag = 0.5 if attachment == "sliding" else 0.0
    can = Can(radius=0.05, length=0.1, mass=4.0, inertia=6e-3)
    load = Load(mass=0.3, offset=0.02, inertia=1e-4)
    other = Scene(can, load, 0.3, attachment, 5.0, damping, drag)
    root = mjcf_file.read(paper.path)
    edited = mjcf_file.differences(root, paper.parameters)
    mjcf_file.write(root, ModelNumbers(other, paper.setting, visuals=True).parameters, paper.path)
    fault = check_model(_compile(root, paper.path), other, paper.setting)
    if fault is not None:
        return f"{paper.path} {fault}"
    if edited:
        names = ", ".join(edited)
        return f"{paper.path} has other numbers than the paper; mjbeer writes a scene's own numbers into {names}"
    return None


def is_edited(numbers: ModelNumbers) -> bool:
    """Return whether the mechanics file of a scene differs from mjbeer's own, wherever it lies.

    Raises:
      TemplateError: if the file is missing or not readable.
    """
    return digest(numbers.structure.content) != _shipped_digests()[numbers.path.name]


def digest(content: tuple[bytes, ...]) -> str:
    """Return the SHA-256 of the content of a mechanics file and of what it includes."""
    return hashlib.sha256(b"".join(content)).hexdigest()


@functools.cache
def _shipped_digests() -> dict[str, str]:
    """Return the SHA-256 of mjbeer's own mechanics files, by their names."""
    rows = [line.split() for line in SHIPPED.read_text().splitlines()]
    return {name: value for value, name in rows}


def check_run(numbers: ModelNumbers, motion: Coordinates) -> None:
    """Compare a file that `is_edited` with theory at the states of a run.

    A limit or a wall may act only there.

    The `motion` must be in the order of time. The states that are compared include the last one,
    and the ends of the ranges of positions and rates. The model has the whole file, including what
    a model to be stepped leaves out.

    Raises:
      TemplateError: if the accelerations differ; the message names the file and the difference.
    """
    last = len(motion.time) - 1
    chosen = set(np.linspace(0, last, min(last + 1, _STATES)).astype(int).tolist())
    for values in (motion.u, motion.phi, motion.u_dot, motion.phi_dot):
        chosen |= {int(values.argmin()), int(values.argmax())}
    root = mjcf_file.read(numbers.path)
    mjcf_file.write(root, numbers.parameters, numbers.path)
    mjcf_file.remove(root, "keyframe")  # It is that of the file's own scene.
    model = _compile(root, numbers.path)
    states = select_samples(motion, sorted(chosen))
    fault = check_model(model, numbers.scene, numbers.setting, states)
    if fault is not None:
        raise TemplateError(f"{numbers.path} {fault}, in a state of this run")


def _compile(root: ET.Element, path: pathlib.Path) -> mujoco.MjModel:
    """Return the model in the tree of the file at a path."""
    try:
        return mjcf_file.parse_spec(root, path).compile()
    except ValueError as error:
        raise TemplateError(f"{path} is refused by MuJoCo: {mjcf_file.one_line(error)}") from error


def check_model(model: mujoco.MjModel, scene: Scene, setting: Setting, motion: Coordinates | None = None) -> str | None:
    """Return how a model differs from its scene, None if it does not.

    It must have the scene's joints, no constraint but that of rolling, and theory's accelerations
    at the states of a `motion`, which are taken as states of rolling without slipping, or at a few
    other states.
    """
    joints = tuple(joint_addresses(model))
    expected_joints = _joints(scene, setting.rolling)
    if joints != expected_joints:
        return f"gives the joints {', '.join(joints)}, not {', '.join(expected_joints)}"
    probes = _probes(scene) if motion is None else _rolling_states(scene, motion)
    equations = _evaluate(model, scene, setting.rolling, probes)
    if isinstance(equations, str):
        return equations
    found = _phi_ddot(model, scene, equations)
    _, expected = accelerations(scene, probes.phi, probes.phi_dot, probes.u_dot)
    size = np.abs(expected).max() + _typical_rate(scene) ** 2
    difference = np.abs(found - expected)
    if not np.all(difference <= _ALLOWED * _rounding(scene, setting.rolling, probes, size)):
        return f"accelerates phi by up to {difference.max():.3g} rad/s^2 (of {size:.3g}) otherwise than theory"
    if equations.warned:
        return "makes MuJoCo warn of a state of rolling"
    return None


def _joints(scene: Scene, rolling: Rolling) -> tuple[str, ...]:
    """Return the joints that the model of a scene has, in this order."""
    sliding = scene.attachment == "sliding"
    if rolling == "reduced":
        return ("slide", "phi") if sliding else ("phi",)
    joints = ["slide"]
    if rolling == "contact":
        joints.append("lift")
    joints.append("roll")
    if sliding:
        joints.append("swing")
    return tuple(joints)


def _typical_rate(scene: Scene) -> float:
    """Return the rate at which a can of this size swings [rad/s]."""
    return math.sqrt(max(scene.gravity, 1.0) / scene.can.radius)


def _probes(scene: Scene) -> Coordinates:
    """Return a few states of rolling, no two of which are mirror images or a quarter turn apart."""
    phi = np.array([-2.6, -0.7, 0.3, 1.1, 2.2])
    phi_dot = _typical_rate(scene) * np.array([2.0, -1.0, 0.5, 3.0, -2.0])
    roll = phi[::-1]
    roll_dot = phi_dot[::-1]
    if scene.attachment == "frozen":
        roll = phi
        roll_dot = phi_dot
    radius = scene.can.radius
    return rolling_coordinates(radius, radius * roll, radius * roll_dot, phi, phi_dot)


def _rolling_states(scene: Scene, motion: Coordinates) -> Coordinates:
    """Return the states of a motion as ones of rolling without slipping."""
    radius = scene.can.radius
    u = motion.u
    u_dot = motion.u_dot
    if scene.attachment == "frozen":
        u = radius * motion.phi
        u_dot = radius * motion.phi_dot
    return rolling_coordinates(radius, u, u_dot, motion.phi, motion.phi_dot)


class _Equations(NamedTuple):
    """The equations of motion of a model, inertias x accelerations = torques, at some states."""

    states: np.ndarray
    """Shape (states, nq + nv)."""
    inertias: np.ndarray
    """Mass matrices, shape (states, nv, nv)."""
    torques: np.ndarray
    """Forces of joints without those of constraints, shape (states, nv)."""
    warned: bool
    """Whether MuJoCo warned of a state."""


def _evaluate(model: mujoco.MjModel, scene: Scene, rolling: Rolling, probes: Coordinates) -> _Equations | str:
    """Return a model's equations of motion at states of rolling, or which constraint is wrong."""
    model = copy.copy(model)
    # "discrete" has changes over a whole step.
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    data = mujoco.MjData(model)
    states = to_states(model, probes)
    inertias = np.empty((len(states), model.nv, model.nv))
    torques = np.empty((len(states), model.nv))
    with quiet():
        for state, inertia, torque in zip(states, inertias, torques, strict=True):
            data.qpos[:] = state[: model.nq]
            data.qvel[:] = state[model.nq :]
            mujoco.mj_forward(model, data)
            fault = _check_constraints(model, data, rolling)
            if fault is not None:
                return fault
            mujoco.mj_fullM(model, data, inertia)
            torque[:] = data.qfrc_smooth
    return _Equations(states, inertias, torques, bool(np.any(data.warning.number)))


def _check_constraints(model: mujoco.MjModel, data: mujoco.MjData, rolling: Rolling) -> str | None:
    """Return which constraint is active besides that of rolling, None if there is none."""
    others = data.nf + data.nl
    expected_equalities = int(rolling == "equality")
    if data.ne != expected_equalities or (data.ncon > 0) != (rolling == "contact") or others > 0:
        return f"gives {data.nefc} rows of constraints, not only those of rolling"
    if rolling == "contact":
        pair = model.pair("rolling")
        rolling_geoms = {int(pair.geom1[0]), int(pair.geom2[0])}
        if not rolling_geoms.issuperset(data.contact.geom.ravel().tolist()):
            return "lets other geoms touch than the can and the incline"
    return None


def _phi_ddot(model: mujoco.MjModel, scene: Scene, equations: _Equations) -> np.ndarray:
    """Return phi_ddot [rad/s^2] of a can that rolls without any slip, shape (states,).

    MuJoCo's own accelerations are those of a constraint that may be soft.
    """
    radius = scene.can.radius
    # The rates of all joints in two motions of rolling, of the can alone and of the load alone; or
    # in one, of both.
    if scene.attachment == "sliding":
        can_rate = np.array([1.0, 0.0])
        load_rate = np.array([0.0, 1.0])
    else:
        can_rate = load_rate = np.ones(1)
    nowhere = 0 * can_rate
    motions = rolling_coordinates(radius, nowhere, radius * can_rate, nowhere, load_rate)
    rates = to_states(model, motions)[:, model.nq :]
    inertias = rates @ equations.inertias @ rates.T
    torques = equations.torques @ rates.T
    accelerations_of_joints = np.linalg.solve(inertias, torques[..., None])[..., 0] @ rates
    velocities = equations.states[:, model.nq :]
    slopes = np.concatenate([velocities, accelerations_of_joints], axis=1)
    return to_coordinates(model, scene, slopes, np.zeros(len(slopes))).phi_dot


def _rounding(scene: Scene, rolling: Rolling, probes: Coordinates, size: float) -> np.ndarray:
    """Return what the rounding of phi_ddot is in proportion to [rad/s^2], shape (states,).

    `size` is that of phi_ddot itself.
    """
    inertia = scene.oscillator.inertia(probes.phi)
    # MuJoCo computes torques from places in the world: the farther the can is from the origin, and
    # the heavier beside the inertia that they turn, the more digits of them are lost.
    rounding = size * (1 + np.abs(probes.roll)) * (1 + scene.mass * scene.can.radius**2 / inertia)
    if scene.oscillator.chord > 0 and rolling == "reduced":
        # The direction of the chord tendon, which has no length at phi = pi.
        rounding /= np.abs(np.cos(probes.phi / 2))
    # Damping takes the difference of two rates.
    rates = np.abs(probes.roll_dot) + np.abs(probes.phi_dot)
    slope = scene.damping_law.derivative(probes.roll_dot - probes.phi_dot)
    return rounding + slope * rates / inertia
