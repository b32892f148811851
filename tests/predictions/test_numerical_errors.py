"""Numerical errors that theory gives in advance, against simulations; each fails on a wrong theory."""

from typing import Literal

import numpy as np
import pytest

from mjbeer import Can, Scene, exact, frozen, pendulum, simulate, sliding
from mjbeer.model.build import build
from mjbeer.model.state import read, start
from mjbeer.simulation.stepping import Stepper
from mjbeer.studies.benchmark.points import CASES
from mjbeer.studies.benchmark.timing import usual_model
from mjbeer.studies.predictions import semi_implicit_euler, soft_constraint
from mjbeer.theory.exact import phi_error
from tests.support import soft_rows
from tests.support.constraints import applied_share

pytestmark = pytest.mark.slow

# What each prediction leaves out, relative to it. The factors that one might get wrong are all larger: 1/12 for 1/24,
# delta/a for delta/2a, b for a.
NEXT_ORDER = 2e-3  # frequency: (omega h)^2 of 4 ms; error of phi: the next power of a timestep of 1/16 ms
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


@pytest.mark.parametrize("name", ["sliding", "frozen", "pendulum"])
def test_the_error_of_euler_is_the_limit_of_small_steps(name: str) -> None:
    """Not a fit: halving the step halves what the prediction misses, relative to it."""
    case, missed = CASES[name], {}
    short = 1e-3 * np.sqrt(case.scene.can.radius / case.scene.gravity)  # a central difference leaves its square
    ahead, behind = (
        semi_implicit_euler.euler_motion(case.scene, case.times, each, "Euler", case.phi0) for each in (short, -short)
    )
    slope = np.abs(ahead - behind).max() / (2 * short)
    for h in (1.25e-4, 6.25e-5):
        run = simulate(case.scene, case.times[-1], case.phi0, integrator="Euler", timestep=h, times=case.times)
        missed[h] = phi_error(run) / h / slope - 1
    assert abs(missed[6.25e-5]) < NEXT_ORDER
    assert missed[1.25e-4] / missed[6.25e-5] == pytest.approx(2, abs=0.3)


@pytest.mark.parametrize("integrator", ["Euler", "implicit"])
def test_the_motion_of_euler_is_right_to_second_order(integrator: Literal["Euler", "implicit"]) -> None:
    """Rolling down: halving the step halves the error, and quarters what is missed of it."""
    scene, times, missed, first = frozen(), np.array([0.0, 1.0]), [], []
    for h in (5e-4, 2.5e-4):
        predicted = semi_implicit_euler.euler_motion(scene, times, h, integrator, np.pi)[-1]
        run = simulate(scene, 1.0, np.pi, rolling="equality", integrator=integrator, timestep=h, times=times)
        missed.append(run.phi[-1] - predicted)
        first.append(run.phi[-1] - exact(scene, times, np.pi).phi[-1])
    assert np.sign(first[0]) == {"Euler": -1, "implicit": 1}[integrator]
    assert abs(missed[0] / first[0]) < NEXT_ORDER
    assert first[0] / first[1] == pytest.approx(2, abs=0.05)
    assert missed[0] / missed[1] == pytest.approx(4, abs=0.2)


@pytest.mark.parametrize("written", ["defaults", "tuned"])
def test_a_can_that_sinks_in_slips(written: str) -> None:
    """The contact point lies midway between the surfaces, at a - delta/2, and the can rolls as with that radius.

    Measured is the second half of 2 s of steady rolling.
    """
    model = build(METAL, "contact") if written == "tuned" else usual_model("contact, defaults", METAL)
    steps = np.arange(round(2.0 / model.opt.timestep) + 1)
    states = Stepper(model).run(start(model, METAL, METAL.equilibrium(), 0.0), steps)
    run = read(model, METAL, states, steps * model.opt.timestep)
    half, slips = len(run.time) // 2, run.u - METAL.can.radius * run.roll
    slip = float((slips[-1] - slips[half]) / (run.u[-1] - run.u[half]))
    predicted = float(run.lift[half:].mean()) / (2 * METAL.can.radius)
    assert slip == pytest.approx(predicted, rel=SETTLING)


@pytest.mark.parametrize("scene", [frozen(), METAL, pendulum()])
def test_a_usual_joint_equality_has_a_share_of_its_force(scene: Scene) -> None:
    model = usual_model("equality, slide first", scene)
    share = applied_share(model, np.zeros(model.nq + model.nv))
    predicted = soft_constraint.reached_share(0.9, soft_rows.diagonal_excess(scene))
    assert share == pytest.approx(predicted, rel=ROUNDING)
