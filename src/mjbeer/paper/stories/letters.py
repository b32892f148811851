"""A sketch of a can on its incline, with the letters of the formulas."""

import math
import pathlib

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc

from mjbeer.output.plots import COLOURS, chart
from mjbeer.theory.load import segment

_INCLINE, _PHI = math.radians(18), math.radians(35)
"""Angles of the sketch [rad]: steep enough to be seen."""
_DOWNHILL = np.array([math.cos(_INCLINE), -math.sin(_INCLINE)])
_AWAY = np.array([math.sin(_INCLINE), math.cos(_INCLINE)])
_LENGTH, _WAY = 5.4, 3.2
"""Length of the incline, and how far the can has rolled down it, in radii of the can."""
_FORCE, _LETTER = COLOURS[1], COLOURS[0]


def draw(path: pathlib.Path) -> None:
    """Draw the sketch as `path` with .svg and with .png.

    Raises:
      OutputError: if a file cannot be written.
    """
    with chart(path, width=6.4, height=3.9) as (axes,):
        axes.set_axis_off()
        axes.set_aspect("equal")
        axis = _WAY * _DOWNHILL + _AWAY
        _incline(axes)
        _can(axes, axis)
        _lengths(axes, axis)
        _forces(axes, axis)


def _incline(axes: Axes) -> None:
    """Draw the incline, the horizontal at its foot, and the angle α between them."""
    foot = _LENGTH * _DOWNHILL
    axes.plot(*np.transpose([-0.5 * _DOWNHILL, foot]), color="black", linewidth=2)
    axes.plot([foot[0] - 1.9, foot[0]], [foot[1], foot[1]], color="black", linewidth=1)
    angle = math.degrees(_INCLINE)
    axes.add_patch(Arc(tuple(foot), 3, 3, theta1=180 - angle, theta2=180, color=_LETTER))
    _write(axes, "α", foot + np.array([-1.72, 0.2]))


def _can(axes: Axes, axis: np.ndarray) -> None:
    """Draw the can, the half of it that beer fills, and the angle φ of the beer's surface to the incline."""
    around = np.linspace(0, 2 * math.pi, 361)
    axes.plot(*(axis[:, None] + [np.cos(around), np.sin(around)]), color="black", linewidth=1.5)
    tilt = -_INCLINE - _PHI  # of the surface to the horizontal: positive φ is clockwise, as the can rolls
    below = tilt - np.linspace(0, math.pi, 181)
    axes.fill(*(axis[:, None] + [np.cos(below), np.sin(below)]), color="#E8A33D", alpha=0.6, linewidth=0)
    surface = np.array([math.cos(tilt), math.sin(tilt)])
    axes.plot(*np.transpose([axis - surface, axis + surface]), color="#A05A00", linewidth=1.5)
    axes.plot(*np.transpose([axis - 1.3 * _DOWNHILL, axis + 1.5 * _DOWNHILL]), "--", color="grey", linewidth=0.8)
    start, end = math.degrees(tilt), math.degrees(-_INCLINE)
    axes.add_patch(Arc(tuple(axis), 1.5, 1.5, theta1=start, theta2=end, color=_LETTER))
    middle = math.radians((start + end) / 2)
    _write(axes, "φ", axis + 0.9 * np.array([math.cos(middle), math.sin(middle)]))


def _lengths(axes: Axes, axis: np.ndarray) -> None:
    """Draw the radius a, the distance b of the beer's centre of mass from the axis, and the way u of the axis."""
    down = -_INCLINE - _PHI - math.pi / 2
    centre = axis + segment(0.5).offset * np.array([math.cos(down), math.sin(down)])
    axes.plot(*axis, "o", color="black", markersize=3)
    axes.plot(*centre, "o", color="black", markersize=6)
    axes.plot(*np.transpose([axis, centre]), color=_LETTER)
    _write(axes, "b", (axis + centre) / 2 + [-0.16, 0.06])
    up = 0.5
    rim = axis + np.array([math.cos(up), math.sin(up)])
    axes.plot(*np.transpose([axis, rim]), color=_LETTER)
    _write(axes, "a", (axis + rim) / 2 + [-0.08, 0.14])
    above = 2.15 * _AWAY
    for end in (np.zeros(2), _WAY * _DOWNHILL):
        axes.plot(*np.transpose([end + 0.1 * _AWAY, end + above + 0.08 * _AWAY]), ":", color="grey", linewidth=0.8)
    _arrow(axes, above, _WAY * _DOWNHILL + above, _LETTER)
    _write(axes, "u", _WAY / 2 * _DOWNHILL + 2.35 * _AWAY)


def _forces(axes: Axes, axis: np.ndarray) -> None:
    """Draw the forces N and F of the incline on the can, and the direction of gravity."""
    touch = axis - _AWAY
    _arrow(axes, touch - 0.9 * _AWAY, touch, _FORCE)
    _write(axes, "N", touch - 0.6 * _AWAY + [-0.2, 0], _FORCE)
    under = touch - 0.07 * _AWAY
    _arrow(axes, under, under - 0.9 * _DOWNHILL, _FORCE)
    _write(axes, "F", touch - 0.75 * _DOWNHILL - 0.27 * _AWAY, _FORCE)
    corner = np.array([_LENGTH * _DOWNHILL[0] - 0.2, 0.9])
    _arrow(axes, corner, corner - [0, 0.9], _FORCE)
    _write(axes, "g", corner + np.array([0.2, -0.5]), _FORCE)


def _arrow(axes: Axes, start: np.ndarray, end: np.ndarray, colour: str) -> None:
    style = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "linewidth": 1.4}
    axes.annotate("", tuple(end), tuple(start), arrowprops=style)


def _write(axes: Axes, letter: str, place: np.ndarray, colour: str = _LETTER) -> None:
    axes.text(place[0], place[1], letter, color=colour, fontsize=15, style="italic", ha="center", va="center")
