"""Processes that measure tasks ahead: the same results in the same order, and none is left when it ends."""

import multiprocessing
import pathlib
import signal
import time
from functools import partial
from typing import Any

import pytest

from mjbeer.studies.stability.crew import crew
from mjbeer.studies.stability.search.batches import batch
from mjbeer.studies.study import Task
from tests.support.errands import fall, where
from tests.support.processes import interrupt, start

pytestmark = pytest.mark.slow

ALONE = """
import pathlib, sys
from functools import partial
from mjbeer.studies.stability.crew import crew
from mjbeer.studies.study import Task
from tests.support.errands import mark_and_sleep
folder = pathlib.Path(sys.argv[1])
tasks = [Task("t", str(place), partial(mark_and_sleep, folder / str(place))) for place in range(4)]
with crew(tasks, 2) as measure:
    for task in tasks:
        measure(task)
"""


def tasks(*functions: Any) -> list[Task]:
    return [Task("search", str(place), function) for place, function in enumerate(functions)]


def test_results_do_not_depend_on_the_number_of_processes() -> None:
    todo = tasks(*(partial(batch, first, 4) for first in (0, 4, 8)))
    with crew(todo, 1) as measure:
        alone = [measure(task) for task in todo]
    with crew(todo, 2) as measure:
        together = [measure(task) for task in todo]
    assert alone == together


def test_only_its_tasks_are_measured_elsewhere_and_only_if_there_are_several() -> None:
    two, other = tasks(where, where), Task("laws", "other", where)
    with crew(two, 2) as measure:
        assert measure(other) == where()
        assert not multiprocessing.active_children()
        assert measure(two[0]) != where()
    with crew(two[:1], 2) as measure:
        assert measure(two[0]) == where()
    assert not multiprocessing.active_children()


def test_a_process_that_is_killed_is_an_error() -> None:
    todo = tasks(fall, fall)
    with pytest.raises(OSError, match="ended from outside while it measured 0"), crew(todo, 2) as measure:
        measure(todo[0])
    assert not multiprocessing.active_children()


def is_there(process: int) -> bool:
    """Whether a process runs; one that ended and whose parent did not ask for its status is a zombie, Z."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(") ", 1)[1][0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.skipif(not pathlib.Path("/proc/self/stat").exists(), reason="no /proc to see other processes in")
@pytest.mark.parametrize(
    ("number", "everybody"), [(signal.SIGINT, True), (signal.SIGINT, False), (signal.SIGKILL, False)]
)
def test_no_process_outlives_the_one_that_started_it(
    number: signal.Signals, everybody: bool, tmp_path: pathlib.Path
) -> None:
    """Ctrl-C reaches all of them, and the others are told by the first; of its being killed they hear as well."""
    process = start([str(tmp_path)], ALONE)
    begun = [tmp_path / "0", tmp_path / "1"]
    _, err = interrupt(process, lambda: all(path.exists() for path in begun), number, everybody=everybody)
    assert err.count("Traceback") <= 1  # its own
    processes = [int(path.read_text()) for path in begun]
    end = time.monotonic() + 10
    while any(is_there(each) for each in processes):
        assert time.monotonic() < end
        time.sleep(0.05)
