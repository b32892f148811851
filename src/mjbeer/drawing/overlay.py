"""The texts of a film: title and time above, notes on what happens, and warnings."""

import math
import textwrap
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from mjbeer.drawing.annotations import LEGENDS
from mjbeer.drawing.quantities import mean_forces
from mjbeer.drawing.sheet import INK, Colour, Sheet
from mjbeer.drawing.style import FilmStyle, scene_names
from mjbeer.drawing.words import in_words
from mjbeer.theory.trajectory import Trajectory

HEIGHT = 4.1
"""Height of the first two lines above a picture, in units of the sheet, as are all heights and
distances here."""
HEADER = 6.0
"""Height with the third line, which says what the marks mean, and what else to know."""
STRIP = 10
"""Height of the charts below a picture."""
NOTE = 3
"""Height of a note, at the top of the scene."""
_MARGIN = 1.2
"""Distance of texts from the edges of the sheet."""
_LEGEND = 1.2
"""Height of the letters of the third line, where there is room."""
_LEGEND_GAPS = (0.5, 1.8)
"""Gaps behind the sign of a mark, and behind its meaning."""
_LEAST = 0.55
"""Height of the smallest letters of the first two lines."""
_LETTER = 0.65
"""Width of a letter of a warning; the mean is a little less."""
_WARNING_MARGINS = 4
"""Width of the picture that a warning leaves free beside its letters."""
_DOUBT = (0.72, 0.05, 0.05)
"""Colour of a warning."""


class _TextLine(NamedTuple):
    """Where a line above a picture is, and how it is written."""

    row: float
    """Height of its middle below the upper edge of the sheet."""
    size: float
    colour: str
    bold: bool
    """Whether what stands on the left is bold."""


_TITLE_LINE = _TextLine(row=1.5, size=1.45, colour=INK, bold=True)
_SCENE_LINE = _TextLine(row=3.25, size=1.25, colour="#52606d", bold=False)
_LEGEND_ROW = 5.0
"""Height of the middle of the third line below the upper edge."""


def draw_header(
    sheet: Sheet, style: FilmStyle, trajectory: Trajectory, time: float, speed: float
) -> None:
    """Draw the three lines above a picture of a motion as they are at a `time` [s]."""
    unit = sheet.unit
    duration = float(trajectory.time[-1] - trajectory.time[0])
    digits = 2
    if duration > 0:
        digits = max(2, math.ceil(-math.log10(duration)) + 1)
    sheet.blank(0, round(HEADER * unit))
    draw_title(sheet, style.title, in_words(trajectory.scene), time, speed, digits)

    body = scene_names(trajectory.scene).body
    legends = [legend for mark in style.marks for legend in LEGENDS[mark]]
    size = _LEGEND * unit
    row = _LEGEND_ROW * unit
    end = sheet.width - _MARGIN * unit
    limit = sheet.text((end, row), style.facts, size, anchor=(1, 0.5)).left - 2 * unit
    meanings = [legend.meaning.format(body) for legend in legends]
    while size > _LEAST * unit and _MARGIN * unit + _legend_width(sheet, meanings, size) > limit:
        size -= 1
    column = _MARGIN * unit
    behind_sign, behind_meaning = _LEGEND_GAPS
    for sign, colour, meaning in legends:
        drawn = sheet.text((column, row), sign, size, colour, bold=True)
        column = drawn.right + behind_sign * unit
        words = sheet.text((column, row), meaning.format(body), size)
        column = words.right + behind_meaning * unit


def _legend_width(sheet: Sheet, meanings: Sequence[str], size: float) -> float:
    """Return how wide a third line with some meanings and their signs is [pixels]."""
    sign = sheet.box((0, 0), "- -", size, bold=True).right
    gaps = sum(_LEGEND_GAPS) * sheet.unit
    return sum(sign + gaps + sheet.box((0, 0), meaning, size).right for meaning in meanings)


def draw_title(
    sheet: Sheet, title: str, words: str, time: float, speed: float, digits: int = 2
) -> None:
    """Draw two lines: a title with the `time` [s], and a scene in words with the playback speed.

    The time has so many `digits` after its point.
    """
    if speed == 1:
        pace = "real time"
    elif speed < 1:
        pace = f"slowed down {1 / speed:.3g} times"
    else:
        pace = f"sped up {speed:.3g} times"
    sheet.blank(0, round(HEIGHT * sheet.unit))
    _draw_line(sheet, _TITLE_LINE, title, f"t = {time:.{digits}f} s")
    _draw_line(sheet, _SCENE_LINE, words, pace)


def _draw_line(sheet: Sheet, line: _TextLine, left: str, right: str) -> None:
    """Write a text at each end of a line; the left one is smaller if it would touch the right."""
    unit = sheet.unit
    row = line.row * unit
    size = line.size * unit
    begin = _MARGIN * unit
    end = sheet.width - begin
    limit = sheet.text((end, row), right, size, line.colour, anchor=(1, 0.5)).left - 2 * unit
    # Letters have whole pixels, and their widths are no smooth function of their size.
    while size > _LEAST * unit and sheet.box((begin, 0), left, size, bold=line.bold).right > limit:
        size -= 1
    sheet.text((begin, row), left, size, line.colour, bold=line.bold)


class Note(NamedTuple):
    """What a film says while a motion does something."""

    words: str
    """What it says, with places for the names of {body} and {load}, and the largest {lift} [mm]."""
    holds: Callable[[Trajectory], np.ndarray]
    """Returns at which samples of a motion it does so."""
    ground: Colour
    """Ground of the note, and of the times in the charts at which it is shown."""


def _slips(motion: Trajectory) -> np.ndarray:
    """Return at which samples a can slips with more than a twentieth of its speed."""
    slip_rate = motion.u_dot - motion.scene.can.radius * motion.roll_dot
    return np.abs(slip_rate) > np.abs(motion.u_dot) / 20


def _hesitates(motion: Trajectory) -> np.ndarray:
    """Return at which samples a can gains speed at less than half its mean rate."""
    gains = np.gradient(motion.u_dot, motion.time)
    return gains < motion.scene.acceleration() / 2


NOTES = {
    "flies": Note(
        "the {body} flies, up to {lift:.0f} mm high",
        lambda motion: motion.lift > 0.02 * motion.scene.can.radius,
        ground=(0.85, 0.95, 0.80),
    ),
    "heavy": Note(
        "the {load} below presses the {body} down",
        lambda motion: mean_forces(motion).normal > 1.8,
        ground=(1.0, 0.85, 0.76),
    ),
    "light": Note(
        "the {load} pulls up: the {body} hardly presses",
        lambda motion: mean_forces(motion).normal < 0.4,
        ground=(0.80, 0.90, 1.0),
    ),
    "slips": Note("the {body} slips", _slips, ground=(0.92, 0.85, 0.97)),
    "hesitates": Note(
        "the {load} is uphill: the {body} hesitates", _hesitates, ground=(1.0, 0.92, 0.62)
    ),
}
"""All notes by name. Forces are in weights of can and load. Where several notes of a film hold, the
one that the film names first is shown."""

Spans = list[tuple[float, float]]
"""From when to when [s] something holds."""


class TimedNote(NamedTuple):
    """A note of a film, and when it is shown."""

    words: str
    spans: Spans
    ground: Colour


def timed_notes(motion: Trajectory, names: Sequence[str]) -> list[TimedNote]:
    """Return the notes of these names with the times at which they are shown.

    A note is shown while it holds and none before it does.
    """
    called = scene_names(motion.scene)
    lift = 1e3 * motion.lift.max()
    notes = []
    taken = np.zeros(len(motion.time), bool)
    for name in names:
        note = NOTES[name]
        words = note.words.format(body=called.body, load=called.load, lift=lift)
        holds = note.holds(motion)
        notes.append(TimedNote(words, _spans(motion.time, holds & ~taken), note.ground))
        taken |= holds
    return notes


def _spans(time: np.ndarray, holds: np.ndarray) -> Spans:
    """Return from when to when [s] something holds that does so at some samples.

    A pause of less than a fiftieth of the motion does not interrupt it.
    """
    changes = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]])))
    edges = np.append(time, time[-1])[changes].tolist()
    begins = edges[::2]
    ends = edges[1::2]
    brief = np.ptp(time) / 50
    spans: Spans = []
    for first, last in zip(begins, ends, strict=True):
        if spans and first - spans[-1][1] < brief:
            spans[-1] = (spans[-1][0], last)
        else:
            spans.append((first, last))
    return spans


def draw_note(sheet: Sheet, notes: Sequence[TimedNote], time: float, top: int) -> None:
    """Write the first of some notes that is shown at a `time` [s] below a row `top`."""
    for note in notes:
        if any(first <= time <= last for first, last in note.spans):
            place = np.array([_MARGIN, NOTE / 2]) * sheet.unit + [0, top]
            sheet.plate(place, [note.words], INK, (0, 0.5), ground=note.ground)
            return


def draw_answer(sheet: Sheet, words: str, top: int) -> None:
    """Write what a motion has shown, below a row `top`."""
    place = np.array([_MARGIN, NOTE / 2]) * sheet.unit + [0, top]
    sheet.plate(place, [words], INK, (0, 0.5))


def draw_warning(sheet: Sheet, doubts: Sequence[str], top: int) -> None:
    """Say below a row `top` that the picture is not to be relied on, if there are `doubts`.

    Each doubt is a reason; what it has in parentheses, the limits of what is trusted, is left out.
    """
    if not doubts:
        return
    letters = int((sheet.width / sheet.unit - _WARNING_MARGINS) / _LETTER)
    lines = ["Not to be relied on"]
    for doubt in doubts:
        reason, *_ = doubt.partition(" (")
        lines += textwrap.wrap(reason, letters)
    place = sheet.unit * np.array([_MARGIN, 0.6]) + [0, top]
    sheet.plate(place, lines, _DOUBT, (0, 0), ground=(1.0, 0.9, 0.88))
