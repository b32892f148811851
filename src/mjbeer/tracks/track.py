"""The track of a filmed can, and the tables of Tracker, Logger Pro, Capstone and phyphox in which people have it."""

import csv
import math
import os
import pathlib
import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError

_LENGTHS, _ANGLES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}, {"rad": 1.0, "deg": math.pi / 180, "°": math.pi / 180}
_COLUMNS = {
    "time": ({"s": 1.0, "ms": 1e-3, "min": 60.0}, "t|time"),
    "frame": ({}, "frames?|steps?"),
    "x": (_LENGTHS, "x|along|distance|position|position x|x position|u|s"),
    "y": (_LENGTHS, "y|position y|y position"),
    "roll": (_ANGLES, "roll"),
    "phi": (_ANGLES, "phi|φ"),
}
"""What is read: the units that it may have, and its usual headings. `docs/live.html` has the same."""
_TITLE = re.compile(r"(?:latest *:)?(?:run *#?\d+ *[:|])? *([^\[(]*[^\[( ])? *(?:[\[(] *(.*?) *[\])])?")
"""How a heading begins: after which run it was, the name and the unit."""
_POINT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)  # 1234.5
_COMMA = re.compile(r"[-+]?(\d+,\d*|,\d+)(e[-+]?\d+)?", re.IGNORECASE)  # 1234,5
_GROUPED = re.compile(
    r"[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?"
)  # 1,234.5; of 1,234 nobody knows whether it is 1.234 or 1234


@dataclass(frozen=True, eq=False)
class Track:
    """Where a filmed can was, and when; all arrays have the shape (points,).

    `time` is by any clock [s]; `along` is the place of the axis along the incline [m] and `roll` the angle of a mark on
    the can [rad], both from anywhere and growing downhill; `phi` is the load's angle to the incline [rad].

    Raises:
      ParameterError: if an array is not finite, they differ in length, the times do not increase, there are fewer than
        12 points, which is twice the usual number of unknowns, or all are in one place.
    """

    time: np.ndarray
    along: np.ndarray
    roll: np.ndarray | None = None
    phi: np.ndarray | None = None

    def __post_init__(self) -> None:
        for name in ("time", "along", *[each for each in ("roll", "phi") if getattr(self, each) is not None]):
            require.set_fields(self, **{name: require.samples(name, getattr(self, name))})
            if (count := len(getattr(self, name))) != len(self.time):
                raise ParameterError(f"{name} must have as many entries as time, {len(self.time)}, got {count}")
        if len(self.time) < 12 or (np.diff(self.time) <= 0).any() or not np.ptp(self.along) > 0:
            got = f"{len(self.time)} from {self.time[0]:g} s to {self.time[-1]:g} s"
            raise ParameterError(f"a track has 12 points or more, ever later and not all in one place, got {got}")


def read_track(
    path: str | os.PathLike[str], columns: Mapping[str, str | int] | None = None, rate: float | None = None
) -> Track:
    """Return the track in a table: a text with tabs, semicolons, commas or spaces between its columns.

    Numbers may have decimal commas, or commas between thousands, if others tell which they are. Lines above the last
    heading are passed over, rows with an empty cell are left out.
    Units stand in the headings, in brackets; without them they are s, m and rad. `columns` says which column is "time",
    "frame", "x", "y", "roll" or "phi", by heading or number from 1, unless its heading is a usual one. `rate` [1/s] is
    that of numbered frames. With x and y the places are along the line through all of them, counted as the can went.

    Raises:
      ParameterError: if it cannot be read so; the message has line and column.
    """
    source, columns = require.path(path), require.instance("columns", {} if columns is None else columns, dict)
    cells = _cells(source)
    first = next((line for line, row in cells.items() if sum(map(_is_number, row)) > 1), 0)
    if not (above := [line for line in cells if line < first]):
        raise ParameterError(f"{source} is no table: there must be a heading above two columns of numbers or more")
    titles = cells[above[-1]]
    used = _used(f"{source}, line {above[-1]}", titles, columns)
    if "frame" in used:
        used["time"] = used.pop("frame")[0], 1 / require.positive("rate of the frames", rate, "1/s")
    texts: dict[str, list[str]] = {name: [] for name in used}
    places: dict[str, list[str]] = {name: [] for name in used}
    for line, row in cells.items():
        if line < first:
            continue
        if any(row[len(titles) :]):
            place = f"{source}, line {line}, column {len(titles) + 1}"
            raise ParameterError(f"{place}: {row[len(titles)]!r} has no heading; are there commas within numbers?")
        if all(at < len(row) and row[at] for at, _ in used.values()):
            for name, (at, _) in used.items():
                texts[name].append(row[at])
                places[name].append(f"{source}, line {line}, column {at + 1}")
    comma = _comma([text for column in texts.values() for text in column])
    arrays = {}
    for name, (_, scale) in used.items():
        values = [_number(*cell, comma) for cell in zip(places[name], texts[name], strict=True)]
        arrays[name] = scale * np.array(values)
    for place, step in zip(places["time"][1:], np.diff(arrays["time"]), strict=True):
        if not step > 0:
            raise ParameterError(f"{place}: this time is not later than the one before")
    along = _straight(source, arrays["x"], arrays["y"]) if "y" in arrays else arrays["x"]
    return Track(arrays["time"], along, arrays.get("roll"), arrays.get("phi"))


def _cells(source: pathlib.Path) -> dict[int, list[str]]:
    """Return the cells of the lines that are not empty, by their numbers."""
    try:
        raw = source.read_bytes()
    except OSError as error:
        raise ParameterError(f"cannot read {require.format_value(str(source))}: {error.strerror or error}") from None
    text = raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", errors="replace")
    lines = {number: line for number, line in enumerate(text.splitlines(), start=1) if line.strip(" \t;,")}
    mark = next((each for each in "\t;," if 2 * sum(each in line for line in lines.values()) > len(lines)), None)
    if mark is None:
        lines = {number: " ".join(line.split()) for number, line in lines.items()}
    # Each line alone: a quotation mark that somebody forgot to close spoils no more than its own.
    rows = {
        number: next(csv.reader([line], delimiter=mark or " ", skipinitialspace=True)) for number, line in lines.items()
    }
    return {number: [cell.strip(' "') for cell in row] for number, row in rows.items()}


def _is_number(text: str) -> bool:
    """Return whether a cell may be a number, of whatever commas."""
    return any(form.fullmatch(text) for form in (_POINT, _COMMA, _GROUPED))


def _comma(texts: list[str]) -> str | None:
    """Return what a comma is in these numbers: "decimal" or "thousands"; None if no number tells."""
    if any(_COMMA.fullmatch(text) and not _GROUPED.fullmatch(text) for text in texts):
        return "decimal"
    return "thousands" if any("." in text or text.count(",") > 1 for text in texts) else None


def _number(place: str, text: str, comma: str | None) -> float:
    """Return the number in a cell at a place of the file; `comma` is what a comma is there."""
    if comma is None and _GROUPED.fullmatch(text):
        either = f"{text!r} may be {text.replace(',', '.')} or {text.replace(',', '')}"
        raise ParameterError(f"{place}: {either}, and no number of this table tells which; write it with a point")
    if comma == "decimal" and _is_number(text) and "." not in text and text.count(",") < 2:
        return float(text.replace(",", "."))
    if comma != "decimal" and (_POINT.fullmatch(text) or _GROUPED.fullmatch(text)):
        return float(text.replace(",", ""))
    among = ", as others here have decimal commas" if comma == "decimal" and _is_number(text) else ""
    raise ParameterError(f"{place}: {text!r} is no number{among}")


def _used(place: str, titles: list[str], columns: Mapping[str, str | int]) -> dict[str, tuple[int, float]]:
    """Return which column has what, and its unit; `titles` are the headings at a place of the file."""
    if not set(columns) <= set(_COLUMNS):
        raise ParameterError(f"columns are those of {', '.join(_COLUMNS)}, got {require.format_value(columns)}")
    parts, used = [_TITLE.findall(title.lower())[0] for title in titles], {}
    for name, (units, usual) in _COLUMNS.items():
        if asked := str(columns.get(name, "")):
            meant = [at for at, title in enumerate(titles) if asked in (title, str(at + 1))]
        else:
            meant = [at for at, (part, _) in enumerate(parts) if re.fullmatch(usual, part)]
        if len(meant) > 1 or (asked and not meant):
            found = f"{len(meant) or 'no'} columns may be {name}"
            raise ParameterError(f"{place}: {found}; say which by its number from 1, of {titles}")
        if meant and not (name == "frame" and "time" in used):
            _, unit = parts[meant[0]]
            if unit and unit not in units:
                allowed = f"the unit of {name} is one of {', '.join(units)}, got {titles[meant[0]]!r}"
                raise ParameterError(f"{place}, column {meant[0] + 1}: {allowed}")
            used[name] = meant[0], units.get(unit, 1.0)
    if "x" not in used or not used.keys() & {"time", "frame"}:
        raise ParameterError(f"{place}: time and x are needed; say which columns they are, of {titles}")
    return used


def _straight(source: pathlib.Path, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the places along the straight line through points, from their middle, counted as they went."""
    places = np.stack([x - x.mean(), y - y.mean()], axis=1)
    _, sizes, ways = np.linalg.svd(places, full_matrices=False)
    along = places @ ways[0]
    if (aside := sizes[1] / math.sqrt(len(x))) > 0.02 * np.ptp(along):  # a mark on the rim is farther, within a metre
        off = f"x and y are {1e3 * aside:.2g} mm off a straight line (rms)"
        raise ParameterError(f"{source}: {off}; track the can's axis, not a mark on its rim")
    return along * math.copysign(1.0, -along[0])
