"""The compiled record of smooth runs is the one that `Record` makes."""

import math

import numpy as np
import pytest

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.integrators.dynamics import Dynamics
from mjbeer.integrators.gauss_jackson import GaussJackson, sundman_time
from mjbeer.model.build import build
from mjbeer.model.joints import initial_state
from mjbeer.simulation.fixed_step import Recorder
from mjbeer.simulation.smooth_recorder import _NAMES, SmoothRecorder
from tests.support.integrators import swing_law
from tests.support.scenes import METAL


@pytest.mark.parametrize("friction", [math.inf, 1e-3])
@pytest.mark.parametrize("scene", [sliding(0.3, can=METAL), frozen(0.1), frozen(-0.3, can=METAL), pendulum()])
def test_the_compiled_record_is_the_same(scene: Scene, friction: float) -> None:
    """In pieces, to rounding; what is a drift is rounding itself, of energies of a size of 1.

    Forces are looked for between the steps, too, which last a hundredth of a radian.
    """
    model, recorders = (
        build(scene),
        (SmoothRecorder(build(scene), scene, friction), Recorder(build(scene), scene, friction)),
    )

    times = np.arange(0, 1.5, 1e-3)
    law = swing_law(scene)
    method = GaussJackson(Dynamics(model), 1e-3, sundman_time(law, law.largest_inertia()))
    states = method.run(initial_state(model, scene, 2.5, 3.0), times)
    for piece in np.array_split(np.arange(len(times)), 3):
        for recorder in recorders:
            recorder(times[piece], states[piece])
    ours, theirs = (vars(recorder.record) for recorder in recorders)
    scale = theirs["_kinetic"] * theirs["angle_covered"]
    # `Record` interpolates the forces between two steps by a line, and ours phi by a cubic.
    assert ours["rolling_ends_at"] == pytest.approx(theirs.pop("rolling_ends_at"), abs=1e-5)
    for name in theirs.keys() & set(_NAMES):
        rounding = 1e-14 * scale if name.startswith("_") or name in ("axis_drift", "lowest_normal") else 0.0
        between = 1e-3 if name in ("lowest_normal", "needed_friction") else 1e-11
        assert ours[name] == pytest.approx(theirs[name], rel=between, abs=rounding), name
    assert ours["rolling_ends_at"] < 1.5 or math.isinf(friction)
