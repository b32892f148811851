"""The maps that come with mjbeer: what the study writes, and what it says of itself."""

import datetime
import json
import pathlib

import pytest

from mjbeer.cli.app import main
from mjbeer.exceptions import ParameterError
from mjbeer.studies.stability import damped_maps, maps, stored
from mjbeer.studies.stability.damped_runs import SILENT
from mjbeer.studies.stability.run import OPTIONS, Stability

pytestmark = pytest.mark.slow

DAY = datetime.date(2026, 11, 21)


def measured(name: str) -> dict:
    """A map of a full study, measured now with four timesteps and stiffnesses."""
    return next(maps.measure(plan, 4) for plan in maps.PLANS if plan.name == name)


def damped() -> dict:
    """A map of the damping, measured now with two timesteps and dampings."""
    return damped_maps.measure("reduced", "RK4", (2, 2))


def test_the_stored_maps_are_all_that_the_study_makes_and_agree_with_theory() -> None:
    kept = stored.load()
    assert [each["name"] for each in kept["maps"]] == [task.name for task in maps.tasks()]
    assert all(each["agrees"] and each["same"] == 1 for each in kept["maps"])
    assert [each["name"] for each in kept["damped"]] == [task.name for task in damped_maps.tasks()]
    assert all(each["agrees"] for each in kept["damped"])
    assert str(SILENT) not in "".join(row for each in kept["damped"] for row in each["measured"])
    assert kept["command"] == "mjbeer stability --maps"
    assert datetime.date.fromisoformat(kept["date"]) >= DAY
    assert {"processor", "system", "python", "versions"} <= set(kept["machine"])


def test_the_stored_file_has_the_form_that_the_study_writes() -> None:
    kept = stored.load()
    results = {"maps": {"a map": measured("gravity, Euler")}, "damped": {"a map": damped()}}
    study = Stability({"extent": "maps"}, kept["machine"], results)
    written = json.loads(stored.to_json(study, DAY))
    assert list(written) == list(kept)
    (now,) = written["damped"]
    for each in kept["damped"]:
        assert list(each) == list(now)
        columns, rows = damped_maps.CELLS
        assert (len(each["timesteps"]), len(each["values"])) == (columns, rows)
        assert [len(row) for row in each["measured"]] == [columns] * rows
        assert [len(edge) for edge in each["boundaries"]] == [2] * rows
    (now,) = written["maps"]
    for each in kept["maps"]:
        assert list(each) == list(now)
        assert {name: type(value) for name, value in each.items()} == {name: type(value) for name, value in now.items()}
        assert len(each["timesteps"]) == len(each["values"]) == maps.CELLS
        assert [len(row) for row in each["measured"]] == [maps.CELLS] * maps.CELLS
        assert set("".join(each["measured"])) <= set("012")
        assert [len(edge) for edge in each["boundaries"]] == [2] * maps.CELLS


def test_a_stored_map_is_what_is_measured_now() -> None:
    """The corners of a stored map are cells of a coarser one over the same ranges."""
    (kept,) = (each for each in stored.load()["maps"] if each["name"] == "gravity, RK4")
    now = measured("gravity, RK4")
    corners = [[kept["measured"][row][column] for column in (0, -1)] for row in (0, -1)]
    assert corners == [[str(now["measured"][row][column]) for column in (0, -1)] for row in (0, -1)]
    assert kept["timesteps"][:: maps.CELLS - 1] == pytest.approx(now["timesteps"][::3], rel=1e-5)
    assert kept["boundaries"][-1] == pytest.approx(
        [now["boundaries"][-1]["measured"], now["boundaries"][-1]["predicted"]], rel=maps.AGREEMENT
    )


def test_a_stored_map_of_the_damping_is_what_is_measured_now() -> None:
    (kept,) = (each for each in stored.load()["damped"] if each["name"] == "reduced, RK4")
    now = damped()
    corners = [[kept["measured"][row][column] for column in (0, -1)] for row in (0, -1)]
    assert corners == [[str(cell) for cell in row] for row in now["measured"]]


@pytest.mark.parametrize(("extent", "option"), OPTIONS.items())
def test_the_command_is_the_one_that_was_given(extent: str, option: str) -> None:
    document = json.loads(stored.to_json(Stability({"extent": extent}, {}), DAY))
    assert document["command"] == f"mjbeer stability {f'--{option}' if option else ''}".strip()
    assert document["date"] == "2026-11-21"


def test_another_file_is_refused(tmp_path: pathlib.Path) -> None:
    for text in ("no JSON", "{}", "[]"):
        (tmp_path / "maps.json").write_text(text)
        with pytest.raises(ParameterError, match=r"maps\.json was not written by `mjbeer stability`"):
            stored.load(tmp_path / "maps.json")


def test_maps_alone_make_a_report(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(maps, "CELLS", 4)
    monkeypatch.setattr(maps, "PLANS", maps.PLANS[:1])
    monkeypatch.setattr(damped_maps, "CELLS", (2, 2))
    monkeypatch.setattr(damped_maps, "PLANS", damped_maps.PLANS[:1])
    assert main(["stability", "--maps", "--output", str(tmp_path)]) == 0
    capsys.readouterr()
    assert [each["name"] for each in stored.load(tmp_path / "maps.json")["maps"]] == ["equality, Euler"]
    assert "Maps of timestep and stiffness" in (tmp_path / "summary.md").read_text()
    assert (tmp_path / "stability-solref.svg").exists()
    assert (tmp_path / "stability-damping.svg").exists()


@pytest.mark.parametrize("options", [("--long", "--quick"), ("--long", "--maps"), ("--quick", "--maps")])
def test_only_one_extent_can_be_asked_for(options: tuple[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stability", *options]) == 2
    assert f"{options[0]} and {options[1]} exclude each other" in capsys.readouterr().err
