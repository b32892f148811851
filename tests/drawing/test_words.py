"""What a user sees of a run: plots, a video, and one line."""

import base64
import math
import pathlib
import re

import imageio_ffmpeg
import numpy as np
import pytest
from matplotlib import pyplot as plt

from mjbeer import Can, Damping, exact, frozen, liquid, pendulum, simulate, sliding
from mjbeer.drawing.words import damping_in_words, in_words
from mjbeer.exceptions import ParameterError


def test_a_plot_shows_the_motion_over_theory() -> None:
    run = simulate(frozen(), 1.0, 1.0)
    above, below = run.plot(theory=True)
    theory, simulated = above.get_lines()
    assert np.array_equal(simulated.get_ydata(), np.degrees(run.phi))
    assert np.array_equal(
        theory.get_ydata(), np.degrees(exact(run.scene, theory.get_xdata(), 1.0).phi)
    )
    assert np.array_equal(below.get_lines()[1].get_ydata(), run.u)
    assert (above.get_ylabel(), below.get_ylabel(), below.get_xlabel()) == (
        "φ [°]",
        "u [m]",
        "time [s]",
    )
    assert [text.get_text() for text in above.get_legend().get_texts()] == [
        "exact theory",
        "MuJoCo",
    ]
    plt.close(above.figure)


def test_what_cannot_happen_is_dotted() -> None:
    """From the top, rolling is possible until N = 0, after 0.834 s.

    A can in contact leaves the incline by itself.
    """
    above, below = exact(frozen(), np.linspace(0, 1, 1001), math.pi).plot()
    for axes in (above, below):
        rolls, pulled = axes.get_lines()
        assert rolls.get_xdata()[-1] < 0.8339 < pulled.get_xdata()[0] < 0.836
        assert (rolls.get_linestyle(), pulled.get_linestyle()) == ("-", ":")
    assert len(above.get_legend().get_texts()) == 2
    plt.close(above.figure)
    above, _ = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=1e-3).plot()
    assert len(above.get_lines()) == 1
    assert above.figure.get_suptitle() == "half-full massless can, beer frozen, incline 10°"
    plt.close(above.figure)


def test_a_plot_shows_what_is_asked_for() -> None:
    run = simulate(frozen(), 0.2, 1.0)
    rate, energy = run.plot("phi_dot", "energy", theory=True)
    assert np.array_equal(rate.get_lines()[1].get_ydata(), np.degrees(run.phi_dot))
    assert np.array_equal(energy.get_lines()[1].get_ydata(), run.energy)
    plt.close("all")
    for name in ("ph", True):
        with pytest.raises(
            ParameterError, match=r"quantity must be one of 'phi', 'u', .*'energy'; got "
        ):
            run.plot(name)


@pytest.mark.draws
@pytest.mark.slow
def test_a_video_is_written_or_shown(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = simulate(frozen(), 0.2, 1.0)
    shown = []
    monkeypatch.setattr("IPython.display.display", shown.append)
    run.video(tmp_path / "run.mp4", 320, 180, progress=False)
    assert (tmp_path / "run.mp4").read_bytes()[4:8] == b"ftyp"
    assert not shown
    run.video(width=320, height=180, fps=20, progress=False)
    (cell,) = shown
    assert 'width="320" height="180"' in cell.data
    assert "autoplay" not in cell.data
    (data,) = re.findall('base64,(.*?)"', cell.data)
    (tmp_path / "shown.mp4").write_bytes(base64.b64decode(data))
    assert imageio_ffmpeg.count_frames_and_secs(tmp_path / "shown.mp4") == (4, 0.2)


def test_a_run_is_one_line_and_does_not_run_again(monkeypatch: pytest.MonkeyPatch) -> None:
    run = simulate(frozen(), 0.5, 1.0, rolling="contact")
    monkeypatch.setattr(
        "mjbeer.simulation.second_run.compare_uneven", lambda _: pytest.fail("a second run")
    )
    assert repr(run) == (
        "<Run frozen, contact, RK4: 501 samples to t = 0.5 s, "
        f"phi = {run.phi[-1]:.6g} rad, u = {run.u[-1]:.6g} m>"
    )


def test_a_scene_in_words() -> None:
    assert in_words(frozen()) == "half-full massless can, beer frozen, incline 10°"
    can = Can.sheet_metal()
    water = liquid("water", math.radians(2), 0.75, can)
    assert in_words(water) == "three-quarters-full can of 8.57 g, water, incline 2°"
    assert in_words(pendulum(0.0)) == "wheel with a pendulum, M = 200 g, m = 100 g, level ground"
    assert (
        damping_in_words(sliding(damping=Damping(1e-5, 0.0, 2e-8)))
        == "1e-05 N m s + 2e-08 N m s^3 w^2"
    )
