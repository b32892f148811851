"""Ctrl-C, SIGTERM and a closed terminal in the middle: the exit status, no process left, and nothing half written.

Each command says when it has come to the middle, and waits there for its signal. That what was measured is kept is
tested where a study or a sweep is; that no file is ever seen half, where files are written.
"""

import os
import pathlib
import signal

import pytest

from tests.support.processes import hear, interrupt, start

pytestmark = pytest.mark.slow

TOLD = "mjbeer: interrupted; what was written is whole\n"
HALTING = """
import sys, time
from mjbeer.cli.app import main
from mjbeer.drawing import video

def halting(frames, *arguments, **named):
    def few():
        for number, frame in enumerate(frames):
            if number == {0}:
                print("drawing", flush=True)
                time.sleep(3600)
            yield frame
    encode(few(), *arguments, **named)

encode, video.encode = video.encode, halting
sys.exit(main())
"""
"""Code of a command that stops before it draws a picture, when ffmpeg has those before."""


@pytest.mark.draws
def test_a_video_in_the_middle(tmp_path: pathlib.Path) -> None:
    """All of its processes hear of it, ffmpeg included, as in a terminal."""
    with start(["render", "frozen", "--output", str(tmp_path / "film.mp4")], HALTING.format(3)) as process:
        hear(process, "drawing")
        assert interrupt(process, signal.SIGINT) == (130, TOLD)
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize(
    ("handler", "numbers", "status"),
    [
        (signal.SIG_DFL, [signal.SIGHUP], 129),
        (signal.SIG_IGN, [signal.SIGHUP, signal.SIGTERM], 143),  # as under nohup: SIGHUP stays ignored
    ],
)
def test_a_report_ends_with_its_processes(
    handler: signal.Handlers, numbers: list[int], status: int, tmp_path: pathlib.Path
) -> None:
    code = (
        "import sys; from mjbeer.cli.app import main; from mjbeer.drawing.video import PlotJob; "
        "from mjbeer.report import page; from tests.support.processes import draw_and_sleep; "
        "page.plot_jobs = lambda folder: [PlotJob(draw_and_sleep, folder / 'plot')]; sys.exit(main())"
    )
    words = ["report", "--output", str(tmp_path / "new")]
    with start(words, code, preexec_fn=lambda: signal.signal(signal.SIGHUP, handler)) as process:
        hear(process, "drawing")
        ended, told = interrupt(process, *numbers)
    assert ended == status
    assert TOLD in told  # SIGHUP ends a helper of Python's own as well, of which it complains to the closed terminal
    assert not list(tmp_path.glob("new/*"))
