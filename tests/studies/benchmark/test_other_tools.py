"""The equations written by hand against the theory's, and every other tool that is there against exact theory."""

import importlib
import math

import numpy as np
import pytest

from mjbeer import Scene, exact, frozen, pendulum, simulate, sliding
from mjbeer.studies.benchmark import other_tools
from mjbeer.studies.benchmark.other_tools import (
    COMPILED_DOP853,
    HEYOKA,
    ODEINT,
    OTHER_TOOLS,
    WHOLE_CALL,
    OtherTool,
    right_hand_side,
)
from mjbeer.studies.benchmark.points import Case
from mjbeer.theory.equations import accelerations
from tests.support.scenes import METAL

pytestmark = pytest.mark.slow

# A tolerance holds for one step, of which there are some hundreds, and for metres, of which a radian of rolling has
# 0.03. Measured: up to 75 times the tolerance (odeint).
GLOBAL = 300
# The error over that tolerance is not constant: steps are few, and methods change their order. Measured: 0.90 to 1.13.
SLOPE = 0.2
TIMES = np.linspace(0, 1.024, 65)


def case(scene: Scene, phi0: float, phi_dot0: float = 0.0) -> Case:
    return Case("test", scene, phi0, "a test", phi_dot0, TIMES)


SLIDING = case(sliding(can=METAL), 1.0, 2.0)
FROZEN = case(frozen(can=METAL), -0.5, 1.0)
OTHERS = {
    "frozen, metal can": FROZEN,
    "sliding": case(sliding(), 1.0),
    "frozen": case(frozen(), 0.0),
    "pendulum": case(pendulum(), 1.0),
}


def error(tool: OtherTool, motion: Case, tolerance: float) -> float:
    """The larger of the errors of phi and u/a, against exact theory, in the second of two runs."""
    solver = tool.set_up(motion, tolerance)
    first = solver.read(solver.run()).motion
    second = solver.read(solver.run()).motion
    assert not np.shares_memory(first.phi, second.phi)
    assert (first.phi == second.phi).all()
    truth = motion.truth()
    phi_error = np.abs(second.phi - truth.phi).max()
    u_error = np.abs(second.u - truth.u).max() / motion.scene.can.radius
    return max(phi_error, u_error)


def require_errors_like_tolerances(name: str, motion: Case) -> None:
    if name in other_tools.absent():
        pytest.skip(f"{name} is absent")
    coarse = 1e-4
    fine = 1e-10
    coarse_error = error(OTHER_TOOLS[name], motion, coarse)
    fine_error = error(OTHER_TOOLS[name], motion, fine)
    assert fine_error <= GLOBAL * fine
    slope = math.log(coarse_error / fine_error) / math.log(coarse / fine)
    assert slope == pytest.approx(1, abs=SLOPE)


@pytest.mark.parametrize("motion", [SLIDING, FROZEN], ids=["sliding", "frozen"])
@pytest.mark.parametrize("name", [ODEINT, HEYOKA])
def test_tolerances_lead_to_exact_theory(name: str, motion: Case) -> None:
    require_errors_like_tolerances(name, motion)


def test_tolerances_of_compiled_equations_lead_to_exact_theory() -> None:
    require_errors_like_tolerances(COMPILED_DOP853, SLIDING)


@pytest.mark.costly
@pytest.mark.parametrize("motion", OTHERS.values(), ids=OTHERS.keys())
@pytest.mark.parametrize("name", [name for name in OTHER_TOOLS if name != WHOLE_CALL])
def test_tolerances_lead_to_exact_theory_from_other_starts(name: str, motion: Case) -> None:
    require_errors_like_tolerances(name, motion)


@pytest.mark.parametrize("motion", [SLIDING, FROZEN], ids=["sliding", "frozen"])
def test_the_equations_are_those_of_the_theory_interpreted_and_compiled(motion: Case) -> None:
    from mjbeer.studies.benchmark.compiled_equations import array_function

    state = np.array(other_tools.initial_state(motion))
    rates = right_hand_side(motion.scene)(0.0, tuple(state))
    expected = accelerations(motion.scene, motion.phi0, motion.phi_dot0, state[-2])
    assert rates[-1] == pytest.approx(float(expected.phi_ddot), rel=1e-13)
    if motion is SLIDING:
        assert rates[-2] == pytest.approx(float(expected.u_ddot), rel=1e-13)
    # The compiler may contract products and sums.
    assert array_function(motion)(0.0, state) == pytest.approx(rates, rel=1e-14)


def test_a_whole_call_is_that_of_simulate() -> None:
    solver = OTHER_TOOLS[WHOLE_CALL].set_up(SLIDING, 1e-9)
    found = solver.read(solver.run()).motion
    run = simulate(SLIDING.scene, float(TIMES[-1]), 1.0, 2.0, tolerance=1e-9, times=TIMES)
    assert (found.phi == run.phi).all()
    assert (found.u == run.u).all()


def test_what_cannot_be_imported_is_absent_and_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: str) -> None:
        raise OSError("cannot open libfmt.so.11")

    monkeypatch.setattr(importlib, "import_module", fail)
    assert other_tools.absent() == {"heyoka": "cannot open libfmt.so.11"}


def test_a_long_motion_is_followed() -> None:
    """SciPy's odeint gives up after 500 steps between two samples, unless it is told otherwise."""
    times = np.array([0.0, 30.0])
    motion = Case("test", frozen(), 1.0, "a test", 0.0, times)
    solver = OTHER_TOOLS["SciPy odeint"].set_up(motion, 1e-9)
    samples = solver.read(solver.run())
    assert samples.evaluations is not None
    assert samples.evaluations > 2 * 500
    assert samples.motion.phi[-1] == pytest.approx(
        exact(frozen(), times, 1.0).phi[-1], abs=GLOBAL * 1e-9 * 30
    )
