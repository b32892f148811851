"""Damping and real liquids on the command line: what is used is told, and what is not allowed is one line."""

import json
import pathlib
import warnings

import numpy as np
import pytest

import mjbeer
from mjbeer.cli.app import main
from mjbeer.cli.studies import Paper
from mjbeer.exceptions import LiquidWarning
from mjbeer.theory.liquid import liquid_in


def test_what_a_liquid_uses_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["simulate", "liquid", "--liquid", "olive oil", "--fill", "0.7", "--phi0", "20", "--duration", "0.1"]
    assert main([*words, "--json"]) == 0
    out, err = capsys.readouterr()
    assert err.startswith(
        f"{liquid_in('olive oil', fill=0.7)}\nnote: olive oil as one lump is an order of magnitude only"
    )
    run = mjbeer.simulate(mjbeer.liquid("olive oil", fill=0.7), 0.1, np.radians(20))
    assert json.loads(out)["u at the end [m]"] == run.u[-1]


def test_its_viscosity_and_density_may_be_given(capsys: pytest.CaptureFixture[str]) -> None:
    words = "simulate liquid --viscosity 2e-5 --density 900 --incline 5 --duration 0.01"
    assert main(words.split()) == 0
    told = capsys.readouterr().err
    assert told.startswith("water: 900 kg/m^3, 2e-05 m^2/s, damped by thin layers at a slip rate of ")


def test_a_thick_liquid_is_noted_in_one_line(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "liquid", "--liquid", "honey", "--duration", "0.01"]) == 0
    _, note = capsys.readouterr().err.splitlines()
    assert note.startswith("note: honey as one lump is an order of magnitude only: it coats the can")
    path = tmp_path / "map.csv"
    words = f"sweep liquid --liquid honey --fill 0.4,0.5,0.6 --incline 5,10 --duration 0.01 --output {path}"
    assert main(words.split()) == 0
    assert capsys.readouterr().err.count("coats the can") == 1


def test_each_scene_of_a_sweep_has_the_damping_of_its_incline(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "map.npz"
    words = f"sweep liquid --incline 5,20 --viscosity 1e-6,1e-5 --phi0 20 --duration 0.2 --output {path}"
    assert main(words.split()) == 0
    inclines, viscosities = np.radians([5, 20]), [1e-6, 1e-5]
    same = mjbeer.sweep(
        mjbeer.liquid, 0.2, np.radians(20), tolerance=1e-6, incline=inclines, viscosity=viscosities, progress=False
    )
    assert np.load(path)["u"].tolist() == same["u"].tolist()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("simulate sliding --damping -1", "damping must be 0 or greater [N m s], got -1.0"),
        ("simulate sliding --damping inf", "damping must be a finite number [N m s], got inf"),
        ("simulate sliding --drag -1", "drag must be 0 or greater [kg/m], got -1.0"),
        ("simulate frozen --damping 1", "misplaced options: --damping (applied to mjbeer simulate frozen)"),
        ("sweep sliding --damping 0,-1", "damping[1]: damping must be 0 or greater [N m s], got -1.0"),
        ("view liquid --liquid hony", "'glycerol', 'honey'; got 'hony': did you mean 'honey'?"),
        ("simulate liquid --viscosity -1", "viscosity must be greater than 0 [m^2/s], got -1.0"),
        ("simulate liquid --viscosity nan", "viscosity must be a finite number [m^2/s], got nan"),
        ("simulate liquid --viscosity 1e-12", "the layer on the wall is turbulent"),
        ("simulate liquid --fill 1", "fill must be less than 1"),
        ("simulate liquid --incline 90", "incline must be between -90 and 90 [degrees], got 90.0"),
    ],
)
def test_what_is_not_allowed_is_one_line(words: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err
    assert err.count("\n") == 1


def test_a_damped_scene_is_exported(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "can.xml"
    words = f"export sliding --damping 1e-3 --can metal --rolling equality --output {path}"
    assert main(words.split()) == 0
    assert 'damping="0.001"' in path.read_text()


def test_a_study_is_not_interrupted_by_what_it_says_of_liquids_elsewhere(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def run(_: Paper) -> int:
        warnings.warn("no lump", LiquidWarning, stacklevel=2)
        return 0

    monkeypatch.setattr(Paper, "run", run)
    assert main(["paper"]) == 0
    assert capsys.readouterr().err == ""
