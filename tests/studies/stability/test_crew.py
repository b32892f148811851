"""Processes that measure tasks ahead: the same results in the same order, and none is left when it ends."""

import contextlib
import multiprocessing
import signal
import socket
from functools import partial
from typing import Any

import pytest

from mjbeer.studies.stability.crew import crew
from mjbeer.studies.stability.search.batches import batch
from mjbeer.studies.study import Task
from tests.support.processes import PATIENCE, fall, interrupt, start, where

pytestmark = pytest.mark.slow

ALONE = """
import sys
from functools import partial
from mjbeer.studies.stability.crew import crew
from mjbeer.studies.study import Task
from tests.support.processes import call_and_sleep
tasks = [Task("t", str(place), partial(call_and_sleep, int(sys.argv[1]))) for place in range(4)]
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


@pytest.mark.parametrize(
    ("number", "everybody"), [(signal.SIGINT, True), (signal.SIGINT, False), (signal.SIGKILL, False)]
)
def test_no_process_outlives_the_one_that_started_it(number: signal.Signals, everybody: bool) -> None:
    """Ctrl-C reaches all of them, and the others are told by the first; of its being killed they hear as well.

    Each of the two calls this process when it is at work, and the system hangs up for it when it has ended.
    """
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(PATIENCE)
        with start([str(server.getsockname()[1])], ALONE) as process, contextlib.ExitStack() as lines:
            calls = [lines.enter_context(server.accept()[0]) for _ in range(2)]
            _, err = interrupt(process, number, everybody=everybody)
            assert err.count("Traceback") <= 1  # its own
            for call in calls:
                call.settimeout(PATIENCE)
                assert call.recv(1) == b""
