"""The examples run as a reader runs them, and their cans move as theory says."""

import pathlib
import re
import runpy
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from mjbeer import standing
from mjbeer.report.carry import carry

CHECKOUT = pathlib.Path(__file__).parents[1]
EXAMPLES = CHECKOUT / "examples"
# RK4 at 1 ms, over ten swings of the load: 5e-8 rad. The equality is rigid, and adds nothing.
OWN = 1e-7
# The contact's softness, and the creep of its friction: with half the timestep and half the time constant, the error of
# the frozen can is half of 2e-7 rad, and that of the sliding one, 5e-8 rad, less than a quarter.
ATTACHED = 5e-7


def load(name: str) -> dict[str, Any]:
    return runpy.run_path(str(EXAMPLES / f"{name}.py"))


@pytest.mark.slow
@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.name)
def test_an_example_runs_by_itself(path: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """From another folder, and without a warning."""
    command = [sys.executable, "-W", "error", str(path)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert re.search(r"phi is within \d\.\de-0[78] rad|at most 0\.55\d N during the move", done.stdout)


def test_a_loop_of_one_s_own_moves_as_theory_says() -> None:
    example = load("own_scene")
    times, phi = example["run"]()
    assert times[-1] > 1.9
    assert abs(phi).max() > 0.9
    assert example["error"](times, phi) < OWN


@pytest.mark.slow
def test_cans_on_a_slope_of_one_s_own_move_as_theory_says() -> None:
    errors = load("attach")["errors"]()
    assert set(errors) == {"frozen", "sliding"}
    assert max(errors.values()) < ATTACHED


@pytest.mark.slow
def test_cans_that_are_carried_are_felt_as_theory_says() -> None:
    """The forces and the ringing of the film; the weld of the gripper is softer by 1 %."""
    times, forces = load("carry")["forces"]()
    for name, modes in (("beer", 1), ("rigid", 0)):
        run = carry(standing(modes=modes))
        assert np.abs(forces[name]).max() == pytest.approx(np.abs(run.force).max(), rel=0.01)
        ringing = np.abs(run.force[run.time > 1.1]).max()
        assert np.abs(forces[name][times > 1.1]).max() == pytest.approx(ringing, rel=0.03, abs=1e-3)


def test_every_example_is_named_in_a_document() -> None:
    documents = [*CHECKOUT.glob("*.md"), *CHECKOUT.glob("docs/*.md"), *CHECKOUT.glob("mjcf/*.md")]
    texts = "".join(path.read_text() for path in documents)
    assert not [path.name for path in EXAMPLES.glob("*.py") if f"examples/{path.name}" not in texts]
