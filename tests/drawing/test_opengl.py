"""Which off-screen OpenGL is used, and what is said if there is none."""

import os
import pathlib
import re
import subprocess
import sys

import pytest

from mjbeer.drawing import opengl
from mjbeer.exceptions import RenderingError
from tests.support.processes import run

pytestmark = pytest.mark.slow

CHECKOUT = pathlib.Path(__file__).parents[2]
linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has a choice of backends")


@pytest.fixture(autouse=True)
def _forget(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    opengl.backend.cache_clear()
    yield
    opengl.backend.cache_clear()


@pytest.fixture
def crashing(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """An environment in which OpenGL crashes when it is loaded; the module that loads it stands for it."""
    folder = tmp_path_factory.mktemp("crashing")
    (folder / "OpenGL").mkdir()
    (folder / "OpenGL" / "__init__.py").write_text("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    path = os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])
    return os.environ | {"PYTHONPATH": path, "MUJOCO_GL": "egl"}


def _failing(monkeypatch: pytest.MonkeyPatch, *broken: str) -> list[str]:
    """Let some backends fail; the list of those that are tried."""
    tried = []

    def why_not(name: str) -> str | None:
        tried.append(name)
        return f"no {name} today" if name in broken else None

    monkeypatch.setattr(opengl, "_why_not", why_not)
    return tried


@pytest.mark.parametrize("asked", ["", "glfw"])
def test_egl_is_tried_first_and_then_osmesa(asked: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once: the answer is kept. A window system in MUJOCO_GL decides nothing."""
    monkeypatch.setenv("MUJOCO_GL", asked)
    tried = _failing(monkeypatch, "egl")
    assert opengl.backend() == opengl.backend() == "osmesa"
    assert tried == ["egl", "osmesa"]


def test_neither_works_names_both_reasons_and_the_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    _failing(monkeypatch, "egl", "osmesa")
    with pytest.raises(RenderingError) as caught:
        opengl.backend()
    message = str(caught.value)
    assert "egl: no egl today" in message
    assert "osmesa: no osmesa today" in message
    assert "apt-get install -y libegl1 libopengl0 libgl1-mesa-dri" in message
    assert "apt-get install -y libosmesa6" in message


@pytest.mark.parametrize("asked", ["osmesa", "EGL "])
def test_mujoco_gl_decides(asked: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", asked)
    name = asked.strip().lower()
    tried = _failing(monkeypatch, name)
    with pytest.raises(RenderingError, match=f"MUJOCO_GL={name} rules out others"):
        opengl.backend()
    assert tried == [name]


def test_a_crash_is_survived(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(opengl, "_PROBE", "import os; os.abort()  # {0}")
    assert opengl._why_not("egl") == "crashed with signal 6"


def test_a_hang_is_survived(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(opengl, "_PROBE", "import time; time.sleep(60)  # {0}")
    monkeypatch.setattr(opengl, "_PATIENCE", 0.2)
    assert opengl._why_not("egl") == "did not start within 0.2 s"


@pytest.mark.costly
@linux
@pytest.mark.parametrize(
    ("everything", "status", "said"),
    [
        ("", 0, r"SKIPPED \[1\] .*no OpenGL; this brings it to Debian and Ubuntu: apt-get update"),
        ("1", 4, r"ERROR: MJBEER_EVERYTHING is set, and not all is here:\n(.*\n)*no off-screen OpenGL"),
    ],
)
def test_tests_that_draw_are_skipped_or_end_the_tests(
    everything: str, status: int, said: str, crashing: dict[str, str]
) -> None:
    name = f"{__file__}::{test_context_is_drawn_with.__name__}"
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", name]
    # pytest imports MuJoCo itself, which loads what MUJOCO_GL names.
    environment = crashing | {"MUJOCO_GL": "disable", "MJBEER_EVERYTHING": everything}
    done = subprocess.run(command, cwd=CHECKOUT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == status, done.stdout
    assert re.search(said, done.stdout + done.stderr)


def test_import_loads_no_opengl_and_sets_no_environment() -> None:
    code = (
        "import os, sys; before = dict(os.environ); import mjbeer.drawing.opengl, mjbeer.drawing.video; "
        "assert dict(os.environ) == before; print(*{'OpenGL'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


@linux
@pytest.mark.parametrize("asked", ["banana", "osmesa"])
def test_what_draws_nothing_needs_no_opengl(asked: str) -> None:
    """MuJoCo itself cannot be imported with the first, nor with the second where there is none."""
    status, out, err = run(["simulate", "frozen", "--duration", "0.01"], env=os.environ | {"MUJOCO_GL": asked})
    assert (status, err) == (0, "")
    assert "phi at the end" in out


@pytest.mark.costly
@linux
def test_a_library_that_crashes_when_it_is_loaded(crashing: dict[str, str], tmp_path: pathlib.Path) -> None:
    """The video is not begun, and the message has the remedy."""
    film = tmp_path / "new" / "film.mp4"
    film.parent.mkdir()
    status, _, err = run(["render", "frozen", "--duration", "0.1", "--output", str(film)], env=crashing)
    assert status == 2
    assert err.startswith(
        "mjbeer: no off-screen OpenGL (MUJOCO_GL=egl rules out others):\n  egl: crashed with signal 11"
    )
    assert opengl.REMEDY in err
    assert not list(film.parent.glob("*"))


@pytest.mark.draws
def test_context_is_drawn_with() -> None:
    opengl.context().make_current()
    if sys.platform == "linux":
        assert os.environ["PYOPENGL_PLATFORM"] == opengl.backend()


RASTERIZERS = """
import pathlib
from mjbeer.drawing import opengl
opengl.context().make_current()
from OpenGL import GL
threads = [(task / "comm").read_text() for task in pathlib.Path("/proc/self/task").iterdir()]
print(sum(name.startswith("llvmpipe") for name in threads), GL.glGetString(GL.GL_RENDERER).decode())
"""


@pytest.mark.draws
@linux
def test_mesa_draws_in_the_thread_that_calls_it_unless_the_user_says_otherwise() -> None:
    def rasterizers(**said: str) -> tuple[int, str]:
        given = {name: value for name, value in os.environ.items() if name != "LP_NUM_THREADS"} | said
        done = subprocess.run(
            [sys.executable, "-c", RASTERIZERS], env=given, capture_output=True, text=True, check=True
        )
        count, renderer = done.stdout.split(maxsplit=1)
        return int(count), renderer

    count, renderer = rasterizers()
    assert count == 0
    if "llvmpipe" in renderer:  # on a graphics card there are none whatever is said
        assert rasterizers(LP_NUM_THREADS="2")[0] == 2
