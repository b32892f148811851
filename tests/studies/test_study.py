"""Checks: judged by their bounds, kept one by one, resumed after an interruption, measured by several processes."""

import json
import math
import multiprocessing
import os
import pathlib
import signal
from functools import partial
from typing import Any

import pytest

from mjbeer.cli.app import main
from mjbeer.exceptions import OutputError, ParameterError
from mjbeer.output import folders
from mjbeer.paper.checks import Check, Result
from mjbeer.studies import study as studies
from mjbeer.studies.study import Study
from tests.support.processes import fall, hear, interrupt, start, where

ALONE = """
import os, pathlib, sys
from mjbeer.paper.checks import Check
from mjbeer.studies.study import run
from tests.support.processes import work_and_sleep
os.cpu_count = lambda: 2
checks = [Check("t", str(place), work_and_sleep) for place in range(4)]
run(checks, None, pathlib.Path(sys.argv[1]), "mjbeer test", {})
"""

HOLD = """
import pathlib, sys, time
from mjbeer.output.folders import owned
with owned(pathlib.Path(sys.argv[1]), sys.argv[2]):
    print("locked", flush=True)
    time.sleep(3600)
"""


@pytest.mark.parametrize(
    ("error", "bound", "passed"),
    [(1.0, 1.0, True), (1.1, 1.0, False), (math.nan, 1.0, False), (None, 0.0, False), (None, math.inf, True)],
)
def test_a_result_passes_within_its_bound(error: float | None, bound: float, passed: bool) -> None:
    result = Result("g", "n", bound=bound, error=error)
    assert result.passed is passed
    assert Result(**json.loads(json.dumps(result.as_json()))).passed is passed


def test_a_deviation_has_a_sign_and_an_error_none() -> None:
    assert Check("g", "n", lambda: -2.0).result().error == 2.0
    found = Check("g", "n", lambda: {"error": -2, "of": 3}).result()
    assert (found.error, found.values) == (2.0, {"of": 3})
    assert Check("g", "n", dict).result().error is None


def counting(done: list[str], names: str = "abc") -> list[Check]:
    """Rows of which the second is interrupted the first time."""

    def measure(name: str) -> dict[str, Any]:
        done.append(name)
        if done == ["a", "b"]:
            raise KeyboardInterrupt
        return {"error": 0.5, "of": name}

    return [Check("g", name, partial(measure, name), "by", 1.0, "rad", "why") for name in names]


def test_an_interrupted_study_goes_on(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    done: list[str] = []
    study, path = counting(done), tmp_path / "study.jsonl"
    with pytest.raises(KeyboardInterrupt):
        studies.run(study, None, path, "mjbeer test", {"quick": True})
    assert [result.name for result in Study.load(path, "mjbeer test").results] == ["a"]
    found = studies.run(study, None, path, "mjbeer test", {"quick": True})
    assert done == ["a", "b", "b", "c"]
    assert Study.load(path, "mjbeer test") == found
    assert [(result.name, result.values["of"]) for result in found.results] == [(name, name) for name in "abc"]
    with pytest.raises(
        ParameterError, match=r"study\.jsonl has a study of other settings, or of another machine: remove"
    ):
        studies.run(study, None, path, "mjbeer test", {"quick": False})
    assert Study.load(path, "mjbeer test") == found


def test_a_finished_study_stays_until_another_is_whole_and_is_not_made_again(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    done: list[str] = ["before"]
    study, path, kept = counting(done), tmp_path / "unfinished.jsonl", tmp_path / "study.jsonl"
    first = studies.run(study, None, path, "mjbeer test", {"quick": False}, kept)
    path.rename(kept)
    assert studies.run(study, None, path, "mjbeer test", {"quick": False}, kept) == first
    assert done == ["before", "a", "b", "c"]
    path.unlink()
    studies.run(study, None, path, "mjbeer test", {"quick": True}, kept)
    assert done == ["before", "a", "b", "c", "a", "b", "c"]
    assert Study.load(kept, "mjbeer test") == first


@pytest.mark.parametrize("text", ["", "{}\n", "[]\n", '{"command": "mjbeer else", "settings": {}, "machine": {}}\n'])
def test_what_is_no_study_is_refused_and_stays(text: str, tmp_path: pathlib.Path) -> None:
    path = tmp_path / "study.jsonl"
    path.write_text(text)
    with pytest.raises(ParameterError, match=r"study\.jsonl was not written by `mjbeer test`"):
        studies.run([], None, path, "mjbeer test", {})
    assert path.read_text() == text


def test_a_result_that_cannot_be_kept_is_an_error(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "study.jsonl"

    def replace_by_folder() -> float:
        path.unlink()
        path.mkdir()
        return 0.0

    with pytest.raises(OutputError, match=r"cannot write .*study\.jsonl"):
        studies.run([Check("g", "a", replace_by_folder)], None, path, "mjbeer test", {})


@pytest.mark.slow
def test_processes_measure_elsewhere_and_the_order_stays(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    together = studies.run(
        [Check("g", name, where) for name in "012"], None, tmp_path / "study.jsonl", "mjbeer test", {}
    )
    assert where()["process"] not in {result.values["process"] for result in together.results}
    assert [result.name for result in together.results] == ["0", "1", "2"]


@pytest.mark.slow
def test_a_process_that_is_killed_is_an_error(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    with pytest.raises(OSError, match="ended from outside"):
        studies.run([Check("g", name, fall) for name in "01"], None, tmp_path / "study.jsonl", "mjbeer test", {})
    assert not multiprocessing.active_children()


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_no_process_outlives_the_one_that_started_it(number: signal.Signals, tmp_path: pathlib.Path) -> None:
    """It alone is interrupted or killed, and its streams are at their end when the others have ended, too."""
    with start([str(tmp_path / "study.jsonl")], ALONE) as process:
        for _ in range(2):
            hear(process, "at work")
        _, err = interrupt(process, number, everybody=False)
    assert err.count("Traceback") <= 1  # its own


@pytest.mark.slow
@pytest.mark.parametrize("command", ["benchmark", "stability", "paper", "report"])
def test_a_second_command_in_a_folder_is_refused_until_the_first_is_gone(
    command: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Killed, the first cannot tidy up; what it leaves keeps nobody out."""
    for work in ("studies.benchmark.timing.conduct", "studies.stability.stability_study.conduct", "report.page.write"):
        monkeypatch.setattr(f"mjbeer.{work}", lambda *_: pytest.fail("it was begun"))
    monkeypatch.setattr("mjbeer.paper.stories.write", lambda *_: pytest.fail("it was begun"))
    folder = tmp_path / "new"
    with start([str(folder), f"mjbeer {command}"], HOLD) as holder:
        hear(holder, "locked")
        assert main([command, "--output", str(folder)]) == 2
        assert capsys.readouterr().err == f"mjbeer: cannot write to {folder}: another command is at work there\n"
        assert sorted(os.listdir(folder)) == [".lock", ".mjbeer"]
        interrupt(holder, signal.SIGKILL)
    for _ in range(2):
        with folders.owned(folder, f"mjbeer {command}"):
            pass
