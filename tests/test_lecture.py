"""The lecture: its times are those of films and live page, and its ratios those of closed forms."""

import json
import math
import pathlib
import re
import sys

import numpy as np
import pytest

from mjbeer.report import films
from tests.test_live import USUAL_CAN, script

CHECKOUT = pathlib.Path(__file__).parents[1]
sys.path.append(str(CHECKOUT / "docs" / "figures"))
import real_beer  # noqa: E402 - beside the figures that it draws

TEXT = (CHECKOUT / "docs" / "lecture.md").read_text(encoding="utf-8")
HALF_A_DIGIT = 0.005
"""[s]."""


def times_of_the_race() -> list[float]:
    """Return the times [s] in the lecture's first table."""
    return [float(time) for time in re.findall(r"^\|[^|]*\| ([\d.]+) s \|", TEXT, re.MULTILINE)]


@pytest.mark.slow
def test_the_times_of_the_race_are_those_of_its_film() -> None:
    finishes = [runner.finish(films.LENGTH) for runner in films.of_beer()]

    assert times_of_the_race() == pytest.approx(finishes, abs=HALF_A_DIGIT)


@pytest.mark.parametrize(
    ("place", "inside", "fill", "degrees"),
    [
        (0, "no friction", 0.75, 30),
        (1, "ice", 0.75, 180),
        (2, "ice", 1.0, 0),
        (3, "nothing", 0.5, 0),
    ],
)
def test_the_live_page_has_the_times_of_the_race(
    place: int, inside: str, fill: float, degrees: float
) -> None:
    setting = {
        **USUAL_CAN,
        "inside": inside,
        "fill": fill,
        "incline": math.radians(5),
        "phi0": math.radians(degrees),
    }
    time = times_of_the_race()[place]
    around = [time - HALF_A_DIGIT, time + HALF_A_DIGIT]

    before, after = script(f"motion({json.dumps(setting)}, {around}).distance")

    assert before < 1 < after


@pytest.mark.slow
def test_the_times_of_the_liquids_are_those_of_their_film() -> None:
    for runner in films.of_liquids():
        time = re.search(rf"{runner.name.removeprefix('olive ')} (?:takes about )?([\d.]+) s", TEXT)
        assert time, runner.name
        digits = len(time[1].partition(".")[2])
        assert f"{runner.finish(films.LENGTH):.{digits}f}" == time[1]


def test_the_ratios_beside_measurements_are_those_of_closed_forms() -> None:
    """A time goes with the root of (m + I/a^2)/m: m of all, and I of what turns.

    The table is made with the package's scenes.
    """
    wall = 0.073 / 2.278
    tin = 0.1
    cylinder = 2.119 / 1.835
    soups = 2.21 / 2.65
    closed = [
        (cylinder, math.sqrt(2 / 1.5)),
        (cylinder, math.sqrt(2 / (1 + wall + (1 - wall) / 2))),
        (cylinder, math.sqrt(2 / (1 + wall))),
        (soups, math.sqrt(1 / 1.5)),
        (soups, math.sqrt((1 + tin) / (1 + tin + (1 - tin) / 2))),
        (soups, 1.0),
    ]
    rows = TEXT.partition("made: measured-by-others")[2].partition("<!-- end")[0]

    found = re.findall(r"([\d.]+) \| ([\d.]+) \|$", rows, re.MULTILINE)
    ratios = [(float(measured), float(theory)) for measured, theory in found]

    assert np.array(ratios) == pytest.approx(np.array(closed), abs=5.1e-4)
    measured, with_wall = ratios[1]
    assert 0.5 < 100 * (measured / with_wall - 1) < 0.6  # "half a percent"


@pytest.mark.slow
def test_the_lead_of_frozen_beer_and_the_reach_of_the_liquids_are_those_of_their_films() -> None:
    sliding, frozen, full, _ = (runner.trajectory for runner in films.of_beer())
    times = np.linspace(0, 1.5, 1501)
    ahead = np.interp(times, frozen.time, frozen.distance)
    lead = ahead - np.interp(times, sliding.time, sliding.distance)
    assert round(100 * lead.max()) == 2  # "two centimetres"
    assert round(100 * ahead[lead > 0][-1]) == 41  # "behind from 41 cm on"
    assert (ahead - np.interp(times, full.time, full.distance) > -1e-4).all()
    reached = [real_beer.lump_until(runner.trajectory) for runner in films.of_liquids()[:3]]
    assert [round(100 * place) for place in reached] == [14, 18, 20]
