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
VIDEO = (*FROZEN, "--width", "320", "--height", "180")
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


@pytest.mark.parametrize("words", [("simulate", *FROZEN), ("export", "frozen"), ("render", *VIDEO)])
def test_what_cannot_be_written_is_known_before_the_work(
    words: tuple[str, ...],
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    if words[0] == "simulate":
        monkeypatch.setattr("mjbeer.cli.motions.trajectory_of", lambda _: pytest.fail("it was simulated"))
    monkeypatch.setattr("mjbeer.drawing.video.encode", lambda *_, **__: pytest.fail("it was drawn"))
    target = tmp_path / f"folder{ {'simulate': '.csv', 'export': '.xml', 'render': '.mp4'}[words[0]] }"
    target.mkdir()
    assert main([*words, "--output", str(target)]) == 2
    assert capsys.readouterr().err == f"mjbeer: cannot write {target}: it is a folder\n"


@pytest.mark.parametrize("command", ["report", "benchmark", "stability", "paper"])
def test_a_folder_that_cannot_be_made_is_known_before_the_work(
    command: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    studies = "studies.benchmark.timing.conduct", "studies.stability.stability_study.conduct"
    for work in ("report.page.validate", *studies):
        monkeypatch.setattr(f"mjbeer.{work}", lambda *_: pytest.fail("the work was begun"))
    assert main([command, "--output", str(tmp_path / "misspelt" / "new")]) == 2
    told = f"there is no folder {tmp_path / 'misspelt'}; the nearest one that exists is {tmp_path}"
    assert capsys.readouterr().err == f"mjbeer: cannot write {tmp_path / 'misspelt' / 'new'}: {told}\n"
    assert not os.listdir(tmp_path)


@linux
def test_a_full_standard_output() -> None:
    with open("/dev/full", "w") as full:
        status, _, err = run(["simulate", *FROZEN], stdout=full)
    assert status == 2
    assert err.count("\n") == 1
    assert "No space left on device" in err


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
