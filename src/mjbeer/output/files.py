"""Output files that appear whole or not at all, and folders that one command at a time works in."""

import os
import pathlib
import secrets
from collections.abc import Generator
from contextlib import contextmanager, suppress

from filelock import FileLock, Timeout

from mjbeer.exceptions import OutputError


@contextmanager
def whole(path: str | os.PathLike[str]) -> Generator[pathlib.Path]:
    """Yield a new hidden file beside `path` to write to; it becomes `path` when all went well, and goes otherwise.

    Open it before a long run: what cannot be written fails at once. What was written is on the disk before it gets
    its name: a machine that stops leaves all of it, or the old file.

    Raises:
      OutputError: if `path` is a folder, a device or read-only, its folder cannot be made or written to, or the disk
        is full.
    """
    target = pathlib.Path(os.path.realpath(path))  # a link stays, and what it points to is replaced
    temporary = target.with_name(f".{target.stem}-{secrets.token_hex(4)}{target.suffix}")
    try:
        if target.exists() and not target.is_file():
            raise OutputError(f"cannot write {path}: it is {'a folder' if target.is_dir() else 'not a regular file'}")
        if target.exists() and not os.access(target, os.W_OK):  # a rename would replace it even so
            raise OutputError(f"cannot write {path}: it is read-only")
        _make(target.parent)
        try:
            temporary.touch(exist_ok=False)
            yield temporary
            with temporary.open("rb+") as written:
                os.fsync(written.fileno())
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise _failure(path, error) from error


@contextmanager
def locked(folder: pathlib.Path) -> Generator[None]:
    """Keep other commands from a study that is read from a folder, added to and written back, while the block runs.

    The folder is made if it is not there. The lock ends with its process, however that ends; its hidden file stays.

    Raises:
      OutputError: if another command holds the lock, or the folder cannot be made or written to.
    """
    lock = FileLock(folder / ".lock", blocking=False)
    try:
        _make(folder)
        lock.acquire()
    except Timeout:
        raise OutputError(f"cannot write to {folder}: another command is at work there") from None
    except OSError as error:
        raise _failure(folder, error) from error
    try:
        yield
    finally:
        lock.release()


def write(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file, whole or not at all.

    Raises:
      OutputError: if it cannot be written.
    """
    with whole(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _make(folder: pathlib.Path) -> None:
    with suppress(FileExistsError):  # a file in its place makes what comes next fail, with a better reason
        folder.mkdir(parents=True)


def _failure(path: str | os.PathLike[str], error: OSError) -> OutputError:
    return OutputError(f"cannot write {path}: {error.strerror or error}")
