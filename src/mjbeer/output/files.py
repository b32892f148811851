"""Files that are either whole or missing, whatever interrupts their writing."""

import os
import pathlib
import secrets
import stat
from collections.abc import Generator
from contextlib import contextmanager

from mjbeer.exceptions import OutputError


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Generator[pathlib.Path]:
    """Yield a new hidden file beside `path` to write to.

    At the end of the block it replaces `path`; after an error it is deleted.
    Enter this block before a long run, so that a path that cannot be written fails at once. If the
    machine stops, `path` is either the complete new file or the old one, whose permissions the new
    one has.

    Raises:
      OutputError: if `path` is a folder, a device or read-only, or its folder does not exist or its
        disk is full.
    """
    with _hidden_file(path) as (temporary, target):
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        temporary.replace(target)


def check_writable(path: str | os.PathLike[str]) -> None:
    """Check before a long run that `atomic_write` can write to `path`; a file there stays.

    Raises:
      OutputError: as `atomic_write` does.
    """
    with _hidden_file(path):
        pass


@contextmanager
def _hidden_file(path: str | os.PathLike[str]) -> Generator[tuple[pathlib.Path, pathlib.Path]]:
    """Yield a new hidden file, which is deleted at the end, and the file that it may replace."""
    # A link is kept, and the file that it points to is replaced.
    target = pathlib.Path(os.path.realpath(path))
    with output_errors(path, target.parent):
        if target.exists() and not target.is_file():
            kind = "a folder" if target.is_dir() else "not a regular file"
            raise OutputError(f"cannot write {path}: it is {kind}")
        # Renaming would replace a file although it is read-only.
        if target.exists() and not os.access(target, os.W_OK):
            raise OutputError(f"cannot write {path}: it is read-only")
        temporary = target.with_name(f".{target.stem}-{secrets.token_hex(4)}{target.suffix}")
        try:
            temporary.touch(exist_ok=False)
            # Before anything is in it that others must not read.
            _take_permissions(target, temporary)
            yield temporary, target
        finally:
            temporary.unlink(missing_ok=True)


def replace(new: pathlib.Path, old: pathlib.Path) -> None:
    """Rename a new file to an old one, which it replaces, with the old one's permissions."""
    _take_permissions(old, new)
    new.replace(old)


def _take_permissions(old: pathlib.Path, new: pathlib.Path) -> None:
    if old.exists():
        new.chmod(stat.S_IMODE(old.stat().st_mode))


@contextmanager
def output_errors(path: str | os.PathLike[str], folder: pathlib.Path) -> Generator[None]:
    """Raise an error of the system about a path as an `OutputError`.

    If the folder does not exist, as when it is misspelt, the error names the nearest one that does.
    """
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        if not folder.is_dir():
            nearest = next(parent for parent in folder.parents if parent.is_dir())
            reason = f"there is no folder {folder}; the nearest one that exists is {nearest}"
        raise OutputError(f"cannot write {path}: {reason}") from error


def write(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file, whole or not at all.

    Raises:
      OutputError: if the file cannot be written.
    """
    with atomic_write(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def make_folder(folder: pathlib.Path) -> None:
    """Make a folder to write to, unless it exists; the folder that it is in must exist.

    Raises:
      OutputError: if it cannot be made.
    """
    with output_errors(folder, folder.absolute().parent):
        folder.mkdir(exist_ok=True)
