"""The command line: streams, exit statuses, and what is refused in one line."""

import json
import math
import os
import pathlib
import re
from collections.abc import Iterable
from importlib.metadata import version

import numpy as np
import pytest

import mjbeer
from mjbeer import frozen, hoop, pendulum, simulate, sliding
from mjbeer.cli.app import COMMANDS, SCENES_OF, main
from mjbeer.cli.motions import Summary
from mjbeer.theory.liquid import liquid_in
from mjbeer.theory.trajectory import csv
from tests.support.processes import run

pytestmark = pytest.mark.slow

SCENES = {"sliding": sliding(), "frozen": frozen(), "pendulum": pendulum(), "hoop": hoop()}


@pytest.mark.parametrize("name", SCENES)
def test_simulate_writes_the_trajectory(
    name: str, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The file's name has brackets, which are markup to the library that prints."""
    target = tmp_path / "motion[red][" / "c].csv"
    target.parent.mkdir()
    start = ["--phi0", "57", "--phi-dot0", "-2e1"]

    status = main(["simulate", name, *start, "--duration", "0.1", f"--output={target}"])

    assert status == 0
    run = simulate(SCENES[name], 0.1, math.radians(57), math.radians(-20))
    assert target.read_text() == csv(run)
    out, err = capsys.readouterr()
    assert out == Summary(run).text()
    assert err == f"wrote {target}\n" + "".join(f"note: {note}\n" for note in Summary(run).notes)


def test_standard_output_has_the_csv_or_the_json_alone(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A note says that the can slips, and a warning that it must be pulled from 0.83 s on."""
    monkeypatch.chdir(tmp_path)
    words = ["simulate", "frozen", "--phi0", "180", "--duration", "1", "--friction", "0.6"]
    run = simulate(frozen(), 1.0, math.pi)
    summary = Summary(run, 0.6)
    messages = [f"model does not hold: {warning}" for warning in run.warnings]
    messages += [f"note: {note}" for note in summary.notes]
    assert len(messages) > 1

    for option, expected in ((["--output", "-"], csv(run)), (["--json"], summary.json())):
        assert main([*words, *option]) == 0
        out, err = capsys.readouterr()
        assert out == expected
        assert err.splitlines()[-len(messages) :] == messages
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("", "the following arguments are required: COMMAND; see `mjbeer --help`"),
        ("simlate sliding", "argument COMMAND: invalid choice: 'simlate' (choose from "),
        ("simulate", "the following arguments are required: SCENE; see `mjbeer simulate --help`"),
        ("simulate standing", "argument SCENE: invalid choice: 'standing' (choose from "),
        (
            "simulate sliding --tol 1e-6",
            "--tol is not understood here; see `mjbeer simulate sliding --help`",
        ),
        ("simulate sliding --phi0 1,2", "argument --phi0: invalid angle value: '1,2'"),
        (
            "fit can.csv sliding --phi0 up",
            "phi0 must be level, free, or a number [degrees], got 'up'",
        ),
        (
            "fit can.csv sliding --phi0 inf",
            "phi0 must be level, free, or a number [degrees], got 'inf'",
        ),
        ("benchmark slding", "scene must be one of 'sliding', 'sliding-metal', "),
        ("simulate sliding --incline 87", "incline must be between -85 and 85 [degrees], got 87"),
        ("sweep frozen --incline 1:86:3", "incline must be between -85 and 85 [degrees], got 86"),
        (
            "simulate sliding --phi0 inf",
            "argument --phi0: it must be a finite number [degrees], got inf",
        ),
        ("simulate frozen --timestep 0", "timestep must be between 1e-07 and 10 [s], got 0.0"),
        (
            "simulate frozen --timestep 0.5 --integrator Euler --phi0 5e5 --duration 900",
            "the run diverged at t =",
        ),
        ("render frozen --output film.avi", "the file's name must end in .mp4, got 'film.avi'"),
        (
            "simulate frozen --json --output -",
            "standard output takes one of them: the JSON, or the CSV of --output -",
        ),
        (
            "sweep frozen",
            "a plot needs one or two options with several values, got 0: write .csv or .nc",
        ),
        (
            "sweep frozen --fill 0.2,0.3 --output map.jpg",
            "the file's name must end in .png or .svg or .csv or .nc",
        ),
    ],
)
def test_what_is_not_allowed_is_one_line_and_exit_status_2(
    words: str,
    message: str,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)

    status = main(words.split())

    out, err = capsys.readouterr()
    assert status == 2
    assert err.startswith(f"mjbeer: {message}")
    assert err.count("\n") == 1
    assert out == ""
    assert not os.listdir(tmp_path)


def help_pages() -> dict[str, Iterable[str]]:
    """Return the names that its help lists for each command line."""
    listed: dict[str, Iterable[str]] = {"": COMMANDS}
    for command in COMMANDS:
        scenes = SCENES_OF.get(command, {})
        listed[command] = scenes
        before_scene = f"{command} FILE" if command == "fit" else command
        listed |= {f"{before_scene} {scene}": () for scene in scenes}
    return listed


@pytest.mark.parametrize(("words", "names"), help_pages().items())
def test_the_help_of_each_command(
    words: str, names: Iterable[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main([*words.split(), "--help"])

    out = capsys.readouterr().out
    assert ended.value.code == 0
    assert f"usage: mjbeer {words}".rstrip() in out
    for name in names:
        assert re.search(rf"^    {name}\s", out, re.MULTILINE)


def test_the_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--version"])

    assert capsys.readouterr().out == f"mjbeer {version('mjbeer')}\n"


def test_the_help_of_a_fit_without_its_file_names_the_file(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit):
        main(["fit", "liquid", "--help"])

    out = capsys.readouterr().out
    assert out.startswith("usage: mjbeer fit FILE liquid [options]\n")
    assert "--viscosity" in out


@pytest.mark.parametrize("words", ["fit liquid", "fit liquid --fill 0.4"])
def test_a_fit_without_its_file_takes_no_scene_for_one(
    words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status = main(words.split())

    assert status == 2
    message = "the following arguments are required: FILE; see `mjbeer fit --help`"
    assert capsys.readouterr().err == f"mjbeer: {message}\n"


def test_no_command_line_loads_what_draws_before_it_is_needed() -> None:
    """It loads no simulator either, so that a mistake and the help are told at once."""
    heavy = "{'mujoco', 'numba', 'scipy', 'matplotlib', 'mjbeer.studies.sweep'}"
    code = f"import sys; from mjbeer.cli.app import main; main(); print({heavy} & set(sys.modules))"
    assert run(["simulate", "frozen", "--phi0", "x"], code)[1] == "set()\n"


@pytest.mark.parametrize(
    ("angle", "noted"), [("3.14159", True), ("-1.571", True), ("3.14", False), ("60", False)]
)
def test_an_angle_that_looks_like_radians_is_noted(
    angle: str, noted: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["simulate", "frozen", "--duration", "0.01", "--phi0", angle]) == 0
    assert (f"note: phi0 = {angle} is taken as degrees" in capsys.readouterr().err) == noted


def test_what_a_liquid_uses_is_told_and_what_speaks_against_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    options = "--fill 0.7 --phi0 20 --duration 1 --json"

    status = main(["simulate", "liquid", "--liquid", "olive oil", *options.split()])

    assert status == 0
    out, err = capsys.readouterr()
    assumed = liquid_in("olive oil", fill=0.7)
    assert err.startswith(f"{assumed}\nnote: olive oil as one lump is an order of magnitude only")
    run = mjbeer.simulate(mjbeer.liquid("olive oil", fill=0.7), 1, np.radians(20))
    assert json.loads(out)["u at the end [m]"] == run.u[-1]
    assert run.warnings
    assert err.splitlines()[2:] == [f"model does not hold: {warning}" for warning in run.warnings]


def test_an_equation_that_is_not_solved_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    words = "simulate frozen --duration 0.5 --integrator Euler --timestep 4e-3"

    status = main(words.split())

    assert status == 0
    message = "equations not solved: energy or momentum drifts as with an error of "
    assert capsys.readouterr().err.startswith(message)
