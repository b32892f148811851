"""`mjbeer sweep`: ranges on the command line, in degrees, and a file of each kind."""

import pathlib

import numpy as np
import pytest

import mjbeer
from mjbeer.cli.app import main
from mjbeer.cli.sweep import values
from mjbeer.exceptions import ParameterError


def test_a_range_a_list_or_a_number() -> None:
    assert values("3") == (3.0,)
    assert values("1,2,5") == (1.0, 2.0, 5.0)
    assert values("-1:1:5") == (-1.0, -0.5, 0.0, 0.5, 1.0)


@pytest.mark.parametrize("text", ["", "x", "1:2", "1:2:0", "1:2:0.5", "1:2:3:4", "1,,2", "1:2:1e3", "nan", "0:inf:3"])
def test_what_is_none_of_these_is_refused(text: str) -> None:
    with pytest.raises(ParameterError):
        values(text)


@pytest.mark.parametrize("ending", [".csv", ".npz", ".nc", ".png", ".svg"])
def test_the_file_has_what_python_gives(
    ending: str, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"map{ending}"
    words = f"sweep frozen --incline 5:60:2 --fill 0.3,0.5 --phi0 20 --duration 0.8 --quantity period --output {path}"
    assert main(words.split()) == 0
    told = capsys.readouterr()
    assert told.out == "2 of 4 scenes went well; 2: a quantity has no value\n"
    assert f"wrote {path}" in told.err
    assert told.err.startswith(
        "failed: 2 scenes, the first at incline = 60, fill = 0.3: period: no equilibrium at an incline of 60 degrees"
    )
    if ending in (".csv", ".npz"):
        same = mjbeer.sweep(
            mjbeer.frozen, 0.8, np.radians(20), tolerance=1e-6, incline=np.radians([5, 60]), fill=[0.3, 0.5]
        )
        phi = np.load(path)["phi"] if ending == ".npz" else np.genfromtxt(path, delimiter=",", names=True)["phi_rad"]
        assert phi.ravel().tolist() == same["phi"].ravel().tolist()
    elif ending in (".png", ".svg"):
        assert path.stat().st_size > 5000


def test_a_file_of_another_sweep_is_replaced_on_request_only(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["sweep", "frozen", "--fill", "0.3,0.5", "--output", str(tmp_path / "map.npz"), "--duration"]
    assert main([*words, "0.1"]) == main([*words, "0.1"]) == 0
    assert main([*words, "0.2"]) == 2
    assert "map.npz has another sweep, whose end [s] differ" in capsys.readouterr().err.replace("\n", " ")
    assert main([*words, "0.2", "--overwrite"]) == 0


def test_scenes_without_a_period_are_counted_by_reason(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The longest of these swings takes 2.4 s: 3.7 s hold the three turning points that 2 s do not."""
    words = f"sweep frozen --incline 1,2,20 --fill 0.5,0.85,0.9 --quantity period --output {tmp_path / 'map.csv'}"
    assert main(words.split()) == 0
    short, none = capsys.readouterr().err.splitlines()[:2]
    assert none.startswith("failed: 2 scenes, the first at incline = 20, fill = 0.85: period: no equilibrium at an inc")
    assert short.startswith("failed: 4 scenes, the first at incline = 1, fill = 0.85: period: only a longer duration ")
    assert main([*words.split(), "--duration", "3.7"]) == 0
    assert capsys.readouterr().out == "7 of 9 scenes went well; 2: a quantity has no value\n"


def test_a_can_that_rolls_on_has_no_period_however_long(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = f"sweep frozen --phi0 60,170 --quantity period --output {tmp_path / 'map.csv'}"
    assert main(words.split()) == 0
    assert "longer" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("sweep frozen --incline 1:100:3", "incline[2] must be between -90 and 90 [degrees], got 100.0"),
        ("sweep frozen --incline 95", "incline must be between -90 and 90 [degrees], got 95.0"),
        ("sweep frozen --fill 0.5:1.5:3", "fill[2]: fill (height of the beer over the can's diameter) must be in"),
        ("sweep frozen --fill 1:2", "'1:2' is no number, no list as 1,2,5, and no range as 1:20:39"),
        ("sweep frozen", "a plot needs one or two options with several values, got 0: write .csv, .npz or .nc"),
        ("sweep frozen --fill 0.2,0.3 --output map.jpg", "name must end in .png or .svg or .csv or .npz or .nc, got"),
        ("sweep --fill 0.2,0.3 frozen", "options: --fill (applied to mjbeer sweep)"),
        ("sweep frozn", "Unrecognized options: frozn; available subcommands: sliding, liquid, frozen, pendulum, hoop"),
        ("sweep", "Expected one of {sliding, liquid, frozen, pendulum, hoop}."),
    ],
)
def test_what_is_not_allowed_is_one_line(
    words: str,
    message: str,
    tmp_path: pathlib.Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words.split()) == 2
    told = capsys.readouterr().err
    assert message in told.replace("\n", " ")
    assert not list(tmp_path.iterdir())


def test_all_scenes_and_a_metal_can(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    for scene, option in (("sliding", "--can metal --fill"), ("pendulum", "--offset"), ("hoop", "--load-mass")):
        path = tmp_path / f"{scene}.csv"
        setting = "--phi0 20 --duration 0.1 --rolling contact --integrator RK4"
        words = f"sweep {scene} {option} 0.01,0.02 {setting} --output {path}"
        assert main(words.split()) == 0
        assert len(path.read_text().splitlines()) == 3
    assert capsys.readouterr().out == "2 of 2 scenes went well\n" * 3
