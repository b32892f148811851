"""Disks, folders and streams that do not take what is written: one line that says so, exit status 2, no half file."""

import os
import pathlib
import resource
import signal
import sys

import pytest

from mjbeer.cli.app import main
from tests.support.processes import run

pytestmark = pytest.mark.slow

FROZEN = ("frozen", "--duration", "0.5")
FOLDERS = ("report", "benchmark", "stability", "paper")
linux = pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is Linux's")


def little_disk() -> None:
    """No file can become longer than 4 KiB, as if the disk were full."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # Python does the same


def test_a_full_disk_leaves_the_old_file(tmp_path: pathlib.Path) -> None:
    """Once before with room enough, for Numba writes caches the first time.

    No bytecode is written: cut off in the checkout, it would end every later run (Python 3.11.2 does not notice).
    """
    target = tmp_path / "motion.csv"
    words = ("simulate", *FROZEN, "--output", str(target))
    assert main(words) == 0
    target.write_text("old")
    env = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"}
    status, _, err = run(words, env=env, preexec_fn=little_disk)
    assert (status, err) == (2, f"mjbeer: cannot write {target}: File too large\n")
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["motion.csv"]


@pytest.mark.parametrize("words", ["simulate frozen", "export frozen", "render frozen", *FOLDERS])
def test_what_cannot_be_written_is_known_before_the_work(
    words: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    work = ["report.page.validate", "studies.benchmark.timing.conduct", "studies.stability.stability_study.conduct"]
    work.append("drawing.video._mediapy" if words == "render frozen" else "cli.motions.trajectory_of")
    for each in work:
        monkeypatch.setattr(f"mjbeer.{each}", lambda *_, **__: pytest.fail("the work was begun"))
    ending = {"export frozen": ".xml", "render frozen": ".mp4"}.get(words, "")
    target, folder = tmp_path / "misspelt" / f"new{ending}", tmp_path / "misspelt"
    assert main([*words.split(), "--output", str(target)]) == 2
    told = f"there is no folder {folder}; the nearest one that exists is {tmp_path}"
    assert capsys.readouterr().err == f"mjbeer: cannot write {target}: {told}\n"
    assert not os.listdir(tmp_path)


@linux
def test_a_full_standard_output() -> None:
    with open("/dev/full", "w") as full:
        status, _, err = run(["simulate", *FROZEN], stdout=full)
    assert status == 2
    assert err.count("\n") == 1
    assert "No space left on device" in err


def test_a_closed_standard_output(tmp_path: pathlib.Path) -> None:
    """It is known before the work, of which nothing is left."""
    target = tmp_path / "motion.csv"
    words = ["simulate", *FROZEN, "--output", str(target)]
    status, _, err = run(words, preexec_fn=lambda: os.close(1))
    assert (status, err) == (2, "mjbeer: cannot write to standard output: it is closed\n")
    assert not target.exists()


@pytest.mark.parametrize("words", [(), ("--output", "-", "--duration", "2")])
def test_a_reader_that_goes_away(words: tuple[str, ...]) -> None:
    """Of less and of more than Python and the pipe keep in between."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        status, _, err = run(["simulate", "frozen", "--duration", "0.01", *words], stdout=writer)
    finally:
        os.close(writer)
    assert (status, err) == (2, "mjbeer: cannot write to standard output: Broken pipe\n")
