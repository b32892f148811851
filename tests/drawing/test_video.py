"""Videos are whole or not there, as long as they should be, and never all in memory."""

import gc
import os
import pathlib
import re
import subprocess
import sys
import weakref
from collections.abc import Iterator

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

from mjbeer import Trajectory, exact, frozen
from mjbeer.drawing import film, video
from mjbeer.drawing.film import reel
from mjbeer.exceptions import OutputError, ParameterError, RenderingError

# The pipe to an ffmpeg that failed is left open by mediapy until its object goes.
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")]

SIZE = {"width": 320, "height": 180}


def motion(duration: float = 0.5) -> Trajectory:
    return exact(frozen(), np.linspace(0, duration, 51), 1.0)


def decode(path: pathlib.Path) -> tuple[str, np.ndarray]:
    """What ffmpeg says about a video, and its frames."""
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(command, capture_output=True, check=True)
    return done.stderr.decode(), np.frombuffer(done.stdout, np.uint8).reshape(-1, 180, 320, 3)


def blank(alive: list[int], frames: int = 40, error: BaseException | None = None) -> Iterator[np.ndarray]:
    """Frames that nothing has drawn; `alive` gets how many of them exist when each is asked for."""
    made: list[weakref.ref] = []
    for _ in range(frames):
        alive.append(sum(each() is not None for each in made))
        frame = np.full((SIZE["height"], SIZE["width"], 3), 200, np.uint8)
        made.append(weakref.ref(frame))
        yield frame
        del frame
    if error is not None:
        raise error


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Let videos have blank frames, which take no time."""
    alive: list[int] = []
    monkeypatch.setattr(film, "draw", lambda trajectory, look, speed, times, *_: blank(alive, len(times)))
    return alive


@pytest.fixture
def ffmpeg(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch):
    """Put a script in the place of ffmpeg."""

    def put(text: str) -> None:
        program = tmp_path_factory.mktemp("bin") / "ffmpeg"
        program.write_text(text)
        program.chmod(0o755)
        monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(program))

    return put


@pytest.mark.draws
def test_a_video_is_h264_of_the_size_and_length_asked_for(tmp_path: pathlib.Path) -> None:
    moved = motion()
    video.render(moved, tmp_path / "can.mp4", fps=20, progress=False, **SIZE)
    assert os.listdir(tmp_path) == ["can.mp4"]
    about, frames = decode(tmp_path / "can.mp4")
    assert re.search(r"Input #0.*mp4.*Video: h264 .*yuv420p.*bt709.* 320x180.* 20 fps", about, re.DOTALL)
    assert frames.shape == (10, 180, 320, 3)
    # The last frame is that of its time, but for what H.264 leaves out.
    off = [np.abs(frames[-1] - video.frame(moved, frame / 20, **SIZE).astype(float)).mean() for frame in (9, 8, 0)]
    assert 1.5 * off[0] < min(off[1:])


@pytest.mark.parametrize(
    ("speed", "fps", "expected"), [(1, 20, 10), (0.5, 20, 20), (2, 20, 5), (1, 40, 20), (100, 20, 1)]
)
def test_speed_stretches_time(
    speed: float, fps: float, expected: int, undrawn: list[int], tmp_path: pathlib.Path
) -> None:
    moved = motion()
    times = reel(moved, speed=speed).times(fps)
    assert len(times) == expected
    assert times[0] == 0
    assert np.allclose(np.diff(times), speed / fps)
    assert times[-1] < moved.time[-1]
    video.render(moved, tmp_path / "can.mp4", speed=speed, fps=fps, progress=False, **SIZE)
    assert len(decode(tmp_path / "can.mp4")[1]) == expected


def test_a_trajectory_that_starts_late_is_shown_from_there() -> None:
    moved = exact(frozen(), np.linspace(1, 2, 11), 1.0)
    assert reel(moved).times(10) == pytest.approx(np.linspace(1, 1.9, 10))


def test_frames_are_never_all_held(undrawn: list[int], tmp_path: pathlib.Path) -> None:
    video.render(motion(2.0), tmp_path / "can.mp4", fps=30, progress=False, **SIZE)
    assert len(undrawn) == 60
    assert max(undrawn) <= 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"path": "can.avi"}, "must end in .mp4, got 'can.avi'"),
        ({"width": 321}, "width must be even, as H.264 wants it, got 321"),
        ({"height": 99.5}, r"height must be a whole number of pixels up to 4096, got 99\.5"),
        ({"width": 1e5}, "width must be a whole number of pixels up to 4096, got 100000.0"),
        ({"fps": 0}, r"fps must be greater than 0 \[1/s\], got 0"),
        ({"speed": 0}, "speed must be greater than 0, got 0"),
        ({"camera": "top"}, "camera must be one of 'auto', 'fixed', 'pan', 'close'; got 'top'"),
    ],
)
def test_bad_input_says_what_is_allowed(
    arguments: dict, message: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ParameterError, match=message):
        video.render(motion(), **{"path": "can.mp4", "progress": False, **SIZE, **arguments})
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("#!/bin/sh\necho out of tune >&2\nexit 3\n", "out of tune"),
        ("#!/bin/sh\ncat > /dev/null\n", "it ended before the video did"),
        (f"#!{sys.executable}\nimport os, sys\nos.kill(os.getpid(), 2)\nsys.exit('out of tune')", "out of tune"),
        ("#!/bin/sh\nhead -c 500000 > /dev/null\nkill -SEGV $$\n", "it ended before the video did"),
        ("no program", "Exec format error"),
    ],
)
def test_a_broken_ffmpeg_leaves_nothing_and_says_why(
    script: str, reason: str, undrawn: list[int], ffmpeg, tmp_path: pathlib.Path
) -> None:
    ffmpeg(script)
    with pytest.raises(RenderingError, match=reason) as caught:
        video.render(motion(), tmp_path / "can.mp4", progress=False, **SIZE)
    assert "pip install --force-reinstall imageio-ffmpeg" in str(caught.value)
    assert os.listdir(tmp_path) == []
    del caught
    gc.collect()  # no pipe is left to it, of which pytest would hear


def test_what_ffmpeg_says_is_told_even_if_it_is_gone_at_the_end(ffmpeg, tmp_path: pathlib.Path) -> None:
    """So little is written that it waits in a buffer, and the pipe is found broken only when all is closed."""
    os.mkfifo(tmp_path / "pipe")
    ffmpeg(f"#!/bin/sh\nexec 9> {tmp_path / 'pipe'}\necho out of tune >&2\nexit 3\n")

    def frames() -> Iterator[np.ndarray]:
        yield np.zeros((16, 16, 3), np.uint8)
        (tmp_path / "pipe").read_bytes()  # which ends when ffmpeg does

    with pytest.raises(RenderingError, match="out of tune"):
        video.encode(frames(), tmp_path / "can.mp4", 16, 16, 10)
    gc.collect()


@pytest.mark.parametrize("reason", ["No space left on device", "Input/output error"])
def test_what_the_disk_says_is_not_ffmpeg_s_fault(
    reason: str, undrawn: list[int], ffmpeg, tmp_path: pathlib.Path
) -> None:
    ffmpeg(f"#!/bin/sh\ncat > /dev/null\necho 'Error writing trailer: {reason}' >&2\nexit 1\n")
    with pytest.raises(OutputError) as caught:
        video.render(motion(), tmp_path / "can.mp4", progress=False, **SIZE)
    assert str(caught.value) == f"cannot write {tmp_path / 'can.mp4'}: {reason}"
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("error", [KeyboardInterrupt(), RuntimeError("no more"), MemoryError()])
def test_an_interrupted_video_leaves_what_was_there(
    error: BaseException, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(film, "draw", lambda *_, **__: blank([], 5, error))
    (tmp_path / "can.mp4").write_text("an older video")
    with pytest.raises(type(error)):
        video.render(motion(), tmp_path / "can.mp4", progress=False, **SIZE)
    assert os.listdir(tmp_path) == ["can.mp4"]
    assert (tmp_path / "can.mp4").read_text() == "an older video"


def test_a_frame_outside_of_the_trajectory_is_an_error() -> None:
    with pytest.raises(ParameterError, match=r"time must be within the trajectory, 0 to 0\.5 s, got 0\.6"):
        video.frame(motion(), 0.6)


@pytest.mark.draws
def test_an_animation_has_all_pictures_and_runs_forever(tmp_path: pathlib.Path) -> None:
    video.write_webp(reel(motion()), tmp_path / "can.webp", 160, 90, 10)
    with Image.open(tmp_path / "can.webp") as image:
        assert (getattr(image, "n_frames", 1), image.info["loop"], image.size) == (5, 0, (160, 90))
        image.seek(3)
        shown = np.asarray(image.convert("RGB")).astype(int)
        assert image.info["duration"] == 100
    drawn = list(reel(motion()).draw(np.arange(5) / 10, 160, 90))
    off = [np.abs(shown - picture).mean() for picture in drawn]
    assert np.argmin(off) == 3
