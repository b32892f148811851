"""A search begins in each valley, finds the swing of the release, and leaves out no swing."""

import itertools
import math

import numpy as np
import pytest

from mjbeer import Can, frozen, liquid
from mjbeer.tracks import first_guess
from mjbeer.tracks.first_guess import FirstGuess, first_guesses, guess_anywhere, guess_nearby
from mjbeer.tracks.least_squares import (
    Minimum,
    Weights,
    as_good_as_best,
    cost,
    distinct,
    first_round,
    nearest_to_guess,
    next_round,
)
from mjbeer.tracks.track_model import TrackModel
from mjbeer.tracks.unknowns import make_unknowns, to_values, to_variables
from tests.tracks.filmed import PLACE, RELEASED, filmed

pytestmark = pytest.mark.slow
METAL = Can.sheet_metal()
OIL = liquid("olive oil", math.radians(2), can=METAL)
ROCKING = frozen(math.radians(2.557), 0.5033, METAL)  # 30 times in 8 s
UNKNOWNS = make_unknowns(["incline", "place"], filmed(ROCKING), ROCKING, {})


@pytest.fixture
def rocking() -> TrackModel:
    return TrackModel(filmed(ROCKING, seconds=8.0), ROCKING, "level")


def test_the_release_is_found_in_the_whole_track(rocking: TrackModel) -> None:
    guess = guess_anywhere(rocking, {"incline": ROCKING.incline})
    interval = 1.8 * rocking.duration / 350  # there are more releases than that
    assert guess.values["released"] == pytest.approx(RELEASED, abs=interval)
    assert guess.values["incline"] == ROCKING.incline


def test_a_guess_a_swing_too_late_is_put_right(rocking: TrackModel) -> None:
    swing = 2 * math.pi / ROCKING.frequency()
    late = {"incline": ROCKING.incline, "place": PLACE, "released": RELEASED + swing}
    guess = guess_nearby(rocking, late)
    interval = 2 * 17 * rocking.swing_time / 200
    assert guess.values["released"] == pytest.approx(RELEASED, abs=interval)


def test_the_next_round_leaves_a_valley_a_swing_too_late(rocking: TrackModel) -> None:
    unknowns = make_unknowns(["incline", "place", "released"], rocking.track, ROCKING, {})
    swing = 2 * math.pi / ROCKING.frequency()
    late = {"incline": ROCKING.incline, "place": PLACE, "released": RELEASED + swing}
    first = first_round(rocking, unknowns, FirstGuess(late, misfit=1e-2))
    second = next_round(rocking, unknowns, first)
    assert to_values(unknowns, first.variables)["released"] > RELEASED + 0.5 * swing
    # Standard errors are some 0.1 ms.
    assert to_values(unknowns, second.variables)["released"] == pytest.approx(RELEASED, abs=1e-3)
    assert second.cost < first.cost


def test_a_sliding_loads_incline_is_put_right_with_the_release() -> None:
    """Its distances are nearly proportional to it: of a fifth too much, at most a fifth is left."""
    model = TrackModel(filmed(OIL), OIL, "level")
    guess = guess_anywhere(model, {"incline": 1.2 * OIL.incline})
    assert guess.values["incline"] == pytest.approx(OIL.incline, rel=0.04)


def test_each_valley_and_each_fill_come_before_the_rest(
    rocking: TrackModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Given are a valley at the smallest incline, and a higher one at the largest."""
    unknowns = make_unknowns(["incline", "fill"], rocking.track, ROCKING, {})

    def pretended(_: TrackModel, values: dict[str, float]) -> FirstGuess:
        steepness = values["incline"] / ROCKING.incline  # 0.7 to 1.5
        valleys = min(abs(steepness - 0.7), 0.3 + abs(steepness - 1.5))
        misfit = 1 + 0.01 * valleys + abs(values["fill"] - 0.3)
        return FirstGuess(values, math.nan if values["fill"] > 0.9 else misfit)

    monkeypatch.setattr(first_guess, "guess_anywhere", pretended)
    guesses = first_guesses(rocking, unknowns)
    inclines = [guess.values["incline"] / ROCKING.incline for guess in guesses]
    fills = [guess.values["fill"] for guess in guesses]
    assert inclines[:2] == pytest.approx([0.7, 1.5])
    kinds = len(set(fills))
    assert len(set(fills[1 : 1 + kinds])) == kinds
    assert max(fills) <= 0.9
    rest = [guess.misfit for guess in guesses[1 + kinds :]]
    assert all(earlier <= later for earlier, later in itertools.pairwise(rest))


def test_leaving_out_a_swing_does_not_pay() -> None:
    """20 of 200 points are off by three standard deviations of the others' noise."""
    nothing_measured = np.empty(0)
    kept = np.ones((1, 200), bool)
    with_all = Weights(np.array([[math.sqrt(1 + 0.1 * 9)]]), kept)
    some = kept.copy()
    some[0, :20] = False
    without_swing = Weights(np.array([[1.0]]), some)
    assert cost(with_all, nothing_measured) < cost(without_swing, nothing_measured)


def minimum(cost: float, **values: float) -> Minimum:
    """A minimum at values; only those and the cost count."""
    weights = Weights(np.ones((1, 1)), np.ones((1, 1), bool))
    variables = to_variables(UNKNOWNS, {"incline": 0.05, "place": 0.1, **values})
    return Minimum(variables, np.zeros(1), np.zeros((1, 2)), True, weights, weights, cost)


def test_minima_of_one_motion_are_one_and_the_best_comes_first() -> None:
    """A hundredth of a degree is no other motion, and another place of the can is none."""
    good = minimum(cost=2.0)
    same = minimum(cost=3.0, incline=0.05 + math.radians(0.009))
    elsewhere = minimum(cost=4.0, place=0.3)
    other = minimum(cost=1.0, incline=0.06)
    assert distinct(UNKNOWNS, [same, good, elsewhere, other]) == [other, good]


def test_of_minima_alike_the_one_near_the_guess_is_taken() -> None:
    """Costs that differ by 9 are three standard errors apart."""
    best = minimum(cost=1.0, incline=0.07)
    near = minimum(cost=9.9, incline=ROCKING.incline)
    worse = minimum(cost=10.1, incline=ROCKING.incline)
    alike = as_good_as_best([best, near, worse])
    assert alike == [best, near]
    assert nearest_to_guess(UNKNOWNS, alike) == near
