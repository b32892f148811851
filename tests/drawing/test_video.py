"""Videos are whole or not there, and as long as they should be."""

import base64
import os
import pathlib
import re
import signal
import subprocess
from collections.abc import Iterator
from functools import partial
from typing import Any, NoReturn

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

WIDTH = 320
HEIGHT = 180
motion = partial(exact, frozen(), np.linspace(0, 0.5, 51), 1.0)
FILM = MotionFilm(motion, speed=1.0, still=0.2)


def render(path: str | os.PathLike[str] | None, **others: Any) -> None:
    """Render the motion in a small size and without a progress bar, unless told otherwise."""
    arguments = {"width": WIDTH, "height": HEIGHT, "progress": False} | others
    video.render(motion(), path, **arguments)


def decode(path: pathlib.Path) -> tuple[str, np.ndarray]:
    """Return what ffmpeg says about a video, and its frames."""
    ffmpeg = imageio_ffmpeg.get_ffmpeg_exe()
    command = [ffmpeg, "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(command, capture_output=True, check=True)
    frames = np.frombuffer(done.stdout, np.uint8).reshape(-1, HEIGHT, WIDTH, 3)
    return done.stderr.decode(), frames


def blank_pictures(count: int, error: BaseException | None = None) -> Iterator[np.ndarray]:
    """Yield pictures that nothing has drawn, and then raise an error if there is one."""
    for _ in range(count):
        yield np.full((HEIGHT, WIDTH, 3), 200, np.uint8)
    if error is not None:
        raise error


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let films have blank pictures, which take no time."""

    def pictures(
        _motion: Any, _style: Any, _speed: float, times: np.ndarray, *_size: int
    ) -> Iterator[np.ndarray]:
        return blank_pictures(len(times))

    monkeypatch.setattr(film, "_pictures", pictures)


def program(folder: pathlib.Path, script: str) -> pathlib.Path:
    """Write a shell script that stands for ffmpeg into a folder, and return its path."""
    path = folder / "ffmpeg"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


@pytest.mark.draws
def test_a_video_is_h264_of_the_size_and_length_asked_for(tmp_path: pathlib.Path) -> None:
    render(tmp_path / "can.mp4", fps=20)

    assert os.listdir(tmp_path) == ["can.mp4"]
    about, frames = decode(tmp_path / "can.mp4")
    format_line = r"Input #0.*mp4.*Video: h264 .*yuv420p.*bt709.* 320x180.* 20 fps"
    assert re.search(format_line, about, re.DOTALL)
    assert len(frames) == 10


@pytest.mark.draws
def test_the_last_frame_of_a_video_is_the_picture_of_its_time(tmp_path: pathlib.Path) -> None:
    """It is nearer to that than to the picture before it; H.264 leaves a little out."""
    render(tmp_path / "can.mp4", fps=20)

    _, frames = decode(tmp_path / "can.mp4")
    pictures = FILM.plan().draw(np.array([8, 9]) / 20, WIDTH, HEIGHT)
    before, last = (np.abs(frames[-1] - picture.astype(float)).mean() for picture in pictures)
    assert 1.5 * last < before


@pytest.mark.draws
def test_without_a_path_a_video_is_shown_in_a_notebook(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = []
    monkeypatch.setattr("IPython.display.display", shown.append)

    motion().video(width=WIDTH, height=HEIGHT, fps=20, progress=False)

    (cell,) = shown
    assert f'width="{WIDTH}" height="{HEIGHT}"' in cell.data
    assert "autoplay" not in cell.data
    (data,) = re.findall('base64,(.*?)"', cell.data)
    copy = tmp_path / "shown.mp4"
    copy.write_bytes(base64.b64decode(data))
    assert imageio_ffmpeg.count_frames_and_secs(copy) == (10, 0.5)


@pytest.mark.draws
def test_with_a_path_a_video_is_written_and_not_shown(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = []
    monkeypatch.setattr("IPython.display.display", shown.append)

    motion().video(tmp_path / "run.mp4", WIDTH, HEIGHT, progress=False)

    assert (tmp_path / "run.mp4").read_bytes()[4:8] == b"ftyp"
    assert not shown


@pytest.mark.parametrize(("speed", "fps", "frames"), [(1, 20, 10), (0.5, 20, 20), (100, 20, 1)])
@pytest.mark.usefixtures("undrawn")
def test_speed_stretches_time(
    speed: float, fps: float, frames: int, tmp_path: pathlib.Path
) -> None:
    times = MotionFilm(motion, speed=speed).plan().times(fps)
    render(tmp_path / "can.mp4", speed=speed, fps=fps)

    assert times == pytest.approx(speed / fps * np.arange(frames))
    assert len(decode(tmp_path / "can.mp4")[1]) == frames


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
    arguments: dict[str, Any],
    message: str,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)

    with pytest.raises(ParameterError, match=message):
        render(**{"path": "can.mp4"} | arguments)

    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("script", "kind", "reason"),
    [
        ("echo out of tune >&2; exit 3", RenderingError, "out of tune\nReinstall it"),
        (
            "cat > /dev/null; echo 'Error: No space left on device' >&2; exit 1",
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
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(program(tmp_path, script)))

    with pytest.raises(kind, match=reason):
        render(tmp_path / "can.mp4")

    assert os.listdir(tmp_path) == ["ffmpeg"]


@pytest.mark.parametrize("frames", [0, 5])  # before the first picture, of which ffmpeg complains
@pytest.mark.parametrize("error", [KeyboardInterrupt(), RenderingError("no more"), MemoryError()])
def test_an_interrupted_video_leaves_what_was_there(
    error: BaseException, frames: int, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "can.mp4").write_text("an older video")
    monkeypatch.setattr(film, "_pictures", lambda *_: blank_pictures(frames, error))

    with pytest.raises(type(error)) as caught:
        render(tmp_path / "can.mp4")

    assert caught.value is error
    assert os.listdir(tmp_path) == ["can.mp4"]
    assert (tmp_path / "can.mp4").read_text() == "an older video"


ENDLESS_VIDEO = """
import pathlib, sys
import numpy as np
from mjbeer.drawing import video
def pictures(*_):
    while True:
        print("writing", flush=True)
        yield np.zeros((720, 1280, 3), np.uint8)  # more than a pipe holds: its writing hangs
video._pictures = pictures
video.write(None, pathlib.Path(sys.argv[1]), 1280, 720, 30)
"""


def test_a_hanging_ffmpeg_ends_with_the_first_interruption(tmp_path: pathlib.Path) -> None:
    """It reads nothing, and ignores the signal itself; the streams end when it has ended, too."""
    hanging = program(tmp_path, "trap '' INT TERM\nexec sleep 3600")
    environment = os.environ | {"IMAGEIO_FFMPEG_EXE": str(hanging)}
    with start([str(tmp_path / "can.mp4")], ENDLESS_VIDEO, environment) as process:
        hear(process, "writing")

        status, error = interrupt(process, signal.SIGINT)

    assert status != 0
    assert error.count("Traceback") == 1
    assert error.strip().endswith("KeyboardInterrupt")
    assert os.listdir(tmp_path) == ["ffmpeg"]


@pytest.fixture
def film_jobs(tmp_path: pathlib.Path) -> list[Job]:
    """Return the jobs of two equal films, beside a hidden file of somebody else's."""
    (tmp_path / ".a-mine").write_text("mine")  # ffmpeg's unfinished files have such names
    films = [FilmJob(FILM, tmp_path / f"{name}.mp4", 160, 90, 10) for name in "ab"]
    return [Job(film_job.path.name, film_job.write) for film_job in films]


@pytest.mark.draws
@pytest.mark.costly
def test_films_are_made_in_other_processes(tmp_path: pathlib.Path, film_jobs: list[Job]) -> None:
    first, second = run_jobs(film_jobs, Console(quiet=True))

    assert sorted(os.listdir(tmp_path)) == [".a-mine", "a.mp4", "b.mp4"]
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    assert first == second
    assert first[8:12] == b"WEBP"


@pytest.mark.costly
def test_what_fails_in_another_process_is_told_once(
    tmp_path: pathlib.Path, film_jobs: list[Job], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Older files are kept. A process that is ended may leave an unfinished file of its own."""
    older = [tmp_path / ".a-mine", tmp_path / "a.mp4", tmp_path / "b.mp4"]
    for path in older:
        path.write_text("older")
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(tmp_path / "nowhere"))

    with pytest.raises(RenderingError, match="nowhere' is not found"):
        run_jobs(film_jobs, Console(quiet=True))

    assert [path.read_text() for path in older] == ["older"] * 3


@pytest.mark.parametrize(("named", "tried"), [("osmesa", "osmesa"), ("glfw", "egl")])
def test_opengl_that_does_not_start_says_what_installs_it(
    named: str, tried: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(name: str) -> NoReturn:
        raise ImportError(f"no {name}")

    monkeypatch.setattr(opengl, "context", opengl.context.__wrapped__)  # without its cache
    monkeypatch.setattr(opengl.importlib, "import_module", fail)
    monkeypatch.setenv("MUJOCO_GL", named)

    problem = str(opengl.problem())

    assert problem.startswith(f"no off-screen OpenGL ({tried}): no mujoco.{tried}")
    assert "apt-get install -y libegl1" in problem


def test_what_draws_nothing_needs_no_opengl() -> None:
    """With this variable MuJoCo itself cannot be imported."""
    environment = os.environ | {"MUJOCO_GL": "banana"}

    status, out, err = run(["simulate", "frozen", "--duration", "0.01"], env=environment)

    assert (status, err) == (0, "")
    assert "phi at the end" in out
