"""The stability study: kept task by task, gone on with, judged, and written."""

import json
import pathlib

import pytest
from rich.console import Console

from mjbeer.exceptions import ParameterError
from mjbeer.studies.stability import report, run, stored, tables
from mjbeer.studies.study import Task
from tests.support import stubs

pytestmark = pytest.mark.slow

QUIET = Console(quiet=True)


def run_of(setting: str, verdict: str, as_expected: bool = True, error: float | None = 1e-9) -> dict:
    return {
        "setting": setting, "verdict": verdict, "error": error, "admitted": error, "says": "", "expected": [verdict],
        "as_expected": as_expected,
    }  # fmt: skip


def case(*runs: dict) -> dict:
    return {"kind": "stiff", "name": "a case", "why": "because", "theory": "an oscillation", "runs": list(runs)}


def study(**results: dict) -> run.Stability:
    return run.Stability({"extent": "quick"}, {}, {group: {"a": each} for group, each in results.items()})


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A study of three tasks, of which the second is interrupted the first time."""
    done: list[str] = []

    def measure(name: str) -> dict:
        if name == "b" and "b" not in done:
            done.append("b")
            raise KeyboardInterrupt
        done.append(name)
        return {"as_expected": True, "of": name}

    three = [Task("laws", name, lambda name=name: measure(name)) for name in "abc"]
    monkeypatch.setattr(run, "tasks", lambda extent: three)
    return done


def test_an_interrupted_study_goes_on(counted: list[str], tmp_path: pathlib.Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        run.conduct(tmp_path, "quick", QUIET)
    assert list(run.Stability.load(tmp_path / "stability.json").results["laws"]) == ["a"]
    found = run.conduct(tmp_path, "quick", QUIET)
    assert counted == ["a", "b", "b", "c"]
    assert [each["of"] for each in found.of("laws")] == ["a", "b", "c"]
    assert run.Stability.load(tmp_path / "stability.json") == found


def test_another_study_does_not_go_on_with_it(counted: list[str], tmp_path: pathlib.Path) -> None:
    counted.append("b")
    run.conduct(tmp_path, "quick", QUIET)
    before = len(counted)
    run.conduct(tmp_path, "long", QUIET)
    assert len(counted) == 2 * before - 1
    run.conduct(tmp_path, "long", QUIET)
    assert len(counted) == 2 * before - 1


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"results": {}}'])
def test_what_is_no_study_is_refused(text: str, tmp_path: pathlib.Path) -> None:
    (tmp_path / "stability.json").write_text(text)
    with pytest.raises(ParameterError, match=r"stability\.json was not written by `mjbeer stability`"):
        run.conduct(tmp_path, "quick", QUIET)


@pytest.mark.parametrize(
    ("found", "unexpected"),
    [
        (study(catalogue=case(run_of("reduced, RK4", "stable and accurate"))), []),
        (
            study(catalogue=case(run_of("reduced, RK4", "wrong and silent", False))),
            ["catalogue: a: reduced, RK4"],
        ),
        (study(laws={"as_expected": False}), ["laws: a"]),
        (study(limits={"agrees": False}), ["limits: a"]),
        (study(search={"never": [{"call": "one"}]}), ["search: a"]),
        (study(search={"never": []}, endurance={"as_expected": True}, maps={"agrees": True}), []),
    ],
)
def test_what_is_unexpected_is_named(found: run.Stability, unexpected: list[str]) -> None:
    assert found.unexpected == unexpected


def test_tables_say_what_happened() -> None:
    runs = (
        run_of("reduced, RK4", "stable and accurate"),
        run_of("equality, RK4", "stable, inaccurate", error=0.3),
        run_of("equality, Euler", "unstable, detected", False, error=None),
        run_of("contact, RK4", "refused", error=None),
    )
    found = study(catalogue=case(*runs))
    assert tables.catalogue(found).rows == [
        (
            "stiff: a case",
            "1 accurate (1e-09)",
            "1 stable, inaccurate (3e-01), 1 unstable, detected; 1 UNEXPECTED",
            "1 refused",
        )
    ]
    assert tables.verdicts(found).rows == [("stiff", "1", "1", "1", "1", "0", "0", "0", "0")]
    lines = tables.runs(found).splitlines()
    assert lines[0] == "kind,case,setting,verdict,error,admitted,says,expected,as_expected"
    assert lines[1] == 'stiff,a case,"reduced, RK4",stable and accurate,1e-09,1e-09,,stable and accurate,True'
    assert len(lines) == 5


@pytest.mark.parametrize("extent", run.OPTIONS)
def test_tasks_have_names_of_their_own(extent: str) -> None:
    names = [(each.group, each.name) for each in run.tasks(extent)]
    assert len(set(names)) == len(names)
    groups = {"maps", "damped"}
    if extent != "maps":
        groups |= {"laws", "limits", "catalogue", "search", "endurance"}
    assert {group for group, _ in names} == groups


def test_the_report_is_written(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One task of each group, for real; the maps have a test of their own."""
    stubs.stability(monkeypatch)
    found = run.conduct(tmp_path, "quick", QUIET)
    report.write(found, tmp_path)
    summary = (tmp_path / "summary.md").read_text()
    assert "All came out as theory expects." in summary
    for each in tmp_path.glob("*.svg"):
        assert f"]({each.name})" in summary
        assert each.with_suffix(".png").stat().st_size > 5000
    assert json.loads((tmp_path / "stability.json").read_text())["settings"] == {"extent": "quick"}
    assert len((tmp_path / "runs.csv").read_text().splitlines()) > 3
    assert stored.load(tmp_path / "maps.json")["maps"] == []
