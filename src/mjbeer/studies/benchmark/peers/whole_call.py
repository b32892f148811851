"""Whole calls of mjbeer's own `simulate`, from a scene to a trajectory that judges itself, timed like another tool."""

import numpy as np

from mjbeer.model.setting import Setting
from mjbeer.simulation.run import integrate as simulate
from mjbeer.studies.benchmark.peers.peer import Integrate, Motion, Peer, decades
from mjbeer.theory.scene import Scene

NAME = "mjbeer.simulate"


def _set_up(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Integrate:
    def integrate() -> Motion:
        run = simulate(scene, phi0, phi_dot0, Setting(tolerance=knob), times)
        return run.phi, run.u

    return integrate


PEER = Peer(name=NAME, tolerances=decades(3, 12), set_up=_set_up)
