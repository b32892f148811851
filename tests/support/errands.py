"""What processes of a crew are given to do in tests: in a module that loads fast, as each of them loads it anew."""

import os
import pathlib
import signal
import time
from typing import Any


def where() -> dict[str, Any]:
    """Return in which process this is."""
    return {"process": os.getpid()}


def mark_and_sleep(path: pathlib.Path) -> dict[str, Any]:
    """Write down in which process this is, and last longer than any test."""
    path.write_text(str(os.getpid()))
    time.sleep(60)
    return {}


def fall() -> dict[str, Any]:
    """End the process as from outside."""
    os.kill(os.getpid(), signal.SIGKILL)
    return {}
