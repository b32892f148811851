"""Loads MJCF with other tools, and moves it for a second: `python consumers.py TOOL FILE...` in the tool's own Python.

It prints one JSON object, which has for every file phi [rad] after the second, or the reason why there is none. It
imports nothing of mjbeer's, which is not installed there. Tools without MuJoCo's keyframes get the start from the text.
"""

import json
import sys
import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping

DURATION = 1.0
"""How long a model is moved [s]."""


def phi(positions: Mapping[str, float]) -> float:
    """Return phi from the positions of the joints by name, which are 0 for joints that a tool has dropped."""
    return positions.get("phi", positions.get("roll", 0.0) + positions.get("swing", 0.0))


def start(path: str) -> tuple[dict[str, tuple[float, float]], float]:
    """Return position and rate of every joint by name in the keyframe, and the timestep [s]."""
    root = ET.parse(path).getroot()
    key, option, world = root.find("keyframe/key"), root.find("option"), root.find("worldbody")
    assert key is not None
    assert option is not None
    assert world is not None
    names = [joint.attrib["name"] for joint in world.iter("joint")]
    zeros = " ".join("0" for _ in names)
    places, rates = (map(float, key.get(name, zeros).split()) for name in ("qpos", "qvel"))
    return dict(zip(names, zip(places, rates, strict=True), strict=True)), float(option.attrib["timestep"])


def with_mujoco(path: str) -> float:
    """MuJoCo of whatever version is installed."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    for _ in range(round(DURATION / model.opt.timestep)):
        mujoco.mj_step(model, data)
    return phi(by_name(model, data.qpos))


def by_name(model: object, qpos: object) -> dict[str, float]:
    """Return the positions of the joints of a MuJoCo model by name."""
    return {model.joint(each).name: float(qpos[model.joint(each).qposadr[0]]) for each in range(model.njnt)}  # ty: ignore


def with_dm_control(path: str) -> float:
    """dm_control's own parser, and its physics."""
    from dm_control import mjcf

    physics = mjcf.Physics.from_mjcf_model(mjcf.from_path(path))
    physics.reset(keyframe_id=0)
    for _ in range(round(DURATION / physics.timestep())):
        physics.step()
    names = [physics.model.joint(each).name.split("/")[-1] for each in range(physics.model.njnt)]
    return phi(dict(zip(names, map(float, physics.data.qpos), strict=True)))


def with_mjx(path: str) -> float:
    """MJX in double precision, on the CPU."""
    import jax

    jax.config.update("jax_enable_x64", True)
    return with_mjx_single(path)


def with_mjx_single(path: str) -> float:
    """MJX as it is by default, in single precision, on the CPU."""
    import jax
    import mujoco
    from mujoco import mjx

    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    device_model, state = mjx.put_model(model), mjx.put_data(model, data)

    def step(_: int, before: object) -> object:
        # A spatial tendon's whole numbers come out with 64 bits, which a loop of JAX's does not accept.
        return jax.tree.map(lambda old, new: new.astype(old.dtype), before, mjx.step(device_model, before))

    move = jax.jit(lambda first: jax.lax.fori_loop(0, round(DURATION / model.opt.timestep), step, first))
    return phi(by_name(model, move(state).qpos))


def with_warp(path: str) -> float:
    """mujoco_warp, on the CPU, in single precision, which is all that it has."""
    import mujoco
    import mujoco_warp
    import warp

    warp.config.quiet = True
    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_forward(model, data)
    device_model, state = mujoco_warp.put_model(model), mujoco_warp.put_data(model, data)
    for _ in range(round(DURATION / model.opt.timestep)):
        mujoco_warp.step(device_model, state)
    return phi(by_name(model, state.qpos.numpy()[0]))


def with_drake(path: str) -> float:
    """Drake, with its integrator of third order to 1e-10."""
    import logging

    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
    from pydrake.systems.framework import DiagramBuilder

    logging.getLogger("drake").setLevel(logging.ERROR)  # it warns of each thing that it ignores
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=0.0)
    Parser(plant).AddModels(path)
    plant.Finalize()
    diagram = builder.Build()
    simulator = Simulator(diagram)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", max_step_size=1e-3).set_target_accuracy(1e-10)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    joints = {name: plant.GetJointByName(name) for name in start(path)[0]}
    places, rates = plant.GetPositions(context), plant.GetVelocities(context)
    for name, values in start(path)[0].items():
        places[joints[name].position_start()], rates[joints[name].velocity_start()] = values
    plant.SetPositions(context, places)
    plant.SetVelocities(context, rates)
    simulator.AdvanceTo(DURATION)
    return phi({name: float(joint.GetOnePosition(context)) for name, joint in joints.items()})


def with_pinocchio(path: str) -> float:
    """Pinocchio's forward dynamics, in the Runge-Kutta method of fourth order, as Pinocchio has no integrator."""
    import numpy as np
    import pinocchio

    model = pinocchio.buildModelFromMJCF(path)
    model = model[0] if isinstance(model, tuple) else model
    data = model.createData()
    joints, h = start(path)
    state = np.array(list(joints.values())).T.ravel()
    half, zero = len(joints), np.zeros(len(joints))

    def rate(now: np.ndarray) -> np.ndarray:
        return np.concatenate([now[half:], pinocchio.aba(model, data, now[:half], now[half:], zero)])

    for _ in range(round(DURATION / h)):
        first = rate(state)
        second = rate(state + h / 2 * first)
        third = rate(state + h / 2 * second)
        state = state + h / 6 * (first + 2 * second + 2 * third + rate(state + h * third))
    return phi(dict(zip(joints, map(float, state[:half]), strict=True)))


def with_pybullet(path: str) -> float:
    """PyBullet, without its damping and its motors."""
    import pybullet

    if not pybullet.isConnected():
        pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, -9.81)  # it does not read the file's
    joints, timestep = start(path)
    pybullet.setTimeStep(timestep)
    body = pybullet.loadMJCF(path)[-1]
    found = {pybullet.getJointInfo(body, each)[1].decode(): each for each in range(pybullet.getNumJoints(body))}
    for name, each in found.items():
        pybullet.setJointMotorControl2(body, each, pybullet.VELOCITY_CONTROL, force=0)
        pybullet.changeDynamics(body, each, linearDamping=0, angularDamping=0, jointDamping=0)
        pybullet.resetJointState(body, each, *joints.get(name, (0.0, 0.0)))
    for _ in range(round(DURATION / timestep)):
        pybullet.stepSimulation()
    if missing := sorted({"phi", "roll", "swing"} & set(joints) - set(found)):
        raise ValueError(f"it has dropped the joint {missing[0]}")
    return phi({name: pybullet.getJointState(body, each)[0] for name, each in found.items()})


TOOLS: dict[str, Callable[[str], float]] = {
    "mujoco": with_mujoco,
    "mjx": with_mjx,
    "mjx-single": with_mjx_single,
    "warp": with_warp,
    "dm_control": with_dm_control,
    "drake": with_drake,
    "pinocchio": with_pinocchio,
    "pybullet": with_pybullet,
}
"""The tools, by the word for the command line."""


def attempt(move: Callable[[str], float], path: str) -> float | str:
    """Return phi, or the first line of the reason why there is none."""
    try:
        return move(path)
    except Exception as error:
        return f"{type(error).__name__}: {str(error).strip().splitlines()[0][:120] if str(error).strip() else ''}"


if __name__ == "__main__":
    print("\n" + json.dumps({path: attempt(TOOLS[sys.argv[1]], path) for path in sys.argv[2:]}))
