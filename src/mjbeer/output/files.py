"""Output files that appear whole or not at all."""

import os
import pathlib
import secrets
from collections.abc import Generator
from contextlib import contextmanager

from mjbeer.exceptions import OutputError
from mjbeer.output.interruption import undoing


@contextmanager
def whole(path: str | os.PathLike[str]) -> Generator[pathlib.Path]:
    """A temporary name beside `path` to write to; it becomes `path` when all went well, and goes otherwise.

    What was written is on the disk before it gets its name: a machine that stops leaves all of it, or the old file.

    Raises:
      OutputError: if `path` is a folder, a device or read-only, its folder cannot be made or written to, or the disk
        is full.
    """
    check(path)
    target = pathlib.Path(os.path.realpath(path))  # a link stays, and what it points to is replaced
    temporary = target.with_name(f".{target.stem}-{secrets.token_hex(4)}{target.suffix}")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with undoing(lambda: temporary.unlink(missing_ok=True)):
            temporary.touch(exist_ok=False)
            yield temporary
            with temporary.open("rb+") as written:
                os.fsync(written.fileno())
            temporary.replace(target)
    except OSError as error:
        raise _cannot(path, error) from error


def check(path: str | os.PathLike[str]) -> None:
    """Find out what can be known beforehand of a file that a long run ends with.

    Raises:
      OutputError: if it is a folder, a device or read-only, or what should be its folder is none or read-only.
    """
    target = pathlib.Path(os.path.realpath(path))
    try:
        if target.exists() and not target.is_file():
            raise OutputError(f"cannot write {path}: it is {'a folder' if target.is_dir() else 'not a regular file'}")
        if target.exists() and not os.access(target, os.W_OK):  # a rename would replace it even so
            raise OutputError(f"cannot write {path}: it is read-only")
    except OSError as error:
        raise _cannot(path, error) from error
    _check_folder(path, target.parent)


def make(folder: pathlib.Path) -> None:
    """Make a folder to write to, if it is not there.

    Raises:
      OutputError: if it cannot be made or written to.
    """
    _check_folder(folder, pathlib.Path(os.path.realpath(folder)))
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _cannot(folder, error) from error


def _check_folder(path: str | os.PathLike[str], folder: pathlib.Path) -> None:
    try:
        above = next(each for each in (folder, *folder.parents) if each.exists())
    except OSError as error:
        raise _cannot(path, error) from error
    if not above.is_dir():
        raise OutputError(f"cannot write {path}: {above} is not a folder")
    if not os.access(above, os.W_OK | os.X_OK):
        raise OutputError(f"cannot write {path}: the folder {above} is read-only")


def write(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file, whole or not at all.

    Raises:
      OutputError: if it cannot be written.
    """
    with whole(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def remove(path: str | os.PathLike[str]) -> None:
    """Remove a file if it is there.

    Raises:
      OutputError: if it cannot be removed, or its folder is none.
    """
    try:
        pathlib.Path(path).unlink(missing_ok=True)
    except OSError as error:
        raise _cannot(path, error) from error


def _cannot(path: str | os.PathLike[str], error: OSError) -> OutputError:
    return OutputError(f"cannot write {path}: {error.strerror or error}")
