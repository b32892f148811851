"""mjbeer validate and mjbeer report: exit status, streams, and the files that appear."""

import json
import math
import os
import pathlib

import pytest

from mjbeer.cli.app import main
from mjbeer.drawing import opengl
from mjbeer.exceptions import MjbeerError
from tests.support import stubs

FILMS = ("sliding", "frozen", "pendulum", "hoop")
FILES = {"validation.json", "summary.md", "paper", *(f"{film}.{kind}" for film in FILMS for kind in ("mp4", "png"))}


@pytest.mark.parametrize(("error", "status"), [(1e-4, 0), (1e-3, 0), (2e-3, 1), (math.nan, 1)])
def test_the_exit_status_of_validate(
    error: float, status: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5, second=error)
    assert main(["validate"]) == status
    lines = capsys.readouterr().out.splitlines()
    (first,) = (line for line in lines if "first" in line)
    (second,) = (line for line in lines if "second" in line)
    assert "pass" in first
    assert ("FAIL" in second) == (status == 1)


@pytest.mark.parametrize(("error", "status"), [(1e-4, 0), (math.nan, 1)])
def test_validate_as_json(
    error: float, status: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=-1e-5, second=error)
    assert main(["validate", "--json"]) == status
    content = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert set(content["versions"]) >= {"mjbeer", "mujoco"}
    assert content["passed"] == (status == 0)
    assert [(row["quantity"], row["error"]) for row in content["checks"]] == [
        ("first", 1e-5),
        ("second", None if math.isnan(error) else error),
    ]


@pytest.mark.parametrize(("error", "status"), [(1e-4, 0), (2e-3, 1)])
def test_an_equation_that_fails_is_in_the_exit_status(
    error: float, status: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5)
    stubs.audited(monkeypatch, good=1e-6, other=error)
    assert main(["validate"]) == status
    lines = capsys.readouterr().out.splitlines()
    (other,) = (line for line in lines if "other" in line)
    assert ("FAIL" in other) == (status == 1)
    assert main(["validate", "--json"]) == status
    content = json.loads(capsys.readouterr().out)
    assert [row["equation"] for row in content["audit"]] == ["good", "other"]
    assert content["passed"] == (status == 0)


@pytest.mark.parametrize("quick", [True, False])
def test_a_report_has_the_table_and_four_scenes(
    quick: bool, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5, second=2e-5)
    calls = stubs.draw(monkeypatch)
    folder = tmp_path / "new" / "report"
    assert main(["report", "--output", str(folder), *(["--quick"] if quick else [])]) == 0
    assert set(os.listdir(folder)) == FILES
    content = json.loads((folder / "validation.json").read_text())
    assert [row["quantity"] for row in content["checks"]] == ["first", "second"]
    summary = (folder / "summary.md").read_text()
    assert "2 of 2 checks passed." in summary
    assert "| first | a stub | 1.0e-05 | 1.0e-03 rad | none |" in summary
    assert all(f"[![{film}]({film}.png)]({film}.mp4)" in summary for film in FILMS)
    out, err = capsys.readouterr()
    assert "second" in out
    assert err.endswith(f"the report is in {folder / 'summary.md'}\n")
    assert set(os.listdir(folder / "paper")) == {
        *("letters.svg", "letters.png", "stories.md", "told.svg"),
        *([] if quick else ["told.mp4"]),
    }
    gallery = [call for call in calls if call["path"].parent == folder]
    assert len(gallery) == 8
    assert {call["width"] for call in gallery if call["function"] == "render"} == {640 if quick else 1280}


def test_the_films_are_of_the_four_scenes_and_can_be_trusted(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stubs.validate(monkeypatch)
    calls = stubs.draw(monkeypatch)
    main(["report", "--quick", "--output", str(tmp_path)])
    runs = {call["path"].stem: call["trajectory"] for call in calls}
    kinds = {name: (run.scene.attachment, run.scene.load.fill is None) for name, run in runs.items()}
    assert kinds == {
        "sliding": ("sliding", False),
        "frozen": ("frozen", False),
        "pendulum": ("sliding", True),
        "hoop": ("frozen", True),
    }
    assert all(run.trusted for name, run in runs.items() if name != "hoop")
    # The hoop is there to leave the incline, which costs it some slip and energy when it lands.
    assert runs["hoop"].takeoff() is not None


@pytest.mark.parametrize(("error", "status"), [(1e-5, 0), (2e-3, 1)])
def test_without_opengl_a_report_has_all_but_films_and_says_so(
    error: float,
    status: int,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    stubs.validate(monkeypatch, first=error)
    calls = stubs.draw(monkeypatch)
    monkeypatch.setattr(opengl, "problem", lambda: "no OpenGL")
    assert main(["report", "--output", str(tmp_path)]) == status
    assert not calls
    assert set(os.listdir(tmp_path)) == {"validation.json", "summary.md", "paper"}
    assert set(os.listdir(tmp_path / "paper")) == {"letters.svg", "letters.png", "told.svg", "stories.md"}
    line = opengl.missing([*(f"{film}.mp4" for film in FILMS), "paper/told.mp4"])
    assert capsys.readouterr().err.endswith(f"{line}\n")
    summary = (tmp_path / "summary.md").read_text()
    assert f"Films: {line}\n" in summary
    assert "| first | a stub |" in summary
    assert ".png" not in summary


def test_a_failed_check_is_in_the_report_and_in_its_exit_status(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stubs.validate(monkeypatch, first=1e-5, second=2e-3)
    stubs.draw(monkeypatch)
    assert main(["report", "--output", str(tmp_path)]) == 1
    summary = (tmp_path / "summary.md").read_text()
    assert "1 of 2 checks passed." in summary
    assert "| second | a stub | 2.0e-03 **FAIL** |" in summary


def test_what_was_written_before_a_failure_is_whole_and_has_no_summary(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5)
    stubs.draw(monkeypatch, fail_at="pendulum.mp4")
    (tmp_path / "summary.md").write_text("of an earlier report")
    assert main(["report", "--output", str(tmp_path)]) == 2
    assert capsys.readouterr().err.endswith("mjbeer: cannot draw pendulum.mp4\n")
    assert set(os.listdir(tmp_path)) == {"validation.json", "sliding.mp4", "sliding.png", "frozen.mp4", "frozen.png"}
    assert json.loads((tmp_path / "validation.json").read_text())["passed"] is True


def test_a_check_that_cannot_be_measured_ends_the_report(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail() -> float:
        raise MjbeerError("no frequency")

    stubs.validate(monkeypatch, first=1e-5)
    monkeypatch.setattr("mjbeer.studies.check.Check.measure", lambda _: fail())
    assert main(["report", "--output", str(tmp_path)]) == 2
    assert capsys.readouterr().err.endswith("mjbeer: no frequency\n")
    assert not os.listdir(tmp_path)
