"""The race: closed forms for the times, the cans where they are, and the names where no can is."""

import math
from functools import partial
from typing import Any

import numpy as np
import pytest

from mjbeer import Can, frozen, simulate, sliding
from mjbeer.drawing.race import Race, Runner
from mjbeer.drawing.sheet import Sheet
from mjbeer.theory.scene import Scene

METAL = Can.sheet_metal()
INCLINE = 0.1


def run(scene: Scene, phi0: float = 0.0, duration: float = 2.5) -> Runner:
    return Runner("a can", simulate(scene, duration, phi0, tolerance=1e-9), (1.0, 0.0, 0.0))


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
    # A fill of 0.01 is a thousandth of the mass.
    assert run(scene).finish(1.0) == pytest.approx(time, rel=2e-3)


def test_the_plates_have_all_times() -> None:
    """Also that of a can which finishes after the end."""
    cans = [run(frozen(INCLINE, fill=1.0)), run(sliding(INCLINE, can=METAL))]
    last = cans[0].finish(1.0)
    first = cans[1].finish(1.0)
    race = partial(Race, "a race", lambda: cans, 1.0, speed=0.5)
    assert race(duration=last + 0.1).results(cans) == [
        (last, f"2nd: {last:.2f} s"),
        (first, f"1st: {first:.2f} s"),
    ]
    early = race(duration=last - 0.01).results(cans)
    assert early == [
        (pytest.approx(last - 0.41), f"needs {last:.2f} s"),
        (first, f"1st: {first:.2f} s"),
    ]


def test_cans_with_the_same_time_share_their_place() -> None:
    """Times are the same that a viewer sees to be; the places after them are counted on."""
    last = run(frozen(INCLINE, fill=1.0))
    first = run(sliding(INCLINE, fill=1.0))
    almost = run(sliding(INCLINE * (1 - 1e-9), fill=1.0))
    assert first.finish(1.0) < almost.finish(1.0)
    race = Race("a race", list, 1.0, duration=3.0, speed=0.5)
    words = [result.words for result in race.results([last, first, almost])]
    quick = f"shared 1st: {first.finish(1.0):.2f} s"
    assert words == [f"3rd: {last.finish(1.0):.2f} s", quick, quick]


@pytest.mark.draws
@pytest.mark.slow
def test_centres_of_mass_stay_abreast_however_the_beer_swings(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The near one is where that of a beer is that does not swing.

    4 pixels are 3 mm, and the axes 12 mm apart.

    The cans, which are red, move to the right, where downhill is.
    """
    dashed = []
    line = Sheet.line

    def keep(sheet: Sheet, places: np.ndarray, *arguments: Any, **more: Any) -> None:
        if more.get("dashes"):
            dashed.append(places)
        line(sheet, places, *arguments, **more)

    monkeypatch.setattr(Sheet, "line", keep)
    for near in (1.0, 0.0):
        cans = [run(sliding(INCLINE), phi0, 0.6) for phi0 in (near, 0.0)]
        race = Race("a comparison", partial(list, cans), 0.3, 0.6, speed=1.0, centres=True)
        pictures = list(race.plan().draw(np.array([0.0, 0.2, 0.4]), 640, 360))
    red = [picture[..., 0] > 2.0 * picture[..., 1] for picture in pictures]
    middles = [np.median(np.nonzero(pixels)[1]) for pixels in red]
    assert np.diff(middles).min() > 20
    columns = np.array(dashed)[:, 0, 0]
    assert columns[:3] == pytest.approx(columns[3:], abs=4)
    assert np.ptp(columns) > 50
