"""Advice: what it says works, from the study that comes with mjbeer."""

import pathlib
import re

import pytest

from mjbeer import exact
from mjbeer.cli.app import main, parse
from mjbeer.cli.motions import Simulate
from mjbeer.exceptions import ParameterError
from mjbeer.studies.benchmark import advice
from mjbeer.studies.cases import CASES, DEFAULT
from mjbeer.theory.exact import phi_error

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", DEFAULT)
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9])
def test_the_command_advised_meets_the_tolerance(name: str, tolerance: float) -> None:
    """Over the study's 2.048 s and from the study's start; on another machine the run time is another."""
    said = advice.advise(name, tolerance)
    line = next(each for each in said.splitlines() if each.startswith("mjbeer simulate"))
    command = parse([*line.split()[1:], "--duration", "2.048"])
    assert isinstance(command, Simulate)
    run = command.simulate()
    assert phi_error(run) <= tolerance


@pytest.mark.parametrize("rolling", ["equality", "contact"])
def test_a_way_of_rolling_can_be_asked_for(rolling: str) -> None:
    said = advice.advise("pendulum", 1e-4, rolling)
    assert f"rolling={rolling!r}" in said
    assert 'solref="' in said
    with pytest.raises(ParameterError, match=r"meets a tolerance of 1e-14 rad"):
        advice.advise("pendulum", 1e-14, rolling)


def test_contact_says_what_build_sets() -> None:
    from mjbeer import build

    said = advice.advise("frozen", 1e-5, "contact")
    integrator, timestep = re.findall(r"integrator='(\w+)', timestep=([\d.e-]+)", said)[0]
    model = build(CASES["frozen"].scene, "contact", integrator=integrator, timestep=float(timestep))
    numbers = [float(each) for each in re.findall(r'solref="([\d.e-]+) 1" solimp="([\d.]+) ', said)[0]]
    assert numbers == pytest.approx([model.pair_solref[0, 0], model.pair_solimp[0, 0]], rel=1e-3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["frozen", "--tolerance", "-1"], "tolerance must be greater than 0 [rad], got -1.0"),
        (["hoop"], "scene must be one of 'sliding', 'sliding-metal', 'frozen', 'pendulum'; got 'hoop'"),
        (["frozen", "--study", "nowhere.json"], "nowhere.json was not written by `mjbeer benchmark`"),
    ],
)
def test_bad_input_is_an_error(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["advise", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_the_study_that_comes_with_mjbeer_is_whole() -> None:
    """Its errors are those of this code, on a few of its points, to the digits that rounding leaves."""
    from mjbeer.studies.benchmark.measure import Rung
    from mjbeer.studies.benchmark.points import Benchmark, Point

    stored = Benchmark.load(advice.SHIPPED)
    assert stored.cases == list(DEFAULT)
    assert {len(point.times) for point in stored.points if point.failure is None} == {1}
    for old in stored.points[:: len(stored.points) // 12]:
        if old.failure or not 1e-10 < old.error < 1e-2 or not old.method:
            continue
        case = CASES[old.case]
        new = Point(old.case, old.way, old.method, old.knob, old.value)
        Rung(case, new, peer=None).measure(case.truth())
        assert new.error == pytest.approx(old.error, rel=1e-3)


def test_cases_are_the_commands_that_they_say(tmp_path: pathlib.Path) -> None:
    for case in CASES.values():
        command = parse(["simulate", *case.command.split(), "--duration", "0.1", "--tolerance", "1e-9"])
        assert isinstance(command, Simulate)
        run = command.simulate()
        truth = exact(case.scene, run.time, case.phi0)
        assert abs(run.phi - truth.phi).max() < 1e-3  # degrees with three digits
