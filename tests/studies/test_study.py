"""A study keeps its results one by one, and goes on with them after an interruption."""

import os
import pathlib
from functools import partial

import pytest

from mjbeer.checks.check import Check, Measured
from mjbeer.exceptions import OutputError, ParameterError
from mjbeer.studies import study as studies
from mjbeer.studies.study import Study
from tests.support.processes import where

COMMAND = "mjbeer test"


@pytest.fixture
def one_core(monkeypatch: pytest.MonkeyPatch) -> None:
    """Checks run in this process then."""
    monkeypatch.setattr(os, "cpu_count", lambda: 1)


def checks_that_count(done: list[str]) -> list[Check]:
    """Three checks, of which the second is interrupted the first time."""

    def measure(name: str) -> Measured:
        done.append(name)
        if done == ["a", "b"]:
            raise KeyboardInterrupt
        return Measured(0.5, {"of": name})

    return [Check("g", name, partial(measure, name), "by", 1.0, "rad", "why") for name in "abc"]


@pytest.mark.usefixtures("one_core")
def test_an_interrupted_study_goes_on(tmp_path: pathlib.Path) -> None:
    done: list[str] = []
    checks = checks_that_count(done)
    path = tmp_path / "study.jsonl"
    with pytest.raises(KeyboardInterrupt):
        studies.run(checks, None, path, COMMAND, {"quick": True})
    assert [result.name for result in Study.load(path, COMMAND).results] == ["a"]

    study = studies.run(checks, None, path, COMMAND, {"quick": True})

    assert done == ["a", "b", "b", "c"]
    assert Study.load(path, COMMAND) == study
    assert [result.name for result in study.results] == ["a", "b", "c"]
    assert [result.values["of"] for result in study.results] == ["a", "b", "c"]


@pytest.mark.usefixtures("one_core")
def test_a_study_of_other_settings_is_refused_and_stays(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "study.jsonl"
    study = studies.run(checks_that_count(["before"]), None, path, COMMAND, {"quick": True})

    with pytest.raises(
        ParameterError,
        match=r"study\.jsonl has a study of other settings, or of another machine: remove",
    ):
        studies.run([], None, path, COMMAND, {"quick": False})

    assert Study.load(path, COMMAND) == study


@pytest.mark.usefixtures("one_core")
def test_a_finished_study_is_not_made_again(tmp_path: pathlib.Path) -> None:
    done = ["before"]
    checks = checks_that_count(done)
    unfinished = tmp_path / "unfinished.jsonl"
    finished = tmp_path / "study.jsonl"
    study = studies.run(checks, None, unfinished, COMMAND, {"quick": False}, finished)
    unfinished.rename(finished)

    again = studies.run(checks, None, unfinished, COMMAND, {"quick": False}, finished)

    assert again == study
    assert done == ["before", "a", "b", "c"]


@pytest.mark.usefixtures("one_core")
def test_a_finished_study_stays_until_another_is_whole(tmp_path: pathlib.Path) -> None:
    done = ["before"]
    checks = checks_that_count(done)
    unfinished = tmp_path / "unfinished.jsonl"
    finished = tmp_path / "study.jsonl"
    study = studies.run(checks, None, finished, COMMAND, {"quick": False})

    studies.run(checks, None, unfinished, COMMAND, {"quick": True}, finished)

    assert done == ["before", "a", "b", "c", "a", "b", "c"]
    assert Study.load(finished, COMMAND) == study


@pytest.mark.parametrize(
    "text", ["", "{}\n", "[]\n", '{"command": "mjbeer else", "settings": {}, "machine": {}}\n']
)
def test_what_is_no_study_is_refused_and_stays(text: str, tmp_path: pathlib.Path) -> None:
    path = tmp_path / "study.jsonl"
    path.write_text(text)

    with pytest.raises(ParameterError, match=r"study\.jsonl was not written by `mjbeer test`"):
        studies.run([], None, path, COMMAND, {})

    assert path.read_text() == text


def test_a_result_that_cannot_be_kept_is_an_error(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "study.jsonl"

    def replace_by_folder() -> float:
        path.unlink()
        path.mkdir()
        return 0.0

    with pytest.raises(OutputError, match=r"cannot write .*study\.jsonl"):
        studies.run([Check("g", "a", replace_by_folder)], None, path, COMMAND, {})


def measure_where() -> Measured:
    """Measure nothing, and tell in which process."""
    return Measured(0.0, where())


@pytest.mark.slow
def test_results_of_other_processes_have_the_order_of_the_checks(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    checks = [Check("g", name, measure_where) for name in "012"]

    study = studies.run(checks, None, tmp_path / "study.jsonl", COMMAND, {})

    assert [result.name for result in study.results] == ["0", "1", "2"]
    assert os.getpid() not in {result.values["process"] for result in study.results}
