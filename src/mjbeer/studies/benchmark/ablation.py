"""What the stages of a step cost a scene that does not need them."""

import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import mujoco
import numpy as np
from mujoco import rollout

from mjbeer.model import state
from mjbeer.model.build import build
from mjbeer.model.engine import quiet, untimed
from mjbeer.studies.cases import CASES

_STEPS, _REPEATS = 4000, 7
_DISABLE = mujoco.mjtDisableBit
_STAGES = {
    "contact": _DISABLE.mjDSBL_CONTACT,
    "constraint": _DISABLE.mjDSBL_CONSTRAINT | _DISABLE.mjDSBL_EQUALITY | _DISABLE.mjDSBL_WARMSTART,
    "sensor": _DISABLE.mjDSBL_SENSOR,
    "actuation": _DISABLE.mjDSBL_ACTUATION,
}


def ablate() -> list[dict[str, Any]]:
    """For each case and two integrators, the time of a step with one more stage over that of a step without.

    "clock" is MuJoCo's statistics of its own run time, "visuals" a model that can be drawn; "everything" is the
    model that can be drawn, with the clock and all of MuJoCo's stages. Interleaved, least of seven.
    """
    rows = []
    for name in ("sliding", "frozen", "pendulum"):
        for integrator in ("Euler", "RK4"):
            loops = _loops(name, integrator)
            times = {stage: [] for stage in loops}
            for _ in range(_REPEATS):
                for stage, loop in loops.items():
                    begin = time.perf_counter()
                    loop()
                    times[stage].append(time.perf_counter() - begin)
            least = {stage: min(each) for stage, each in times.items()}
            ratios = {stage: each / least["nothing"] for stage, each in least.items() if stage != "nothing"}
            rows.append({"case": name, "integrator": integrator, "step": least["nothing"] / _STEPS, **ratios})
    return rows


def _loops(name: str, integrator: str) -> dict[str, Callable[[], tuple[np.ndarray, np.ndarray]]]:
    case = CASES[name]
    lean = build(case.scene, integrator=integrator)
    loops = {"nothing": _loop(name, lean)}
    for stage, flags in _STAGES.items():
        model = build(case.scene, integrator=integrator)
        if not model.opt.disableflags & int(flags):
            continue  # it needs that one
        model.opt.disableflags &= ~int(flags)
        loops[stage] = _loop(name, model)
    loops["clock"] = _loop(name, lean, nullcontext)
    loops["visuals"] = _loop(name, _drawable(name, integrator, lean.opt.disableflags))
    loops["everything"] = _loop(name, _drawable(name, integrator, 0), nullcontext)
    return loops


def _drawable(name: str, integrator: str, disabled: int) -> mujoco.MjModel:
    model = build(CASES[name].scene, visuals=True, integrator=integrator)
    model.opt.disableflags = disabled
    return model


def _loop(
    name: str, model: mujoco.MjModel, watch: Callable[[], AbstractContextManager[None]] = untimed
) -> Callable[[], tuple[np.ndarray, np.ndarray]]:
    data, full = mujoco.MjData(model), np.zeros((1, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    start = state.start(model, CASES[name].scene, CASES[name].phi0, 0.0)
    full[0, 1 : 1 + len(start)] = start

    def loop() -> tuple[np.ndarray, np.ndarray]:
        with quiet(), watch(), rollout.Rollout(nthread=0) as pool:
            return pool.rollout(model, [data], full, nstep=_STEPS)

    return loop
