"""A can that is carried by a gripper that holds it upright, and the film of a gentle and a quick move."""

from collections.abc import Generator
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.drawing.camera import View
from mjbeer.drawing.carried import CarriedCans
from mjbeer.drawing.film import RenderPlan
from mjbeer.drawing.overlay import HEIGHT, STRIP, head
from mjbeer.drawing.scene import Painter, Scenery
from mjbeer.drawing.sheet import INK, Sheet
from mjbeer.drawing.strip import Chart, Line, Strip
from mjbeer.model.build import build
from mjbeer.theory.scenes import sliding
from mjbeer.theory.standing import QUANTITATIVE, Standing, standing

_FORCE_X = 3
"""Place of the level force in MuJoCo's force of a body on its parent: the moment comes first."""
_DISTANCE, _LONGEST = 0.4, 2.4  # way of the grippers [m], and how long the film watches them [s]


@dataclass(frozen=True, eq=False)
class Carried:
    """What a gripper feels, and what the liquid does; arrays have the shape (steps,)."""

    time: np.ndarray
    """[s]"""
    place: np.ndarray
    """Place of the can [m]."""
    acceleration: np.ndarray
    """Acceleration of the can [m/s^2]."""
    force: np.ndarray
    """Level force of the gripper on the can [N]."""
    rise: np.ndarray
    """How high the surface rises at the wall ahead, by all modes that move, over the radius."""


def carry(
    can: Standing, distance: float = _DISTANCE, duration: float = 1.0, after: float = 1.0, timestep: float = 5e-4
) -> Carried:
    """Return the motion of a can that is moved by a `distance` [m] in a `duration` [s], and then held for `after` [s].

    The move has the least jerk that starts and ends at rest. In the frame of the gripper the can stands still and
    gravity is tilted by the acceleration, so that the gripper is as rigid as can be.
    """
    model = build(can, free=False, timestep=timestep)
    data, body = mujoco.MjData(model), model.body("can").id
    time = timestep * np.arange(round((duration + after) / timestep) + 1)
    place, acceleration = minimum_jerk(time, distance, duration)
    _, pushed = minimum_jerk(time + timestep / 2, distance, duration)  # a step has the gravity of its middle
    force, rise = np.empty_like(time), np.zeros_like(time)
    for step, now in enumerate(acceleration):
        model.opt.gravity[0] = -now
        mujoco.mj_forward(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        force[step] = data.cfrc_int[body, _FORCE_X]
        rise[step] = sum(data.sensor(f"slosh{mode}_rise").data[0] for mode in range(1, can.modes + 1))
        model.opt.gravity[0] = -pushed[step]
        mujoco.mj_step(model, data)
    return Carried(time, place, acceleration, force, rise)


def minimum_jerk(time: np.ndarray, distance: float, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Return place [m] and acceleration [m/s^2] of a move with the least jerk, at times [s] of shape (times,)."""
    share = np.clip(time / duration, 0.0, 1.0)
    place = distance * share**3 * (10 - 15 * share + 6 * share**2)
    return place, distance / duration**2 * 60 * share * (1 - share) * (1 - 2 * share)


class Move(NamedTuple):
    """A move of the film."""

    duration: float  # [s]
    name: str
    colour: tuple[float, float, float]


QUICK, GENTLE = Move(1.0, "in 1 s", (0.80, 0.15, 0.20)), Move(1.6, "in 1.6 s", (0.05, 0.40, 0.75))


@dataclass(frozen=True)
class Carry:
    """The film of two cans that are moved 0.4 m, one quickly and one gently; it is a `drawing.film.Film`."""

    title: str = "Two grippers carry beer: which of them feels it slosh?"
    speed: float = 0.5
    still: float = 0.25
    caption: str = (
        "Two cans, half full of beer, are carried 0.4 m: the near one in 1 s, the far one in 1.6 s. The chart has "
        "the force of each gripper, and in grey what it would be if the beer were solid, as in other simulators. In "
        "the gentle move the surface rises by less than 0.1 R at the wall, where linear theory gives numbers, and the "
        "beer hardly rings after the stop. In the quick move it rises by 0.28 R, which is beyond that: the extra force "
        "and the ringing, a tenth of the largest force each, are then more of a picture than numbers."
    )

    def plan(self) -> RenderPlan:
        """Compute both motions, and return what is needed to draw them."""
        moves = {
            move: carry(standing(), duration=move.duration, after=_LONGEST - move.duration) for move in (QUICK, GENTLE)
        }
        return RenderPlan(0.0, _LONGEST, self.speed, partial(self._draw, moves))

    def _draw(self, moves: dict[Move, Carried], times: np.ndarray, width: int, height: int) -> Generator[np.ndarray]:
        sheet, ground = Sheet(width, height), sliding(0.0)
        top, below = round(HEIGHT * sheet.unit), round(STRIP * sheet.unit)
        cans = CarriedCans.held(standing(modes=0), [move.colour for move in moves], _APART)
        points = [cans.outline(number, np.array([x])).reshape(-1, 3) for number in (0, 1) for x in (_LEFT, _DISTANCE)]
        view = View.towards(_EYE, np.concatenate(points), (width, height - top - below), 0.02)
        strip = Strip([Chart("force [N]", _lines(moves))], width, below)
        words = self.title, f"half a 12-oz can of beer, carried {_DISTANCE:g} m"
        scenery = Scenery(ground, cans.model, (0.0, _DISTANCE))
        with closing(Painter(cans, scenery, *view.pixels, still=True)) as painter:
            for time in times:
                sheet.boxes.clear()
                now = [
                    [np.interp(time, run.time, run.place), np.interp(time, run.time, run.rise)]
                    for run in moves.values()
                ]
                painter.paint(sheet, view, np.array(now), top)
                for number, ((move, run), (x, _)) in enumerate(zip(moves.items(), now, strict=True)):
                    for rise in (-QUANTITATIVE, QUANTITATIVE):
                        sheet.line(view.pixel(cans.wall(number, x, rise), top), 0.12 * sheet.unit, INK)
                    highest = np.abs(run.rise[run.time <= time]).max()
                    trust = "only a picture" if highest > QUANTITATIVE else "within 0.1 R"
                    place = view.pixel(cans.wall(number, x, 0.0)[0] - [0.03, 0, 0], top)
                    told = f"rises by {highest:.2f} R: {trust}"
                    sheet.plate(place, [(move.name, True, move.colour), (told, False, INK)], (1, 0.5))
                head(sheet, words, time, self.speed)
                strip.draw(sheet, time, height - below)
                yield sheet.picture()


_APART, _LEFT = 0.34, -0.26
_EYE = np.array([0.1, -2.2, 1.5])


def _lines(moves: dict[Move, Carried]) -> list[Line]:
    """Return the forces over time, and those of solid beer."""
    lines = [Line(f"moved {move.name}", run.time, run.force, move.colour) for move, run in moves.items()]
    for run in moves.values():
        whole = standing()
        lines.append(Line("solid beer", run.time, (whole.mass + whole.can.mass) * run.acceleration))
    return lines
