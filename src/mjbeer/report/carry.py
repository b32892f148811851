"""A can that is carried by a gripper that holds it upright, and the film of a gentle and a quick move."""

from collections.abc import Generator
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.drawing.camera import View, circle
from mjbeer.drawing.film import Film, RenderPlan
from mjbeer.drawing.overlay import HEIGHT, STRIP, draw_title
from mjbeer.drawing.scene import Display
from mjbeer.drawing.sheet import INK, Sheet
from mjbeer.drawing.strip import Chart, ChartStrip, Line
from mjbeer.model.build import build
from mjbeer.model.looks import WALL
from mjbeer.theory.scene import sliding
from mjbeer.theory.standing import QUANTITATIVE, Standing, standing

_TIMESTEP = 5e-4  # [s]
_DISTANCE, _LONGEST = 0.4, 2.4  # way of the grippers [m], and how long the film watches them [s]
_APART, _HIGH = 0.34, 0.015  # distance of the grippers, and height at which they hold their cans [m]
_LEFT, _EYE = -0.26, np.array([0.1, -2.2, 1.5])  # where the picture begins, and where the eye is [m]
_PLATES, _STEEL = 24, np.array([0.32, 0.36, 0.42])  # flat faces around half a can, and a colour
_CORNERS = (-0.06, 0.0), (0.06, 0.0), (0.06, 0.19), (-0.06, 0.19)  # of what is around a gripper, from its can's bottom
_OUTLINE = np.array([[(x, y, z) for x, z in _CORNERS] for y in (-0.034, 0.034)])  # of its near and its far side [m]


class Carried(NamedTuple):
    """What a gripper feels, and what the liquid does; arrays have the shape (steps,)."""

    time: np.ndarray  # [s]
    place: np.ndarray  # place of the can [m]
    acceleration: np.ndarray  # acceleration of the can [m/s^2]
    force: np.ndarray  # level force of the gripper on the can [N]
    rise: np.ndarray  # how high the surface rises at the wall ahead, by all modes that move, over the radius


def carry(can: Standing, distance: float = _DISTANCE, duration: float = 1.0, after: float = 1.0) -> Carried:
    """Return the motion of a can that is moved by a `distance` [m] in a `duration` [s], and then held for `after` [s].

    The move has the least jerk that starts and ends at rest. In the frame of the gripper the can stands still and
    gravity is tilted by the acceleration, so that the gripper is as rigid as can be.
    """
    model = build(can, free=False, timestep=_TIMESTEP)
    data, body = mujoco.MjData(model), model.body("can").id
    time = _TIMESTEP * np.arange(round((duration + after) / _TIMESTEP) + 1)
    place, acceleration = minimum_jerk(time, distance, duration)
    _, pushed = minimum_jerk(time + _TIMESTEP / 2, distance, duration)  # a step has the gravity of its middle
    force, rise = np.empty_like(time), np.zeros_like(time)
    for step, now in enumerate(acceleration):
        model.opt.gravity[0] = -now
        mujoco.mj_forward(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        force[step] = data.cfrc_int[body, 3]  # the level force on its parent: the moment comes first
        for mode, elevation in enumerate(can.elevations(), start=1):
            rise[step] -= elevation * data.sensor(f"slosh{mode}_up").data[0]
        model.opt.gravity[0] = -pushed[step]
        mujoco.mj_step(model, data)
    return Carried(time, place, acceleration, force, rise)


def minimum_jerk(time: np.ndarray, distance: float, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Return place [m] and acceleration [m/s^2] of a move with the least jerk, at times [s] of shape (times,)."""
    share = np.clip(time / duration, 0.0, 1.0)
    place = distance * share**3 * (10 - 15 * share + 6 * share**2)
    return place, distance / duration**2 * 60 * share * (1 - share) * (1 - 2 * share)


MOVES = {1.0: (0.80, 0.15, 0.20), 1.6: (0.05, 0.40, 0.75)}  # times that moves take [s], and colours; the quick in front


@dataclass(frozen=True)
class Carry(Film):
    """The film of two cans that are moved 0.4 m, one quickly and one gently."""

    title: str = "Two grippers carry beer: which of them feels it slosh?"
    speed: float = 0.5
    still: float = 0.25
    caption: str = (
        "Two cans, half full of beer, are carried 0.4 m, in 1 s and in 1.6 s. The chart has the force of each gripper, "
        "and in grey what it would be if the beer were solid, as in other simulators. In the gentle move the surface "
        "rises by less than 0.1 R at the wall, where linear theory gives numbers, and the beer hardly rings after the "
        "stop. In the quick move it rises by 0.28 R, which is beyond that: the extra force and the ringing, a tenth of "
        "the largest force each, are then more of a picture than numbers."
    )

    def plan(self) -> RenderPlan:
        runs = {duration: carry(standing(), duration=duration, after=_LONGEST - duration) for duration in MOVES}
        return RenderPlan(0.0, _LONGEST, self.speed, partial(self._draw, runs))

    def _draw(self, runs: dict[float, Carried], times: np.ndarray, width: int, height: int) -> Generator[np.ndarray]:
        sheet, can = Sheet(width, height), standing()
        top, below = round(HEIGHT * sheet.unit), round(STRIP * sheet.unit)
        display = Display([sliding(0.0)] * len(runs), _APART, lines=(0.0, _DISTANCE))
        corners = [_OUTLINE + np.array([x, y, _HIGH]) for x in (_LEFT, _DISTANCE) for y in (0.0, _APART)]
        view = View.towards(_EYE, np.reshape(corners, (-1, 3)), (width, height - top - below), top, 0.02)
        lines = [Line(f"moved in {each:g} s", run.time, run.force, MOVES[each]) for each, run in runs.items()]
        lines += [Line("solid beer", run.time, (can.mass + can.can.mass) * run.acceleration) for run in runs.values()]
        strip = ChartStrip([Chart("force [N]", lines)], width, below)
        display.draw_empty(sheet, view)
        empty = sheet.part(top, height - below)
        for time in times:
            sheet.put(empty, top)
            for lane, (duration, run) in reversed(list(enumerate(runs.items()))):
                place = np.array([np.interp(time, run.time, run.place), lane * _APART, _HIGH])
                display.shade(sheet, view, place + _OUTLINE)
                rise = float(np.interp(time, run.time, run.rise))
                _draw_gripper(sheet, view, display, can, place, rise, np.array(MOVES[duration]))
                highest = np.abs(run.rise[run.time <= time]).max()
                trust = "only a picture" if highest > QUANTITATIVE else "within 0.1 R"
                said, side = (f"in {duration:g} s", f"rises by {highest:.2f} R: {trust}"), [-0.065, 0, can.height]
                sheet.plate(view.pixel(place + np.array(side)), said, MOVES[duration], (1, 0.5))
            draw_title(sheet, self.title, "half a 12-oz can of beer, carried 0.4 m", time, self.speed)
            strip.draw(sheet, time, height - below)
            yield sheet.picture()


def _draw_gripper(
    sheet: Sheet, view: View, display: Display, can: Standing, place: np.ndarray, rise: float, colour: np.ndarray
) -> None:
    """Draw a gripper with pads of a colour, and its can with the bottom at a `place` [m], cut open in front; the liquid
    is higher by `rise` radii at the wall ahead."""
    length, wall = can.can.length, (1 + WALL) * can.can.radius
    assert abs(rise) * wall < min(can.height, length - can.height), "the surface reaches the lid or the bottom"
    metal, beer = (display.model.mat(name).rgba[:3] for name in ("metal", "beer"))

    def face(corners: np.ndarray, colour: np.ndarray, normal: np.ndarray) -> None:
        sheet.area(view.pixel(place + corners), display.lit(colour, normal, view))

    around = np.insert(circle(1.0, 2 * _PLATES), 2, 0.0, axis=1)  # directions: first behind the axis, then before it
    surface = wall * around + np.outer(can.height + rise * wall * around[:, 0], [0, 0, 1])
    for first in range(2 * _PLATES):  # the wall behind, from inside, and the liquid before it
        behind, two = first < _PLATES, slice(first, first + 3, 2)  # each overlaps with the next, so that no gap is seen
        high = wall * around[two] + [0, 0, length] if behind else surface[two]
        side = (metal, -around[first]) if behind else (beer, around[first])
        face(np.concatenate([wall * around[two], high[::-1]]), *side)
    face(surface, beer, np.array([-rise, 0, 1]))
    for limit in (-QUANTITATIVE, QUANTITATIVE):
        line = wall * around[_PLATES:] + [0, 0, can.height + limit * can.can.radius]
        sheet.line(view.pixel(place + line), 0.12 * sheet.unit, INK)
    boxes = [(side * (wall + 0.005), length / 2, [0.004, 0.012, 0.03], colour) for side in (-1, 1)]
    boxes += [(side * (wall + 0.014), length / 2 + 0.03, [0.005, 0.01, length / 2], _STEEL) for side in (-1, 1)]
    boxes += [(0.0, length + 0.03, [wall + 0.024, 0.014, 0.008], _STEEL)]
    for x, z, half, paint in boxes:
        centre = np.array([x, 0.0, z])
        for axis in (0, 2, 1):  # of each two sides the one that is turned to the eye, and the front at last
            normal = np.sign(view.eye - place - centre)[axis] * np.eye(3)[axis]
            one, other = np.delete(np.eye(3), axis, axis=0)
            corners = normal + np.array([-one - other, one - other, one + other, other - one])
            face(centre + half * corners, paint, normal)
