"""Small swings of a scene about its equilibrium: whether they are stable and accurate, and what theory predicts."""

import math
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model import state
from mjbeer.model.build import build
from mjbeer.model.engine import quiet
from mjbeer.model.setting import Integrator, Rolling, Setting
from mjbeer.predictions import linear_stability
from mjbeer.predictions.linear_stability import ACCURACY, ACCURATE_PERIODS, GROWTH, PERIODS
from mjbeer.simulation.run import Prepared
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.exact import exact
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.scene import Scene

STABLE_AMPLITUDE = 1e-4
"""Amplitude of the swing that has to stay bounded [rad]: even a hundredfold, it changes the frequency by 1e-5 only."""
ACCURATE_AMPLITUDE = 1e-3
"""Amplitude of the swing that has to stay accurate [rad]: the exact motion has the same nonlinearity."""
_FREE_FALL = 1e-2
"""Relative tolerance for saying that the last RK4 stage was in free fall. Without contact it adds -g h cos(alpha)/6 to
lift_dot; with contact, a thousandth of that."""


@dataclass(frozen=True)
class Swings:
    """Swings of one scene with one way of rolling and one integrator. `swing` is the timestep as omega h."""

    scene: Scene
    rolling: Rolling
    integrator: Integrator
    settled: bool = True
    """Whether a can in contact starts at the depth at which it is carried, or 1e-9 radii deep as in `simulate`."""

    def bounded(self, swing: float) -> bool:
        """Return whether the energy stays below `GROWTH` squared times its initial value, over `PERIODS` periods."""
        form, rest = self.scene.oscillator, self.scene.equilibrium()
        try:
            motion = self._simulate(swing, STABLE_AMPLITUDE, math.floor(PERIODS * 2 * math.pi / swing))
        except DivergenceError:
            return False
        above = form.inertia(motion.phi) * motion.phi_dot**2 / 2 - form.drop(motion.phi, rest)
        return bool((above < GROWTH**2 * above[0]).all())

    def accurate(self, swing: float) -> bool:
        """Return whether the error stays below `ACCURACY` over `ACCURATE_PERIODS` periods."""
        steps = math.floor(ACCURATE_PERIODS * 2 * math.pi / swing)
        try:
            motion = self._simulate(swing, ACCURATE_AMPLITUDE, steps)
        except DivergenceError:
            return False
        omega = self.scene.frequency()
        times = np.arange(steps + 1) * swing / omega
        truth = exact(self.scene, times, self.scene.equilibrium() + ACCURATE_AMPLITUDE)
        off = np.hypot(motion.phi - truth.phi, (motion.phi_dot - truth.phi_dot) / omega)
        return bool(off.max() < ACCURACY * ACCURATE_AMPLITUDE)

    def accurate_limit(self) -> float:
        """Return the largest omega h of an accurate swing by theory.

        A contact is the softer the longer the timestep to which it is tuned. The can sinks in by delta, in proportion
        to h^2, and rolls like one of radius a - delta/2, whose equilibrium and frequency are slightly different. delta
        is read from the model at rest.
        """
        if self.rolling != "contact":
            return linear_stability.accurate_limit(self.integrator)
        omega, rest = self.scene.frequency(), self.scene.equilibrium()
        model = build(self.scene, self.rolling, integrator=self.integrator, timestep=1 / omega)
        settled = settle(model, state.start(model, self.scene, rest, 0.0))
        depth = -float(state.read(model, self.scene, settled[None], times=np.zeros(1)).lift[0])

        def excess(swing: float) -> float:
            form = self._oscillator_at_depth(depth * swing**2)
            drift = (form.equilibrium() - rest) / ACCURATE_AMPLITUDE
            return linear_stability.error(self.integrator, swing, drift, form.frequency() / omega) - ACCURACY

        return linear_stability.first(excess, 5e-3, linear_stability.stable_limit(self.integrator))

    def loses_a_stage(self, swing: float) -> bool:
        """Return whether the last of RK4's stages in the first step has no contact and falls freely.

        That stage has a weight of a sixth, so that it then adds -g h cos(alpha)/6 to lift_dot.
        """
        timestep = swing / self.scene.frequency()
        motion = self._simulate(swing, STABLE_AMPLITUDE, 1)
        falls = -self.scene.gravity * math.cos(self.scene.incline) * timestep / 6
        return bool(abs(motion.lift_dot[1] / falls - 1) < _FREE_FALL)

    def _simulate(self, swing: float, amplitude: float, steps: int) -> Coordinates:
        """Return a number of steps of a swing of an amplitude [rad]."""
        scene, timestep = self.scene, swing / self.scene.frequency()
        prepared = Prepared(scene, Setting(self.rolling, self.integrator, timestep))
        start = prepared.start(scene.equilibrium() + amplitude, 0.0)
        start = settle(prepared.model, start) if self.settled else start
        times = timestep * np.arange(steps + 1)
        return prepared.coordinates(prepared.solve(start, times).states, times)

    def _oscillator_at_depth(self, depth: float) -> Oscillator:
        """Return the oscillator of a can that has sunk into the incline by a depth [m]."""
        scene = self.scene
        reduce = Oscillator.sliding if scene.attachment == "sliding" else Oscillator.frozen
        can = replace(scene.can, radius=scene.can.radius - depth / 2)
        return reduce(can, scene.load, scene.incline, scene.gravity)


def settle(model: mujoco.MjModel, at: np.ndarray) -> np.ndarray:
    """Return a state, shape (nq + nv,), with the lift at which the can has no acceleration away from the incline.

    A model without a lift gets its state back. The contact force is linear in the depth, so that two trials give the
    wanted depth. From any other depth the can would fall or rise to it, unlike in the exact motion.
    """
    if "lift" not in (joints := state.places(model)):
        return at
    index = joints["lift"]
    data, balanced = mujoco.MjData(model), at.copy()

    def acceleration(lift: float) -> float:
        data.qpos[:], data.qvel[:] = at[: model.nq], at[model.nq :]
        data.qpos[index], data.qacc_warmstart[:] = lift, 0.0
        with quiet():
            mujoco.mj_forward(model, data)
        return float(data.qacc[index])

    trials = -1e-7, -2e-7
    first, second = (acceleration(lift) for lift in trials)
    balanced[index] = trials[0] - first * (trials[1] - trials[0]) / (second - first)
    return balanced
