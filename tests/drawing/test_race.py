"""The race: closed forms for the times, the cans where they are, and the names where no can is."""

import math

import numpy as np
import pytest

from mjbeer import Can, exact, frozen, liquid, simulate, sliding
from mjbeer.drawing.overlay import HEIGHT
from mjbeer.drawing.race import Race, Result, Runner
from mjbeer.drawing.sheet import Sheet
from mjbeer.exceptions import LiquidWarning, ParameterError
from mjbeer.theory.scene import Scene

METAL = Can.sheet_metal()
INCLINE = 0.1
RED = (1.0, 0.0, 0.0)
BLUE = (0.0, 0.0, 1.0)


def runner(scene: Scene, phi0: float = 0.0, duration: float = 2.5) -> Runner:
    return Runner("a can", simulate(scene, duration, phi0, tolerance=1e-9), RED)


def race(*runners: Runner, duration: float = 3.0) -> Race:
    """Return a race of some cans over a metre."""
    return Race("a race", lambda: runners, length=1.0, duration=duration, speed=0.5)


@pytest.mark.parametrize(
    ("scene", "acceleration"),
    [
        (frozen(INCLINE, fill=1.0), 2 / 3),  # a solid cylinder
        (sliding(INCLINE, fill=1.0), 1.0),  # a block without friction, eq. (9)
        (frozen(INCLINE, fill=0.01, can=Can.hoop(mass=0.6)), 1 / 2),  # a hoop
    ],
)
def test_times_are_those_of_even_acceleration(scene: Scene, acceleration: float) -> None:
    time = math.sqrt(2 * 1.0 / (acceleration * 9.81 * math.sin(INCLINE)))

    finish = runner(scene).finish(1.0)

    # A fill of 0.01 is a thousandth of the mass.
    assert finish == pytest.approx(time, rel=2e-3)


def test_the_plates_have_places_and_times() -> None:
    slow = runner(frozen(INCLINE, fill=1.0))
    quick = runner(sliding(INCLINE, can=METAL))

    results = race(slow, quick).results([slow, quick])

    last = slow.finish(1.0)
    first = quick.finish(1.0)
    assert results == [
        Result(last, f"2nd: {last:.2f} s"),
        Result(first, f"1st: {first:.2f} s"),
    ]


def test_a_time_that_the_model_of_a_liquid_cannot_tell_well_has_two_digits() -> None:
    """Thin water in a quick can is no lump: the wall carries it round."""
    with pytest.warns(LiquidWarning, match="terminal speed"):
        scene = liquid("water", INCLINE, 0.75, METAL)
    with pytest.warns(LiquidWarning, match="from t = "):
        quick = runner(scene, duration=1.5)
    slow = runner(frozen(INCLINE, fill=1.0))

    words = [result.words for result in race(quick, slow).results([quick, slow])]

    assert words == [f"1st: ≈ {quick.finish(1.0):.1f} s", f"2nd: {slow.finish(1.0):.2f} s"]


def test_a_can_that_comes_too_late_has_its_time_shortly_before_the_end() -> None:
    slow = runner(frozen(INCLINE, fill=1.0))
    time = slow.finish(1.0)

    (late,) = race(slow, duration=time - 0.01).results([slow])

    assert late == Result(pytest.approx(time - 0.41), f"needs {time:.2f} s")


def test_a_can_whose_motion_ends_before_the_finish_does_not_need_infinitely_long() -> None:
    stopped = runner(frozen(INCLINE, fill=1.0), duration=0.5)

    (result,) = race(stopped).results([stopped])

    assert result == Result(2.6, "not there after 0.50 s")


def test_cans_with_the_same_time_share_their_place() -> None:
    """Times are the same if a viewer sees the same digits; the places after them are counted on."""
    slow = runner(frozen(INCLINE, fill=1.0))
    quick = runner(sliding(INCLINE, fill=1.0))
    almost = runner(sliding(INCLINE * (1 - 1e-9), fill=1.0))
    cans = [slow, quick, almost]

    words = [result.words for result in race(*cans).results(cans)]

    assert quick.finish(1.0) < almost.finish(1.0)
    shared = f"shared 1st: {quick.finish(1.0):.2f} s"
    assert words == [f"3rd: {slow.finish(1.0):.2f} s", shared, shared]


def test_five_cans_have_five_places() -> None:
    masses = (0.5, 0.4, 0.3, 0.2, 0.1)  # the heavier a can's wall, the slower it is
    cans = [runner(sliding(INCLINE, can=Can.hoop(mass=mass))) for mass in masses]

    words = [result.words for result in race(*cans).results(cans)]

    assert [place.split(":")[0] for place in words] == ["5th", "4th", "3rd", "2nd", "1st"]


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (frozen(INCLINE, can=Can.massless(0.066, 0.12)), r"radius, got 0.033 m and 0.066 m"),
        (frozen(2 * INCLINE), r"incline, got 0.1 rad and 0.2 rad"),
    ],
)
def test_cans_that_do_not_race_on_equal_terms_are_refused(other: Scene, message: str) -> None:
    cans = [runner(frozen(INCLINE)), runner(other)]

    with pytest.raises(ParameterError, match=message):
        race(*cans).plan()


def pictures_of_a_race(size: float) -> list[np.ndarray]:
    """Return pictures of a race in which all lengths, and gravity, are `size` times as large.

    They are of the start, half-way, and when the first can has arrived.
    """
    can = Can.massless(0.033 * size, 0.12 * size)
    gravity = 9.81 * size  # so that the motion takes the same time
    times = np.linspace(0, 0.9, 201)
    quick = exact(sliding(INCLINE, can=can, gravity=gravity), times, 1.0)
    slow = exact(frozen(INCLINE, can=can, gravity=gravity), times, math.pi)
    cans = [Runner("quick", quick, RED), Runner("slow", slow, BLUE)]
    film = Race("a race", lambda: cans, 0.3 * size, duration=0.9, speed=1.0)
    return list(film.plan().draw(np.array([0.0, 0.5, 0.9]), 640, 360))


@pytest.mark.draws
@pytest.mark.slow
def test_a_race_of_large_cans_over_a_long_distance_looks_like_one_of_small_cans() -> None:
    """Below the title, which has the distance, all is where it is: cans, lines and plates."""
    below_title = slice(math.ceil(HEIGHT * Sheet(640, 360).unit), None)
    small = np.array(pictures_of_a_race(1.0))[:, below_title].astype(int)

    large = np.array(pictures_of_a_race(10.0))[:, below_title].astype(int)

    # Rounding, in single precision in OpenGL, moves an edge by a small part of a pixel.
    differ = np.abs(small - large).max(axis=-1) > 25
    assert differ.mean() < 1e-4
    # What moves in the small race is a hundred times as much.
    assert (np.abs(np.diff(small, axis=0)).max(axis=-1) > 25).mean() > 1e-2


@pytest.mark.draws
def test_each_can_has_a_close_up_and_is_held_at_the_finish() -> None:
    """The close-up of the can that has arrived stays as it is, and so does that can."""
    can = Can.massless(0.033, 0.12)
    quick = Runner("quick", exact(sliding(0.3, can=can), np.linspace(0, 0.9, 201), 1.0), RED)
    slow = Runner("slow", exact(frozen(0.3, can=can), np.linspace(0, 0.9, 201), math.pi), BLUE)
    finish = quick.finish(0.3)
    assert finish < slow.finish(0.3)
    film = Race("a race", lambda: [quick, slow], 0.3, duration=0.9, speed=1.0)

    before, after, later = film.plan().draw(finish + np.array([-0.1, 0.001, 0.05]), 640, 360)

    close_ups = slice(290, 355)
    of_quick = slice(0, 320)
    of_slow = slice(320, 640)
    assert np.ptp(after[close_ups, of_quick]) > 200
    assert np.array_equal(after[close_ups, of_quick], later[close_ups, of_quick])
    assert not np.array_equal(before[close_ups, of_quick], after[close_ups, of_quick])
    assert not np.array_equal(after[close_ups, of_slow], later[close_ups, of_slow])
    board = slice(60, 240)
    assert red(after[board]) == pytest.approx(red(later[board]), abs=0.5)
    assert red(after[board]) - red(before[board]) > 20


def red(picture: np.ndarray) -> float:
    """Return the column in the middle of what is red."""
    is_red = (picture[..., 0] > 2.0 * picture[..., 1]) & (picture[..., 0] > 100)
    return float(np.median(np.nonzero(is_red)[1]))


@pytest.fixture
def joined(monkeypatch: pytest.MonkeyPatch) -> list[np.ndarray]:
    """Return a list that is filled with the places of each dashed line as it is drawn [pixels]."""
    dashed = []
    line = Sheet.line

    def keep(sheet: Sheet, places: np.ndarray, *arguments, dashes=(), **more) -> None:
        if dashes:
            dashed.append(places)
        line(sheet, places, *arguments, dashes=dashes, **more)

    monkeypatch.setattr(Sheet, "line", keep)
    return dashed


def comparison(*phis: float) -> list[np.ndarray]:
    """Return three pictures of the centres of mass of beers that are let go at some angles."""
    cans = [runner(sliding(INCLINE), phi0, 0.6) for phi0 in phis]
    film = Race("a comparison", lambda: cans, 0.3, 0.6, speed=1.0, centres=True)
    return list(film.plan().draw(np.array([0.0, 0.2, 0.4]), 640, 360))


@pytest.mark.draws
@pytest.mark.slow
def test_centres_of_mass_stay_abreast_however_the_beer_swings(joined: list[np.ndarray]) -> None:
    """The near centre is where it is if that beer does not swing: within 4 pixels.

    They are 3 mm, and the axes are 12 mm apart.
    """
    comparison(1.0, 0.0)
    comparison(0.0, 0.0)

    nearest = np.array([places[0, 0] for places in joined])
    swinging = nearest[:3]
    still = nearest[3:]
    assert swinging == pytest.approx(still, abs=4)
    assert np.ptp(still) > 50


@pytest.mark.draws
@pytest.mark.slow
def test_the_cans_of_a_comparison_roll_downhill_to_the_right() -> None:
    pictures = comparison(0.0, 0.0)

    columns = []
    for picture in pictures:
        is_red = picture[..., 0] > 2.0 * picture[..., 1]
        columns.append(np.median(np.nonzero(is_red)[1]))
    assert np.diff(columns).min() > 15
