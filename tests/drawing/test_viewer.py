"""MuJoCo's viewer on the templates and on scenes: the can is in the picture, and keys do what they are said to do."""

import math
import os
import pathlib
import subprocess
import sys
from collections.abc import Generator

import mujoco
import numpy as np
import pytest

from mjbeer import exact, frozen
from mjbeer.drawing import viewer
from mjbeer.drawing.viewer import Player, view
from mjbeer.exceptions import ParameterError, UnsupportedError
from mjbeer.model.build import compile_spec
from mjbeer.model.export import present
from mjbeer.model.setting import Setting, mjcf_folder
from tests.support import processes
from tests.support.scenes import METAL
from tests.support.screen import Screen, screen

pytestmark = pytest.mark.slow

TEMPLATES = ("sliding", "frozen", "pendulum", "hoop")
SCENE = frozen(can=METAL)
# The load of the hoop, the smallest, has 2000 pixels in a window of 853 x 533; an empty board has none.
SEEN = 300


def load(picture: np.ndarray) -> int:
    """Return how many pixels have the colour of beer or brass, with hardly any blue, or of ice, with little red."""
    red, green, blue = np.moveaxis(picture.astype(float), 2, 0)
    amber = (red > 100) & (green > 0.5 * red) & (blue < 0.3 * red)
    ice = (blue > 150) & (green > 0.8 * blue) & (red < 0.8 * blue)
    return int((amber | ice).sum())


def is_drawn(picture: np.ndarray) -> bool:
    """Return whether a window has a picture: the wall behind the can is nearly white."""
    return int((picture.min(axis=2) > 200).sum()) > 10_000


@pytest.fixture
def shown(tmp_path: pathlib.Path) -> Generator[Screen]:
    with screen(tmp_path) as each:
        yield each


@pytest.mark.costly
@pytest.mark.views
@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_shows_its_can_after_three_seconds(name: str, shown: Screen) -> None:
    """In MuJoCo's viewer as it comes, which runs the model at once."""
    command = [sys.executable, "-m", "mujoco.viewer", f"--mjcf={mjcf_folder() / name}.xml"]
    with subprocess.Popen(command, env=shown.environment) as process:
        try:
            shown.wait(is_drawn)
            assert load(shown.after(3.0)) > SEEN
        finally:
            process.terminate()


@pytest.mark.costly
@pytest.mark.views
@pytest.mark.parametrize("scene", ["sliding", "frozen --can metal", "pendulum", "hoop"])
def test_a_scene_is_viewed_paused_runs_and_starts_anew(scene: str, shown: Screen) -> None:
    """Without a change of the picture while it is paused, and with the same picture as at first when it starts anew.

    The can is still seen after three seconds of its motion, which are shown in one.
    """
    words = ["view", *scene.split(), "--phi0", "100", "--speed", "3"]
    with processes.start(words, env=shown.environment) as process:
        try:
            shown.wait(is_drawn)
            paused = shown.at_rest()
            shown.press("space")
            shown.wait(lambda picture: not np.array_equal(picture, paused))
            assert load(shown.after(1.0)) > SEEN
            shown.press("BackSpace")
            shown.wait(lambda picture: np.array_equal(picture, paused))
        finally:
            process.terminate()
        assert process.communicate() == ("", "mjbeer: interrupted; what was written is whole\n")
    assert process.returncode == 143


@pytest.mark.costly
@pytest.mark.views
def test_the_command_ends_with_its_window(shown: Screen) -> None:
    with processes.start(["view", "frozen"], env=shown.environment) as process:
        try:
            shown.wait(is_drawn)
            shown.press("ctrl+q")
            assert process.communicate() == ("", "")
        finally:
            process.kill()
    assert process.returncode == 0


def test_without_a_display_there_is_one_line_with_two_ways_on() -> None:
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    status, out, err = processes.run(["view", "frozen"], env=environment)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("mjbeer: no window can be opened: ")
    assert "`mjbeer render`" in err
    assert "`mjbeer export`" in err


def player(speed: float = 1.0, phi0: float = 2.0) -> Player:
    setting = Setting("equality")
    return Player(compile_spec(present(SCENE, setting, phi0, 0.0), setting.rigid), speed)


def test_a_player_moves_as_theory_says() -> None:
    """RK4 at 1 ms in 0.1 s, and a rigid equality: 1e-10 rad."""
    playing = player()
    playing.advance(1.0)
    assert playing.data.time == 0  # until the space bar is pressed
    playing.press(viewer._SPACE)
    for _ in range(10):
        playing.advance(0.01)
    time = playing.data.time
    assert time == pytest.approx(0.1, abs=2e-3)  # of a step that is begun, the rest is left for the next frame
    assert playing.data.joint("roll").qpos[0] == pytest.approx(exact(SCENE, [time], 2.0).phi[0], abs=1e-9)


@pytest.mark.parametrize("speed", [0.1, 1.0, 2.0])
def test_a_player_has_the_speed_that_was_asked_for(speed: float) -> None:
    playing = player(speed)
    playing.press(viewer._SPACE)
    for _ in range(40):
        playing.advance(0.005)
    assert playing.data.time == pytest.approx(speed * 0.2, abs=2e-3)


def test_a_player_starts_anew_where_the_viewer_resets_the_model() -> None:
    """MuJoCo resets to its own start, all coordinates zero; the motion's start is another one."""
    playing = player()
    playing.press(viewer._SPACE)
    playing.advance(0.01)
    mujoco.mj_resetData(playing.model, playing.data)
    playing.advance(0.01)
    assert playing.paused
    assert playing.data.time == 0
    assert playing.data.joint("roll").qpos[0] == 2.0
    assert playing.data.sensor("phi").data[0] == 2.0


def test_a_slow_machine_does_not_fall_behind_for_ever() -> None:
    """An hour that was slept through is not made up for."""
    playing = player()
    playing.press(viewer._SPACE)
    playing.advance(3600.0)
    behind = playing.data.time
    playing.advance(0.0)
    assert behind < 3600
    assert playing.data.time <= behind + 2 / 60


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"integrator": "DOP853"}, UnsupportedError, "DOP853 is mjbeer's integrator, not MuJoCo's; view with one of"),
        ({"integrator": "GaussJackson"}, UnsupportedError, "GaussJackson is mjbeer's integrator, not MuJoCo's; view"),
        ({"speed": 0.0}, ParameterError, "speed must be greater than 0, got 0.0"),
        ({"phi0": math.nan}, ParameterError, "phi0 must be a finite number"),
        ({"rolling": "gears"}, ParameterError, "rolling must be one of"),
    ],
)
def test_what_is_not_allowed_is_said_before_a_window_opens(
    arguments: dict[str, object], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        view(SCENE, **arguments)
