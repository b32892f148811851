"""Folders of results: each belongs to one command, which replaces them when new ones are whole."""

import pathlib
import shutil
from collections.abc import Generator
from contextlib import contextmanager

from mjbeer.exceptions import OutputError
from mjbeer.output import files

MARKER = ".mjbeer"
"""Name of the file that says which command a folder belongs to."""
UNFINISHED = ".unfinished"
"""Name of the folder within it for new results that are not yet complete."""
_NAMED = 3
"""Number of foreign files that an error names."""


@contextmanager
def owned(folder: pathlib.Path, command: str) -> Generator[None]:
    """Hold a folder of results for a command while the block runs; make it before, if needed.

    A new or an empty folder belongs to the command from then on. The system releases the lock when
    the process ends, even if it is killed; its hidden file may stay.

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
      OutputError: if the folder is not empty and does not belong to the command.
    """
    marker = folder / MARKER
    names = sorted(path.name for path in folder.iterdir())
    if MARKER in names:
        owner = marker.read_text(encoding="utf-8").strip()
        if owner != command:
            advice = "name another folder, or remove this one"
            raise OutputError(f"cannot write to {folder}: it belongs to `{owner}`: {advice}")
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

    After an error or an interruption the old results are unchanged. The folder must be `owned`.

    Raises:
      OutputError: if the folder cannot be written to.
    """
    unfinished = folder / UNFINISHED
    with files.output_errors(folder, folder):
        if unfinished.exists():  # a command was killed
            shutil.rmtree(unfinished)
        unfinished.mkdir(mode=0o700)  # others may not be allowed to read the results
    try:
        yield unfinished
        with files.output_errors(folder, folder):
            for path in sorted(unfinished.iterdir()):
                files.replace(path, folder / path.name)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
