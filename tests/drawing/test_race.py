"""The race: closed forms for the times, the cans where they are, and the names where no can is."""

import math

import numpy as np
import pytest

from mjbeer import Can, exact, frozen, simulate, sliding
from mjbeer.drawing.race import Course, Race, Runner
from mjbeer.drawing.sheet import Sheet
from mjbeer.exceptions import ParameterError
from mjbeer.theory.scene import Scene

METAL = Can.sheet_metal()
INCLINE = 0.1
RED = (1.0, 0.0, 0.0)
# A run to a tolerance of 1e-9 radians, over the speed at the finish, 1 m/s: far below a nanosecond.
SIMULATED = 1e-9


def run(scene: Scene, phi0: float = 0.0, duration: float = 2.5) -> Runner:
    return Runner("a can", simulate(scene, duration, phi0, tolerance=1e-9), RED)


@pytest.mark.parametrize(
    ("scene", "acceleration"),
    [
        (frozen(INCLINE, fill=1.0), 2 / 3),  # a solid cylinder
        (sliding(INCLINE, fill=1.0), 1.0),  # a block without friction, eq. (9)
        (frozen(INCLINE, fill=1e-5, can=Can.hoop(mass=0.02)), 1 / 2),  # a hoop
    ],
)
def test_times_are_those_of_even_acceleration(scene: Scene, acceleration: float) -> None:
    time = math.sqrt(2 * 1.0 / (acceleration * 9.81 * math.sin(INCLINE)))
    runner = run(scene)
    assert runner.finish_of_theory(1.0) == pytest.approx(time, rel=1e-5)  # the fill of 1e-5 is a millionth of the mass
    assert runner.finish(1.0) == pytest.approx(runner.finish_of_theory(1.0), abs=SIMULATED)


@pytest.mark.parametrize(("scene", "phi0"), [(sliding(INCLINE, can=METAL), 1.0), (frozen(INCLINE, can=METAL), math.pi)])
def test_at_the_finish_a_can_is_at_the_line(scene: Scene, phi0: float) -> None:
    runner = run(scene, phi0, 2.0)
    time = runner.finish_of_theory(0.7)
    motion = exact(scene, np.array([0.0, time]), phi0)
    assert motion.u[1] - motion.u[0] == pytest.approx(0.7, abs=1e-10)
    assert runner.finish(0.7) == pytest.approx(time, abs=SIMULATED)


@pytest.mark.slow
def test_a_can_that_does_not_finish_is_followed_until_the_others_have() -> None:
    """What honey does not reach has no time, and the table has how far it came."""
    fast, slow = run(sliding(INCLINE, can=METAL)), run(sliding(INCLINE, can=METAL, damping=1e-2), duration=1.8)
    assert slow.finish(1.0) == slow.finish_of_theory(1.0) == math.inf
    race = Race("a race", lambda: [fast, slow], length=1.0, speed=1.0, told=str, still=0.0, after=0.1)
    end = fast.finish(1.0)
    assert race.reel().end == end + 0.1
    results = Course(race, [fast, slow], 320, 180)
    (first, by_theory), (second, second_by_theory) = results.words
    assert first == by_theory == f"{end:.2f} s"
    assert second == second_by_theory == f"{slow.way_of_theory(end):.2f} m"


def test_runs_that_are_too_short_are_errors() -> None:
    fast, short = run(sliding(INCLINE, can=METAL)), run(frozen(INCLINE, fill=1.0), duration=0.3)
    with pytest.raises(
        ParameterError, match=r"a can rolls 0\.0\d+ m to t = 0\.3 s, and the race is over 1 m and lasts"
    ):
        Race("a race", lambda: [fast, short], 1.0, 1.0, told=str, still=0.0).reel()
    with pytest.raises(ParameterError, match="no can finishes: none rolls 1 m while its motion lasts"):
        Race("a race", lambda: [short], 1.0, 1.0, told=str, still=0.0).reel()


@pytest.mark.slow
def test_the_chart_of_a_race_does_not_tell_who_wins() -> None:
    """Theory's line is there at the end, and at the start only in the legend."""
    cans = [run(sliding(INCLINE, can=METAL))]
    race = Race("a race", lambda: cans, 1.0, 1.0, told=str, still=0.0)
    course, counts = Course(race, cans, 640, 360), []
    for time in (0.0, cans[0].finish(1.0)):
        sheet = Sheet(640, 360)
        course.strip.draw(sheet, time, 0)
        grey = np.abs(sheet.picture().astype(int) - [180, 188, 200]).max(axis=2) < 12
        counts.append(grey.sum())
    assert 0 < counts[0] < 0.3 * counts[1]


@pytest.mark.draws
@pytest.mark.slow
def test_a_race_is_drawn_with_its_cans_at_the_lines() -> None:
    """Each can's colour is found where it is at the start, and beyond the finish in the end."""
    cans = [run(frozen(INCLINE, fill=1.0, can=METAL)), run(sliding(INCLINE, can=METAL))]
    race = Race("a race", lambda: cans, length=0.5, speed=1.0, told=str, still=0.0, after=0.1)
    reel = race.reel()
    assert reel.end == pytest.approx(max(can.finish(0.5) for can in cans) + 0.1)
    course = Course(race, cans, 320, 180)
    first, last = reel.draw(np.array([0.0, reel.end]), 320, 180)
    assert first.shape == last.shape == (180, 320, 3)
    for time, picture, other in ((0.0, first, last), (reel.end, last, first)):
        course.display.pose(course.positions(time))
        for name in ("can", "1-can"):
            column, row = course.view.pixel(course.display.data.body(name).xpos).astype(int)
            near = slice(course.top + row - 4, course.top + row + 4), slice(column - 4, column + 4)
            if 4 < column < 316:  # in the end the winner is out of the picture
                assert np.abs(picture[near].astype(int) - other[near]).mean() > 20
