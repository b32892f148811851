"""Where a loop is compiled, it is said once, on a terminal; and a loop that is in the cache is not compiled."""

import os
import pathlib
import subprocess
import sys

import pytest
from mjbeer.simulation.compiling import _TEXT

pytestmark = pytest.mark.slow

RUN = """
from mjbeer import frozen, simulate
simulate(frozen(), 0.1, 1.0)
"""
RUNS = f"""
{RUN}
simulate(frozen(), 0.1, 1.0, integrator="DOP853", timestep=0.01)
simulate(frozen(), 0.1, 1.0, tolerance=1e-6)
"""


def said(cache: pathlib.Path, terminal: bool, runs: str = RUNS) -> str:
    """Return what a process with some `runs` in it writes to standard error."""
    reader, writer = os.openpty() if terminal else os.pipe()
    settings = {"NUMBA_CACHE_DIR": str(cache), "TERM": "xterm", "COLUMNS": "200"}
    subprocess.run([sys.executable, "-c", runs], env=os.environ | settings, stderr=writer, check=True)
    if terminal:
        os.write(writer, b"end")  # reading a terminal waits for something
    os.close(writer)
    text = b""
    with open(reader, "rb", buffering=0) as stream:
        while terminal and not text.endswith(b"end"):  # a terminal may hand over less than was written
            text += stream.read(10_000)
        return (text or stream.read(10_000)).decode()


def test_it_is_said_once_where_somebody_sees_it(tmp_path: pathlib.Path) -> None:
    assert said(tmp_path / "cache", terminal=True).split("\r\n") == [_TEXT, "end"]
    assert said(tmp_path / "cache", terminal=True) == "end"
    assert said(tmp_path / "other", terminal=False, runs=RUN) == ""
