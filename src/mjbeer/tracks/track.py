"""The track of a filmed can, and the tables of Tracker, Logger Pro, Capstone and phyphox."""

import csv
import itertools
import math
import os
import pathlib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.tracks.board import Line, line_through, perspective

_FEWEST_POINTS = 12
"""The fewest points of a track: twice the usual number of unknowns of a fit."""


@dataclass(frozen=True, eq=False)
class Track:
    """Where a filmed can was, and when; all arrays have the shape (points,).

    `time` is by any clock [s]. `along` is the place of the can's axis along the incline [m], and
    `roll` is the angle of a mark on the can [rad]: both may begin anywhere, and grow downhill.
    `phi` is the load's angle to the incline [rad]. `scale_error` is the relative standard error of
    all distances, as it follows from marks on the board; 0 if none is known.

    Raises:
      ParameterError: if an array is not finite, they differ in length, the times do not increase,
        there are fewer than 12 points, or all are in one place.
    """

    time: np.ndarray
    along: np.ndarray
    roll: np.ndarray | None = None
    phi: np.ndarray | None = None
    scale_error: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        for name in ("time", *self.channels):
            array = require.samples(name, getattr(self, name))
            require.set_fields(self, **{name: array})
            if len(array) != len(self.time):
                count = f"{len(self.time)}, got {len(array)}"
                raise ParameterError(f"{name} must have as many entries as time, {count}")
        scale_error = require.non_negative("scale_error", self.scale_error)
        require.set_fields(self, scale_error=scale_error)
        enough = len(self.time) >= _FEWEST_POINTS
        later = bool((np.diff(self.time) > 0).all())
        moved = bool(np.ptp(self.along) > 0)
        if not (enough and later and moved):
            allowed = f"{_FEWEST_POINTS} points or more, ever later and not all in one place"
            got = f"{len(self.time)} from {self.time[0]:g} s to {self.time[-1]:g} s"
            raise ParameterError(f"a track has {allowed}, got {got}")

    @property
    def channels(self) -> tuple[str, ...]:
        """The names of the arrays that were tracked: "along", and perhaps "roll" and "phi"."""
        angles = [name for name in ("roll", "phi") if getattr(self, name) is not None]
        return ("along", *angles)


class _Column(NamedTuple):
    """A quantity that a column may have: its units in terms of SI's, and its usual headings."""

    units: dict[str, float]
    usual: str
    """A pattern that matches the usual headings."""


class _Used(NamedTuple):
    """The index of a column that is read, and the size of its unit in SI's."""

    index: int
    in_si: float


class _Cell(NamedTuple):
    """The text of a cell, and its line and column for messages."""

    text: str
    place: str


_LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}
_ANGLES = {"rad": 1.0, "deg": math.pi / 180, "°": math.pi / 180}
_COLUMNS = {
    "time": _Column({"s": 1.0, "ms": 1e-3, "min": 60.0}, "t|time"),
    "frame": _Column({}, "frames?|steps?"),
    "x": _Column(_LENGTHS, "x|along|distance|position|position x|x position|u|s"),
    "y": _Column(_LENGTHS, "y|position y|y position"),
    "roll": _Column(_ANGLES, "roll"),
    "phi": _Column(_ANGLES, "phi|φ"),
}
"""The quantities that are read. `docs/live.html` has the same table."""
_PIXELS = {"px": 1.0, "pixel": 1.0, "pixels": 1.0}
"""The units of x and y in a picture."""
_TITLE = re.compile(
    r"(?:latest *:)?(?:run *#?\d+ *[:|])? *([^\[(]*[^\[( ])? *(?:[\[(] *(.*?) *[\])])?"
)
"""A heading: perhaps the number of a run, the name of the quantity, its unit in brackets."""
_POINT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)
"""A number with a decimal point, such as 1234.5, or a whole one."""
_COMMA = re.compile(r"[-+]?(\d+,\d*|,\d+)(e[-+]?\d+)?", re.IGNORECASE)
"""A number with a decimal comma, such as 1234,5."""
_GROUPED = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?")
"""A number with commas between thousands, such as 1,234.5. Alone, 1,234 may be 1.234 or 1234."""


def read_track(
    path: str | os.PathLike[str],
    columns: Mapping[str, str | int] | None = None,
    rate: float | None = None,
    scale: float | None = None,
    marks: Sequence[Sequence[float]] | None = None,
) -> Track:
    """Return the track in a table: a text with tabs, semicolons, commas or spaces between columns.

    Numbers may have decimal commas, or commas between thousands, if other numbers show which of the
    two they are. Lines above the last heading are ignored, and rows with an empty cell are left
    out. Units stand in brackets in the headings; without them they are s, m and rad. If the table
    has x and y, places are measured along the straight line through all points, in the direction in
    which the can went.

    Args:
      path: the file.
      columns: the headings, or the numbers from 1 on, of the columns "time", "frame", "x", "y",
        "roll" and "phi"; columns with usual headings need not be named.
      rate: the rate of numbered frames [1/s].
      scale: pixels a metre, if the places in the table are in pixels of a camera that looked
        squarely at the board.
      marks: three or more points of the line along which the axis went, or of one beside it: x and
        y in the table's pixels, and the place on the board [m]. The places in the table are in
        pixels, too; their perspective is that of the marks.

    Raises:
      ParameterError: if the table cannot be read; the message has line and column.
    """
    source = require.path(path)
    in_pixels = ""
    if scale is not None:
        scale = require.positive("scale", scale, "pixels/m")
        in_pixels = f"a scale of {require.format_value(scale)} pixels/m"
    board = None
    if marks is not None:
        board = perspective(marks)
        if in_pixels:
            raise ParameterError(f"marks have a scale of their own, got {in_pixels} as well")
        in_pixels = "a board with marks in pixels"
    columns = require.instance("columns", {} if columns is None else columns, dict)
    rows = _rows(source)
    heading = _heading_line(source, rows)
    titles = rows[heading]
    data = {line: row for line, row in rows.items() if line > heading}
    used = _used_columns(f"{source}, line {heading}", titles, columns, in_pixels)
    if "frame" in used:
        interval = 1 / require.positive("rate of the frames", rate, "1/s")
        used["time"] = _Used(used.pop("frame").index, interval)
    cells = _cells(source, data, used, len(titles))
    comma = _meaning_of_commas(itertools.chain(*cells.values()))
    arrays = {}
    for name, column in cells.items():
        numbers = [_number(cell, comma) for cell in column]
        arrays[name] = used[name].in_si * np.array(numbers)
    for cell, interval in zip(cells["time"][1:], np.diff(arrays["time"]), strict=True):
        if interval <= 0:
            raise ParameterError(f"{cell.place}: this time is not later than the one before")
    if board and "y" not in arrays:
        raise ParameterError(f"{source}, line {heading}: with marks, x and y are needed")
    along = arrays["x"]
    scale_error = 0.0
    if "y" in arrays:
        points = np.stack([arrays["x"], arrays["y"]], axis=1)
        along = _line(source, points).places(points)
        if board:
            along = _downhill(board.places(points))
            scale_error = board.scale_error(points)
    if scale is not None:
        along = along / scale
    roll = arrays.get("roll")
    phi = arrays.get("phi")
    return Track(arrays["time"], along, roll, phi, scale_error=scale_error)


def _rows(source: pathlib.Path) -> dict[int, list[str]]:
    """Return the cells of the lines that are not empty, by the numbers of the lines."""
    lines = {}
    for number, line in enumerate(_text(source).splitlines(), start=1):
        if line.strip(" \t;,"):
            lines[number] = line
    delimiter = " "
    for mark in "\t;,":
        if 2 * sum(mark in line for line in lines.values()) > len(lines):
            delimiter = mark
            break
    rows = {}
    for number, line in lines.items():
        spaced = " ".join(line.split()) if delimiter == " " else line
        # Each line is read alone, so that a missing quotation mark spoils no other line.
        row = next(csv.reader([spaced], delimiter=delimiter, skipinitialspace=True))
        rows[number] = [cell.strip(' "') for cell in row]
    return rows


def _text(source: pathlib.Path) -> str:
    """Return the text of a file in UTF-8, or in UTF-16 with its mark, as spreadsheets write it."""
    try:
        raw = source.read_bytes()
    except OSError as error:
        name = require.format_value(str(source))
        raise ParameterError(f"cannot read {name}: {error.strerror or error}") from None
    marked = raw[:2] in (b"\xff\xfe", b"\xfe\xff")
    return raw.decode("utf-16" if marked else "utf-8-sig", errors="replace")


def _heading_line(source: pathlib.Path, rows: dict[int, list[str]]) -> int:
    """Return the number of the line above the first row with two numbers."""
    for above, line in itertools.pairwise(rows):
        if sum(_is_number(cell) for cell in rows[above]) > 1:
            break
        if sum(_is_number(cell) for cell in rows[line]) > 1:
            return above
    needed = "there must be a heading above two columns of numbers or more"
    raise ParameterError(f"{source} is no table: {needed}")


def _used_columns(
    place: str, titles: list[str], columns: Mapping[str, str | int], in_pixels: str
) -> dict[str, _Used]:
    """Return the columns that are read; `titles` are the headings, `place` their file and line.

    `in_pixels` is what turns places in pixels into ones in metres, or "" if they are in metres.
    """
    if not set(columns) <= set(_COLUMNS):
        got = require.format_value(columns)
        raise ParameterError(f"columns are those of {', '.join(_COLUMNS)}, got {got}")
    used = {}
    for name in _COLUMNS:
        index = _column_index(place, titles, name, str(columns.get(name, "")))
        if index is None or (name == "frame" and "time" in used):
            continue
        where = f"{place}, column {index + 1}"
        used[name] = _Used(index, _size_of_unit(where, titles[index], name, in_pixels))
    if "x" not in used or not used.keys() & {"time", "frame"}:
        needed = f"time and x are needed; say which columns they are, of {titles}"
        raise ParameterError(f"{place}: {needed}")
    return used


def _column_index(place: str, titles: list[str], name: str, asked: str) -> int | None:
    """Return the index of the column asked for, or else of one with a usual heading, or None."""
    usual = _COLUMNS[name].usual
    meant = [
        index for index, title in enumerate(titles) if _is_meant(title, index + 1, asked, usual)
    ]
    if len(meant) > 1 or (asked and not meant):
        found = f"{len(meant) or 'no'} columns may be {name}"
        raise ParameterError(f"{place}: {found}; say which by its number from 1, of {titles}")
    return meant[0] if meant else None


def _is_meant(title: str, number: int, asked: str, usual: str) -> bool:
    """Return whether a column has the heading or number asked for, or else a usual heading."""
    if asked:
        return asked in (title, str(number))
    heading, _ = _name_and_unit(title)
    return re.fullmatch(usual, heading) is not None


def _size_of_unit(where: str, title: str, name: str, in_pixels: str) -> float:
    """Return the size of a column's unit in SI's, which is 1 if its heading has no unit."""
    units = _COLUMNS[name].units
    instead = ""
    if name in ("x", "y"):
        instead = ", or pixels with a scale or marks"
        if in_pixels:
            units = _PIXELS
            instead = f" with {in_pixels}"
    _, unit = _name_and_unit(title)
    if unit and unit not in units:
        allowed = f"the unit of {name} is one of {', '.join(units)}{instead}"
        raise ParameterError(f"{where}: {allowed}, got {title!r}")
    return units.get(unit, 1.0)


def _name_and_unit(title: str) -> tuple[str, str]:
    """Return the name and the unit in a heading, each perhaps empty."""
    return _TITLE.findall(title.lower())[0]


def _cells(
    source: pathlib.Path, rows: dict[int, list[str]], used: dict[str, _Used], width: int
) -> dict[str, list[_Cell]]:
    """Return the cells of each column that is read, of rows of at most `width` cells.

    Rows in which one of them is empty are left out.
    """
    cells: dict[str, list[_Cell]] = {name: [] for name in used}
    for line, row in rows.items():
        if any(row[width:]):
            place = f"{source}, line {line}, column {width + 1}"
            hint = "are there commas within numbers?"
            raise ParameterError(f"{place}: {row[width]!r} has no heading; {hint}")
        if all(column.index < len(row) and row[column.index] for column in used.values()):
            for name, column in used.items():
                place = f"{source}, line {line}, column {column.index + 1}"
                cells[name].append(_Cell(row[column.index], place))
    return cells


def _is_number(text: str) -> bool:
    """Return whether a cell may be a number, whatever its commas mean."""
    return any(form.fullmatch(text) for form in (_POINT, _COMMA, _GROUPED))


def _meaning_of_commas(cells: Iterable[_Cell]) -> str | None:
    """Return what a comma means in these numbers: "decimal", "thousands", or None if unknown."""
    texts = [cell.text for cell in cells]
    if any(_COMMA.fullmatch(text) and not _GROUPED.fullmatch(text) for text in texts):
        return "decimal"
    if any("." in text or text.count(",") > 1 for text in texts):
        return "thousands"
    return None


def _number(cell: _Cell, comma: str | None) -> float:
    """Return the number in a cell; `comma` is what a comma means."""
    text = cell.text
    if comma is None and _GROUPED.fullmatch(text):
        either = f"{text!r} may be {text.replace(',', '.')} or {text.replace(',', '')}"
        unclear = "no number of this table tells which; write it with a point"
        raise ParameterError(f"{cell.place}: {either}, and {unclear}")
    decimal = comma == "decimal"
    if decimal and _is_number(text) and "." not in text and text.count(",") < 2:
        return float(text.replace(",", "."))
    if not decimal and (_POINT.fullmatch(text) or _GROUPED.fullmatch(text)):
        return float(text.replace(",", ""))
    among = ", as others here have decimal commas" if decimal and _is_number(text) else ""
    raise ParameterError(f"{cell.place}: {text!r} is no number{among}")


def _line(source: pathlib.Path, points: np.ndarray) -> Line:
    """Return the straight line through points, shape (points, 2), that are those of the axis."""
    try:
        return line_through("x and y", points)
    except ParameterError as error:
        hint = "track the can's axis, not a mark on its rim"
        raise ParameterError(f"{source}: {error}; {hint}") from None


def _downhill(places: np.ndarray) -> np.ndarray:
    """Return places [m] that grow in the direction in which the can went, as those of `_line`."""
    return places * math.copysign(1.0, places.mean() - places[0])
