"""The compiled record of smooth runs is the one that `Record` makes, and what is compiled for them is theory's."""

import math

import numpy as np
import pytest

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.model.build import build
from mjbeer.model.state import start
from mjbeer.simulation.gauss_jackson import GaussJackson, _by_theory
from mjbeer.simulation.kernels import _NAMES, SmoothRecorder, see
from mjbeer.simulation.multistep import form, pace
from mjbeer.simulation.stepping import Recorder
from mjbeer.simulation.tolerance import _longest
from mjbeer.theory.equations import accelerations
from tests.support.scenes import METAL, SCENES


@pytest.mark.parametrize("friction", [math.inf, 1e-3])
@pytest.mark.parametrize("scene", [sliding(0.3, can=METAL), frozen(0.1), frozen(-0.3, can=METAL), pendulum()])
def test_the_compiled_record_is_the_same(scene: Scene, friction: float) -> None:
    """In pieces, to rounding; what is a drift is rounding itself, of energies of a size of 1."""
    model, recorders = build(scene), (SmoothRecorder(scene, friction), Recorder(build(scene), scene, friction))

    times = np.arange(0, 1.5, 1e-3)
    states = GaussJackson(model, scene).run(start(model, scene, 2.5, 3.0), times, 1e-3)
    for piece in np.array_split(np.arange(len(times)), 3):
        recorders[1](times[piece], states[piece])
    for time, state in zip(times, states, strict=True):
        see(*recorders[0].kernel, time, state)
    ours, theirs = (vars(recorder.record) for recorder in recorders)
    scale = theirs["_kinetic"] * theirs["path"]
    for name in _NAMES:
        assert ours[name] == pytest.approx(theirs[name], rel=1e-11, abs=1e-14 * scale if "_" in name else 0.0), name
    assert ours["fails_at"] < 1.5 or math.isinf(friction)


@pytest.mark.parametrize("precision", [0.0, 1e-9])
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_what_is_compiled_is_theory_s_acceleration_and_its_change(scene: Scene, precision: float) -> None:
    """In the method's own time, t' = sqrt(J / J(phi0)): phi'' = t'^2 phi_ddot + t'' phi_dot."""
    numbers, small = form(scene, 0.3, precision), 1e-5

    def truth(phi: float, rate: float) -> float:
        ours = phi + np.array([-small, 0.0, small])
        slower, fast, faster = (pace(numbers, each) for each in ours)
        # Central differences err by the square of `small`.
        bend = (faster - slower) / (2 * small)
        return fast**2 * accelerations(scene, phi, rate / fast, 0.0)[1] + bend * rate**2 / fast

    assert pace(numbers, 0.3) == pytest.approx(1.0, rel=1e-15)
    for phi, rate in ((0.7, 12.0), (-2.0, 3.0)):
        gain, change = _by_theory(numbers, math.sin(phi), math.cos(phi), rate, small, 10 * small)
        assert gain == pytest.approx(truth(phi, rate), rel=1e-9)
        beside = _by_theory(numbers, math.sin(phi + small), math.cos(phi + small), rate + 10 * small, 0.0, 0.0)[0]
        assert change == pytest.approx(beside - gain, rel=100 * small)


def test_what_does_not_move_may_be_looked_at_seldom() -> None:
    assert _longest(sliding(gravity=0.0), 1.0, 0.0, 1.0, 1e-9) == 1 / 8
