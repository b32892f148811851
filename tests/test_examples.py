"""The examples run as a reader runs them, and their cans move as theory says."""

import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

from mjbeer import standing
from mjbeer.report.carry import carry

CHECKOUT = pathlib.Path(__file__).parents[1]
EXAMPLES = CHECKOUT / "examples"
# RK4 at 1 ms, over ten swings of the load: 5e-8 rad. The equality is rigid, and adds nothing.
OWN = 1e-7
# The contact's softness, and the creep of its friction: with half the timestep and half the time
# constant, the error of the frozen can is half of 2e-7 rad, and that of the sliding one, 5e-8 rad,
# less than a quarter.
ATTACHED = 5e-7


def told(name: str, folder: pathlib.Path, pattern: str) -> np.ndarray:
    """The numbers in the lines that an example prints, from another folder and without a
    warning."""
    command = [sys.executable, "-W", "error", str(EXAMPLES / f"{name}.py")]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return np.array(re.findall(pattern, done.stdout), float)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "cans", "allowed"), [("own_scene", 1, OWN), ("attach", 2, ATTACHED)]
)
def test_a_scene_of_one_s_own_moves_as_theory(
    name: str, cans: int, allowed: float, tmp_path: pathlib.Path
) -> None:
    errors = told(name, tmp_path, r"after 2 s phi is within (\S+) rad")
    assert len(errors) == cans
    assert max(errors) < allowed


@pytest.mark.slow
def test_cans_that_are_carried_are_felt_as_theory_says(tmp_path: pathlib.Path) -> None:
    """The forces and the ringing of the film; the weld of the gripper is softer by 1 %."""
    forces = told("carry", tmp_path, r"at most (\S+) N during the move, (\S+) N after the stop")
    for (most, ringing), modes in zip(forces, (1, 0), strict=True):
        run = carry(standing(modes=modes))
        assert most == pytest.approx(np.abs(run.force).max(), rel=0.01)
        assert ringing == pytest.approx(np.abs(run.force[run.time > 1.1]).max(), rel=0.03, abs=1e-3)


def test_every_example_is_named_in_a_document() -> None:
    texts = "".join(
        path.read_text() for path in [*CHECKOUT.glob("*.md"), *CHECKOUT.glob("docs/*.md")]
    )
    assert not [path.name for path in EXAMPLES.glob("*.py") if f"examples/{path.name}" not in texts]
