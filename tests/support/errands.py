"""What processes of a crew are given to do in tests: in a module that loads fast, as each of them loads it anew."""

import os
import signal
import socket
import time
from typing import Any


def where() -> dict[str, Any]:
    """Return in which process this is."""
    return {"process": os.getpid()}


def call_and_sleep(port: int) -> dict[str, Any]:
    """Call a port of this machine, and hold the line for longer than any test."""
    with socket.create_connection(("127.0.0.1", port)):
        time.sleep(3600)
    return {}


def fall() -> dict[str, Any]:
    """End the process as from outside."""
    os.kill(os.getpid(), signal.SIGKILL)
    return {}
