"""Many scenes at once: `mjbeer.sweep`, MuJoCo's RK4 with a timestep for each scene, and heyoka, at equal error."""

import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import mujoco
import numpy as np

from mjbeer.exceptions import ToleranceError
from mjbeer.model import state
from mjbeer.model.build import build
from mjbeer.model.engine import quiet, untimed
from mjbeer.studies.benchmark import peers
from mjbeer.studies.benchmark.peers import Motion
from mjbeer.studies.sweep.run import sweep
from mjbeer.theory.exact import exact
from mjbeer.theory.named import sliding

TOLERANCE = 1e-6
"""Error of phi and u/a at the end that every scene must keep [rad], relative beyond 1 rad."""
_DURATION, _START = 2.0, 1.0
_INCLINES, _FILLS = np.radians(np.linspace(1, 30, 100)), np.linspace(0.05, 0.95, 100)
_SEED = 16
_STEPS = 400
"""Timesteps a small period with which the search for a scene's timestep begins."""
_SEARCHED = 8
"""Timesteps that are tried for each scene: the order of RK4 leads from one to the next, within a few per cent."""
_MARGIN = 1.02
_LOCAL = 1e-7
"""Tolerance of heyoka's steps; with 1e-6 the largest error of 200 scenes is twice `TOLERANCE`."""


class Sample:
    """Some of 10,000 scenes of sliding beer, from rest, with their exact ends and models for MuJoCo's RK4."""

    def __init__(self, count: int) -> None:
        draw = np.random.default_rng(_SEED)
        self.threads = os.cpu_count() or 1
        self.inclines, self.fills = draw.choice(_INCLINES, count), draw.choice(_FILLS, count)
        self.scenes = [sliding(float(tilt), float(fill)) for tilt, fill in zip(self.inclines, self.fills, strict=True)]
        ends = [exact(scene, [_DURATION], _START) for scene in self.scenes]
        self._phi, self._u = np.array([[end.phi[0], end.u[0]] for end in ends]).T
        self._radius = np.array([scene.can.radius for scene in self.scenes])
        self.periods = np.array([_DURATION * scene.frequency() / (2 * np.pi) for scene in self.scenes])
        """The duration in small periods of each scene."""
        self._models = [build(scene) for scene in self.scenes]
        self._data = [mujoco.MjData(model) for model in self._models]

    def errors(self, motion: Motion) -> np.ndarray:
        """Return the error [rad] of each scene at its end, relative where the angle exceeds 1 rad."""
        of_phi = np.abs(motion[0] - self._phi) / np.maximum(1, np.abs(self._phi - _START))
        return np.maximum(of_phi, np.abs(motion[1] - self._u) / np.maximum(self._radius, np.abs(self._u)))

    def by_sweep(self) -> Motion:
        """Return the ends by `mjbeer.sweep`, to the tolerance, in its default threads."""
        scenes: dict[str, Any] = {"incline": self.inclines, "fill": self.fills}
        swept = sweep(sliding, _DURATION, _START, paired=True, tolerance=TOLERANCE, progress=False, **scenes)
        return swept["phi"], swept["u"]

    def by_rk4(self, steps: np.ndarray) -> Motion:
        """Return the ends by MuJoCo's RK4 with a number of timesteps for each scene, in as many threads as cores.

        `mujoco.rollout` and `mujoco.batch` step all scenes equally often; this loop is as fast as theirs. MuJoCo's
        clock is off, which halves its time.
        """

        def step(scene: int) -> np.ndarray:
            model, data = self._models[scene], self._data[scene]
            model.opt.timestep = _DURATION / steps[scene]
            begin = state.start(model, self.scenes[scene], _START, 0.0)
            mujoco.mj_resetData(model, data)
            data.qpos[:], data.qvel[:] = begin[: model.nq], begin[model.nq :]
            mujoco.mj_step(model, data, int(steps[scene]))
            return data.qpos

        with quiet(), untimed(), ThreadPoolExecutor(self.threads) as executor:
            ends = np.array(list(executor.map(step, range(len(self.scenes)))))
        joints = state.places(self._models[0])
        return ends[:, joints["phi"]], ends[:, joints["slide"]]

    def steps(self) -> np.ndarray:
        """Return the least numbers of timesteps, within some per cent, with which RK4 keeps the tolerance.

        Raises:
          ToleranceError: if it does not in some scene.
        """
        tried, best = np.ceil(_STEPS * self.periods), np.full(len(self.scenes), np.inf)
        for _ in range(_SEARCHED):
            errors = self.errors(self.by_rk4(tried))
            best = np.where(errors <= TOLERANCE, np.minimum(best, tried), best)
            tried = np.ceil(_MARGIN * tried * np.clip(errors / TOLERANCE, 1e-3, 1e3) ** 0.25)
        if not np.isfinite(best).all():
            raise ToleranceError(f"RK4 does not reach {TOLERANCE:g} rad in {np.isinf(best).sum()} scenes")
        return best


def compare(quick: bool) -> dict[str, Any]:
    """Return the time of a scene [s] and the largest error [rad] of each way to simulate many scenes, in rounds.

    RK4 is timed twice: with the timestep that is best for each scene, which only exact theory knows, and with the same
    share of each scene's small period, a rule that one can follow. Models and integrators are compiled before.

    Raises:
      ToleranceError: if RK4 does not reach the tolerance.
    """
    sample, rounds = Sample(50 if quick else 200), 2 if quick else 5
    best = sample.steps()
    share = float((best / sample.periods).max())
    ways: dict[str, Callable[[], Motion]] = {
        "mjbeer.sweep": sample.by_sweep,
        "MuJoCo RK4, best timestep of each scene": lambda: sample.by_rk4(best),
        f"MuJoCo RK4, {share:.0f} timesteps a small period": lambda: sample.by_rk4(np.ceil(share * sample.periods)),
    }
    if not peers.absent():
        ways["heyoka's ensemble, equations by hand"] = peers.ensemble(sample.scenes, _START, _DURATION, _LOCAL)
    errors = {name: float(sample.errors(way()).max()) for name, way in ways.items()}  # and warms caches
    seconds = dict.fromkeys(ways, float("inf"))
    for _ in range(rounds):
        for name, way in ways.items():
            begin = time.perf_counter()
            way()
            seconds[name] = min(seconds[name], (time.perf_counter() - begin) / len(sample.scenes))
    return {"ways": [{"name": name, "seconds": seconds[name], "error": errors[name]} for name in ways]}
