"""The command line: what goes to which stream, and with which exit status it ends."""

import io
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
from importlib.metadata import version

import mujoco
import numpy as np
import pytest

from mjbeer import exact, frozen, hoop, pendulum, simulate, sliding
from mjbeer.cli.app import main
from mjbeer.cli.figures import Figures
from mjbeer.theory.trajectory import csv
from tests.support import stubs

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
    assert target.read_text() == csv(run)
    out, err = capsys.readouterr()
    assert out == Figures(run).text()
    assert err == f"wrote {target}\n" + "".join(f"note: {note}\n" for note in Figures(run).notes)
    time, u, phi = np.loadtxt(target, delimiter=",", skiprows=1, usecols=(0, 1, 2)).T
    truth = exact(SCENES[name], time, math.radians(57), math.radians(-20))
    assert np.abs(phi - truth.phi).max() < RK4
    assert np.abs(u - truth.u).max() < RK4 * SCENES[name].can.radius


def test_standard_output_has_the_csv_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "--duration", "0.05", "--output", "-", "frozen"]) == 0
    out, err = capsys.readouterr()
    assert out == csv(simulate(frozen(), 0.05, math.radians(60)))
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
        ("simulate frozen --timestep 0", "timestep must be between 1e-07 and 10 [s], got 0.0"),
        ("simulate frozen --duration -1", "duration must be greater than 0 [s], got -1.0"),
        ("simulate frozen --tolerance 0", "tolerance must be greater than 0 [rad], got 0.0"),
        ("simulate hoop --radius 0", "hoop radius must be between 0.0001 and 100 [m], got 0.0"),
        ("simulate pendulum --offset 0.04", "load offset must be 0, or between 3.3e-16 and 0.033 [m], got 0.04"),
        ("simulate hoop --friction 0 --rolling contact", "friction must be between 1e-05 and inf, got 0.0"),
        ("simulate sliding --rolling equality", "a massless can with a sliding load exists only in rolling="),
        ("simulate frozen --timestep 0.5 --integrator Euler --phi0 5e5 --duration 900", "the run diverged at t ="),
        ("stability --long --quick", "--long and --quick exclude each other"),
        ("render frozen --output film.avi", "the file's name must end in .mp4, got 'film.avi'"),
        ("render frozen --camera top", "invalid choice 'top' for argument '--camera'"),
        ("simulate frozen --output .", "cannot write .: it is a folder"),
        ("simulate frozen --tolerance 1e-6 --integrator Euler", "give a tolerance or an integrator: a tolerance ch"),
        ("render frozen --integrator RK4 --tolerance 1e-6", "give a tolerance or an integrator: a tolerance ch"),
        ("export frozen --output x.urdf", "MJCF is written: the file's name must end in .xml, got 'x.urdf'"),
        ("export frozen --output x.mjcf", "MJCF is written: the file's name must end in .xml, got 'x.mjcf'"),
        ("export frozen --output x", "MJCF is written: the file's name must end in .xml, got 'x'"),
        ("simulate frozen --json --output -", "standard output takes one of them: the JSON, or the CSV of --output -"),
        ("simulate sliding --integrator rk4", "invalid choice 'rk4' for argument '--integrator'. Expected one of ('Eu"),
        ("export sliding --output x.xml --integrator DOP853", "invalid choice 'DOP853' for argument '--integrator'."),
        ("simulate sliding --rolling gears", "invalid choice 'gears' for argument '--rolling'. Expected one of ('red"),
        ("simulate sliding --phi0 half", "Error parsing --phi0: could not convert string to float: 'half'"),
        ("simulate sliding --tolerance None", "Error parsing --tolerance: could not convert string to float: 'None'"),
        ("simulate sliding --phi0", "Missing value for argument '--phi0'."),
        ("simulate sliding more", "Unrecognized options: more"),
        ("simlate sliding", "Unrecognized options: simlate, sliding; available subcommands: simulate, render, view, "),
        ("simulate slding", "Unrecognized options: slding; available subcommands: sliding, liquid, frozen, pendulum, "),
        ("simulate --duraton 3 sliding", "Unrecognized options: --duraton, 3; did you mean --duration?\n"),
        ("simulate sliding --phi 3", "Unrecognized options: --phi, 3; did you mean --phi-dot0 or --phi0?\n"),
        ("paper --xyzzy", "Unrecognized options: --xyzzy\n"),
        (
            "simulate frozen --speed=2",
            "Unrecognized options: --speed=2; it belongs to mjbeer render or mjbeer view\n",
        ),
        (
            "simulate --fill 0.3 sliding",
            "Unrecognized or misplaced options: --fill (applied to mjbeer simulate) 0.3 (applied to mjbeer simulate); "
            "it belongs to mjbeer simulate sliding or ",
        ),
        ("", "Expected one of {simulate, render, view, export, "),
        ("simulate", "Expected one of {sliding, liquid, frozen, pendulum, hoop}."),
        ("--tyro-print-completion tcsh", "words are completed in bash, zsh and fish"),
        ("export sliding", "Missing from mjbeer export: --output PATH"),
        ("benchmark slding", "invalid choice 'slding' for argument 'scenes'. Expected one of ('sliding', "),
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


def test_an_error_is_one_line_however_it_is_drawn() -> None:
    """In boxes or, where standard output has no such letters, in dashes; in a narrow or a wide terminal."""
    for encoding in ("utf-8", "ascii"):
        for columns in ("40", "200"):
            done = subprocess.run(
                [sys.executable, "-m", "mjbeer", "simulate", "frozen", "--rolling", "gears"],
                env=os.environ | {"PYTHONIOENCODING": encoding, "COLUMNS": columns},
                capture_output=True, text=True, check=False,
            )  # fmt: skip
            assert (done.returncode, done.stdout) == (2, "")
            assert done.stderr == (
                "mjbeer: invalid choice 'gears' for argument '--rolling'. "
                "Expected one of ('reduced', 'equality', 'contact').\n"
            )


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("simulate frozen --integrator Euler --timestep 0.01", "as a run at other timesteps shows"),
        ("simulate frozen --phi0 180 --duration 1", "the incline would have to pull at the can"),
        ("simulate hoop --rolling contact --friction 0.01 --duration 0.3", "the can slips by"),
    ],
)
def test_a_run_that_is_not_to_be_trusted_says_so(words: str, reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*words.split(), "--output", "-"]) == 0
    out, err = capsys.readouterr()
    assert any(line.startswith("not to be trusted: ") and reason in line for line in err.splitlines())
    assert "not to be trusted" not in out


def test_a_real_can_that_would_slip_is_a_note(capsys: pytest.CaptureFixture[str]) -> None:
    """The motion is right, and yet no can moves like that."""
    words = "simulate frozen --phi0 180 --duration 0.8 --friction 0.6"
    assert main([*words.split(), "--output", "-"]) == 0
    out, err = capsys.readouterr()
    (note,) = Figures(simulate(frozen(), 0.8, math.pi), 0.6).notes
    assert err.splitlines()[-1] == f"note: {note}"
    assert "note" not in out


def test_standard_output_has_the_json_alone(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "motion.csv"
    words = f"simulate frozen --phi0 180 --duration 1 --friction 0.6 --json --output {target}"
    assert main(words.split()) == 0
    out, err = capsys.readouterr()
    run = simulate(frozen(), 1.0, math.pi)
    content = json.loads(out, parse_constant=pytest.fail)
    assert content == json.loads(Figures(run, 0.6).json())
    assert (content["trusted"], content["warnings"]) == (False, list(run.warnings))
    assert err.splitlines()[0] == f"wrote {target}"
    assert target.read_text() == csv(run)


def test_a_tolerance_has_the_integrator_that_keeps_it(capsys: pytest.CaptureFixture[str]) -> None:
    for rolling, integrator in (("reduced", "GaussJackson"), ("equality", "DOP853")):
        assert main(f"simulate frozen --rolling {rolling} --duration 1 --tolerance 1e-9".split()) == 0
        assert f"{rolling}, {integrator}" in capsys.readouterr().out
    assert main(["simulate", "frozen", "--duration", "0.1"]) == 0
    assert "reduced, RK4" in capsys.readouterr().out


def test_the_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"mjbeer {version('mjbeer')}\n"


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("mjbeer sim", "simulate"),
        ("mjbeer simulate sl", "sliding"),
        ("mjbeer simulate --tol", "--tolerance"),
        ("mjbeer simulate --rolling con", "contact"),
        ("mjbeer simulate sliding --fi", "--fill"),
    ],
)
def test_the_shell_completes(
    typed: str, offered: str, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--tyro-print-completion", "bash"])
    assert not ended.value.code
    script = tmp_path / "completion.bash"
    script.write_text(
        capsys.readouterr().out + f"COMP_WORDS=({typed})\nCOMP_CWORD={len(typed.split()) - 1}\n"
        "$(complete -p mjbeer | sed 's/.*-F \\([^ ]*\\).*/\\1/')\n" + 'echo "${COMPREPLY[@]}"\n'
    )
    done = subprocess.run(["bash", str(script)], capture_output=True, text=True, check=True)
    assert done.stdout == f"{offered}\n"


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


@pytest.mark.parametrize(("speed", "advice"), [("1", "0.2"), ("0.3", "0.2"), ("0.295", "0.2"), ("0.285", None)])
def test_a_film_in_which_a_can_turns_too_fast_for_the_eye_is_noted(
    speed: str,
    advice: str | None,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """In 2 s with g sin(10 degrees) a massless can of 33 mm comes to 103 rad/s, 1 rad in 0.29/30 s."""
    stubs.draw(monkeypatch)
    words = ["render", "sliding", "--phi0", "0", "--speed", speed, "--output", str(tmp_path / "film.mp4")]
    assert main(words) == 0
    err = capsys.readouterr().err
    assert re.findall(r"--speed (\S+) shows it better", err) == ([advice] if advice else [])


@pytest.mark.parametrize(
    ("angle", "noted"),
    [("3.14159", True), ("-1.571", True), ("0.5236", True), ("3.14", False), ("1.5", False), ("60", False)],
)
def test_an_angle_that_looks_like_radians_is_noted(angle: str, noted: bool, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "frozen", "--duration", "0.01", "--phi0", angle]) == 0
    assert (f"note: phi0 = {angle} is taken as degrees" in capsys.readouterr().err) == noted


def test_an_export_says_how_its_start_is_loaded(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "can.xml"
    assert main(["export", "frozen", "--phi0", "30", "--output", str(target)]) == 0
    said = capsys.readouterr().err.split(": ")[1]
    assert 'The start is the keyframe "start"' in target.read_text().replace("'start'", '"start"')
    model = mujoco.MjModel.from_xml_path(str(target))
    data = mujoco.MjData(model)
    exec(said, {"mujoco": mujoco, "model": model, "data": data})
    assert data.joint("phi").qpos[0] == math.radians(30)
