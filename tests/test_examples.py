"""The examples run as a reader runs them, and their cans move as theory says."""

import pathlib
import re
import runpy
import subprocess
import sys

import mujoco
import numpy as np
import pytest

from mjbeer import standing
from mjbeer.report.carry import carry
from mjbeer.theory.standing import QUANTITATIVE

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


@pytest.mark.slow
def test_two_fingers_carry_a_can_and_do_not_spill(tmp_path: pathlib.Path) -> None:
    pattern = (
        r"carried (\S+) m and hangs (\S+) m [^@]* by at most (\S+) mm "
        r"[^@]* by at most (\S+) degrees[^@]* at most (\S+) of the friction "
        r"[^@]* at most (\S+) R, and by (\S+) R after"
    )
    ((carried, height, slip, tilt, used, rise, ringing),) = told("grasp", tmp_path, pattern)
    example = runpy.run_path(str(EXAMPLES / "grasp.py"))
    can = example["CAN"]
    weight = 9.81 * (can.mass + can.can.mass)
    assert carried == pytest.approx(example["CARRY"], abs=1e-3)
    # It began 0.4 mm deep in a soft table. The motor that lifts is a spring of 2e4 N/m.
    assert height == pytest.approx(example["LIFT"] - 4e-4 - weight / 2e4, abs=1e-4)
    # Friction in MuJoCo creeps: at 10 um/s, this makes 0.04 mm.
    assert slip < 0.1
    # A pendulum with the fingers as its axis would tilt by a/g, 4.5 degrees, and more as it rings.
    assert tilt < 0.2
    # At rest the weight needs the least. With the moment about the fingers, and what slosh adds, it
    # must be well below 1, where the can slips.
    at_rest = weight / (2 * example["FRICTION"][0] * example["GRIP"])
    assert at_rest < used < 1.5 * at_rest
    # The can follows the fingers, and so the beer rises as in a can that is moved so: what the
    # motors lag behind, and how the can yields in the fingers, are a few percent of it.
    move = carry(can, example["CARRY"], example["CARRIED"] - example["LIFTED"])
    after = move.time > example["CARRIED"] - example["LIFTED"] + 0.1
    assert rise == pytest.approx(np.abs(move.rise).max(), rel=0.02)
    assert ringing == pytest.approx(np.abs(move.rise[after]).max(), rel=0.1)
    assert rise < QUANTITATIVE


@pytest.mark.costly
def test_a_can_swings_in_fingers_that_do_not_hold_a_twist() -> None:
    """So that friction against twisting is what the tilt of the other test measures."""
    example = runpy.run_path(str(EXAMPLES / "grasp.py"))
    names = example["grasp"].__globals__
    make_world = example["world"]

    def with_condim_3() -> mujoco.MjModel:
        model = make_world()
        model.geom_condim[:] = 3
        return model

    names["world"] = with_condim_3
    assert np.degrees(example["grasp"]().tilt.max()) > 4.5


def test_every_example_is_named_in_a_document() -> None:
    texts = "".join(
        path.read_text() for path in [*CHECKOUT.glob("*.md"), *CHECKOUT.glob("docs/*.md")]
    )
    assert not [path.name for path in EXAMPLES.glob("*.py") if f"examples/{path.name}" not in texts]
