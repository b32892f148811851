"""The compiled record of smooth runs is the one that `Record` makes, and what is compiled for them is theory's."""

import math

import numpy as np
import pytest
from scipy.special import ellipk

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.model.build import build
from mjbeer.model.state import start
from mjbeer.simulation import timestep
from mjbeer.simulation.gauss_jackson import GaussJackson, _correct
from mjbeer.simulation.recording import _NAMES, Recorder, SmoothRecorder
from mjbeer.theory.equations import accelerations
from tests.support.scenes import METAL, SCENES


@pytest.mark.parametrize("friction", [math.inf, 1e-3])
@pytest.mark.parametrize("scene", [sliding(0.3, can=METAL), frozen(0.1), frozen(-0.3, can=METAL), pendulum()])
def test_the_compiled_record_is_the_same(scene: Scene, friction: float) -> None:
    """In pieces, to rounding; what is a drift is rounding itself, of energies of a size of 1."""
    model, recorders = build(scene), (SmoothRecorder(scene, friction), Recorder(build(scene), scene, friction))

    def watch(times: np.ndarray, states: np.ndarray) -> None:
        for recorder in recorders:
            for piece in np.array_split(np.arange(len(times)), 3):
                recorder(times[piece], states[piece])

    GaussJackson(model, scene).run(start(model, scene, 2.5, 3.0), np.array([1.5]), 1e-3, watch)
    ours, theirs = (vars(recorder.record) for recorder in recorders)
    scale = theirs["_kinetic"] * theirs["path"]
    for name in _NAMES:
        assert ours[name] == pytest.approx(theirs[name], rel=1e-11, abs=1e-14 * scale if "_" in name else 0.0), name
    assert ours["fails_at"] < 1.5 or math.isinf(friction)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_correction_is_what_theory_s_accelerations_change_by(scene: Scene) -> None:
    """To the second order of the change of the state."""
    small, size = 1e-5, build(scene).nv
    form = GaussJackson(build(scene), scene)._form
    for phi, rate in ((0.7, 12.0), (-2.0, 3.0)):
        before, after = (
            np.array(accelerations(scene, phi + step, rate + 10 * step, 0.0))[-size:] for step in (0.0, small)
        )
        state, moved = np.zeros(2 * size), np.zeros(2 * size)
        state[[size - 1, -1]], moved[[size - 1, -1]] = (phi, rate), (small, 10 * small)
        history = before[:, None].copy()
        _correct((*form, 0.0), state, moved, np.concatenate([np.zeros(size), before]), history, 0)
        assert history[:, 0] - before == pytest.approx(after - before, rel=100 * small)


@pytest.mark.parametrize("phi0", [0.3, 1.0, 2.5])
def test_the_nearest_singularity_of_a_pendulum_is_that_of_its_elliptic_function(phi0: float) -> None:
    """A wheel that is too heavy to move leaves phi = 2 asin(k sn(omega t)), with a pole at K(1 - k^2)/omega. The way
    there ends at 5i rad, from where on it takes 0.16/omega, and less if the swing is large."""
    scene = pendulum(0.0, wheel_mass=1e4, load_mass=0.1)
    form = scene.oscillator
    numbers = form.base, form.chord, form.swing, form.slope, form.depth, form.bottom
    distance, rate, *_ = timestep._shape(numbers, phi0, 0.0, 1.0)
    assert distance * rate == pytest.approx(ellipk(1 - math.sin(phi0 / 2) ** 2), abs=0.17)


def test_a_brief_passage_is_left_to_long_steps_elsewhere() -> None:
    assert timestep.longest(pendulum(0.1, wheel_mass=1e-2), 1.0, 0.0, 1.0, 1e-9) > 1e-4
    assert timestep.longest(pendulum(0.1, wheel_mass=1e-6), 1.0, 0.0, 1.0, 1e-9) == 0


def test_what_does_not_move_may_be_looked_at_seldom() -> None:
    assert timestep.longest(sliding(gravity=0.0), 1.0, 0.0, 1.0, 1e-9) == 1 / 8
