"""Folders of results: each belongs to one command, which replaces them when new ones are whole."""

import pathlib
import shutil
from collections.abc import Generator
from contextlib import contextmanager

from mjbeer.exceptions import OutputError
from mjbeer.output import files

MARKER = ".mjbeer"
"""Name of the file that says to which command a folder belongs."""
UNFINISHED = ".unfinished"
"""Name of the folder in it that has the new results until they are whole."""
_NAMED = 3
"""Number of files of others that an error names."""


@contextmanager
def owned(folder: pathlib.Path, command: str) -> Generator[None]:
    """Hold a folder of results for a command while the block runs; make it before, if needed.

    A new or an empty folder belongs to the command from now on. The system releases the hold when
    the process ends, even if it is killed; the hidden file of the lock may stay.

    Raises:
      OutputError: if the folder cannot be made, has files that the command did not write, or is
        held by another process.
    """
    # Here, as it takes long to import, and not every command needs it.
    from filelock import FileLock, Timeout

    files.make_folder(folder)
    with files.output_errors(folder, folder):
        _claim(folder, command)
        try:
            lock = FileLock(folder / ".lock", blocking=False).acquire()
        except Timeout:
            raise OutputError(
                f"cannot write to {folder}: another command is at work there"
            ) from None
    with lock:
        yield


def _claim(folder: pathlib.Path, command: str) -> None:
    """Write the marker of a command into an empty folder.

    Raises:
      OutputError: if the folder is not empty, and not the command's.
    """
    marker = folder / MARKER
    names = sorted(path.name for path in folder.iterdir())
    if MARKER in names:
        owner = marker.read_text(encoding="utf-8").strip()
        if owner != command:
            advice = "name another folder, or remove this one"
            raise OutputError(f"cannot write to {folder}: it is of `{owner}`: {advice}")
    elif names:
        others = ", ".join(names[:_NAMED])
        if len(names) > _NAMED:
            others += f" and {len(names) - _NAMED} more"
        raise OutputError(
            f"cannot write to {folder}: `{command}` did not write what is there ({others}): "
            "name a new or an empty folder"
        )
    else:
        files.write(marker, f"{command}\n")


@contextmanager
def replaced(folder: pathlib.Path) -> Generator[pathlib.Path]:
    """Yield an empty folder for new results; after the block its files replace those in `folder`.

    After an error or an interruption the old results are as they were. The folder must be `owned`.

    Raises:
      OutputError: if the folder cannot be written to.
    """
    unfinished = folder / UNFINISHED
    with files.output_errors(folder, folder):
        if unfinished.exists():  # of a command that was killed
            shutil.rmtree(unfinished)
        unfinished.mkdir(mode=0o700)  # old results may be ones that others must not read
    try:
        yield unfinished
        with files.output_errors(folder, folder):
            for path in sorted(unfinished.iterdir()):
                files.replace(path, folder / path.name)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
