"""The stability study as a whole: its rows, what it writes, and the maps that come with mjbeer."""

import datetime
import json
import math
import pathlib
from functools import partial

import pytest

from mjbeer.cli.app import main
from mjbeer.exceptions import ParameterError
from mjbeer.studies.study import Result, Row, Study
from mjbeer.studies.stability import stiff_maps, study
from mjbeer.studies.stability.stiff_maps import CELLS, DAMPED_CELLS, PLANS, measure, measure_damped
from mjbeer.studies.stability.stiff_runs import SILENT
from tests.support import figures, stubs

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("extent", study.EXTENTS)
def test_rows_have_names_of_their_own(extent: str) -> None:
    names = [(row.group, row.name) for row in study.plan(extent)]
    assert len(set(names)) == len(names)
    searched = {"limits", "cases", "search"} if extent != "maps" else set()
    assert {group for group, _ in names} == {"maps", "damped", *searched}


def test_the_study_is_written(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One row of each group, for real; the maps are small."""
    stubs.stability(monkeypatch)
    seen = figures.saved(monkeypatch)
    assert main(["stability", "--quick", "--json", "--output", str(tmp_path)]) == 0
    assert json.loads(capsys.readouterr().out)["failed"] == []
    found = Study.load(tmp_path / "stability.jsonl", "mjbeer stability")
    assert {result.group for result in found.results} == {"limits", "maps", "damped", "cases", "search"}
    summary = (tmp_path / "summary.md").read_text()
    assert "All came out as theory expects." in summary
    drawn = sorted(each.stem for each in tmp_path.glob("*.svg"))
    assert drawn == ["stability-damping", "stability-solref"]
    for name in drawn:
        assert f"]({name}.svg)" in summary
    assert [figures.faults(figure) for figure in seen] == [[], []]
    kept = stiff_maps.load(tmp_path / "maps.json")
    assert [each["name"] for each in kept["maps"]] == ["equality, Euler"]
    assert kept["command"] == "mjbeer stability --quick"
    found.results[0] = Result("limits", "a limit", bound=0.05, error=0.1, values=found.results[0].values)
    study.write(found, tmp_path)
    assert "**1 did not come out as theory expects.**" in (tmp_path / "summary.md").read_text()


def test_the_stored_maps_are_all_that_the_study_makes_and_agree_with_theory() -> None:
    kept = stiff_maps.load()
    rows = stiff_maps.rows()
    for group in ("maps", "damped"):
        assert [each["name"] for each in kept[group]] == [row.name for row in rows if row.group == group]
        assert all(each["agrees"] for each in kept[group])
    assert all(each["same"] == 1 for each in kept["maps"])
    assert str(SILENT) not in "".join(row for each in kept["damped"] for row in each["measured"])
    assert kept["command"] == "mjbeer stability --maps"
    assert datetime.date.fromisoformat(kept["date"]) >= datetime.date(2026, 11, 21)
    assert {"processor", "system", "python", "versions"} <= set(kept["machine"])
    for group, (columns, lines) in (("maps", CELLS), ("damped", DAMPED_CELLS)):
        for each in kept[group]:
            assert (len(each["timesteps"]), len(each["values"]), len(each["boundaries"])) == (columns, lines, lines)
            assert [len(row) for row in each["measured"]] == [columns] * lines


def test_stored_maps_are_what_is_measured_now_in_the_form_in_which_they_are_kept() -> None:
    """The corners of a stored map are cells of a coarser one over the same ranges."""
    (plan,) = (plan for plan in PLANS if plan.name == "gravity, RK4")
    corners = (2, 2)
    made = {
        "maps": Row("maps", plan.name, partial(measure, plan, corners)),
        "damped": Row("damped", "reduced, RK4", partial(measure_damped, "reduced", "RK4", corners)),
    }
    whole = Study("mjbeer stability", {"extent": "maps"}, {}, [row.result() for row in made.values()])
    document, stored = json.loads(stiff_maps.to_json(whole, datetime.date.today())), stiff_maps.load()
    assert list(document) == list(stored)
    for group, row in made.items():
        (kept,), (now,) = ([each for each in of[group] if each["name"] == row.name] for of in (stored, document))
        assert set(now) <= set(kept)
        assert now["timesteps"] == [kept["timesteps"][place] for place in (0, -1)]
        for place in (0, -1):
            assert now["measured"][place] == kept["measured"][place][0] + kept["measured"][place][-1]
            stretches = ([edge or math.inf for edge in of["boundaries"][place]] for of in (kept, now))
            assert next(stretches) == pytest.approx(next(stretches), rel=0.05)


@pytest.mark.parametrize("text", ["no JSON", "{}", "[]"])
def test_another_file_is_refused(text: str, tmp_path: pathlib.Path) -> None:
    (tmp_path / "maps.json").write_text(text)
    with pytest.raises(ParameterError, match=r"maps\.json was not written by `mjbeer stability`"):
        stiff_maps.load(tmp_path / "maps.json")


@pytest.mark.parametrize("options", [("--long", "--quick"), ("--long", "--maps"), ("--quick", "--maps")])
def test_only_one_extent_can_be_asked_for(options: tuple[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stability", *options]) == 2
    assert f"{options[0]} and {options[1]} exclude each other" in capsys.readouterr().err
