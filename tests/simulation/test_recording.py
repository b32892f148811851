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
from mjbeer.theory.record import Record
from tests.support.scenes import METAL

DRIFTS = ("energy_change", "swing_drift", "axis_drift")
"""Differences that are rounding themselves, of all the energy that swings to and fro."""
BETWEEN_LOOKS = {
    "rolling_ends_at": {"abs": 1e-5},  # [s]; measured: 5e-7
    "lowest_normal": {"rel": 1e-3},  # measured: 3e-4
    "needed_friction": {"rel": 1e-3},
}
"""How far the two records may be apart in what happens between two looks at the forces."""
MEASURED = [field.name for field in fields(Record) if field.name not in ("scene", "friction")]


@pytest.mark.parametrize("friction", [math.inf, 1e-3])
@pytest.mark.parametrize(
    "scene", [sliding(0.3, can=METAL), frozen(0.1), frozen(-0.3, can=METAL), pendulum()]
)
def test_the_compiled_record_is_the_same(scene: Scene, friction: float) -> None:
    """In pieces, to rounding. The other recorder looks for forces at more points in each step."""
    times = np.arange(0, 1.5, 1e-3)
    setting = Setting(integrator="GaussJackson", timestep=1e-3)
    stepped = SteppedModel(model_numbers(scene, setting))
    compiled = SmoothRecorder(stepped.model, scene, friction)
    plain = Recorder(stepped.model, scene, friction, look_within_steps=True)
    states = fixed_method(stepped, setting).run(stepped.initial_state(2.5, 3.0), times)

    for piece in np.array_split(np.arange(len(times)), 3):
        compiled(times[piece], states[piece])
        plain(times[piece], states[piece])

    ours = compiled.record
    theirs = plain.record
    phi = to_coordinates(stepped.model, scene, states, times).phi
    size = theirs.kinetic_energy * np.abs(np.diff(phi)).sum()
    allowed = BETWEEN_LOOKS | {name: {"abs": 1e-14 * size} for name in DRIFTS}
    assert (ours.scene, ours.friction) == (theirs.scene, theirs.friction)
    for name in MEASURED:
        expected = getattr(theirs, name)
        apart = allowed.get(name, {"rel": 1e-11})
        assert getattr(ours, name) == pytest.approx(expected, **apart), name
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
