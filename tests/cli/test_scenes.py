"""`mjbeer scenes` says of every scene what its argument class says, and the defaults are those of Python."""

import csv
import inspect
import io
import math

import pytest

import mjbeer
from mjbeer.cli.app import main
from mjbeer.cli.arguments import SCENES
from mjbeer.cli.scenes import options
from mjbeer.output import terminal

UNITS = {
    "--incline": "degrees", "--radius": "m", "--length": "m", "--gravity": "m/s^2", "--fill": "",
    "--density": "kg/m^3", "--can": "", "--wheel-mass": "kg", "--load-mass": "kg", "--offset": "m", "--hoop-mass": "kg",
    "--damping": "N m s", "--drag": "kg/m", "--liquid": "", "--viscosity": "m^2/s",
}  # fmt: skip


@pytest.fixture
def listed(capsys: pytest.CaptureFixture[str]) -> list[dict[str, str]]:
    """The rows that a program reads."""
    assert main(["scenes"]) == 0
    return list(csv.DictReader(io.StringIO(capsys.readouterr().out), delimiter="\t", quoting=csv.QUOTE_NONE))


def test_every_scene_and_every_unit(listed: list[dict[str, str]]) -> None:
    assert {row["scene"] for row in listed} == set(SCENES) == {"sliding", "liquid", "frozen", "pendulum", "hoop"}
    assert {row["option"]: row["unit"] for row in listed} == UNITS
    assert all(row["meaning"].endswith(".") for row in listed)


@pytest.mark.parametrize("name", SCENES)
def test_the_defaults_are_those_of_python(name: str, listed: list[dict[str, str]]) -> None:
    said = {row["option"]: row["default"] for row in listed if row["scene"] == name}
    meant = inspect.signature(getattr(mjbeer, name)).parameters
    shared = [each for each in meant if f"--{each.replace('_', '-')}" in said and each != "can"]
    assert {"incline", "gravity"} <= set(shared)
    for each in shared:
        text = said[f"--{each.replace('_', '-')}"]
        if meant[each].default is None:
            assert text == "the liquid's own"
            continue
        value = float(text)
        assert (math.radians(value) if each == "incline" else value) == pytest.approx(meant[each].default, rel=1e-6)
    assert ("--can" in said) == ("can" in meant)
    assert said.get("--liquid") == (meant["name"].default if "name" in meant else None)


def test_no_option_is_left_out(listed: list[dict[str, str]], capsys: pytest.CaptureFixture[str]) -> None:
    for name in SCENES:
        with pytest.raises(SystemExit):
            main(["export", name, "--help"])
        text = capsys.readouterr().out
        assert all(f"{row['option']} " in text for row in listed if row["scene"] == name)
        assert len(options(name)) == len([row for row in listed if row["scene"] == name])


def test_an_eye_reads_each_option_once(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr(terminal, "is_read_by_eye", lambda: True)
    assert main(["scenes"]) == 0
    out = capsys.readouterr().out
    assert out.count("--radius") == 1
    assert out.count("--incline") == 2  # the hoop's is 0
    assert "10 degrees" in out
    assert all(name in out for name in SCENES)
    assert max(len(line) for line in out.splitlines()) <= 80
