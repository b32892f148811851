"""How long a scene of a sweep takes, beside `mujoco.batch` with RK4 at a timestep that is as exact, and heyoka.

`python -m mjbeer.studies.sweep.speed` measures it on the scenes of `docs/sweeps.md`.
"""

import math
import os
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from mujoco.batch import Batch

from mjbeer.exceptions import ToleranceError
from mjbeer.model import state
from mjbeer.model.build import build
from mjbeer.output import processes, terminal
from mjbeer.output.terminal import Table
from mjbeer.studies.sweep.ensemble import Propagate, ensemble, installed
from mjbeer.studies.sweep.run import sweep
from mjbeer.theory.exact import exact
from mjbeer.theory.named import sliding

TOLERANCE = 1e-6
"""Error of phi and u/a that every scene must keep [rad], relative beyond 1 rad."""
_DURATION, _START = 2.0, 1.0
_INCLINES, _FILLS = np.radians(np.linspace(1, 30, 100)), np.linspace(0.05, 0.95, 100)
_SEED = 16
_FEWEST, _MOST = 2000, 64_000
"""Smallest number of timesteps of RK4 that is tried, and the largest."""
_REFINED = 2
"""How often the range between too few timesteps and enough of them is halved; at first it is a factor of 2."""
_LOCAL = 1e-7
"""Tolerance of heyoka's steps; with 1e-6 the largest error of 200 scenes is twice `TOLERANCE`."""
_ROUNDS = 4
"""Times that each way is timed, one after the other; the shortest counts."""


class Sample:
    """Some of 10,000 scenes of sliding beer, with their exact motions at the end."""

    def __init__(self, count: int) -> None:
        draw = np.random.default_rng(_SEED)
        self.inclines, self.fills = draw.choice(_INCLINES, count), draw.choice(_FILLS, count)
        self.scenes = [sliding(*each) for each in zip(self.inclines, self.fills, strict=True)]
        ends = [exact(scene, [_DURATION], _START) for scene in self.scenes]
        self._radius = np.array([scene.can.radius for scene in self.scenes])
        self._phi, self._u = np.array([[end.phi[0], end.u[0]] for end in ends]).T

    def error(self, phi: np.ndarray, u: np.ndarray) -> float:
        """Return the largest error [rad] of all scenes, relative where the angle exceeds 1 rad, for their ends."""
        of_phi = np.abs(phi - self._phi) / np.maximum(1, np.abs(self._phi - _START))
        of_u = np.abs(u - self._u) / np.maximum(self._radius, np.abs(self._u))
        return float(np.maximum(of_phi, of_u).max())

    def by_sweep(self, executor: Executor) -> tuple[float, float]:
        """Return the time of a scene [s] in a sweep, and the largest error [rad]."""
        began = time.perf_counter()
        swept = sweep(
            sliding,
            _DURATION,
            _START,
            paired=True,
            tolerance=TOLERANCE,
            incline=self.inclines,
            fill=self.fills,
            executor=executor,
            progress=False,
        )
        return (time.perf_counter() - began) / len(self.scenes), self.error(swept["phi"], swept["u"])

    def by_batch(self, timestep: float, threads: int) -> tuple[float, float]:
        """Return the time of a scene [s] in mujoco.batch with RK4, without making its model, and the largest error."""
        models = [build(scene, timestep=timestep) for scene in self.scenes]
        batch = Batch(models[0], nsim=len(models), nthread=threads)
        batch.set_models(models)
        qpos, qvel = batch.bind("qpos"), batch.bind("qvel")
        for index, (model, scene) in enumerate(zip(models, self.scenes, strict=True)):
            start = state.start(model, scene, _START, 0.0)
            qpos[index], qvel[index] = start[: model.nq], start[model.nq :]
        began = time.perf_counter()
        batch.step(nstep=round(_DURATION / timestep))
        took = (time.perf_counter() - began) / len(models)
        joints = state.places(models[0])
        return took, self.error(qpos[:, joints["phi"]], qpos[:, joints["slide"]])

    def by_ensemble(self, propagate: Propagate) -> tuple[float, float]:
        """Return the time of a scene [s] in heyoka's ensemble, without compiling it, and the largest error [rad]."""
        began = time.perf_counter()
        phi, u = propagate()
        return (time.perf_counter() - began) / len(self.scenes), self.error(phi, u)

    def timestep(self, threads: int) -> float:
        """Return the largest timestep [s], to a fifth, at which RK4 keeps the tolerance in all scenes.

        Raises:
          ToleranceError: if even the smallest does not.
        """
        steps = _FEWEST
        while not self._kept(steps, threads):
            steps *= 2
            if steps > _MOST:
                raise ToleranceError(f"RK4 does not reach {TOLERANCE:g} rad with {_MOST} timesteps")
        too_few = steps // 2
        for _ in range(_REFINED):
            between = round(math.sqrt(too_few * steps))
            if self._kept(between, threads):
                steps = between
            else:
                too_few = between
        return _DURATION / steps

    def _kept(self, steps: int, threads: int) -> bool:
        return self.by_batch(_DURATION / steps, threads)[1] <= TOLERANCE


@dataclass
class Timed:
    """A way to simulate the sample, with its shortest time and its largest error so far."""

    name: str
    measure: Callable[[], tuple[float, float]]
    seconds: float = np.inf
    error: float = 0.0


def compare(count: int, rounds: int = _ROUNDS, cores: int | None = None) -> list[Timed]:
    """Return the times of sweeps, of mujoco.batch, and of heyoka if it is there, on some scenes; in rounds.

    Raises:
      ToleranceError: if RK4 does not reach the tolerance.
    """
    sample, cores = Sample(count), cores or os.cpu_count() or 1
    timestep = sample.timestep(cores)
    with ThreadPoolExecutor(cores) as threads, processes.pool(cores) as pool:
        ways = [
            Timed(f"mjbeer.sweep, {cores} threads", lambda: sample.by_sweep(threads)),
            Timed(f"mjbeer.sweep, {cores} processes", lambda: sample.by_sweep(pool)),
            Timed(f"mujoco.batch, RK4 at {timestep * 1e3:.3g} ms", lambda: sample.by_batch(timestep, cores)),
        ]
        if installed():
            propagate = ensemble(sample.scenes, _START, _DURATION, _LOCAL)
            ways.append(Timed("heyoka's ensemble, equations by hand", lambda: sample.by_ensemble(propagate)))
        for way in ways:
            way.measure()  # compiles, and starts the processes
        for _ in range(rounds):
            for way in ways:
                seconds, error = way.measure()
                way.seconds, way.error = min(way.seconds, seconds), max(way.error, error)
    return ways


def table(ways: Sequence[Timed]) -> Table:
    """Return a table of the ways, each with its time over that of the first one."""
    rows = [
        (way.name, f"{way.seconds * 1e3:.3g}", f"{way.seconds / ways[0].seconds:.2g}", f"{way.error:.1e}")
        for way in ways
    ]
    columns = ("by", "time of a scene [ms]", "over the first", "largest error [rad]")
    return Table(f"Sliding beer, 2 s, all scenes within {TOLERANCE:g} rad of exact theory", columns, rows)


if __name__ == "__main__":
    terminal.show(table(compare(200)))
