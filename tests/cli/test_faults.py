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


@pytest.mark.parametrize("words", WORK)
def test_what_cannot_be_written_is_known_before_the_work(
    words: str,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Where the same command can write, it begins its work."""
    monkeypatch.chdir(CHECKOUT)
    monkeypatch.setattr(f"mjbeer.{WORK[words]}", begin)
    command = words.split()
    name = f"new{ENDINGS.get(command[0], '')}"
    folder = tmp_path / "misspelt"
    target = folder / name
    assert main([*command, "--output", str(target)]) == 2
    reason = f"there is no folder {folder}; the nearest one that exists is {tmp_path}"
    assert capsys.readouterr().err == f"mjbeer: cannot write {target}: {reason}\n"
    assert not os.listdir(tmp_path)
    with pytest.raises(WorkError):
        main([*command, "--output", str(tmp_path / name)])


def test_an_export_names_the_folder_that_does_not_exist(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """To export takes less than a second, so nothing is checked before."""
    folder = tmp_path / "misspelt"
    target = folder / "can.xml"
    assert main(["export", "frozen", "--output", str(target)]) == 2
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
    assert main(["render", scene, *options.split()]) == 2
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
    assert main([command, "--output", str(tmp_path)]) == 2
    reason = f"`mjbeer {command}` did not write what is there (index.html, stories.md, summary.md)"
    advice = "name a new or an empty folder"
    assert capsys.readouterr().err == f"mjbeer: cannot write to {tmp_path}: {reason}: {advice}\n"
    assert sorted(os.listdir(tmp_path)) == names
    assert all((tmp_path / name).read_text() == "mine" for name in names)


@pytest.mark.parametrize(
    ("command", "last"),
    [
        ("report", "index.html"),
        ("benchmark", "summary.md"),
        ("stability", "summary.md"),
        ("paper", "stories.md"),
    ],
)
def test_old_results_stay_if_a_command_is_interrupted_at_its_end(
    command: str, last: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """When all but the last file are written. Then it is run again, and writes them all."""
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
    words = [command, "--output", str(tmp_path)]
    assert main(words) == 0
    names = [path for path in tmp_path.iterdir() if not path.name.startswith(".")]
    assert tmp_path / last in names
    for path in names:
        path.write_text("old")
    write = files.write

    def interrupted(path: pathlib.Path, text: str) -> None:
        if path.name == last:
            raise KeyboardInterrupt
        write(path, text)

    with monkeypatch.context() as patched:
        patched.setattr(files, "write", interrupted)
        assert main(words) == 130
    assert [path.read_text() for path in names] == ["old"] * len(names)
    assert main(words) == 0
    assert "old" not in [path.read_text() for path in names]


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
