"""Output files that appear whole or not at all."""

import os
import pathlib
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

from mjbeer.exceptions import OutputError


@contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[pathlib.Path]:
    """A temporary name beside `path` to write to; it becomes `path` when all went well, and goes otherwise.

    Raises:
      OutputError: if the folder cannot be made or written to, or the disk is full.
    """
    target = pathlib.Path(path)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.stem}-", suffix=target.suffix)
        os.close(handle)
    except OSError as error:
        raise OutputError(f"cannot write {target}: {error.strerror or error}") from error
    temporary = pathlib.Path(name)
    try:
        yield temporary
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    except OSError as error:
        raise OutputError(f"cannot write {target}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)


def write(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file, whole or not at all.

    Raises:
      OutputError: if it cannot be written.
    """
    with whole(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _umask() -> int:
    """The process's mask, which can only be read by setting it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
