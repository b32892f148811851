"""mjbeer validate and mjbeer report: exit status, streams, and the files that appear."""

import json
import math
import os
import pathlib
import re
from types import ModuleType

import pytest

from mjbeer.cli.app import main
from mjbeer.drawing import opengl, video
from mjbeer.drawing.film import Take
from mjbeer.exceptions import MjbeerError
from mjbeer.output import terminal
from tests.support import stubs
from tests.support.pages import Page

SENTENCE = r"{} of {} checks and {} of {} claims of the paper passed, in \d+ s\n"
FILMS = ("race", "liquids", "sliding", "frozen", "pendulum", "hoop", "carry")
DRAWN = {f"{film}{end}" for film in FILMS for end in (".mp4", "-still.png")}
FILES = {"validation.json", "index.html", "paper", "plots"}


@pytest.mark.parametrize(("error", "status"), [(1e-4, 0), (1e-3, 0), (2e-3, 1), (math.nan, 1)])
def test_the_exit_status_of_validate(
    error: float, status: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5, second=error)
    assert main(["validate"]) == status
    out, err = capsys.readouterr()
    assert out == ""
    failure = f"FAILED: stubs: second (a stub): error {error:.1e}, at most 1.0e-03 rad\n" if status else ""
    assert re.fullmatch(re.escape(failure) + SENTENCE.format(2 - status, 2, 0, 0), err)
    assert main(["validate", "--json"]) == status
    content = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert content["passed"] == (status == 0)
    assert [row["error"] for row in content["checks"]] == [1e-5, None if math.isnan(error) else error]


@pytest.mark.parametrize("options", [[], ["--table"], ["--json"]])
@pytest.mark.parametrize("eye", [True, False])
def test_a_failure_is_told_whatever_is_asked_for(
    options: list[str], eye: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5, second=2e-3)
    stubs.audited(monkeypatch, good=1e-6, other=math.nan)
    monkeypatch.setattr(terminal, "is_read_by_eye", lambda: eye)
    assert main(["validate", *options]) == 1
    out, err = capsys.readouterr()
    *failures, last = err.splitlines()
    assert failures == [
        "FAILED: stubs: second (a stub): error 2.0e-03, at most 1.0e-03 rad",
        "FAILED: other: a stub (none): error nan, at most 1.0e-03",
    ]
    assert re.fullmatch(SENTENCE.format(1, 2, 1, 2), last + "\n")
    assert ("│ first" in out) == (eye and options == ["--table"])
    assert (out == "") == (not options)
    assert ("\nfirst\t" in out) == (not eye and options == ["--table"])


@pytest.mark.slow
@pytest.mark.parametrize("quick", [True, False])
def test_a_report_has_the_table_and_the_films(
    quick: bool, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5, second=2e-5)
    calls = stubs.draw(monkeypatch)
    folder = tmp_path / "report"
    assert main(["report", "--output", str(folder), *(["--quick"] if quick else [])]) == 0
    assert set(os.listdir(folder)) == FILES | DRAWN
    content = json.loads((folder / "validation.json").read_text())
    assert [row["name"] for row in content["checks"]] == ["first", "second"]
    read = Page.of((folder / "index.html").read_text())
    assert "2 of 2 checks and 0 of 0 claims of the paper passed." in [element.text for element in read.all("p")]
    cells = [element.text for element in read.all("td")]
    assert cells[cells.index("first") :][:5] == ["first", "a stub", "1.0e-05", "1.0e-03 rad", "none"]
    assert len(read.all("video")) == len(FILMS) + (not quick)
    out, err = capsys.readouterr()
    assert out == ""
    last = err.partition(f"the report is in {folder / 'index.html'}\n")[2]
    assert re.fullmatch(SENTENCE.format(2, 2, 0, 0), last)
    story = [] if quick else ["told.mp4", "told-still.png"]
    assert set(os.listdir(folder / "paper")) == {"letters.svg", "stories.md", "told.svg", *story}
    films = [call for call in calls if call["path"].parent == folder]
    assert [call["path"].stem for call in films] == list(FILMS)
    assert {call["width"] for call in films} == ({640} if quick else {1152, 960})
    runs = {call["path"].stem: call["film"].trajectory() for call in films if isinstance(call["film"], Take)}
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


@pytest.mark.slow
@pytest.mark.parametrize(("error", "status"), [(1e-5, 0), (2e-3, 1)])
@pytest.mark.parametrize("lacking", [opengl, video])
def test_without_opengl_or_ffmpeg_a_report_has_all_but_films_and_says_so(
    lacking: ModuleType,
    error: float,
    status: int,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A film of an earlier report goes, for it would not be of this one; a failed check is in page and exit status."""
    stubs.validate(monkeypatch, first=error)
    calls = stubs.draw(monkeypatch)
    monkeypatch.setattr(lacking, "problem", lambda: "there is none")
    (tmp_path / "hoop.mp4").write_text("of an earlier report")
    assert main(["report", "--output", str(tmp_path)]) == status
    assert not calls
    assert set(os.listdir(tmp_path)) == FILES
    line = lacking.missing([*(f"{film}.mp4" for film in FILMS), "paper/told.mp4"])
    assert f"{line}\nthe report is in " in capsys.readouterr().err
    read = Page.of((tmp_path / "index.html").read_text())
    assert any(line in element.text for element in read.all("p"))
    assert ("2.0e-03 FAIL" in [element.text for element in read.all("td")]) == bool(status)
    assert not read.all("video")


def test_what_was_written_before_a_failure_is_whole_and_has_no_page(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5)
    stubs.draw(monkeypatch, fail_at="pendulum.mp4")
    (tmp_path / "index.html").write_text("of an earlier report")
    assert main(["report", "--output", str(tmp_path)]) == 2
    assert capsys.readouterr().err.endswith("mjbeer: cannot draw pendulum.mp4\n")
    before = {f"{film}{end}" for film in ("race", "liquids", "sliding", "frozen") for end in (".mp4", "-still.png")}
    assert set(os.listdir(tmp_path)) == (FILES - {"index.html"}) | before
    assert json.loads((tmp_path / "validation.json").read_text())["passed"] is True


def test_a_check_that_cannot_be_measured_ends_the_report(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail() -> float:
        raise MjbeerError("no frequency")

    stubs.validate(monkeypatch, first=1e-5)
    stubs.draw(monkeypatch)
    monkeypatch.setattr("mjbeer.checks.Check.result", lambda _: fail())
    assert main(["report", "--output", str(tmp_path)]) == 2
    assert capsys.readouterr().err.endswith("mjbeer: no frequency\n")
    assert set(os.listdir(tmp_path)) == {"paper", "plots"}
