"""A can that is carried by a gripper, and the film of a gentle and a quick move."""

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
from mjbeer.model.attach import surface_slope
from mjbeer.model.build import build
from mjbeer.model.looks import WALL
from mjbeer.theory.paper_scenes import sliding
from mjbeer.theory.standing import QUANTITATIVE, Standing, standing

_TIMESTEP = 5e-4
"""[s]."""
_DISTANCE = 0.4
"""How far the grippers move [m]."""
_DURATION = 2.4
"""How long the film watches them [s]."""
_LANE = 0.34
"""Distance of the grippers from each other [m]."""
_HEIGHT = 0.015
"""How high above the board the bottoms of the cans are held [m]."""
_BEGIN = -0.3
"""How far to the right the place is that the left edge of the picture shows [m]."""
_CLOSE_UP = np.array([10.5, 8.0])
"""Width and height of a close-up, in units of the sheet."""
_NEAR_EYE = np.array([0.0, -0.45, 0.06])
"""Where the eye of a close-up is from the middle of the surface [m]."""
_EYE = np.array([0.1, -2.2, 1.5])
"""Where the eye is [m]."""
_FACES = 24
"""Number of flat faces around half a can."""
_STEEL = np.array([0.32, 0.36, 0.42])
_CORNERS = ((-0.06, 0.0), (0.06, 0.0), (0.06, 0.19), (-0.06, 0.19))
_OUTLINE = np.array([[(x, y, z) for x, z in _CORNERS] for y in (-0.034, 0.034)])
"""A box around a gripper and its can: its near and its far side, from the bottom of the can [m]."""


class Carried(NamedTuple):
    """What a gripper feels, and what the liquid does; arrays have the shape (steps,)."""

    time: np.ndarray
    """[s]."""
    place: np.ndarray
    """Place of the can [m]."""
    acceleration: np.ndarray
    """Acceleration of the can [m/s^2]."""
    force: np.ndarray
    """Level force of the gripper on the can [N]."""
    rise: np.ndarray
    """How high the surface rises at the wall ahead, by all modes that move, divided by R."""


def carry(
    can: Standing, distance: float = _DISTANCE, duration: float = 1.0, after: float = 1.0
) -> Carried:
    """Return the motion of a can that is moved by a `distance` [m] in a `duration` [s].

    It is then held for `after` [s]. The move has the least jerk that starts and ends at rest. In
    the frame of the gripper the can stands still, and gravity is tilted by the acceleration: so the
    gripper is rigid.
    """
    model = build(can, free=False, timestep=_TIMESTEP)
    data = mujoco.MjData(model)
    body = model.body("can").id
    time = _TIMESTEP * np.arange(round((duration + after) / _TIMESTEP) + 1)
    place, acceleration = minimum_jerk(time, distance, duration)
    # A step takes the gravity of its middle.
    _, half_step_later = minimum_jerk(time + _TIMESTEP / 2, distance, duration)
    force = np.empty_like(time)
    rise = np.empty_like(time)
    for step in range(len(time)):
        model.opt.gravity[0] = -acceleration[step]
        mujoco.mj_forward(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        force[step] = data.cfrc_int[body, 3]  # along x; the three moments come first
        rise[step] = surface_slope(model, data, "")[0]
        model.opt.gravity[0] = -half_step_later[step]
        mujoco.mj_step(model, data)
    return Carried(time, place, acceleration, force, rise)


def minimum_jerk(
    time: np.ndarray, distance: float, duration: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return place [m] and acceleration [m/s^2] of a move with the least jerk, at times [s]."""
    share = np.clip(time / duration, 0.0, 1.0)
    place = distance * share**3 * (10 - 15 * share + 6 * share**2)
    acceleration = distance / duration**2 * 60 * share * (1 - share) * (1 - 2 * share)
    return place, acceleration


class Move(NamedTuple):
    """A move in the film."""

    duration: float
    """[s]."""
    colour: tuple[float, float, float]


MOVES = (Move(1.0, (0.80, 0.15, 0.20)), Move(1.6, (0.05, 0.40, 0.75)))
"""The quick move, which is in front, and the gentle one."""


@dataclass(frozen=True)
class Carry(Film):
    """The film of two cans that are moved 0.4 m, one quickly and one gently."""

    title: str = "Two grippers carry beer: which of them feels it slosh?"
    speed: float = 0.5
    still: float = 0.25
    hold: float = 1.0
    caption: str = (
        "Two cans, half full of beer, are carried 0.4 m, in 1 s and in 1.6 s. The charts show "
        "each gripper's force on its can, the part of it that sloshing adds to what a rigid can "
        "needs, and how high the surface stands at the wall ahead. The black rings are 3.3 mm "
        "above and below the surface at rest, a tenth of the radius: between them the theory of "
        "small waves holds, on which the model rests. In the gentle move the surface rises by 3.0 "
        "mm, and the beer hardly sloshes after the stop. In the quick move it rises by 9.4 mm, "
        "far beyond the rings: that the force is then 0.55 N in place of 0.50 N, a tenth more, "
        "and that a tenth of it goes on after the stop, is an estimate."
    )

    def plan(self) -> RenderPlan:
        can = standing()
        runs = [
            carry(can, duration=move.duration, after=_DURATION - move.duration) for move in MOVES
        ]
        draw = partial(self._draw, can, runs)
        return RenderPlan(0.0, _DURATION, self.speed, draw, self.hold)

    def _draw(
        self, can: Standing, runs: list[Carried], times: np.ndarray, width: int, height: int
    ) -> Generator[np.ndarray]:
        sheet = Sheet(width, height)
        top = round(HEIGHT * sheet.unit)
        below = round(STRIP * sheet.unit)
        display = Display([sliding(0.0)] * len(MOVES), _LANE, lines=(0.0, _DISTANCE))
        view = _view((width, height - top - below), top)
        pen = _Pen(sheet, view, display)
        strip = ChartStrip(_charts(can, runs), width, below)
        display.scenery.draw(sheet, view)
        empty = sheet.part(top, height - below)
        for time in times:
            sheet.put(empty, top)
            for lane in reversed(range(len(MOVES))):  # the nearest comes last
                _draw_move(pen, can, lane, runs[lane], time)
            words = f"half a 12-oz can of beer, carried {_DISTANCE:g} m"
            draw_title(sheet, self.title, words, time, self.speed)
            for lane in range(len(MOVES)):
                _draw_close_up(pen, can, lane, runs[lane], time)
            strip.draw(sheet, time, height - below)
            yield sheet.picture()


def _view(pixels: tuple[int, int], top: int) -> View:
    """Return the view of both moves from their starts to their ends."""
    corners = [
        _OUTLINE + np.array([x, y, _HEIGHT]) for x in (_BEGIN, _DISTANCE) for y in (0.0, _LANE)
    ]
    return View.towards(_EYE, np.reshape(corners, (-1, 3)), pixels, top, 0.02)


def _charts(can: Standing, runs: list[Carried]) -> list[Chart]:
    """Return charts of the forces, of what the slosh adds to them, and of the surface."""
    mass = can.mass + can.can.mass
    whole_time = runs[0].time[[0, -1]]
    radius = 1e3 * can.can.radius  # [mm]
    limit = radius * QUANTITATIVE
    forces = []
    added = []
    rises = [
        Line(f"black rings, ±{limit:.1f} mm", whole_time, np.full(2, height), thin=True)
        for height in (-limit, limit)
    ]
    for move, run in zip(MOVES, runs, strict=True):
        name = f"moved in {move.duration:g} s"
        forces.append(Line(name, run.time, run.force, move.colour))
        added.append(Line(name, run.time, run.force - mass * run.acceleration, move.colour))
        rises.append(Line(name, run.time, radius * run.rise, move.colour))
    return [
        Chart("force on the can [N]", forces),
        Chart("of it, by sloshing [N]", added),
        Chart("surface ahead [mm]", rises),
    ]


class _Pen(NamedTuple):
    """Draws lit faces of things in space onto a sheet."""

    sheet: Sheet
    view: View
    display: Display

    def face(self, corners: np.ndarray, colour: np.ndarray, normal: np.ndarray) -> None:
        """Fill the face between some corners [m], shape (n, 3)."""
        lit = self.display.scenery.lit(colour, normal, self.view)
        self.sheet.area(self.view.pixel(corners), lit)

    def box(self, centre: np.ndarray, half: np.ndarray, colour: np.ndarray) -> None:
        """Draw a box with a centre and half its sizes [m]."""
        for axis in (0, 2, 1):  # the front comes last
            # Of two opposite sides, the one that faces the eye is seen.
            normal = np.sign(self.view.eye - centre)[axis] * np.eye(3)[axis]
            across, upward = np.delete(np.eye(3), axis, axis=0)
            corners = np.array(
                [-across - upward, across - upward, across + upward, upward - across]
            )
            self.face(centre + half * (normal + corners), colour, normal)


def _draw_move(pen: _Pen, can: Standing, lane: int, run: Carried, time: float) -> None:
    """Draw a gripper and its can at a `time` [s]."""
    move = MOVES[lane]
    place = np.array([np.interp(time, run.time, run.place), lane * _LANE, _HEIGHT])
    pen.display.scenery.shade(pen.sheet, pen.view, place + _OUTLINE)
    _draw_can(pen, can, place, float(np.interp(time, run.time, run.rise)))
    _draw_gripper(pen, can, place, np.array(move.colour))


def _draw_close_up(pen: _Pen, can: Standing, lane: int, run: Carried, time: float) -> None:
    """Draw the surface of a can at a `time` [s] at the left edge, with its highest rise."""
    sheet = pen.sheet
    unit = sheet.unit
    width, height = np.round(_CLOSE_UP * unit).astype(int)
    small = Sheet(int(width), int(height))
    surface = np.array([0.0, 0.0, can.height])
    half = 1.15 * can.can.radius
    corners = surface + np.array([[-half, 0, 0], [half, 0, 0]])
    view = View.towards(surface + _NEAR_EYE, corners, (int(width), int(height)), 0, 0.0)
    small.blank(0, int(height))
    near = pen._replace(sheet=small, view=view)
    _draw_can(near, can, np.zeros(3), float(np.interp(time, run.time, run.rise)))

    highest = np.abs(run.rise).max()
    is_small = highest <= QUANTITATIVE
    where = "between" if is_small else "beyond"
    trust = "the numbers hold" if is_small else "an estimate only"
    move = MOVES[lane]
    row = len(MOVES) - 1 - lane  # the far one is above
    left = 0.6 * unit
    top = (HEIGHT + 0.6) * unit + row * (height + 1.6 * unit)
    sheet.composite(small.part(0, int(height)), round(left), round(top))
    lines = [
        f"in {move.duration:g} s",
        f"rises by up to {1e3 * can.can.radius * highest:.1f} mm,",
        f"{where} the black rings:",
        trust,
    ]
    sheet.plate(np.array([left + width, top]), lines, move.colour, (0, 0))


def _draw_can(pen: _Pen, can: Standing, place: np.ndarray, rise: float) -> None:
    """Draw a can with the bottom at a `place` [m], cut open in front.

    The liquid is higher by `rise` radii at the wall ahead.
    """
    length = can.can.length
    wall = (1 + WALL) * can.can.radius
    room = min(can.height, length - can.height)
    assert abs(rise) * wall < room, "the surface reaches the lid or the bottom"
    metal = pen.display.model.mat("metal").rgba[:3]
    beer = pen.display.model.mat("beer").rgba[:3]
    # Unit vectors from the axis: first those to the half behind it, then those to the front half.
    around = np.insert(circle(1.0, 2 * _FACES), 2, 0.0, axis=1)
    bottom = place + wall * around
    lid = bottom + np.array([0, 0, length])
    surface = bottom + np.outer(can.height + rise * wall * around[:, 0], [0, 0, 1])
    for first in range(2 * _FACES):
        edges = slice(first, first + 3, 2)  # a face overlaps the next, so that no gap is seen
        if first < _FACES:  # the inside of the wall at the back
            inside = np.concatenate([bottom[edges], lid[edges][::-1]])
            pen.face(inside, metal, -around[first])
        else:  # the liquid, where the wall is cut away
            front = np.concatenate([bottom[edges], surface[edges][::-1]])
            pen.face(front, beer, around[first])
    pen.face(surface, beer, np.array([-rise, 0, 1]))
    for limit in (-QUANTITATIVE, QUANTITATIVE):
        height = can.height + limit * can.can.radius
        line = bottom[_FACES:] + np.array([0, 0, height])
        pen.sheet.line(pen.view.pixel(line), 0.12 * pen.sheet.unit, INK)


def _draw_gripper(pen: _Pen, can: Standing, place: np.ndarray, colour: np.ndarray) -> None:
    """Draw a gripper, with pads of a colour, that holds a can with the bottom at a `place` [m]."""
    length = can.can.length
    wall = (1 + WALL) * can.can.radius
    # Half the sizes of its parts [m]; where they are leaves gaps that are seen.
    pad = np.array([0.004, 0.012, 0.03])
    arm = np.array([0.005, 0.01, length / 2])
    bridge = np.array([wall + 0.024, 0.014, 0.008])
    for side in (-1, 1):
        pen.box(place + np.array([side * (wall + 0.005), 0, length / 2]), pad, colour)
    for side in (-1, 1):
        pen.box(place + np.array([side * (wall + 0.014), 0, length / 2 + 0.03]), arm, _STEEL)
    pen.box(place + np.array([0, 0, length + 0.03]), bridge, _STEEL)
