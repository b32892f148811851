"""Virtual environments for other tools, in build/, which git ignores. They stay there."""

import pathlib
import shutil
import subprocess
import sys
from collections.abc import Sequence

from filelock import FileLock

CHECKOUT = pathlib.Path(__file__).parents[1]
_PIP_INSTALL = (
    "-m",
    "pip",
    "install",
    "--quiet",
    "--disable-pip-version-check",
    "--only-binary=:all:",
)


class AbsentError(Exception):
    """A tool cannot be had here."""


def python_with(folder: pathlib.Path, name: str, requirements: Sequence[str]) -> str:
    """Return the Python in a folder that has `requirements`, after installing them if need be.

    Raises:
      AbsentError: if pip cannot install them; the message has the tool's name and the reason.
    """
    program = folder / "bin" / "python"
    stamp = folder / "installed.txt"
    folder.parent.mkdir(parents=True, exist_ok=True)
    with FileLock(f"{folder}.lock"):  # several processes may run the tests
        if not stamp.exists() or stamp.read_text() != "\n".join(requirements):
            subprocess.run([sys.executable, "-m", "venv", "--clear", folder], check=True)
            words = [program, *_PIP_INSTALL, *requirements]
            ran = subprocess.run(words, capture_output=True, text=True, check=False)
            if ran.returncode:
                shutil.rmtree(folder)
                reason = ran.stderr.strip().splitlines()[-1]
                raise AbsentError(f"pip cannot install {name}: {reason}")
            stamp.write_text("\n".join(requirements))
    return str(program)
