"""Disks, folders and streams that do not take what is written: one line that says so, exit status 2, no half file."""

import os
import pathlib
import stat
import subprocess
import sys
import time

import pytest

from mjbeer.cli.app import main
from mjbeer.paper.stories.report import stories
from mjbeer.studies.benchmark.points import Benchmark
from tests.support.processes import SHORT, little_disk, run

pytestmark = pytest.mark.slow

FROZEN = ("frozen", "--duration", "0.5")
VIDEO = (*FROZEN, "--width", "320", "--height", "180")
linux = pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is Linux's")


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (("simulate", *FROZEN), "motion.csv"),
        pytest.param(("render", *VIDEO), "film.mp4", marks=pytest.mark.draws),
    ],
)
def test_a_full_disk_leaves_the_old_file(words: tuple[str, ...], name: str, tmp_path: pathlib.Path) -> None:
    target = tmp_path / name
    target.write_text("old")
    status, _, err = run([*words, "--output", str(target)], preexec_fn=little_disk)
    assert (status, err) == (2, f"mjbeer: cannot write {target}: File too large\n")
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == [name]


def test_a_full_disk_ends_the_stories_at_the_first_plot(tmp_path: pathlib.Path) -> None:
    """Drawn once before, for matplotlib and numba write caches the first time."""
    stories()[0].draw(tmp_path / "before" / "trivial")
    folder = tmp_path / "paper"
    folder.mkdir()
    (folder / "stories.md").write_text("old")
    status, _, err = run(["paper", "--output", str(folder)], preexec_fn=little_disk)
    assert (status, err) == (2, f"mjbeer: cannot write {folder / 'letters.svg'}: File too large\n")
    assert not os.listdir(folder)  # nor a summary of plots that are not there


def test_a_study_that_cannot_be_saved_again_stays_as_it_was(tmp_path: pathlib.Path) -> None:
    """The first ladders have been saved when the disk is full."""
    status, _, err = run(["benchmark", "frozen", "--output", str(tmp_path)], SHORT, preexec_fn=little_disk)
    assert status == 2
    assert err.endswith(f"mjbeer: cannot write {tmp_path / 'study.json'}: File too large\n")
    assert len({each.curve for each in Benchmark.load(tmp_path / "study.json").points}) >= 1
    assert set(os.listdir(tmp_path)) == {".lock", "study.json"}


@pytest.mark.parametrize("words", [("simulate", *FROZEN), ("export", "frozen"), ("render", *VIDEO)])
def test_what_cannot_be_written_is_known_before_the_work(
    words: tuple[str, ...],
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A folder of that name, a file in the folder's place, and a read-only file. For root none is read-only."""
    monkeypatch.setattr("mjbeer.output.files.os.access", lambda path, _: bool(os.stat(path).st_mode & stat.S_IWUSR))
    suffix = {"simulate": ".csv", "export": ".xml", "render": ".mp4"}[words[0]]
    if words[0] == "simulate":
        monkeypatch.setattr("mjbeer.cli.arguments.Motion.simulate", lambda _: pytest.fail("it was simulated"))
    monkeypatch.setattr("mjbeer.drawing.encoder.encode", lambda *_, **__: pytest.fail("it was drawn"))
    (tmp_path / f"folder{suffix}").mkdir()
    (tmp_path / f"file{suffix}").touch(mode=0o444)
    for name, reason in {
        f"folder{suffix}": "it is a folder",
        f"file{suffix}": "it is read-only",
        f"file{suffix}/x/new{suffix}": "Not a directory",
    }.items():
        assert main([*words, "--output", str(tmp_path / name)]) == 2
        assert capsys.readouterr().err == f"mjbeer: cannot write {tmp_path / name}: {reason}\n"


@pytest.mark.parametrize("command", ["report", "benchmark", "stability", "paper"])
def test_a_folder_that_cannot_be_made_is_known_before_the_work(
    command: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for work in ("report.write.validate", "studies.benchmark.run.conduct", "studies.stability.run.conduct"):
        monkeypatch.setattr(f"mjbeer.{work}", lambda *_: pytest.fail("the work was begun"))
    (tmp_path / "file").touch()
    assert main([command, "--output", str(tmp_path / "file" / "new")]) == 2
    err = capsys.readouterr().err
    assert err.startswith(f"mjbeer: cannot write {tmp_path / 'file' / 'new'}")
    assert err.endswith(": Not a directory\n")


@linux
@pytest.mark.parametrize("words", [("simulate", *FROZEN), ("--help",)])
def test_a_full_standard_output(words: tuple[str, ...]) -> None:
    with open("/dev/full", "w") as full:
        status, _, err = run(words, stdout=full)
    assert status == 2
    assert err.count("\n") == 1
    assert "No space left on device" in err


@pytest.mark.parametrize("words", [(), ("--output", "-"), ("--output", "-", "--duration", "2")])
def test_a_reader_that_goes_away(words: tuple[str, ...]) -> None:
    """Of tables, and of less and of more than Python and the pipe keep in between."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        status, _, err = run(["simulate", "frozen", "--duration", "0.01", *words], stdout=writer)
    finally:
        os.close(writer)
    assert (status, err) == (2, "mjbeer: cannot write to standard output: Broken pipe\n")


def test_two_commands_may_write_one_file_at_a_time(tmp_path: pathlib.Path) -> None:
    """Each appears whole: what is there at the end is the one or the other."""
    alone = []
    for angle in ("20", "50"):
        assert main(["simulate", *FROZEN, "--phi0", angle, "--output", str(tmp_path / "alone.csv")]) == 0
        alone.append((tmp_path / "alone.csv").read_text())
    (tmp_path / "alone.csv").unlink()
    code = "import sys; from mjbeer.cli.app import main; [main() for _ in range(3)]"
    words = ("simulate", *FROZEN, "--output", str(tmp_path / "same.csv"), "--phi0")
    both = [subprocess.Popen([sys.executable, "-c", code, *words, angle], stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL) for angle in ("20", "50")]  # fmt: skip
    seen = set()
    while any(each.poll() is None for each in both):
        if (tmp_path / "same.csv").exists():
            seen.add((tmp_path / "same.csv").read_text())
        time.sleep(1e-3)  # and leaves the processor to them
    assert seen == set(alone)
    assert os.listdir(tmp_path) == ["same.csv"]
