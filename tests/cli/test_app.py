"""The command line: what goes to which stream, and with which exit status it ends."""

import io
import math
import os
import pathlib
import shutil
import subprocess
import sysconfig

import numpy as np
import pytest

from mjbeer import exact, frozen, hoop, pendulum, simulate, sliding
from mjbeer.cli import trajectory
from mjbeer.cli.app import main

pytestmark = pytest.mark.slow

SCENES = {"sliding": sliding(), "frozen": frozen(), "pendulum": pendulum(), "hoop": hoop()}
# RK4 at 1 ms over 0.1 s: 2e-6 rad for the light hoop, whose load turns at 45 rad/s at the bottom; 1e-8 for others.
RK4 = 1e-5


def entry(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run the installed console script."""
    script = shutil.which("mjbeer", path=sysconfig.get_path("scripts"))
    assert script is not None
    return subprocess.run([script, *arguments], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", SCENES)
def test_simulate_writes_the_trajectory(name: str, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "new" / "motion.csv"
    assert main(["simulate", name, "--phi0", "57", "--phi-dot0", "-20", "--duration", "0.1", f"--output={target}"]) == 0
    run = simulate(SCENES[name], 0.1, math.radians(57), math.radians(-20))
    assert target.read_text() == trajectory.csv(run)
    out, err = capsys.readouterr()
    assert "phi at the end" in out
    assert err == f"wrote {target}\n"
    time, u, phi = np.loadtxt(target, delimiter=",", skiprows=1, usecols=(0, 1, 2)).T
    truth = exact(SCENES[name], time, math.radians(57), math.radians(-20))
    assert np.abs(phi - truth.phi).max() < RK4
    assert np.abs(u - truth.u).max() < RK4 * SCENES[name].can.radius


def test_standard_output_has_the_csv_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "--duration", "0.05", "--output", "-", "frozen"]) == 0
    out, err = capsys.readouterr()
    assert out == trajectory.csv(simulate(frozen(), 0.05, math.radians(60)))
    assert "phi at the end" in err


def test_without_output_no_file_is_written(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["simulate", "frozen", "--duration", "0.05"]) == 0
    assert capsys.readouterr().err == ""
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("simulate sliding --incline 100", "incline must be between -90 and 90 [degrees], got 100.0"),
        ("export frozen --output x.xml --incline nan", "incline must be between -90 and 90 [degrees], got nan"),
        ("simulate sliding --phi0 inf", "phi0 must be a finite number [degrees], got inf"),
        ("export frozen --output x.xml --phi-dot0 nan", "phi_dot0 must be a finite number [degrees/s], got nan"),
        ("simulate sliding --fill 0", "fill (height of the beer over the can's diameter) must be in (0, 1], got 0.0"),
        ("simulate frozen --fill 1.2", "fill (height of the beer over the can's diameter) must be in (0, 1], got 1.2"),
        ("simulate frozen --timestep 0", "timestep must be greater than 0 [s], got 0.0"),
        ("simulate frozen --duration -1", "duration must be greater than 0 [s], got -1.0"),
        ("simulate frozen --tolerance 0", "tolerance must be greater than 0 [rad], got 0.0"),
        ("simulate hoop --radius 0", "hoop radius must be greater than 0 [m], got 0.0"),
        ("simulate pendulum --offset 0.04", "the load must be inside the can"),
        ("simulate hoop --friction 0 --rolling contact", "friction must be greater than 0, got 0.0"),
        ("simulate sliding --rolling equality", "a massless can with a sliding load exists only in rolling="),
        ("simulate frozen --timestep 0.5 --integrator Euler --phi0 3e9 --duration 900", "the run diverged at t ="),
        ("render frozen --output film.avi", "the file's name must end in .mp4, got 'film.avi'"),
        ("render frozen --camera top", "camera must be one of 'side', 'quarter', 'overview'; got 'top'"),
        ("simulate frozen --output .", "cannot write .: it is a folder"),
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
    assert main(words.split()) == 2
    out, err = capsys.readouterr()
    assert err.startswith(f"mjbeer: {message}")
    assert err.count("\n") == 1
    assert out == ""
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize(
    ("words", "named"),
    [
        ("simulate rolling", "rolling"),
        ("simulate sliding --integrator rk4", "'rk4'"),
        ("export sliding --output x.xml --integrator DOP853", "'DOP853'"),
        ("simulate sliding --rolling gears", "'gears'"),
        ("simulate sliding --phi0 half", "half"),
        ("simulate sliding --wheel-mass 1", "--wheel-mass"),
        ("export sliding", "--output"),
        ("simulate", "sliding, frozen, pendulum, hoop"),
        ("", "simulate, render, view, export, validate, benchmark, advise, stability, report, paper"),
    ],
)
def test_what_is_not_understood_ends_with_exit_status_2(
    words: str, named: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "120")
    with pytest.raises(SystemExit) as ended:
        main(words.split())
    out, err = capsys.readouterr()
    assert ended.value.code == 2
    assert named in err
    assert out == ""


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("simulate frozen --integrator Euler --timestep 0.01", "as a run at half the timestep shows"),
        ("simulate frozen --phi0 180 --duration 1", "the incline would have to pull at the can"),
        ("simulate hoop --rolling contact --friction 0.01 --duration 0.3", "the can slips by"),
    ],
)
def test_a_run_that_is_not_to_be_trusted_says_so(words: str, reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*words.split(), "--output", "-"]) == 0
    out, err = capsys.readouterr()
    assert any(line.startswith("not to be trusted: ") and reason in line for line in err.splitlines())
    assert "not to be trusted" not in out


def test_names_of_files_are_shown_as_they_are(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    # Brackets are markup to the library that prints.
    monkeypatch.chdir(tmp_path)
    for name in ("run[red].csv", "run[", "a very long name " * 12 + "[bold].csv"):
        assert main(["simulate", "frozen", "--duration", "0.01", "--output", name]) == 0
        assert capsys.readouterr().err == f"wrote {name}\n"
        assert (tmp_path / name).is_file()
    assert main(["simulate", "frozen", "--duration", "0.01", "--output", "b[/c].csv"]) == 0
    assert capsys.readouterr().err == "wrote b[/c].csv\n"


def test_the_console_script_runs_and_its_output_can_be_read() -> None:
    done = entry("simulate", "frozen", "--duration", "0.05", "--output", "-")
    rows = np.loadtxt(io.StringIO(done.stdout), delimiter=",", skiprows=1)
    assert done.returncode == 0
    assert np.array_equal(rows[:, 2], simulate(frozen(), 0.05, math.radians(60)).phi)


def test_the_console_script_passes_on_the_exit_status() -> None:
    done = entry("simulate", "frozen", "--fill", "2")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.splitlines() == [
        "mjbeer: fill (height of the beer over the can's diameter) must be in (0, 1], got 2.0"
    ]
