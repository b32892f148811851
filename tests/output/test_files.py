"""Files appear whole or not at all, whatever goes wrong in between."""

import errno
import os
import pathlib
from unittest.mock import Mock

import pytest

from mjbeer.exceptions import OutputError
from mjbeer.output import files


def test_a_file_is_written_with_any_user_s_permissions(tmp_path: pathlib.Path) -> None:
    target = tmp_path / "motion.csv"
    usual = tmp_path / "usual"
    usual.touch()
    files.write(target, "φ\n")
    assert target.read_bytes() == "φ\n".encode()
    assert target.stat().st_mode == usual.stat().st_mode


@pytest.mark.parametrize("mode", [0o600, 0o664])
def test_a_file_keeps_its_permissions_and_nobody_else_reads_the_new_one_before(
    mode: int, tmp_path: pathlib.Path
) -> None:
    target = tmp_path / "motion.csv"
    target.write_text("old")
    target.chmod(mode)
    with files.atomic_write(target) as temporary:
        assert temporary.stat().st_mode & 0o777 == mode
        temporary.write_text("new")
    assert target.stat().st_mode & 0o777 == mode
    assert target.read_text() == "new"


def test_a_folder_that_may_be_misspelt_is_not_made(tmp_path: pathlib.Path) -> None:
    """Where a folder is to be written to, its last name may be new, and its others may not."""
    for write in (lambda path: files.write(path, ""), files.make_folder):
        with pytest.raises(
            OutputError,
            match=f"there is no folder {tmp_path}/reslts; the nearest .* is {tmp_path}$",
        ):
            write(tmp_path / "reslts" / "new")
    assert not os.listdir(tmp_path)
    for _ in range(2):
        files.make_folder(tmp_path / "results")
    assert os.listdir(tmp_path) == ["results"]


def test_a_check_leaves_the_old_file_and_nothing_else(tmp_path: pathlib.Path) -> None:
    target = tmp_path / "film.mp4"
    files.check_writable(target)
    assert not os.listdir(tmp_path)
    target.write_text("old")
    files.check_writable(target)
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["film.mp4"]
    with pytest.raises(OutputError, match=f"cannot write {tmp_path}: it is a folder"):
        files.check_writable(tmp_path)


@pytest.mark.parametrize("error", [RuntimeError("drawing failed"), KeyboardInterrupt()])
def test_what_fails_leaves_the_old_file_and_nothing_else(
    tmp_path: pathlib.Path, error: BaseException
) -> None:
    target = tmp_path / "film.mp4"
    target.write_text("old")

    def fail() -> None:
        with files.atomic_write(target) as temporary:
            # Only within a file system is a rename atomic; ffmpeg takes the format from the suffix.
            assert (temporary.parent, temporary.suffix) == (tmp_path, ".mp4")
            temporary.write_text("ne")
            raise error

    with pytest.raises(type(error)) as caught:
        fail()
    assert caught.value is error
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["film.mp4"]


@pytest.mark.parametrize(
    ("where", "name", "number"),
    [
        (pathlib.Path, "write_text", errno.ENOSPC),
        (os, "fsync", errno.ENOSPC),  # what has its name is on the disk, over a network too
        (pathlib.Path, "touch", errno.EACCES),  # to the superuser no folder is closed
    ],
)
def test_a_disk_that_does_not_take_it_is_an_output_error(
    where: object, name: str, number: int, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "motion.csv"
    target.write_text("old")
    with monkeypatch.context() as patched:
        patched.setattr(where, name, Mock(side_effect=OSError(number, os.strerror(number))))
        with pytest.raises(OutputError) as caught:
            files.write(target, "new and longer")
    assert str(caught.value) == f"cannot write {target}: {os.strerror(number)}"
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["motion.csv"]


def test_a_link_stays_and_what_is_read_only_or_a_device_is_not_replaced(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = tmp_path / "link.csv"
    target = tmp_path / "far" / "motion.csv"
    pipe = tmp_path / "pipe"
    link.symlink_to(target)
    target.parent.mkdir()
    for text in ("made", "replaced"):
        files.write(link, text)
        assert link.is_symlink()
        assert target.read_text() == text
    os.mkfifo(pipe)
    with pytest.raises(OutputError, match="pipe: it is not a regular file"):
        files.write(pipe, "")
    assert pipe.is_fifo()
    monkeypatch.setattr(os, "access", lambda *_: False)  # to the superuser no file is read-only
    with pytest.raises(OutputError, match="it is read-only"):
        files.write(target, "")
    assert target.read_text() == "replaced"
