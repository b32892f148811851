"""The ffmpeg that mediapy runs: it never outlives this process, and why it failed is found out."""

import contextlib
import errno
import os
import signal
import subprocess
from collections.abc import Generator
from types import TracebackType
from typing import TYPE_CHECKING, Self

import numpy as np

from mjbeer.drawing.watchdog import Watchdog
from mjbeer.exceptions import RenderingError

if TYPE_CHECKING:
    import mediapy

_PATIENCE = 120
"""How long it may take for a frame, or to end [s]: a thousand times what it takes."""
_LAST_WORDS = 5
"""How long it may take to end once it no longer listens [s]."""
_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS)
"""What a disk may say that is not ffmpeg's fault."""


class Ffmpeg:
    """A context manager around mediapy's writer, which leaves neither a process nor a pipe.

    mediapy has the command line, but waits for its process for ever, and cannot end it.
    """

    def __init__(self, writer: "mediapy.VideoWriter") -> None:
        self._writer = writer
        self._watchdog = Watchdog(self.kill, _PATIENCE)

    @property
    def _process(self) -> subprocess.Popen[bytes] | None:
        return self._writer._popen

    def start(self) -> None:
        """Start it.

        Raises:
          RenderingError: if it cannot be started.
        """
        try:
            self._writer.__enter__()
        except (OSError, RuntimeError) as error:
            raise no_video(error) from error

    def write(self, frame: np.ndarray) -> None:
        """Hand over a frame.

        Raises:
          RenderingError: if it takes none.
          OSError: if the disk is full, or broken.
        """
        with self._judged():
            self._writer.add_image(frame)

    def end(self) -> None:
        """Have it end the video.

        Raises:
          RenderingError: if it fails.
          OSError: if the disk is full, or broken.
        """
        process = self._process
        assert process is not None
        assert process.stdin is not None
        with self._judged():
            process.stdin.close()
            if process.wait() != 0:
                raise OSError(f"it ended with exit status {process.returncode}")

    def kill(self) -> None:
        """End it at once; the video is lost."""
        if self._process is not None:
            self._process.kill()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if (process := self._process) is not None:
            for pipe in (process.stdin, process.stderr):
                if pipe is not None and not pipe.closed:
                    with contextlib.suppress(OSError):  # what it has not taken in is lost with it
                        os.set_blocking(pipe.fileno(), False)
                        pipe.close()
            process.wait()

    @contextlib.contextmanager
    def _judged(self) -> Generator[None]:
        try:
            with self._watchdog:
                yield
        except OSError as error:
            raise self._failure(error) from error

    def _failure(self, error: OSError) -> Exception:
        process = self._process
        assert process is not None
        assert process.stderr is not None
        try:
            process.wait(_LAST_WORDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        os.set_blocking(process.stderr.fileno(), False)  # a process that it started may hold the pipe open
        said = (process.stderr.read() or b"").decode(errors="replace").strip()
        if self._watchdog.lost:
            return no_video(f"it did not go on for {_PATIENCE} s. {said}")
        for code in _DISK:
            if os.strerror(code) in said or (code, process.returncode) == (errno.EFBIG, -signal.SIGXFSZ):
                return OSError(code, os.strerror(code))
        if process.returncode < 0:
            return no_video(f"it was ended by {signal.Signals(-process.returncode).name}. {said}")
        if process.returncode == 0:
            return no_video(f"it ended before the video did. {said}")
        return no_video(said or str(error))


def no_video(reason: Exception | str) -> RenderingError:
    """What to say, and to do, about an ffmpeg that does not work."""
    return RenderingError(
        f"ffmpeg did not write the video: {str(reason).strip()}\n"
        "Reinstall it with `pip install --force-reinstall imageio-ffmpeg`, or name one that works in the environment "
        "variable IMAGEIO_FFMPEG_EXE"
    )
