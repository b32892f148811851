"""Disks, folders and streams that refuse: an error of one line, exit status 2, and no half file."""

import os
import pathlib
import resource
import signal
import sys

import pytest

from mjbeer.cli.app import main
from mjbeer.output import files
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.study import Study
from tests.support import stubs
from tests.support.processes import run

pytestmark = pytest.mark.slow

FROZEN = ("frozen", "--duration", "0.5")
FOLDERS = ("report", "benchmark", "stability", "paper")
linux = pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is Linux's")


def little_disk() -> None:
    """Let no file become longer than 4 KiB, as if the disk were full."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
    # As in Python, the signal is ignored, so that to write is an error.
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)


def test_a_full_disk_leaves_the_old_file(tmp_path: pathlib.Path) -> None:
    """The first run has room enough, for Numba writes its caches then.

    Python writes no bytecode: a file of it that was cut off would end every later run, since Python
    3.11.2 does not notice.
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


class WorkError(Exception):
    """What stands in for the work of a command, so that a test knows that it has begun."""


def begin(*_: object, **__: object) -> None:
    raise WorkError


WORK = {
    "simulate frozen": "cli.motions.run_of",
    "render frozen": "cli.motions.run_of",
    "render standing": "drawing.standing_film.StandingFilm.plan",
    "fit examples/synthetic_track.csv frozen": "tracks.fit.fit",
    "sweep frozen --fill 0.3,0.5": "studies.sweep.sweep",
    "report": "report.page.write",
    "benchmark": "studies.benchmark.timing.run",
    "stability": "studies.stability.stability_study.run",
    "paper": "paper.stories.write",
}
"""The function that does the work of each command."""
ENDINGS = {"render": ".mp4", "fit": ".svg", "sweep": ".csv"}
CHECKOUT = pathlib.Path(__file__).parents[2]


@pytest.fixture
def beginning(words: str, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the words of a command that raises WorkError where it begins its work."""
    monkeypatch.chdir(CHECKOUT)
    monkeypatch.setattr(f"mjbeer.{WORK[words]}", begin)
    return words.split()


@pytest.mark.parametrize("words", WORK)
def test_what_cannot_be_written_is_known_before_the_work(
    beginning: list[str], tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "misspelt"
    target = folder / f"new{ENDINGS.get(beginning[0], '')}"

    status = main([*beginning, "--output", str(target)])

    assert status == 2
    reason = f"there is no folder {folder}; the nearest one that exists is {tmp_path}"
    assert capsys.readouterr().err == f"mjbeer: cannot write {target}: {reason}\n"
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize("words", WORK)
def test_a_command_that_can_write_begins_its_work(
    beginning: list[str], tmp_path: pathlib.Path
) -> None:
    target = tmp_path / f"new{ENDINGS.get(beginning[0], '')}"

    with pytest.raises(WorkError):
        main([*beginning, "--output", str(target)])


def test_an_export_names_the_folder_that_does_not_exist(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """To export takes less than a second, so nothing is checked before."""
    folder = tmp_path / "misspelt"
    target = folder / "can.xml"

    status = main(["export", "frozen", "--output", str(target)])

    assert status == 2
    reason = f"there is no folder {folder}; the nearest one that exists is {tmp_path}"
    assert capsys.readouterr().err == f"mjbeer: cannot write {target}: {reason}\n"


@pytest.mark.parametrize("scene", ["frozen", "standing"])
@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("--output film.avi", "the file's name must end in .mp4, got 'film.avi'"),
        ("--width 641", "width must be an even number of pixels up to 4096"),
        ("--height 5000", "height must be an even number of pixels up to 4096"),
        ("--speed 0", "speed must be greater than 0, got 0"),
    ],
)
def test_the_options_of_a_film_are_checked_before_the_work(
    scene: str,
    options: str,
    message: str,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(f"mjbeer.{WORK[f'render {scene}']}", begin)

    status = main(["render", scene, *options.split()])

    assert status == 2
    assert capsys.readouterr().err.startswith(f"mjbeer: {message}")
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize("command", FOLDERS)
def test_a_folder_of_others_is_refused_before_the_work(
    command: str,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(f"mjbeer.{WORK[command]}", begin)
    names = ["index.html", "stories.md", "summary.md"]
    for name in names:
        (tmp_path / name).write_text("mine")

    status = main([command, "--output", str(tmp_path)])

    assert status == 2
    reason = f"`mjbeer {command}` did not write what is there (index.html, stories.md, summary.md)"
    advice = "name a new or an empty folder"
    assert capsys.readouterr().err == f"mjbeer: cannot write to {tmp_path}: {reason}: {advice}\n"
    assert sorted(os.listdir(tmp_path)) == names
    assert all((tmp_path / name).read_text() == "mine" for name in names)


@pytest.fixture
def little_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let every command that fills a folder write results that are at hand."""
    stubs.validate(monkeypatch, first=1e-5)
    stubs.draw(monkeypatch)
    study = Study("mjbeer stability", {"quick": True}, {})
    monkeypatch.setattr("mjbeer.studies.benchmark.timing.run", lambda *_: Benchmark.load(SHIPPED))
    monkeypatch.setattr(
        "mjbeer.studies.benchmark.work_precision.draw",
        lambda _, path: files.write(path.with_suffix(".svg"), "a diagram"),
    )
    monkeypatch.setattr("mjbeer.studies.stability.stability_study.run", lambda *_: study)
    monkeypatch.setattr("mjbeer.studies.stability.map_plots.figures", lambda _: {})


@pytest.fixture
def old_results(command: str, tmp_path: pathlib.Path, little_work: None) -> list[pathlib.Path]:
    """Return the files that a command has written, each of which now says "old"."""
    assert main([command, "--output", str(tmp_path)]) == 0
    paths = [path for path in tmp_path.iterdir() if not path.name.startswith(".")]
    for path in paths:
        path.write_text("old")
    return paths


@pytest.fixture
def interrupted(
    command: str,
    last: str,
    old_results: list[pathlib.Path],
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
) -> int:
    """Return the exit status of a command that is interrupted where all but one file is written."""
    assert tmp_path / last in old_results
    write = files.write

    def interrupt(path: pathlib.Path, text: str) -> None:
        if path.name == last:
            raise KeyboardInterrupt
        write(path, text)

    with monkeypatch.context() as patched:
        patched.setattr(files, "write", interrupt)
        return main([command, "--output", str(tmp_path)])


each_command_and_its_last_file = pytest.mark.parametrize(
    ("command", "last"),
    [
        ("report", "index.html"),
        ("benchmark", "summary.md"),
        ("stability", "summary.md"),
        ("paper", "stories.md"),
    ],
)


@each_command_and_its_last_file
def test_old_results_stay_if_a_command_is_interrupted_at_its_end(
    interrupted: int, old_results: list[pathlib.Path]
) -> None:
    assert interrupted == 130
    assert [path.read_text() for path in old_results] == ["old"] * len(old_results)


@each_command_and_its_last_file
@pytest.mark.usefixtures("interrupted")
def test_a_command_that_was_interrupted_writes_all_results_when_it_is_run_again(
    command: str, old_results: list[pathlib.Path], tmp_path: pathlib.Path
) -> None:
    status = main([command, "--output", str(tmp_path)])

    assert status == 0
    assert "old" not in [path.read_text() for path in old_results]


@linux
def test_a_full_standard_output() -> None:
    with open("/dev/full", "w") as full:
        status, _, err = run(["simulate", *FROZEN], stdout=full)

    assert status == 2
    assert err.count("\n") == 1
    assert "No space left on device" in err


def test_a_closed_standard_output(tmp_path: pathlib.Path) -> None:
    """The command notices before the work, and leaves no file."""
    target = tmp_path / "motion.csv"
    words = ["simulate", *FROZEN, "--output", str(target)]

    status, _, err = run(words, preexec_fn=lambda: os.close(1))

    assert (status, err) == (2, "mjbeer: cannot write to standard output: it is closed\n")
    assert not target.exists()


@pytest.mark.parametrize("words", [(), ("--output", "-", "--duration", "2")])
def test_a_reader_that_goes_away(words: tuple[str, ...]) -> None:
    """One output fits into the buffers of Python and of the pipe, the other does not."""
    reader, writer = os.pipe()
    os.close(reader)

    try:
        status, _, err = run(["simulate", "frozen", "--duration", "0.01", *words], stdout=writer)
    finally:
        os.close(writer)

    assert (status, err) == (2, "mjbeer: cannot write to standard output: Broken pipe\n")
