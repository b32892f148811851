"""The equations written by hand against the theory's, and every other tool that is there against exact theory."""

import importlib
import math

import numpy as np
import pytest

from mjbeer import Scene, exact, frozen, pendulum, simulate, sliding
from mjbeer.studies.benchmark import other_tools
from mjbeer.studies.benchmark.other_tools import OTHER_TOOLS, WHOLE, OtherTool
from tests.support.scenes import METAL

pytestmark = pytest.mark.slow

# A tolerance holds for one step, of which there are some hundreds, and for metres, of which a radian of rolling has
# 0.03. Measured: up to 75 times the tolerance (odeint).
GLOBAL = 300
# The error over that tolerance is not constant: steps are few, and methods change their order. Measured: 0.90 to 1.13.
SLOPE = 0.2
TIMES = np.linspace(0, 1.024, 65)
STARTS = {
    "sliding": (sliding(), 1.0, 0.0),
    "sliding, metal can": (sliding(can=METAL), 1.0, 2.0),
    "frozen": (frozen(), 0.0, 0.0),
    "frozen, metal can": (frozen(can=METAL), -0.5, 1.0),
    "pendulum": (pendulum(), 1.0, 0.0),
}


def error(tool: OtherTool, scene: Scene, phi0: float, phi_dot0: float, tolerance: float) -> float:
    """The larger of the errors of phi and u/a, against exact theory, in the second of two runs."""
    run = tool.set_up(scene, phi0, phi_dot0, TIMES, tolerance)
    (first, *_), (phi, u, _) = run(), run()
    assert first is not phi
    assert (first == phi).all()
    truth = exact(scene, TIMES, phi0, phi_dot0)
    return max(np.abs(phi - truth.phi).max(), np.abs(u - truth.u).max() / scene.can.radius)


@pytest.mark.parametrize("start", STARTS.values(), ids=STARTS.keys())
@pytest.mark.parametrize("name", [name for name in OTHER_TOOLS if name != WHOLE])
def test_tolerances_lead_to_exact_theory(name: str, start: tuple[Scene, float, float]) -> None:
    if name in other_tools.absent():
        pytest.skip(f"{name} is absent")
    coarse, fine = 1e-4, 1e-10
    first, last = error(OTHER_TOOLS[name], *start, coarse), error(OTHER_TOOLS[name], *start, fine)
    assert last <= GLOBAL * fine
    assert math.log(first / last) / math.log(coarse / fine) == pytest.approx(1, abs=SLOPE)


def test_a_whole_call_is_that_of_simulate() -> None:
    phi, u, _ = OTHER_TOOLS[WHOLE].set_up(sliding(), 1.0, 0.0, TIMES, 1e-9)()
    run = simulate(sliding(), float(TIMES[-1]), 1.0, tolerance=1e-9, times=TIMES)
    assert (phi == run.phi).all()
    assert (u == run.u).all()


def test_what_cannot_be_imported_is_absent_and_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: str) -> None:
        raise OSError("cannot open libfmt.so.11")

    monkeypatch.setattr(importlib, "import_module", fail)
    assert other_tools.absent() == {"heyoka": "cannot open libfmt.so.11"}
