"""Loads MJCF with other tools, and moves it for a second: `python consumers.py TOOL FILE...` in the tool's own Python.

It prints one JSON object, which has for every file phi [rad] after the second, or the reason why there is none. It
imports nothing of mjbeer's, which is not installed there.
"""

import json
import sys
from collections.abc import Callable, Mapping

DURATION = 1.0
"""How long a model is moved [s]."""


def phi(positions: Mapping[str, float]) -> float:
    """Return phi from the positions of the joints by name, which are 0 for joints that a tool has dropped."""
    return positions.get("phi", positions.get("roll", 0.0) + positions.get("swing", 0.0))


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
    return {
        model.joint(each).name: float(qpos[model.joint(each).qposadr[0]])
        for each in range(model.njnt)
    }  # ty: ignore


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
        return jax.tree.map(
            lambda old, new: new.astype(old.dtype), before, mjx.step(device_model, before)
        )

    move = jax.jit(
        lambda first: jax.lax.fori_loop(0, round(DURATION / model.opt.timestep), step, first)
    )
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


TOOLS: dict[str, Callable[[str], float]] = {
    "mujoco": with_mujoco,
    "mjx": with_mjx,
    "mjx-single": with_mjx_single,
    "warp": with_warp,
    "dm_control": with_dm_control,
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
