"""The compiled record of smooth runs is the one that `RecordMaker` makes."""

import math
from dataclasses import fields

import numpy as np
import pytest

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.model.joints import to_coordinates
from mjbeer.model.setting import Setting
from mjbeer.simulation.methods import fixed_method, model_numbers
from mjbeer.simulation.recorder import Recorder
from mjbeer.simulation.smooth_recorder import SmoothRecorder
from mjbeer.simulation.stepped_model import SteppedModel
from tests.support.scenes import METAL

DRIFTS = ("energy_change", "swing_drift", "axis_drift")
"""Differences that are rounding themselves, of all the energy that swings to and fro."""


@pytest.mark.parametrize("friction", [math.inf, 1e-3])
@pytest.mark.parametrize(
    "scene", [sliding(0.3, can=METAL), frozen(0.1), frozen(-0.3, can=METAL), pendulum()]
)
def test_the_compiled_record_is_the_same(scene: Scene, friction: float) -> None:
    """In pieces, to rounding. The other recorder looks for forces at more points in each step."""
    setting = Setting(integrator="GaussJackson", timestep=1e-3)
    stepped = SteppedModel(model_numbers(scene, setting))
    compiled = SmoothRecorder(stepped.model, scene, friction)
    plain = Recorder(stepped.model, scene, friction, look_within_steps=True)
    times = np.arange(0, 1.5, 1e-3)
    states = fixed_method(stepped, setting).run(stepped.initial_state(2.5, 3.0), times)
    for piece in np.array_split(np.arange(len(times)), 3):
        compiled(times[piece], states[piece])
        plain(times[piece], states[piece])
    ours = compiled.record
    theirs = plain.record
    phi = to_coordinates(stepped.model, scene, states, times).phi
    size = theirs.kinetic_energy * np.abs(np.diff(phi)).sum()
    for field in fields(theirs):
        mine = getattr(ours, field.name)
        expected = getattr(theirs, field.name)
        if field.name in ("scene", "friction"):
            assert mine == expected
        elif field.name in DRIFTS:
            assert mine == pytest.approx(expected, abs=1e-14 * size)
        elif field.name == "rolling_ends_at":  # between two looks. Measured: 5e-7 s
            assert mine == pytest.approx(expected, abs=1e-5)
        elif field.name in ("lowest_normal", "needed_friction"):  # measured: 3e-4
            assert mine == pytest.approx(expected, rel=1e-3)
        else:
            assert mine == pytest.approx(expected, rel=1e-11), field.name
    assert ours.rolling_ends_at < 1.5 or math.isinf(friction)


def test_a_start_that_cannot_roll_is_its_end() -> None:
    """At the start the load turns so fast that the can is lifted: N < 0."""
    scene = frozen(can=METAL)
    setting = Setting(integrator="GaussJackson", timestep=1e-3)
    stepped = SteppedModel(model_numbers(scene, setting))
    recorder = SmoothRecorder(stepped.model, scene)
    start = stepped.initial_state(math.pi, 60.0)
    fixed_method(stepped, setting).run(start, np.array([0.0, 0.1]), recorder)
    assert recorder.record.rolling_ends_at == 0
    assert recorder.record.lowest_normal < 0
    assert recorder.record.needed_friction == math.inf
