"""Scenes that tests share, random ones, and how far a run of them is from theory."""

import math

import mujoco
import numpy as np
from hypothesis import strategies as st

from mjbeer import Can, Load, Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.model.joints import to_coordinates
from mjbeer.model.setting import MUJOCO_INTEGRATORS
from mjbeer.simulation.run import Run
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.trajectory import largest_error

METAL = Can.sheet_metal()
SCENES = {
    "sliding": sliding(),
    "sliding, metal can": sliding(can=METAL),
    "frozen": frozen(),
    "frozen, metal can": frozen(can=METAL),
    "pendulum": pendulum(),
    "hoop": hoop(),
}
MASSIVE = {name: scene for name, scene in SCENES.items() if name != "sliding"}
"""Those that MuJoCo can roll by a constraint."""
ARRAYS = ("time", "u", "phi", "u_dot", "phi_dot", "roll", "roll_dot", "lift", "lift_dot", "energy")
"""What a run has an array of, with a number for each sample."""
ANY_ROLLING_INTEGRATORS = (*MUJOCO_INTEGRATORS, "DOP853")
"""The integrators that step a can however it rolls."""


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """Any can, any load with some inertia of its own, inclines to 60 degrees either way."""

    def between(low: float, high: float) -> float:
        return draw(st.floats(low, high))

    radius = 10 ** between(-2, 0)
    load_mass = 10 ** between(-2, 1)
    mass = draw(st.sampled_from([0.0, 1.0])) * load_mass * 10 ** between(-3, 3)
    share = draw(st.sampled_from([0.0, 1.0])) * between(1e-6, 1)
    can = Can(radius, 3 * radius, mass, mass * radius**2 * share)
    load = Load(load_mass, radius * between(0.05, 0.95), load_mass * radius**2 * between(0.05, 0.5))
    attachment = draw(st.sampled_from(["sliding", "frozen"]))
    return Scene(can, load, between(-math.pi / 3, math.pi / 3), attachment)


def coordinates(model: mujoco.MjModel, data: mujoco.MjData, scene: Scene) -> Coordinates:
    """The state of a model as theory's coordinates, with one sample."""
    state = np.concatenate([data.qpos, data.qvel])
    return to_coordinates(model, scene, state[np.newaxis], np.array([data.time]))


def error(run: Run) -> float:
    """The largest error of phi and u/a at the samples of a run [rad], as a tolerance bounds it."""
    start = run.phi0, run.scene.initial_axis(run.phi0, run.phi_dot0)[0]
    return largest_error(
        run, exact(run.scene, run.time, run.phi0, run.phi_dot0), run.scene.can.radius, start
    )
