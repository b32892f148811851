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

MESSAGE = "mjbeer: interrupted; every file written is complete\n"


def test_a_report_ends_with_its_processes(tmp_path: pathlib.Path) -> None:
    """Nothing is checked, no film is drawn, and the plot never ends.

    Its hidden file goes, and a file of a like name does not.
    """
    code = (
        "import sys; "
        "from mjbeer.cli.app import main; "
        "from mjbeer.report import films, page; "
        "from tests.support import processes; "
        "films.film_jobs = lambda folder, quick: []; "
        "page.validate = processes.sleep; "
        "page.plot_jobs = lambda folder: [processes.EndlessPlot(folder / 'plot')]; "
        "sys.exit(main())"
    )
    folder = tmp_path / "new"
    with folders.owned(folder, "mjbeer report"):
        (folder / "index.html").write_text("of an earlier report")
        (folder / ".plot-of-mine").write_text("mine")
    before = {*os.listdir(folder), ".lock"}

    with start(["report", "--output", str(folder)], code) as process:
        hear(process, "drawing")
        ended, messages = interrupt(process, signal.SIGHUP)

    assert ended == 128 + signal.SIGHUP
    # SIGHUP ends a helper of Python's own as well, of which it complains to the closed terminal.
    assert MESSAGE in messages
    assert {*os.listdir(folder), ".lock"} == before
    assert (folder / "index.html").read_text() == "of an earlier report"
    assert (folder / ".plot-of-mine").read_text() == "mine"


def test_a_closed_terminal_does_not_end_what_ignores_it_and_sigterm_does() -> None:
    """As under nohup: SIGHUP stays ignored. The processes of the command end, too."""
    code = (
        "import sys; "
        "from mjbeer.cli import app; "
        "from tests.support import processes; "
        "app.COMMANDS['validate'] = processes.two_that_sleep; "
        "sys.exit(app.main())"
    )

    def ignore() -> None:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)

    with start(["validate"], code, preexec_fn=ignore) as process:
        hear(process, "at work")
        ended, messages = interrupt(process, signal.SIGHUP, signal.SIGTERM)

    assert ended == 128 + signal.SIGTERM
    assert messages == MESSAGE
