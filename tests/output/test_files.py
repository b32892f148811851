"""Files appear whole or not at all, whatever goes wrong in between; a study's folder has one command at a time."""

import errno
import os
import pathlib
import signal
import stat

import pytest

from mjbeer.cli.app import main
from mjbeer.exceptions import OutputError
from mjbeer.output import files
from tests.support import stubs
from tests.support.processes import hear, interrupt, start

HOLD = """
import pathlib, sys, time
from mjbeer.output import files
with files.locked(pathlib.Path(sys.argv[1])):
    print("locked", flush=True)
    time.sleep(3600)
"""


def test_a_file_is_written_into_new_folders(tmp_path: pathlib.Path) -> None:
    target = tmp_path / "a" / "b" / "motion.csv"
    files.write(target, "φ\n")
    assert target.read_bytes() == "φ\n".encode()
    assert os.listdir(target.parent) == ["motion.csv"]


def test_the_temporary_file_is_a_neighbour_with_the_same_suffix(tmp_path: pathlib.Path) -> None:
    # Only within a file system is a rename atomic; ffmpeg takes the format from the suffix.
    with files.whole(tmp_path / "film.mp4") as temporary:
        assert temporary.parent == tmp_path
        assert temporary.suffix == ".mp4"
        assert not (tmp_path / "film.mp4").exists()
        temporary.write_text("new")
    assert os.listdir(tmp_path) == ["film.mp4"]


def test_two_may_write_one_file_at_a_time(tmp_path: pathlib.Path) -> None:
    """It is whole whenever it is looked at: the one, and then the other."""
    target = tmp_path / "motion.csv"
    with files.whole(target) as one:
        with files.whole(target) as other:
            one.write_text("one")
            other.write_text("other")
        assert target.read_text() == "other"
    assert target.read_text() == "one"
    assert os.listdir(tmp_path) == ["motion.csv"]


@pytest.mark.parametrize("error", [RuntimeError("drawing failed"), KeyboardInterrupt()])
def test_what_fails_leaves_the_old_file_and_nothing_else(tmp_path: pathlib.Path, error: BaseException) -> None:
    target = tmp_path / "film.mp4"
    target.write_text("old")

    def fail() -> None:
        with files.whole(target) as temporary:
            temporary.write_text("ne")
            raise error

    with pytest.raises(type(error)) as caught:
        fail()
    assert caught.value is error
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["film.mp4"]


def test_a_full_disk_is_an_output_error(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: pathlib.Path, text: str, **_: object) -> int:
        path.write_bytes(text.encode()[:3])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    target = tmp_path / "motion.csv"
    target.write_text("old")
    with monkeypatch.context() as patched:
        patched.setattr(pathlib.Path, "write_text", full)
        with pytest.raises(OutputError) as caught:
            files.write(target, "new and longer")
    assert str(caught.value) == f"cannot write {target}: No space left on device"
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["motion.csv"]


def test_what_has_its_name_is_on_the_disk(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And a disk that turns out to be full only then, as over a network, is one of the faults."""
    target = tmp_path / "motion.csv"
    target.write_text("old")
    seen = []

    def sync(file: int) -> None:
        seen.append((os.fstat(file).st_size, target.read_text()))
        if len(seen) > 1:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", sync)
    files.write(target, "new")
    assert target.read_text() == "new"
    with pytest.raises(OutputError, match="No space left on device"):
        files.write(target, "newer")
    assert seen == [(3, "old"), (5, "new")]
    assert os.listdir(tmp_path) == ["motion.csv"]
    assert target.read_text() == "new"


@pytest.mark.parametrize("mask", [0o022, 0o077, 0o000])
def test_permissions_are_those_of_any_new_file(tmp_path: pathlib.Path, mask: int) -> None:
    before = os.umask(mask)
    try:
        files.write(tmp_path / "motion.csv", "")
    finally:
        assert os.umask(before) == mask
    assert stat.S_IMODE((tmp_path / "motion.csv").stat().st_mode) == 0o666 & ~mask


def test_a_device_is_not_replaced_by_a_file(tmp_path: pathlib.Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(OutputError, match="pipe: it is not a regular file"):
        files.write(pipe, "")
    assert pipe.is_fifo()


def test_a_link_stays_and_leads_to_the_new_file(tmp_path: pathlib.Path) -> None:
    link, target = tmp_path / "link.csv", tmp_path / "far" / "motion.csv"
    link.symlink_to(target)
    for text in ("made", "replaced"):
        files.write(link, text)
        assert link.is_symlink()
        assert target.read_text() == text


def test_a_folder_that_may_not_be_written_to_is_an_output_error(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # To the superuser no folder is closed, so the system's answer is imitated.
    def refuse(path: pathlib.Path, *_: object, **__: object) -> None:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))

    monkeypatch.setattr(pathlib.Path, "touch", refuse)
    with pytest.raises(OutputError) as caught:
        files.write(tmp_path / "motion.csv", "")
    assert str(caught.value) == f"cannot write {tmp_path / 'motion.csv'}: Permission denied"


@pytest.mark.parametrize("command", ["benchmark", "stability"])
def test_a_second_study_in_a_folder_is_refused_until_the_first_is_gone(
    command: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Killed, the first cannot tidy up; what it leaves keeps nobody out."""
    stubs.benchmark(monkeypatch)
    monkeypatch.setattr("mjbeer.studies.stability.run.tasks", lambda quick: [])
    folder = tmp_path / "a" / "new"
    with start([str(folder)], HOLD) as holder:
        hear(holder, "locked")
        assert main([command, "--output", str(folder)]) == 2
        assert capsys.readouterr().err == f"mjbeer: cannot write to {folder}: another command is at work there\n"
        assert os.listdir(folder) == [".lock"]
        interrupt(holder, signal.SIGKILL)
    with files.locked(folder):
        pass
    with files.locked(folder):
        pass


def test_an_error_in_a_locked_folder_is_its_own(tmp_path: pathlib.Path) -> None:
    with pytest.raises(OSError, match="mine"), files.locked(tmp_path):
        raise OSError("mine")
