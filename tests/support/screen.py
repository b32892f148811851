"""A screen without a monitor: Xvfb, whose picture is a file, and keys that xdotool presses."""

import contextlib
import os
import pathlib
import shutil
import struct
import subprocess
import time
from collections.abc import Callable, Generator

import numpy as np

INSTALL = "apt-get install -y xvfb xdotool libgl1 libgl1-mesa-dri"
_SIZE = 1280, 800
_PATIENCE = 600


def problem() -> str | None:
    """Return why there is no such screen here, or None if there is one."""
    lacking = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
    return f"no {' and no '.join(lacking)}; this brings it to Debian and Ubuntu: {INSTALL}" if lacking else None


class Screen:
    """A screen that a program shows its windows on if it has the `environment`."""

    def __init__(self, display: str, memory: pathlib.Path) -> None:
        self.environment = {name: value for name, value in os.environ.items() if name != "WAYLAND_DISPLAY"}
        self.environment["DISPLAY"] = display
        self._memory = memory

    def picture(self) -> np.ndarray:
        """Return what is on the screen, of shape (height, width, 3): red, green and blue."""
        content = self._memory.read_bytes()  # an X window dump: a header, colours, and four bytes a pixel
        header = struct.unpack(">25I", content[:100])
        start, width, height, line, colours = (header[i] for i in (0, 4, 5, 12, 19))
        rows = np.frombuffer(content, np.uint8, height * line, start + 12 * colours).reshape(height, line)
        return rows[:, : 4 * width].reshape(height, width, 4)[..., 2::-1]

    def press(self, key: str) -> None:
        """Press a key, by its name in X."""
        subprocess.run(["xdotool", "key", key], env=self.environment, check=True)

    def after(self, seconds: float) -> np.ndarray:
        """Return the picture after some time."""
        time.sleep(seconds)
        return self.picture()

    def at_rest(self) -> np.ndarray:
        """Return the first picture that stays the same for half a second."""
        end = time.monotonic() + _PATIENCE
        picture = self.picture()
        while not np.array_equal(later := self.after(0.5), picture):
            assert time.monotonic() < end
            picture = later
        return picture

    def wait(self, until: Callable[[np.ndarray], bool]) -> np.ndarray:
        """Return the first picture for which `until` is true."""
        end = time.monotonic() + _PATIENCE
        while not until(picture := self.picture()):
            assert time.monotonic() < end
            time.sleep(0.1)
        return picture


@contextlib.contextmanager
def screen(folder: pathlib.Path) -> Generator[Screen]:
    """Yield a screen, whose memory is a file in a folder."""
    size = "x".join(map(str, (*_SIZE, 24)))
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", size, "-fbdir", str(folder), "-noreset"]
    with subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL) as server:
        os.close(writing)
        try:
            with os.fdopen(reading) as told:
                number = told.readline().strip()
            yield Screen(f":{number}", folder / "Xvfb_screen0")
        finally:
            server.terminate()
