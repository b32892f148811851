"""The track that a scene would give is that of its exact motion, as a camera would see it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mjbeer import Can, Damping, Scene, Track, exact, frozen, liquid
from mjbeer.tracks.track_model import TrackModel, with_parameters
from tests.tracks.filmed import PLACE, RELEASED, filmed

pytestmark = pytest.mark.slow
METAL = Can.sheet_metal()
OIL = liquid("olive oil", math.radians(2), can=METAL)
ICE = frozen(math.radians(5), can=METAL)
BY_HAND = Scene(METAL, OIL.load, OIL.incline, "sliding", damping=Damping(1e-3, 1e-4, 1e-5))
VALUES = {"place": PLACE, "released": RELEASED}


@pytest.mark.parametrize("scene", [OIL, ICE, BY_HAND], ids=["oil", "ice", "made by hand"])
def test_without_a_lens_it_is_that_of_the_motion(scene: Scene) -> None:
    track = filmed(scene, noise=0.0)
    predicted = TrackModel(track, scene, "level").predict(VALUES)
    # A tolerance of 1e-5 rad and the spline's error together: below 1e-5 radii, 0.3 micrometres.
    assert predicted == pytest.approx(track.along[np.newaxis], abs=1e-6)


def test_parameters_and_the_start_may_be_among_the_values() -> None:
    changes = {"incline": 0.04, "fill": 0.4, "drag": 0.01}
    track = filmed(with_parameters(OIL, changes), phi0=0.3, noise=0.0)
    predicted = TrackModel(track, OIL, "level").predict(VALUES | changes | {"phi0": 0.3})
    assert predicted == pytest.approx(track.along[np.newaxis], abs=1e-6)


def test_damping_is_a_factor_on_the_law() -> None:
    """Its three torques are alike at 10 rad/s."""
    thick = replace(BY_HAND, damping=Damping(2e-3, 2e-4, 2e-5))
    track = filmed(thick, noise=0.0)
    predicted = TrackModel(track, BY_HAND, "level").predict(VALUES | {"damping": 2.0})
    assert predicted == pytest.approx(track.along[np.newaxis], abs=1e-6)


def test_a_lens_bends_it_in_the_middle_and_not_at_the_ends() -> None:
    """The scale stretches what the lens has not bent."""
    model = TrackModel(filmed(OIL, noise=0.0), OIL, "level")
    straight = model.predict(VALUES)[0]
    seen = model.predict(VALUES | {"bend": 0.01, "scale": 1.1})[0]
    share = (straight - straight.min()) / np.ptp(straight)
    bent = seen - 1.1 * straight
    bent_there = np.interp([0, 0.25, 0.5, 1], share, bent)
    # Between two points the parabola is less than 1e-5 m off its chord, as they are 1/30 apart.
    assert bent_there == pytest.approx([0, 0.0075, 0.01, 0], abs=3e-5)


def test_the_mark_turns_with_the_can_and_phi_is_the_loads() -> None:
    true = filmed(ICE, phi0=-1.0, noise=0.0)
    nothing = np.zeros(len(true.time))
    model = TrackModel(Track(true.time, true.along, roll=nothing, phi=nothing), ICE, -1.0)
    along, roll, phi = model.predict(VALUES | {"turned": 0.7})
    rolls = true.time > RELEASED
    run = exact(ICE, true.time[rolls] - RELEASED, -1.0)
    assert along == pytest.approx(true.along, abs=1e-6)
    assert roll == pytest.approx(0.7 + (true.along - PLACE) / METAL.radius, abs=3e-5)
    assert phi[rolls] == pytest.approx(run.phi, abs=3e-5)
    assert (phi[~rolls] == -1.0).all()


@pytest.mark.parametrize("impossible", [{"fill": 1.5}, {"damping": -1.0}, {"incline": 2.0}])
def test_what_cannot_move_has_no_numbers(impossible: dict[str, float]) -> None:
    model = TrackModel(filmed(OIL), OIL, "level")
    assert np.isnan(model.predict(VALUES | impossible)).all()
