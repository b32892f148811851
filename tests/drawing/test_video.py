"""Videos are whole or not there, and as long as they should be."""

import os
import pathlib
import re
import signal
import subprocess
from collections.abc import Iterator
from functools import partial

import imageio_ffmpeg
import numpy as np
import pytest
from rich.console import Console

from mjbeer import exact, frozen
from mjbeer.drawing import film, opengl, video
from mjbeer.drawing.film import MotionFilm
from mjbeer.drawing.video import FilmJob
from mjbeer.exceptions import OutputError, ParameterError, RenderingError
from mjbeer.output.jobs import Job, run_jobs
from tests.support.processes import hear, interrupt, run, start

# The pipe to an ffmpeg that failed is left open by mediapy until its object goes.
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")]

SIZE = {"width": 320, "height": 180}
motion = partial(exact, frozen(), np.linspace(0, 0.5, 51), 1.0)
FILM = MotionFilm(motion, speed=1.0, still=0.2)


def decode(path: pathlib.Path) -> tuple[str, np.ndarray]:
    """What ffmpeg says about a video, and its frames."""
    command = [
        imageio_ffmpeg.get_ffmpeg_exe(),
        "-i",
        str(path),
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-",
    ]
    done = subprocess.run(command, capture_output=True, check=True)
    return done.stderr.decode(), np.frombuffer(done.stdout, np.uint8).reshape(-1, 180, 320, 3)


ENDLESS_VIDEO = """
import pathlib, sys
import numpy as np
from mjbeer.drawing import video
def pictures(*_):
    while True:
        print("writing", flush=True)
        yield np.zeros((720, 1280, 3), np.uint8)  # more than a pipe holds: its writing hangs
video._pictures = lambda *_: pictures()
video.write(None, pathlib.Path(sys.argv[1]), 1280, 720, 30)
"""


def blank(frames: int, error: BaseException | None = None) -> Iterator[np.ndarray]:
    """Frames that nothing has drawn."""
    yield from (np.full((SIZE["height"], SIZE["width"], 3), 200, np.uint8) for _ in range(frames))
    if error is not None:
        raise error


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let videos have blank frames, which take no time."""
    monkeypatch.setattr(
        film, "_pictures", lambda motion, style, speed, times, *_: blank(len(times))
    )


@pytest.mark.draws
def test_a_video_is_h264_of_the_size_and_length_asked_for(tmp_path: pathlib.Path) -> None:
    video.render(motion(), tmp_path / "can.mp4", fps=20, progress=False, **SIZE)
    assert os.listdir(tmp_path) == ["can.mp4"]
    about, frames = decode(tmp_path / "can.mp4")
    assert re.search(
        r"Input #0.*mp4.*Video: h264 .*yuv420p.*bt709.* 320x180.* 20 fps", about, re.DOTALL
    )
    assert frames.shape == (10, 180, 320, 3)
    # The last frame is that of its time, but for what H.264 leaves out.
    pictures = FILM.plan().draw(np.array([9, 8, 0]) / 20, 320, 180)
    differences = [np.abs(frames[-1] - picture.astype(float)).mean() for picture in pictures]
    assert 1.5 * differences[0] < min(differences[1:])


@pytest.mark.parametrize(("speed", "fps", "expected"), [(1, 20, 10), (0.5, 20, 20), (100, 20, 1)])
@pytest.mark.usefixtures("undrawn")
def test_speed_stretches_time(
    speed: float, fps: float, expected: int, tmp_path: pathlib.Path
) -> None:
    assert MotionFilm(motion, speed=speed).plan().times(fps) == pytest.approx(
        speed / fps * np.arange(expected)
    )
    video.render(motion(), tmp_path / "can.mp4", speed=speed, fps=fps, progress=False, **SIZE)
    assert len(decode(tmp_path / "can.mp4")[1]) == expected


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"path": "can.avi"}, "must end in .mp4, got 'can.avi'"),
        (
            {"width": 321},
            "width must be an even number of pixels up to 4096, as H.264 wants it, got 321",
        ),
        ({"height": 4098}, "height must be an even number of pixels up to 4096"),
        ({"fps": 0}, r"fps must be greater than 0 \[1/s\], got 0"),
        ({"speed": 0}, "speed must be greater than 0, got 0"),
        ({"camera": "top"}, "camera must be one of 'auto', 'fixed', 'pan'; got 'top'"),
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
    ("script", "kind", "reason"),
    [
        ("echo out of tune >&2\nexit 3\n", RenderingError, "out of tune\nReinstall it"),
        (
            "cat > /dev/null\necho 'Error: No space left on device' >&2\nexit 1\n",
            OutputError,
            "can.mp4: No space left",
        ),
    ],
)
@pytest.mark.usefixtures("undrawn")
def test_a_broken_ffmpeg_or_a_full_disk_leaves_nothing_and_says_why(
    script: str,
    kind: type[Exception],
    reason: str,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    program = tmp_path / "ffmpeg"
    program.write_text(f"#!/bin/sh\n{script}")
    program.chmod(0o755)
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(program))
    with pytest.raises(kind, match=reason):
        video.render(motion(), tmp_path / "can.mp4", progress=False, **SIZE)
    assert os.listdir(tmp_path) == ["ffmpeg"]


@pytest.mark.parametrize("error", [KeyboardInterrupt(), RenderingError("no more"), MemoryError()])
def test_an_interrupted_video_leaves_what_was_there(
    error: BaseException, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also before the first picture, of which ffmpeg complains."""
    (tmp_path / "can.mp4").write_text("an older video")
    for frames in (0, 5):
        monkeypatch.setattr(film, "_pictures", lambda *_, n=frames, **__: blank(n, error))
        with pytest.raises(type(error)) as caught:
            video.render(motion(), tmp_path / "can.mp4", progress=False, **SIZE)
        assert caught.value is error
    assert os.listdir(tmp_path) == ["can.mp4"]
    assert (tmp_path / "can.mp4").read_text() == "an older video"


@pytest.mark.slow
def test_a_hanging_ffmpeg_ends_with_the_first_interruption(tmp_path: pathlib.Path) -> None:
    """It reads nothing, and ignores the signal itself; the streams end when it has ended, too."""
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\ntrap '' INT TERM\nexec sleep 3600\n")
    program.chmod(0o755)
    environment = os.environ | {"IMAGEIO_FFMPEG_EXE": str(program)}
    with start([str(tmp_path / "can.mp4")], ENDLESS_VIDEO, environment) as process:
        hear(process, "writing")

        status, error = interrupt(process, signal.SIGINT)

    assert status != 0
    assert error.count("Traceback") == 1
    assert error.strip().endswith("KeyboardInterrupt")
    assert os.listdir(tmp_path) == ["ffmpeg"]


@pytest.mark.draws
@pytest.mark.costly
def test_films_are_made_in_other_processes_or_one_error_is_told(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A hidden file of somebody else's that has a like name stays.

    A process that is ended may leave one of its own.
    """
    (tmp_path / ".a-mine").write_text("mine")
    films = [FilmJob(FILM, tmp_path / f"{name}.mp4", 160, 90, 10) for name in "ab"]
    jobs = [Job(film.path.name, film.write) for film in films]
    stills = run_jobs(jobs, Console(quiet=True))
    assert sorted(os.listdir(tmp_path)) == [".a-mine", "a.mp4", "b.mp4"]
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    assert stills[0] == stills[1]
    assert stills[0][8:12] == b"WEBP"
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(tmp_path / "nowhere"))
    with pytest.raises(RenderingError, match="nowhere' is not found"):
        run_jobs(jobs, Console(quiet=True))
    assert {".a-mine", "a.mp4", "b.mp4"} <= {*os.listdir(tmp_path)}


def test_opengl_that_does_not_start_says_what_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(opengl, "context", opengl.context.__wrapped__)
    monkeypatch.setattr(
        opengl.importlib, "import_module", lambda name: exec(f"raise ImportError('no {name}')")
    )
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    assert str(opengl.problem()).startswith("no off-screen OpenGL (osmesa): no mujoco.osmesa")
    monkeypatch.setenv("MUJOCO_GL", "glfw")
    assert str(opengl.problem()).startswith("no off-screen OpenGL (egl): no mujoco.egl")
    assert "apt-get install -y libegl1" in str(opengl.problem())


def test_what_draws_nothing_needs_no_opengl() -> None:
    """MuJoCo itself cannot be imported with this."""
    status, out, err = run(
        ["simulate", "frozen", "--duration", "0.01"], env=os.environ | {"MUJOCO_GL": "banana"}
    )
    assert (status, err) == (0, "")
    assert "phi at the end" in out
