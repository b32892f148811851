"""SIGTERM and a closed terminal in the middle: no process is left, and nothing half written.

That what was measured is kept is tested where a study or a sweep is; that no file is ever seen
half, where files are written.
"""

import os
import pathlib
import signal

import pytest

from mjbeer.output import folders
from tests.support.processes import hear, interrupt, start

pytestmark = pytest.mark.slow

MESSAGE = "mjbeer: interrupted; what was written is whole\n"


@pytest.mark.parametrize(
    ("handler", "numbers", "status"),
    [
        (signal.SIG_DFL, [signal.SIGHUP], 129),
        (
            signal.SIG_IGN,
            [signal.SIGHUP, signal.SIGTERM],
            143,
        ),  # as under nohup: SIGHUP stays ignored
    ],
)
def test_a_report_ends_with_its_processes(
    handler: signal.Handlers, numbers: list[int], status: int, tmp_path: pathlib.Path
) -> None:
    """The films are not drawn, and the plot never ends.

    Its hidden file goes, and a file of a like name does not.
    """
    code = (
        "import sys; "
        "from mjbeer.cli.app import main; "
        "from mjbeer.drawing.video import PlotJob; "
        "from mjbeer.report import films, page; "
        "from tests.support.processes import draw_and_sleep; "
        "films.film_jobs = lambda folder, quick: []; "
        "page.plot_jobs = lambda folder: [PlotJob(draw_and_sleep, folder / 'plot')]; "
        "sys.exit(main())"
    )
    folder = tmp_path / "new"
    with folders.owned(folder, "mjbeer report"):
        (folder / "index.html").write_text("of an earlier report")
        (folder / ".plot-of-mine").write_text("mine")
    before = {*os.listdir(folder), ".lock"}
    words = ["report", "--output", str(folder)]
    with start(words, code, preexec_fn=lambda: signal.signal(signal.SIGHUP, handler)) as process:
        hear(process, "drawing")
        ended, messages = interrupt(process, *numbers)
    assert ended == status
    # SIGHUP ends a helper of Python's own as well, of which it complains to the closed terminal.
    assert MESSAGE in messages
    assert {*os.listdir(folder), ".lock"} == before
    assert (folder / "index.html").read_text() == "of an earlier report"
    assert (folder / ".plot-of-mine").read_text() == "mine"
