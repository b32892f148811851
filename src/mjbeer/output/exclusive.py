"""A folder that one command at a time writes to."""

import contextlib
import errno
import os
import pathlib
import platform
import shlex
import sys
from collections.abc import Generator

from filelock import FileLock, Timeout

from mjbeer.exceptions import OutputError
from mjbeer.output import files
from mjbeer.output.interruption import undoing

_NAME = ".mjbeer-writes-here"
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP)
"""What file systems say that have no locks, as some of networks."""


@contextlib.contextmanager
def claimed(folder: pathlib.Path) -> Generator[None]:
    """Keep other commands from writing to a folder, which is made if it is not there, while the block runs.

    The claim ends with its process, however that ends, and nobody ever waits for it. Where a file system has no
    locks there is none: every file is whole even so.

    Raises:
      OutputError: if another command has claimed the folder, or it cannot be made or written to.
    """
    path = folder / _NAME
    new = not folder.exists()
    files.make(folder)
    with contextlib.ExitStack() as stack:
        try:
            stack.enter_context(FileLock(path, blocking=False))
        except Timeout:
            raise OutputError(
                f"cannot write to {folder}: {_holder(path)} is writing there; wait for its end, or write elsewhere"
            ) from None
        except OSError as error:
            if error.errno not in _NO_LOCKS:
                raise OutputError(f"cannot write to {folder}: {error.strerror or error}") from error
        # Removed while it is locked: who has opened it in between finds that it is gone, and makes another.
        stack.enter_context(undoing(lambda: _leave(path, new)))
        with contextlib.suppress(OSError):  # it is the lock that counts, not who is told to have it
            path.write_text(_myself(), encoding="utf-8")
        yield


def _leave(path: pathlib.Path, new: bool) -> None:
    """Remove the claim, and the folder that was made for it if nothing came into it."""
    with contextlib.suppress(OSError):
        path.unlink(missing_ok=True)
        if new:
            path.parent.rmdir()


def _myself() -> str:
    command = shlex.join([pathlib.Path(sys.argv[0]).name, *sys.argv[1:]])
    return f"process {os.getpid()} on {platform.node()} (`{command}`)"


def _holder(path: pathlib.Path) -> str:
    try:
        return path.read_text(encoding="utf-8") or "another command"
    except (OSError, ValueError):
        return "another command"
