"""What an interruption leaves: files that are whole or not there, and no process."""

import os
import pathlib
import secrets
import signal
import stat
import threading
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

from mjbeer.exceptions import OutputError


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Generator[pathlib.Path]:
    """Yield a new hidden file beside `path` to write to; at the end it replaces `path`, or is deleted after an error.

    Enter this block before a long run, so that a path that cannot be written fails at once. If the machine stops,
    `path` is either the complete new file or the old one, whose permissions the new one has.

    Raises:
      OutputError: if `path` is a folder, a device or read-only, or its folder does not exist or its disk is full.
    """
    target = pathlib.Path(os.path.realpath(path))  # a link is kept, and the file that it points to is replaced
    with output_errors(path, target.parent):
        if target.exists() and not target.is_file():
            raise OutputError(f"cannot write {path}: it is {'a folder' if target.is_dir() else 'not a regular file'}")
        if target.exists() and not os.access(target, os.W_OK):  # renaming would replace it although it is read-only
            raise OutputError(f"cannot write {path}: it is read-only")
        temporary = target.with_name(f".{target.stem}-{secrets.token_hex(4)}{target.suffix}")
        try:
            temporary.touch(exist_ok=False)
            _take_permissions(target, temporary)  # before anything is in it that others must not read
            yield temporary
            with temporary.open("rb+") as file:
                os.fsync(file.fileno())
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)


def replace(new: pathlib.Path, old: pathlib.Path) -> None:
    """Rename a new file so that it replaces an old one, if there is one, with the old one's permissions."""
    _take_permissions(old, new)
    new.replace(old)


def _take_permissions(old: pathlib.Path, new: pathlib.Path) -> None:
    if old.exists():
        new.chmod(stat.S_IMODE(old.stat().st_mode))


@contextmanager
def output_errors(path: str | os.PathLike[str], folder: pathlib.Path) -> Generator[None]:
    """Raise what the system has against a path as an `OutputError`; a folder that may be misspelt is not made."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        if not folder.is_dir():
            nearest = next(each for each in folder.parents if each.is_dir())
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


@contextmanager
def pool(most: int) -> Generator[Any]:
    """Yield an executor with a process for each core, but not more than `most`; they start when work is submitted.

    At the end of the block, or when it is interrupted, the processes are ended.
    """
    import multiprocessing  # here, as `import mjbeer` would take a fifth longer
    from concurrent.futures import ProcessPoolExecutor

    # Not forked: a copy of a process with several threads may hang, and a copy of OpenGL is of no use.
    # Threads for linear algebra would take the cores from other processes; NumPy asks when it is loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    context, count = multiprocessing.get_context("spawn"), max(1, min(os.cpu_count() or 1, most))
    executor = ProcessPoolExecutor(count, context, _follow_parent)
    try:
        yield executor
    except BaseException:
        for child in multiprocessing.active_children():
            child.terminate()
        raise
    finally:
        executor.shutdown(cancel_futures=True)


def _follow_parent() -> None:
    """Make this process leave interruptions to its parent, and end when the parent does, even if that is killed."""
    import multiprocessing

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent: Any = multiprocessing.parent_process()

    def end() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=end, daemon=True).start()
