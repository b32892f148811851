"""A fit is doubted for reasons, each of which is made here by hand."""

from dataclasses import replace

import numpy as np
import pytest

from mjbeer import Track, frozen
from mjbeer.tracks.doubts import chance_of_white_noise, doubts, doubts_of_law
from mjbeer.tracks.least_squares import Minimum, Weights
from mjbeer.tracks.unknowns import Measurement, make_unknowns, to_values, to_variables

POINTS = 160
TRACK = Track(np.linspace(0, 3, POINTS), np.linspace(0, 2, POINTS) ** 2)
UNKNOWNS = make_unknowns(
    ["incline", "fill", "place"], TRACK, frozen(0.05), {"fill": Measurement(0.5, 0.01)}
)
VALUES = {"incline": 0.05, "fill": 0.5, "place": 0.0}
WEIGHTS = Weights(np.array([[1e-3]]), np.ones((1, POINTS), bool))
GOOD = Minimum(
    variables=to_variables(UNKNOWNS, VALUES),
    residuals=np.append(np.random.default_rng(0).standard_normal(POINTS), 0.0),
    jacobian=100
    * np.eye(POINTS + 1, 3),  # all variables are known to a hundredth of a large change
    converged=True,
    weights=WEIGHTS,
    next_weights=WEIGHTS,
    cost=0.0,
)


def moved(**values: float) -> Minimum:
    """The good minimum with other values."""
    return replace(GOOD, variables=to_variables(UNKNOWNS, VALUES | values))


def test_there_is_no_doubt_of_a_good_minimum() -> None:
    assert doubts(GOOD, [GOOD], UNKNOWNS) == ()


def test_white_noise_is_doubted_as_often_as_said() -> None:
    """The smallest of four chances that are alike is counted four times: so it is less often."""
    rng = np.random.default_rng(1)
    chances = np.array([chance_of_white_noise(rng.standard_normal(POINTS)) for _ in range(500)])
    # Of 500, 50 would be below 0.1 if the four were independent, and 12.5 if they were one; a count
    # has a standard deviation of its root.
    assert 12.5 - 3 * 12.5**0.5 < (chances < 0.1).sum() < 50 + 3 * 50**0.5


@pytest.mark.parametrize(("size", "rare"), [(0.52, "1,000"), (0.6, "100,000"), (2.0, "1,000,000")])
def test_slow_waves_below_the_noise_are_no_white_noise(size: float, rare: str) -> None:
    """A wave of 0.7 of the noise has 40 of the power of one, among 10 in a sixteenth of all."""
    noise = np.random.default_rng(2).standard_normal(POINTS)
    wave = size * np.sqrt(2) * np.cos(np.linspace(0, 4 * np.pi, POINTS))
    minimum = replace(GOOD, residuals=np.append(noise + wave, 0.0))
    (doubt,) = doubts(minimum, [minimum], UNKNOWNS)
    of_noise = f"their difference is not like noise, which is as smooth in fewer than 1 of {rare}"
    assert doubt == f"the model is wrong, or the track: {of_noise} tracks"


def test_points_left_out_are_counted_and_not_judged() -> None:
    """They are zeros in the residuals, as in a fit, and as a block would be smooth."""
    kept = np.ones((1, POINTS), bool)
    kept[0, 40:44] = False
    residuals = GOOD.residuals.copy()
    residuals[40:44] = 0.0
    minimum = replace(GOOD, residuals=residuals, weights=Weights(WEIGHTS.noise, kept))
    assert doubts(minimum, [minimum], UNKNOWNS) == (
        "4 points are far from all others, and were left out",
    )


@pytest.mark.parametrize(("fill", "is_doubted"), [(0.529, False), (0.531, True)])
def test_a_measured_value_three_errors_off_is_doubted(fill: float, is_doubted: bool) -> None:
    minimum = moved(fill=fill)
    found = doubts(minimum, [minimum], UNKNOWNS)
    doubt = "the model is wrong, or what was known: fill is 0.531, 3.1 standard errors off 0.5"
    assert found == ((doubt,) if is_doubted else ())


@pytest.mark.parametrize(("bend", "is_doubted"), [(0.0129, False), (0.0131, True)])
def test_a_bend_that_the_track_hardly_tells_is_doubted_sooner(
    bend: float, is_doubted: bool
) -> None:
    """An error of 5 mm before the fit and of 2.5 mm after it leave 4.33 mm to chance."""
    unknowns = make_unknowns(["bend"], TRACK, frozen(0.05), {"bend": Measurement(0.0, 5e-3)})
    jacobian = np.zeros((POINTS + 1, 1))
    jacobian[0] = 2  # the error is half of a large change, 5 mm
    variables = to_variables(unknowns, {"bend": bend})
    minimum = replace(GOOD, variables=variables, jacobian=jacobian)
    found = doubts(minimum, [minimum], unknowns)
    off = "bend is 13 mm, 3.0 standard errors off 0 mm"
    hint = "an oblique camera bends a track, and marks on the board unbend it"
    doubt = f"the model is wrong, or what was known: {off}; {hint}"
    assert found == ((doubt,) if is_doubted else ())


@pytest.mark.parametrize(
    ("factor", "error", "is_doubted"),
    [
        (1.29, 0.0, False),
        (1.31, 0.0, True),
        (0.69, 0.0, True),
        (1.59, 0.17, False),  # three times 0.197 are 0.592
        (1.60, 0.17, True),
    ],
)
def test_a_damping_far_from_its_law_is_doubted(
    factor: float, error: float, is_doubted: bool
) -> None:
    """The polynomial of the law has an error of a tenth."""
    found = doubts_of_law("water", factor, error)
    begin = f"the damping is {factor:.2g} times that of water: was it water"
    assert [doubt.startswith(begin) for doubt in found] == [True] * is_doubted


def test_what_changes_together_is_named() -> None:
    """Of the sum of incline and place nothing is known, of all else much."""
    jacobian = np.zeros((POINTS + 1, 3))
    jacobian[0] = 100, 0, -100
    jacobian[1] = 0, 100, 0
    minimum = replace(GOOD, jacobian=jacobian)
    assert doubts(minimum, [minimum], UNKNOWNS) == ("this track does not tell incline from place",)


def test_another_motion_is_named_if_it_is_beyond_the_errors() -> None:
    """The error of the fill is a hundredth of 0.1; and another place is no other motion."""
    near = moved(fill=0.505)
    elsewhere = moved(place=3.0)
    other = moved(fill=0.51)
    assert doubts(GOOD, [GOOD, near, elsewhere], UNKNOWNS) == ()
    found = "another motion is as near to the track: incline 2.86°, fill 0.51"
    assert doubts(GOOD, [GOOD, other], UNKNOWNS) == (found,)
    assert to_values(UNKNOWNS, other.variables)["fill"] == pytest.approx(0.51)


def test_a_search_that_was_stopped_is_told() -> None:
    (doubt,) = doubts(replace(GOOD, converged=False), [GOOD], UNKNOWNS)
    assert doubt == "the search was stopped before it came to the nearest motion"
