"""The film of a standing can: its motion is that of linear theory, and its pictures show it."""

import pathlib

import imageio_ffmpeg
import numpy as np
import pytest

from mjbeer import Can, build, standing
from mjbeer.cli.app import main
from mjbeer.drawing.standing_film import StandingFilm, free_decay, slosh
from mjbeer.theory.standing import QUANTITATIVE, Standing


@pytest.mark.parametrize(
    "can",
    [standing("water", 0.3), standing(modes=3), standing(can=Can.sheet_metal(0.05, 0.3))],
    ids=repr,
)
def test_the_liquid_is_let_go_and_rings_as_theory_says(can: Standing) -> None:
    """Theory is linear, and the model's modes are pendulums.

    The period of a pendulum is longer by the 16th part of the square of its angle, here 0.12 rad.
    After half a second the phase lags by 9e-4 of some 12 rad, and the rise by 1.1e-3 R.
    """
    motion = slosh(can, build(can, free=False), 0.5)

    assert motion.rise[0] == pytest.approx(QUANTITATIVE, rel=1e-12)
    assert np.abs(motion.rise - free_decay(can, motion.time)).max() < 1.1e-3
    # The liquid swings to the other side, and is damped.
    assert motion.rise.min() < -0.9 * QUANTITATIVE
    assert motion.rise[1:].max() < QUANTITATIVE


@pytest.mark.draws
@pytest.mark.slow
def test_the_surface_is_seen_to_tilt() -> None:
    """Half a period later the liquid is as high at the other side.

    So the picture loses beer at the right of the axis, and gains it at the left.
    """
    can = standing("water")
    half_period = np.pi / can.frequencies()[0]
    plan = StandingFilm(can, half_period, speed=1.0).plan()

    first, last = plan.draw(np.array([0.0, half_period]), 640, 480)

    gained = beer_in_columns(last) - beer_in_columns(first)
    middle = 320
    assert gained[: middle - 8].sum() > 100
    assert gained[middle + 8 :].sum() < -100


def beer_in_columns(picture: np.ndarray) -> np.ndarray:
    """Return how many pixels of beer each column has between the title and the chart."""
    blue = picture[90:320, :, 2]
    return (blue < 120).sum(axis=0)  # beer is the only thing there with so little blue


@pytest.mark.draws
@pytest.mark.slow
def test_the_command_line_draws_a_standing_can(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "can.mp4"
    words = (
        "render standing --fill 0.3 --modes 0 --duration 0.2 --speed 0.5 --width 160 --height 120"
    )

    status = main([*words.split(), "--output", str(path)])

    assert status == 0
    frames, _ = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert frames == 12  # 0.2 s, slowed down twice, at 30 per second
    assert "nothing moves in this film, because the liquid is solid" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--camera pan", "--camera is not understood"),
        ("--tolerance 1e-6", "--tolerance is not understood"),
        ("--integrator DOP853", "integrator must be one of 'Euler'"),
        ("--output can.png", r"the file's name must end in .mp4"),
        ("--duration -1", "duration must be"),
        ("--width 161", "width must be an even number"),
    ],
)
def test_what_a_standing_can_does_not_have_is_refused(
    words: str, message: str, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["--output", str(tmp_path / "can.mp4"), *words.split()]

    status = main(["render", "standing", *given])

    assert status == 2
    assert message in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
