"""Jobs in other processes: what comes back, what names a job that fails, and what an interruption
leaves."""

import multiprocessing
import os
import signal
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import pytest

from mjbeer.cli.app import main
from mjbeer.exceptions import ParameterError
from mjbeer.output.jobs import Job, as_finished, finished_jobs, run_jobs
from tests.support.processes import fall, hear, interrupt, start, where, work_and_sleep

AT_WORK = """
import os, sys
from mjbeer.output.jobs import Job, run_jobs
from tests.support.processes import hang_in_a_program
os.cpu_count = lambda: 2
run_jobs([Job(str(place), hang_in_a_program) for place in range(4)], None)
"""
"""Its workers wait for a program that hangs and ignores signals, as ffmpeg might."""


def fail(name: str) -> None:
    raise ParameterError(f"no {name} here")


@pytest.fixture
def two_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)


@pytest.mark.parametrize("cores", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_results_are_in_the_order_of_the_jobs(cores: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """With two cores the jobs run in other processes, which have ended then."""
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    jobs = [Job(str(number), partial(abs, -number)) for number in range(5)]
    jobs.append(Job("place", where))

    *results, place = run_jobs(jobs, None)

    assert results == [0, 1, 2, 3, 4]
    assert (place["process"] == os.getpid()) == (cores == 1)
    assert not multiprocessing.active_children()


@pytest.mark.parametrize("cores", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_what_a_job_raises_names_the_job(cores: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    jobs = [Job("a good job", partial(abs, 1)), Job("a bad job", partial(fail, "beer"))]

    with pytest.raises(ParameterError, match="no beer here") as caught:
        run_jobs(jobs, None)

    assert caught.value.__notes__ == ["while at work on a bad job"]


def test_the_command_line_says_which_job_failed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def validate(_: Any) -> None:
        run_jobs([Job("the checks", partial(fail, "beer"))], None)

    monkeypatch.setattr("mjbeer.studies.validation.validate.validate", validate)

    assert main(["validate"]) == 2

    assert capsys.readouterr().err == "mjbeer: no beer here, while at work on the checks\n"


@pytest.mark.slow
@pytest.mark.usefixtures("two_cores")
def test_a_process_that_is_killed_names_the_jobs_under_way() -> None:
    """The job that waits for its turn was not under way."""
    jobs = [Job("asleep", work_and_sleep), Job("killed", fall), Job("never begun", where)]

    with pytest.raises(OSError, match="ended from outside while at work on asleep, killed: is mem"):
        run_jobs(jobs, None)

    assert not multiprocessing.active_children()


@pytest.mark.slow
@pytest.mark.usefixtures("two_cores")
def test_the_processes_end_when_nobody_wants_the_rest() -> None:
    finished = finished_jobs([Job("quick", where), Job("asleep", work_and_sleep)], None)
    assert next(finished).job.name == "quick"

    finished.close()

    assert not multiprocessing.active_children()


def test_a_job_is_taken_when_its_turn_comes() -> None:
    """So a later one may depend on the results of earlier ones."""
    taken: list[int] = []

    def jobs() -> Any:
        for number in range(4):
            taken.append(number)
            yield Job(str(number), partial(abs, number))

    with ThreadPoolExecutor(1) as threads:
        finished = as_finished(jobs(), threads, at_once=2)
        first = next(finished)
        assert (first.result, taken[:2], len(taken) < 4) == (0, [0, 1], True)
        rest = [result for _, result in finished]

    assert sorted(rest) == [1, 2, 3]


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_no_process_outlives_the_one_that_started_it(number: signal.Signals) -> None:
    """It alone gets the signal; its streams end only when those that it started have ended, too."""
    with start([], AT_WORK) as process:
        for _ in range(2):
            hear(process, "at work")

        _, error = interrupt(process, number, everybody=False)

    assert error.count("Traceback") <= 1  # its own
