"""Output files that appear whole or not at all."""

import os
import pathlib
import secrets
import sys
from collections.abc import Generator
from contextlib import contextmanager

from mjbeer.exceptions import OutputError


@contextmanager
def whole(path: str | os.PathLike[str]) -> Generator[pathlib.Path]:
    """A temporary name beside `path` to write to; it becomes `path` when all went well, and goes otherwise.

    Raises:
      OutputError: if `path` is a folder or a device, its folder cannot be made or written to, or the disk is full.
    """
    target = pathlib.Path(os.path.realpath(path))  # a link stays, and what it points to is replaced
    try:
        if target.exists() and not target.is_file():
            raise OutputError(f"cannot write {path}: it is {'a folder' if target.is_dir() else 'not a regular file'}")
        temporary = target.with_name(f".{target.stem}-{secrets.token_hex(4)}{target.suffix}")
        target.parent.mkdir(parents=True, exist_ok=True)
        temporary.touch(exist_ok=False)
    except OSError as error:
        raise OutputError(f"cannot write {path}: {error.strerror or error}") from error
    try:
        yield temporary
        temporary.replace(target)
    except OSError as error:
        raise OutputError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)


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
        raise OutputError(f"cannot write {path}: {error.strerror or error}") from error


def show(text: str) -> None:
    """Write to standard output, all of it before this returns.

    Raises:
      OutputError: if it cannot be written, as into a pipe that nobody reads any more.
    """
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        # What is left in the buffer would fail once more, with a traceback, when Python ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise OutputError(f"cannot write to standard output: {error.strerror or error}") from error
