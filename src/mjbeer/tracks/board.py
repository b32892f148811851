"""Places along a board, from points of its picture and from marks at known places on it.

A camera that looks obliquely at a board sees its far half smaller. A pinhole camera maps a straight
line to p = (a q + b)/(c q + 1), where q is the place on the line and p that on the line's picture;
so q = (p - b)/(a - c p). Marks at known places give a, b and c. The marks and the can are projected
at right angles on the straight line that comes nearest to the marks in the picture.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy import optimize

from mjbeer import require
from mjbeer.exceptions import ParameterError

_LARGEST_ASIDE = 0.02
"""Largest distance (rms) of points from their straight line, as a share of its length.

A mark on a can's rim is farther from its line on tracks of up to a metre.
"""
_FEWEST_MARKS = 3
_CLICK = 1.0
"""Standard error of a mark in the picture [pixels], unless the marks themselves show a larger
one."""
_LARGEST_MISFIT = 0.01
"""Largest distance (rms) of marks from a perspective, as a share of their length in the picture."""
_STRONGEST = 1.0
"""Largest c of a perspective in units of the board: one end is then seen nine times as large as the
other."""
_BEYOND = 0.25
"""How far the can may be beyond the last marks or beside their line, as a share of their length.

The errors of a perspective grow fast beyond its marks.
"""


class Line(NamedTuple):
    """The straight line with the least squares of the distances of some points from it."""

    middle: np.ndarray
    direction: np.ndarray
    """A unit vector, in the direction from the first of the points to the middle."""

    def places(self, points: np.ndarray) -> np.ndarray:
        """Return places along the line, from its middle on, of points of shape (points, 2)."""
        return (points - self.middle) @ self.direction

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Return the distances of points from the line."""
        across = np.array([-self.direction[1], self.direction[0]])
        return np.abs((points - self.middle) @ across)


def line_through(what: str, points: np.ndarray) -> Line:
    """Return the line through points, shape (points, 2).

    Raises:
      ParameterError: if they are not in one line; the message calls them `what`.
    """
    middle = points.mean(axis=0)
    _, sizes, directions = np.linalg.svd(points - middle, full_matrices=False)
    direction = directions[0]
    along = (points - middle) @ direction
    aside = sizes[1] / math.sqrt(len(points))
    if aside > _LARGEST_ASIDE * np.ptp(along):
        share = 100 * aside / np.ptp(along)
        raise ParameterError(f"{what} are {share:.2g} % of their length off a straight line (rms)")
    return Line(middle, direction * math.copysign(1.0, -along[0]))


@dataclass(frozen=True)
class Perspective:
    """The perspective of a board, which turns points of the picture into places on the board.

    In the formula at the head of this file, q is the distance from `centre` divided by `length`,
    and p is the place on the line divided by `seen_length`.
    """

    line: Line
    """The board's line in the picture."""
    ends: tuple[float, float]
    """Where on this line the outermost marks are [pixels]."""
    centre: float
    """The mean place of the marks on the board [m]."""
    length: float
    """The distance of the outermost marks on the board [m]."""
    coefficients: np.ndarray
    """a, b and c."""
    covariance: np.ndarray
    """Their covariance matrix."""

    @property
    def seen_length(self) -> float:
        """Return the distance of the outermost marks in the picture [pixels]."""
        return self.ends[1] - self.ends[0]

    def places(self, points: np.ndarray) -> np.ndarray:
        """Return the places on the board [m] of points in the picture, shape (points, 2).

        Raises:
          ParameterError: if they are far from the marks.
        """
        seen = self.line.places(points)
        beyond = np.abs(seen - np.clip(seen, *self.ends)).max()
        beside = self.line.distances(points).max()
        if max(beyond, beside) > _BEYOND * self.seen_length:
            far = f"{beyond:.0f} pixels beyond the last marks or {beside:.0f} beside their line"
            allowed = f"at most a quarter of their length of {self.seen_length:.0f} pixels"
            raise ParameterError(f"the can must be {allowed} away from the marks, got {far}")
        a, b, c = self.coefficients
        p = seen / self.seen_length
        return self.centre + self.length * (p - b) / (a - c * p)

    def scale_error(self, points: np.ndarray) -> float:
        """Return the relative standard error of the largest distance between points."""
        a, b, c = self.coefficients
        seen = self.line.places(points)
        p = np.array([seen.min(), seen.max()]) / self.seen_length
        q = (p - b) / (a - c * p)
        gradients = np.stack([-q, -np.ones(2), p * q]) / (a - c * p)
        change = np.diff(gradients, axis=1)[:, 0]
        error = math.sqrt(change @ self.covariance @ change)
        return error / float(np.ptp(q))


def perspective(marks: Any) -> Perspective:
    """Return the perspective of a board with marks, shape (marks, 3).

    Each mark has its x and y in the picture [pixels] and its place on the board [m].

    Raises:
      ParameterError: if the marks are fewer than three, not in one line, not in order, or not the
        picture of a board.
    """
    table = _sorted_table(marks)
    metres = table[:, 2]
    line = line_through("the marks", table[:, :2])
    seen = line.places(table[:, :2])
    if not (np.diff(seen) > 0).all():
        raise ParameterError("marks must be in the same order on the board and in the picture")
    centre = float(metres.mean())
    length = float(np.ptp(metres))
    seen_length = float(np.ptp(seen))
    # In these units all numbers are about 1, so that the least squares are well conditioned.
    q = (metres - centre) / length
    p = seen / seen_length
    start = [1.0, 0.0, 0.0]
    errors = np.full(len(p), _CLICK / seen_length)
    try:
        coefficients, covariance = optimize.curve_fit(
            _picture, q, p, start, errors, absolute_sigma=True
        )
    except RuntimeError:  # the search finds no end, as where marks are far off
        got = require.format_value(table)
        raise ParameterError(f"marks must be those of a straight board, got {got}") from None
    squares = float(((_picture(q, *coefficients) - p) ** 2).sum())
    spare = len(p) - len(coefficients)
    misfit = math.sqrt(squares / spare) if spare else 0.0
    if misfit > _LARGEST_MISFIT:
        off = f"marks are {100 * misfit:.2g} % of their length off any perspective (rms)"
        raise ParameterError(f"{off}: is one of them mistyped?")
    if abs(coefficients[2]) > _STRONGEST:
        allowed = "marks must be those of a camera that looks at the board, not along it"
        raise ParameterError(f"{allowed}, got {require.format_value(table)}")
    larger = max(1.0, misfit * seen_length / _CLICK)
    ends = (float(seen[0]), float(seen[-1]))
    return Perspective(line, ends, centre, length, coefficients, larger**2 * covariance)


def _sorted_table(marks: Any) -> np.ndarray:
    """Return the marks as an array of shape (marks, 3), in the order of their places."""
    try:
        table = np.asarray(marks)
    except ValueError:  # its rows differ in length
        table = np.empty(0)
    good = table.dtype.kind in "iuf" and table.ndim == 2 and table.shape[-1] == 3
    if not (good and len(table) >= _FEWEST_MARKS and np.isfinite(table).all()):
        allowed = f"{_FEWEST_MARKS} or more of x and y [pixels] and the place on the board [m]"
        raise ParameterError(f"marks must be {allowed}, got {require.format_value(marks)}")
    table = table[np.argsort(table[:, 2])].astype(float)
    if not (np.diff(table[:, 2]) > 0).all():
        got = require.format_value(table[:, 2])
        raise ParameterError(f"marks must be at different places on the board, got {got}")
    return table


def _picture(q: np.ndarray, a: float, b: float, c: float) -> np.ndarray:
    """Return where places on a line are seen on its picture."""
    return (a * q + b) / (c * q + 1)
