"""Ctrl-C, kill and a closed terminal in the middle: the exit status, what is kept, and nothing half left."""

import os
import pathlib
import signal
import threading

import pytest

from mjbeer.output import interruption
from mjbeer.studies.benchmark import points
from tests.support.processes import SHORT, interrupt, start

TWICE = """
import pathlib, signal, sys, time
from mjbeer.output import interruption, files as output
with interruption.heeded(), output.whole(sys.argv[1]) as temporary:
    temporary.write_text("half")
    try:
        time.sleep(60)
    finally:
        time.sleep(60)  # a cleanup that takes its time
"""


def halves(folder: pathlib.Path) -> list[str]:
    return [each for each in os.listdir(folder) if each.startswith(".")] if folder.exists() else []


def test_a_video_in_the_middle(tmp_path: pathlib.Path) -> None:
    """All of its processes hear of it, ffmpeg included, as in a terminal."""
    words = ["render", "frozen", "--duration", "60", "--tolerance", "1e-6", "--output", str(tmp_path / "film.mp4")]
    ended, err = interrupt(start(words), lambda: halves(tmp_path), signal.SIGINT)
    assert (ended, err) == (130, "mjbeer: interrupted; what was written is whole\n")
    assert not os.listdir(tmp_path)


def test_an_ffmpeg_that_hangs_is_ended_too(tmp_path: pathlib.Path) -> None:
    program = tmp_path / "ffmpeg"
    program.write_text(f"#!/bin/sh\necho $$ > {tmp_path / 'pid'}\nexec sleep 100\n")
    program.chmod(0o755)
    environment = os.environ | {"IMAGEIO_FFMPEG_EXE": str(program)}
    words = ["render", "frozen", "--duration", "1", "--output", str(tmp_path / "film" / "film.mp4")]
    process = start(words, env=environment)
    ended, err = interrupt(process, (tmp_path / "pid").exists, signal.SIGTERM, everybody=False)
    assert (ended, err) == (143, "mjbeer: interrupted; what was written is whole\n")
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "pid").read_text()), 0)
    assert not os.listdir(tmp_path / "film")


def test_the_stories_that_were_told_are_kept(tmp_path: pathlib.Path) -> None:
    process = start(["paper", "--output", str(tmp_path)])
    ended, _ = interrupt(process, (tmp_path / "trivial.png").exists, signal.SIGTERM)
    assert ended == 143
    assert (tmp_path / "trivial.png").read_bytes().endswith(b"IEND\xaeB`\x82")
    assert not (tmp_path / "stories.md").exists()
    assert not halves(tmp_path)


def test_a_benchmark_keeps_what_was_measured(tmp_path: pathlib.Path) -> None:
    (tmp_path / "summary.md").write_text("of another study")
    words = ["benchmark", "frozen", "--output", str(tmp_path)]
    ended, _ = interrupt(start(words, SHORT), (tmp_path / "study.json").exists, signal.SIGTERM)
    assert ended == 143
    assert set(os.listdir(tmp_path)) == {".lock", "study.json"}
    assert points.load(tmp_path / "study.json").points


def test_a_report_that_validates_has_written_nothing(tmp_path: pathlib.Path) -> None:
    code = (
        "import sys; from mjbeer.studies.validation import motions; from mjbeer.studies.check import Row; import time; "
        "motions.rows = lambda: [Row('q', 'b', 1, 'rad', 'r', "
        "lambda: (print('measuring', flush=True), time.sleep(60)))]; from mjbeer.cli.app import main; sys.exit(main())"
    )
    process = start(["report", "--output", str(tmp_path / "new")], code)
    assert process.stdout is not None
    process.stdout.readline()
    assert interrupt(process, lambda: True, signal.SIGHUP) == (129, "mjbeer: interrupted; what was written is whole\n")
    assert not os.listdir(tmp_path / "new")


def test_a_second_signal_waits_for_no_cleanup_and_leaves_no_half_file(tmp_path: pathlib.Path) -> None:
    process = start([str(tmp_path / "file")], TWICE)
    assert interrupt(process, lambda: halves(tmp_path), signal.SIGINT, signal.SIGINT) == (130, "")
    assert not os.listdir(tmp_path)


def test_a_killed_command_leaves_nothing_under_the_final_name(tmp_path: pathlib.Path) -> None:
    (tmp_path / "film.mp4").write_text("old")
    words = ["render", "frozen", "--duration", "60", "--output", str(tmp_path / "film.mp4")]
    ended, _ = interrupt(start(words), lambda: halves(tmp_path), signal.SIGKILL, everybody=False)
    assert ended == -signal.SIGKILL
    assert (tmp_path / "film.mp4").read_text() == "old"
    assert len(halves(tmp_path)) == 1


def test_what_is_ignored_stays_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """As SIGHUP under nohup."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with interruption.heeded():
            signal.raise_signal(signal.SIGHUP)
            with pytest.raises(interruption.Interrupted) as caught:
                signal.raise_signal(signal.SIGTERM)
        assert caught.value.status == 143
    finally:
        signal.signal(signal.SIGHUP, before)


def test_other_threads_leave_signals_alone() -> None:
    seen = []

    def enter() -> None:
        with interruption.heeded():
            seen.append(signal.getsignal(signal.SIGTERM))

    thread = threading.Thread(target=enter)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGTERM)]
