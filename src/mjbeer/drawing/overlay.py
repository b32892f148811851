"""The texts of a film: title and time above, notes on what happens, and warnings."""

import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from mjbeer.drawing.annotations import LEGENDS
from mjbeer.drawing.sheet import INK, Sheet
from mjbeer.drawing.strip import mean_forces
from mjbeer.drawing.style import FilmStyle, scene_names
from mjbeer.drawing.words import in_words
from mjbeer.theory.trajectory import Trajectory

HEIGHT = 4.1
"""Height of the first two lines above a picture, in units of the sheet."""
HEADER = 5.6
"""Height with the third line, which says what the marks mean."""
STRIP = 10
"""Height of the charts below a picture."""
NOTE = 3
"""Height of a note, at the top of the scene."""
_MARGIN = 1.2
"""Distance of texts from the edges of the sheet."""
_GREY = "#52606d"  # colour of the second line
_DOUBT = (0.72, 0.05, 0.05)  # colour of a warning


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
    column = _MARGIN * unit
    row = 4.7 * unit
    for mark in style.marks:
        for sign, colour, meaning in LEGENDS[mark]:
            drawn = sheet.text((column, row), sign, 1.1 * unit, colour, bold=True)
            words = sheet.text((drawn.right + 0.5 * unit, row), meaning.format(body), unit)
            column = words.right + 1.8 * unit


def draw_title(
    sheet: Sheet, title: str, words: str, time: float, speed: float, digits: int = 2
) -> None:
    """Draw two lines: a title with the `time` [s], and a scene in words with the playback speed.

    `digits` are those of the time after its point.
    """
    if speed == 1:
        pace = "real time"
    elif speed < 1:
        pace = f"slowed down {1 / speed:.3g} times"
    else:
        pace = f"sped up {speed:.3g} times"
    unit = sheet.unit
    sheet.blank(0, round(HEIGHT * unit))
    clock = sheet.text(
        (sheet.width - _MARGIN * unit, 1.5 * unit),
        f"t = {time:.{digits}f} s",
        1.45 * unit,
        anchor=(1, 0.5),
    )
    _draw_fitting(sheet, title, 1.5 * unit, 1.45 * unit, INK, clock.left, bold=True)
    aside = sheet.text(
        (sheet.width - _MARGIN * unit, 3.2 * unit), pace, 1.1 * unit, _GREY, anchor=(1, 0.5)
    )
    _draw_fitting(sheet, words, 3.2 * unit, 1.1 * unit, _GREY, aside.left)


def _draw_fitting(
    sheet: Sheet, text: str, row: float, size: float, colour: str, until: float, bold: bool = False
) -> None:
    """Draw a text from the left margin, smaller where it would come near a column `until`."""
    left = _MARGIN * sheet.unit
    wanted = sheet.box((left, 0), text, size, bold=bold).right
    fits = max(0.5, min(1.0, (until - 2 * sheet.unit) / wanted))
    sheet.text((left, row), text, fits * size, colour, bold=bold)


class Note(NamedTuple):
    """What a film says while a motion does something."""

    words: str
    """What it says, with places for {body} and {load}, by name, and the largest {lift} [mm]."""
    holds: Callable[[Trajectory], np.ndarray]
    """Returns at which samples of a motion it does so."""


def _slips(motion: Trajectory) -> np.ndarray:
    """Return where a can slips; a contact that rolls creeps, which is less."""
    rate = np.abs(np.gradient(motion.slip, motion.time))
    return rate > 0.09 * np.sqrt(motion.scene.can.radius)


def _hesitates(motion: Trajectory) -> np.ndarray:
    gains = np.gradient(motion.u_dot, motion.time)
    return gains < motion.scene.acceleration() / 2


NOTES = {
    "flies": Note(
        "its {load} pulls it up: it flies, up to {lift:.0f} mm high",
        lambda motion: motion.lift > 0.02 * motion.scene.can.radius,
    ),
    "slips": Note("it slips: rolling needs more friction than μN", _slips),
    "heavy": Note(
        "the {load} below presses the {body} down",
        lambda motion: mean_forces(motion).normal > 1.8,
    ),
    "light": Note(
        "the {load} pulls up: the {body} hardly presses",
        lambda motion: mean_forces(motion).normal < 0.4,
    ),
    "hesitates": Note("the {load} is uphill: the {body} hesitates", _hesitates),
}
"""All notes by name. Where several of a film hold, the first of them is shown."""

Spans = list[tuple[float, float]]
"""From when to when [s] something holds."""


def note_spans(motion: Trajectory, names: Sequence[str]) -> dict[str, Spans]:
    """Return from when to when [s] notes hold, by their words."""
    called = scene_names(motion.scene)
    lift = 1e3 * motion.lift.max()
    spans: dict[str, Spans] = {}
    for name in names:
        words = NOTES[name].words.format(body=called.body, load=called.load, lift=lift)
        spans[words] = _spans(motion.time, NOTES[name].holds(motion))
    return spans


def _spans(time: np.ndarray, holds: np.ndarray) -> Spans:
    """Return from when to when [s] what holds at samples does so, without brief pauses."""
    changes = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]])))
    edges = np.append(time, time[-1])[changes].tolist()
    brief = np.ptp(time) / 50
    spans: Spans = []
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        if spans and first - spans[-1][1] < brief:
            spans[-1] = (spans[-1][0], last)
        else:
            spans.append((first, last))
    return spans


def draw_note(sheet: Sheet, notes: Mapping[str, Spans], time: float, top: int) -> None:
    """Write the first of some notes that holds at a `time` [s] below a row `top`."""
    for words, spans in notes.items():
        if any(first <= time <= last for first, last in spans):
            place = np.array([_MARGIN, NOTE / 2]) * sheet.unit + [0, top]
            sheet.plate(place, [words], INK, (0, 0.5), ground=(1.0, 0.95, 0.72))
            return


def draw_warning(sheet: Sheet, doubts: Sequence[str], top: int) -> None:
    """Say below a row `top` that what is shown is not to be relied on, if there are `doubts`.

    A doubt is shown up to its parentheses, which say what would be trusted.
    """
    if not doubts:
        return
    # The mean letter is 0.6 units wide.
    letters = int((sheet.width / sheet.unit - 4) / 0.65)
    lines = ["Not to be relied on"]
    for doubt in doubts:
        reason, *_ = doubt.partition(" (")
        lines += textwrap.wrap(reason, letters)
    place = sheet.unit * np.array([_MARGIN, 0.6]) + [0, top]
    sheet.plate(place, lines, _DOUBT, (0, 0), ground=(1.0, 0.9, 0.88))
