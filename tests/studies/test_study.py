"""Checks: judged by their bounds, and measured by several processes."""

import contextlib
import json
import math
import multiprocessing
import os
import signal
import socket
from collections.abc import Callable
from typing import Any

import pytest

from mjbeer.checks import Check, Result
from mjbeer.studies import study as studies
from tests.support.processes import PATIENCE, fall, interrupt, start, where

ALONE = """
import sys
from functools import partial
from mjbeer.checks import Check
from mjbeer.studies.study import run
from tests.support.processes import call_and_sleep
checks = [Check("t", str(place), partial(call_and_sleep, int(sys.argv[1]))) for place in range(4)]
run(checks, None, "mjbeer test", {})
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


def places(count: int, measure: Callable[[], dict[str, Any]] = where) -> list[Check]:
    return [Check("g", str(place), measure) for place in range(count)]


@pytest.mark.slow
def test_processes_measure_elsewhere_and_the_order_stays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    together = studies.run(places(3), None, "mjbeer test", {})
    assert where()["process"] not in {result.values["process"] for result in together.results}
    assert [result.name for result in together.results] == ["0", "1", "2"]
    assert not multiprocessing.active_children()


@pytest.mark.slow
def test_a_process_that_is_killed_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    with pytest.raises(OSError, match="ended from outside"):
        studies.run(places(2, fall), None, "mjbeer test", {})
    assert not multiprocessing.active_children()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "everybody"), [(signal.SIGINT, True), (signal.SIGINT, False), (signal.SIGKILL, False)]
)
def test_no_process_outlives_the_one_that_started_it(number: signal.Signals, everybody: bool) -> None:
    """Ctrl-C reaches all of them, and the others are told by the first; of its being killed they hear as well.

    Each of the two calls this process when it is at work, and the system hangs up for it when it has ended.
    """
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(PATIENCE)
        with (
            start([str(server.getsockname()[1])], ALONE) as process,
            contextlib.ExitStack() as lines,
        ):
            calls = [lines.enter_context(server.accept()[0]) for _ in range(2)]
            _, err = interrupt(process, number, everybody=everybody)
            assert err.count("Traceback") <= 1  # its own
            for call in calls:
                call.settimeout(PATIENCE)
                assert call.recv(1) == b""
