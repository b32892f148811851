"""Numerical errors that theory gives in advance, against simulations; each fails on a wrong theory."""

import mujoco
import numpy as np
import pytest

from mjbeer import Can, Scene, exact, frozen, pendulum, simulate, sliding
from mjbeer.model.build import build
from mjbeer.model.joints import initial_state, to_coordinates
from mjbeer.simulation.fixed_step import states_after
from mjbeer.studies.benchmark.timing import usual_model
from mjbeer.studies.predictions import reached_share
from tests.support.constraints import applied_share, diagonal_excess

pytestmark = pytest.mark.slow

# What each prediction leaves out, relative to it. The factors that one might get wrong are all larger: 1/12 for 1/24,
# delta/a for delta/2a, b for a.
NEXT_ORDER = 2e-3  # frequency: (omega h)^2 of 4 ms
SETTLING = 1e-2  # slip: the can still sinks and creeps a little
ROUNDING = 1e-9  # distance and shares are exact
METAL = sliding(can=Can.sheet_metal())


@pytest.mark.parametrize("scene", [sliding(), frozen(), pendulum()])
def test_euler_raises_the_frequency(scene: Scene) -> None:
    """By (omega h)^2/24: the map has eigenvalues exp(+-i nu h) with sin(nu h/2) = omega h/2.

    Measured is a swing of 1e-4 rad, whose finite amplitude adds 1e-9 only.
    """
    swing = simulate(scene, 20.0, scene.equilibrium() + 1e-4, integrator="Euler", timestep=4e-3)
    predicted = (scene.frequency() * 4e-3) ** 2 / 24
    assert swing.frequency() / scene.frequency() - 1 == pytest.approx(predicted, rel=NEXT_ORDER)


def test_euler_lengthens_the_distance() -> None:
    """From rest, after n = T/h steps the distance is a h^2 n (n + 1)/2 instead of a T^2/2."""
    run = simulate(sliding(), 2.0, 0.0, integrator="Euler", timestep=1e-3)
    excess = float(run.u[-1] / exact(run.scene, run.time, 0.0).u[-1] - 1)
    assert excess == pytest.approx(1e-3 / 2.0, rel=ROUNDING)


@pytest.mark.parametrize("written", ["defaults", "tuned"])
def test_a_can_that_sinks_in_slips(written: str) -> None:
    """The contact point lies midway between the surfaces, at a - delta/2, and the can rolls as with that radius.

    Measured is the second half of 2 s of steady rolling.
    """
    model = build(METAL, "contact") if written == "tuned" else usual_model("contact, defaults", METAL)
    steps = np.arange(round(2.0 / model.opt.timestep) + 1)
    states = states_after(model, mujoco.MjData(model), initial_state(model, METAL, METAL.equilibrium(), 0.0), steps)
    run = to_coordinates(model, METAL, states, steps * model.opt.timestep)
    half, slips = len(run.time) // 2, run.u - METAL.can.radius * run.roll
    slip = float((slips[-1] - slips[half]) / (run.u[-1] - run.u[half]))
    predicted = float(run.lift[half:].mean()) / (2 * METAL.can.radius)
    assert slip == pytest.approx(predicted, rel=SETTLING)


@pytest.mark.parametrize("scene", [frozen(), METAL, pendulum()])
def test_a_usual_joint_equality_has_a_share_of_its_force(scene: Scene) -> None:
    model = usual_model("equality, slide first", scene)
    share = applied_share(model, np.zeros(model.nq + model.nv))
    predicted = reached_share(0.9, diagonal_excess(model, scene.can.radius))
    assert share == pytest.approx(predicted, rel=ROUNDING)
