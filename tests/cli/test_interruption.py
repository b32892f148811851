"""Ctrl-C, kill and a closed terminal in the middle: the exit status, what is kept, and nothing half left."""

import os
import pathlib
import signal

import pytest

from mjbeer.studies.benchmark.points import Benchmark
from tests.support.processes import SHORT, interrupt, run, start

pytestmark = pytest.mark.slow


def halves(folder: pathlib.Path) -> list[str]:
    return [each for each in os.listdir(folder) if each.startswith(".")] if folder.exists() else []


@pytest.mark.draws
def test_a_video_in_the_middle(tmp_path: pathlib.Path) -> None:
    """All of its processes hear of it, ffmpeg included, as in a terminal."""
    words = ["render", "frozen", "--duration", "60", "--tolerance", "1e-6", "--output", str(tmp_path / "film.mp4")]
    ended, err = interrupt(start(words), lambda: halves(tmp_path), signal.SIGINT)
    assert (ended, err) == (130, "mjbeer: interrupted; what was written is whole\n")
    assert not os.listdir(tmp_path)


@pytest.mark.draws
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
    assert Benchmark.load(tmp_path / "study.json").points


@pytest.mark.parametrize(
    ("handler", "numbers", "status"),
    [
        (signal.SIG_DFL, [signal.SIGHUP], 129),
        (signal.SIG_IGN, [signal.SIGHUP, signal.SIGTERM], 143),  # as under nohup: SIGHUP stays ignored
    ],
)
def test_a_report_that_validates_has_written_nothing(
    handler: signal.Handlers, numbers: list[int], status: int, tmp_path: pathlib.Path
) -> None:
    code = (
        "import sys, time; from mjbeer.studies.validation import motions; from mjbeer.studies.check import Check; "
        "motions.checks = lambda: [Check('q', 'b', 1, 'rad', 'r', "
        "lambda: (print('measuring', flush=True), time.sleep(60)))]; from mjbeer.cli.app import main; sys.exit(main())"
    )
    words = ["report", "--output", str(tmp_path / "new")]
    process = start(words, code, preexec_fn=lambda: signal.signal(signal.SIGHUP, handler))
    assert process.stdout is not None
    process.stdout.readline()
    told = "mjbeer: interrupted; what was written is whole\n"
    assert interrupt(process, lambda: True, *numbers) == (status, told)
    assert not os.listdir(tmp_path / "new")


@pytest.mark.draws
def test_a_killed_command_leaves_nothing_under_the_final_name(tmp_path: pathlib.Path) -> None:
    (tmp_path / "film.mp4").write_text("old")
    words = ["render", "frozen", "--duration", "60", "--output", str(tmp_path / "film.mp4")]
    ended, _ = interrupt(start(words), lambda: halves(tmp_path), signal.SIGKILL, everybody=False)
    assert ended == -signal.SIGKILL
    assert (tmp_path / "film.mp4").read_text() == "old"
    assert len(halves(tmp_path)) == 1


def test_what_tests_start_ignores_no_signal() -> None:
    """Whoever runs the tests may ignore some, as under nohup or after a script's `&`; no test may wait for those."""
    before = {
        number: signal.signal(number, signal.SIG_IGN) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    }
    code = (
        f"import signal; print(signal.SIG_IGN in [signal.getsignal(n) for n in {[int(number) for number in before]}])"
    )
    try:
        assert run([], code) == (0, "False\n", "")
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
