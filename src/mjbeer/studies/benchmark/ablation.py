"""How much longer a step takes with stages of MuJoCo that the scene does not need."""

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
from mjbeer.model.setting import Integrator
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
    """Return a row for each of three cases and two integrators: run times of a step with a stage that it does not need.

    "step" is the time [s] of a step without such stages; the others are ratios to it, by the name of the stage. "clock"
    is MuJoCo's statistics of its own run time, "visuals" a model with geoms to be drawn, and "everything" that model
    with the clock and all stages. The stages take turns, and of seven run times each the least is taken.
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
            least = {stage: min(seconds) for stage, seconds in times.items()}
            ratios = {stage: seconds / least["nothing"] for stage, seconds in least.items() if stage != "nothing"}
            rows.append({"case": name, "integrator": integrator, "step": least["nothing"] / _STEPS, **ratios})
    return rows


def _loops(name: str, integrator: Integrator) -> dict[str, Callable[[], tuple[np.ndarray, np.ndarray]]]:
    """Return a function for each stage that runs `_STEPS` steps of a case with it; "nothing" is without any."""
    case = CASES[name]
    lean = build(case.scene, integrator=integrator)
    loops = {"nothing": _loop(name, lean)}
    for stage, flags in _STAGES.items():
        model = build(case.scene, integrator=integrator)
        if not model.opt.disableflags & int(flags):
            continue  # the model needs this stage
        model.opt.disableflags &= ~int(flags)
        loops[stage] = _loop(name, model)
    loops["clock"] = _loop(name, lean, nullcontext)
    loops["visuals"] = _loop(name, _drawable(name, integrator, lean.opt.disableflags))
    loops["everything"] = _loop(name, _drawable(name, integrator, 0), nullcontext)
    return loops


def _drawable(name: str, integrator: Integrator, disabled: int) -> mujoco.MjModel:
    """Return the model of a case with geoms to be drawn, with the stages in the flags `disabled`."""
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
