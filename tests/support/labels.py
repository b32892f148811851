"""Where the texts of films are, and what they would cover."""

from itertools import combinations

import numpy as np

from mjbeer.drawing.camera import View
from mjbeer.drawing.film import Film, Stage, Take
from mjbeer.drawing.overlay import Look
from mjbeer.drawing.race import Course, Race
from mjbeer.drawing.scene import coordinates
from mjbeer.drawing.sheet import Box, Sheet, overlap

_SIZE = (960, 540)


def faults(film: Film, count: int = 40) -> list[str]:
    """Return what is wrong with the texts of a film at some times: over a can, over each other, over the edge."""
    if isinstance(film, Race):
        return _of_race(film, count)
    assert isinstance(film, Take)
    return _of_take(film, count)


def _of_take(take: Take, count: int) -> list[str]:
    trajectory = take.trajectory()
    look = take.look or Look.usual(trajectory)
    times = np.linspace(trajectory.time[0], trajectory.time[-1], count)
    stage = Stage.of(trajectory, look, take.speed, *_SIZE)
    found = []
    for time, now in zip(times, coordinates(trajectory, times), strict=True):
        stage.sheet.boxes.clear()
        stage.explain(time, now)
        rim = _rim(stage.shot.view(time), stage.display.outline(0, now)[0], stage.top)
        found += [f"{fault} at {time:.3f} s" for fault in _check(stage.sheet, [rim])]
    return found


def _of_race(race: Race, count: int) -> list[str]:
    runners = race.runners()
    reel, found = race.reel(), []
    course = Course(race, runners, *_SIZE)
    for time in np.linspace(reel.start, reel.end, count):
        course.sheet.boxes.clear()
        course.explain(time)
        rims = [
            _rim(course.view, ends, course.top)
            for number, position in enumerate(course.positions(time))
            for ends in course.display.outline(number, position)
        ]
        found += [f"{fault} at {time:.3f} s" for fault in _check(course.sheet, rims)]
    return found


def _rim(view: View, points: np.ndarray, top: int) -> np.ndarray:
    return view.pixel(points) + np.array([0, top])


def _check(sheet: Sheet, rims: list[np.ndarray]) -> list[str]:
    found = []
    for box in sheet.boxes:
        left, top, right, bottom = box
        if left < 0 or top < 0 or right > sheet.width or bottom > sheet.height:
            found.append(f"text over the edge {box}")
        found += [f"text over a can {box}" for rim in rims if _inside(box, rim)]
    for one, other in combinations(sheet.boxes, 2):
        if overlap(one, other):
            found.append(f"texts over each other {one} {other}")
    return found


def _inside(box: Box, rim: np.ndarray) -> bool:
    """Return whether a box and a disc overlap; the disc is given by its rim, and seen as an ellipse."""
    centre, half = (rim.max(axis=0) + rim.min(axis=0)) / 2, np.ptp(rim, axis=0) / 2
    nearest = np.clip(centre, box[:2], box[2:])
    return bool(np.hypot(*((nearest - centre) / half)) < 1)
