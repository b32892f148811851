"""The texts of a film: titles, and notes and warnings where and when they hold."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from mjbeer import Scene, Trajectory, exact, frozen, pendulum, simulate, sliding
from mjbeer.drawing.overlay import (
    NOTES,
    Spans,
    draw_header,
    draw_title,
    draw_warning,
    timed_notes,
)
from mjbeer.drawing.sheet import overlap
from mjbeer.drawing.style import FilmStyle
from tests.support.recorder import Recorder


@pytest.mark.parametrize("width", [640, 1280])
def test_no_title_runs_into_the_time(width: int) -> None:
    sheet = Recorder(width, 360)

    draw_title(sheet, "a long title " * 5, "many words " * 8, 0.0, 0.25)

    time, title, pace, scene = sheet.boxes
    assert sheet.words[0] == "t = 0.00 s"
    assert sheet.words[2] == "slowed down 4 times"
    assert not overlap(time, title)
    assert not overlap(pace, scene)
    assert not overlap(title, scene)


@pytest.mark.parametrize("width", [640, 1280])
def test_what_the_marks_mean_does_not_run_into_the_facts(width: int) -> None:
    sheet = Recorder(width, 360)
    run = exact(frozen(), np.linspace(0, 0.5, 51), 1.0)
    style = FilmStyle("a title", marks=("paths", "normal"), facts="let go on top at t = 0, μ = 1")

    draw_header(sheet, style, run, 0.0, 0.25)

    facts, *legends = sheet.boxes[4:]
    assert sheet.words[4] == style.facts
    assert sheet.words[-1] == "normal force N"
    assert max(legend.right for legend in legends) < facts.left


@pytest.mark.parametrize("width", [400, 1280])
def test_the_note_on_a_run_that_is_not_trusted_fits_into_the_picture(width: int) -> None:
    sheet = Recorder(width, 720)
    doubt = (
        "phi and u/a are off by 0.499 rad (trusted up to 0.01), as a run at other timesteps shows"
    )

    draw_warning(sheet, [doubt], 100)

    assert " ".join(sheet.words) == "Not to be relied on phi and u/a are off by 0.499 rad"
    assert min(box.left for box in sheet.boxes) > 0
    assert max(box.right for box in sheet.boxes) < width
    assert min(box.top for box in sheet.boxes) >= 100


def test_a_run_that_is_trusted_has_no_note() -> None:
    sheet = Recorder(400, 720)

    draw_warning(sheet, [], 100)

    assert sheet.boxes == []


def noted(run: Trajectory, name: str) -> Spans:
    """Return from when to when a note holds."""
    (note,) = timed_notes(run, [name])
    return note.spans


def angles(run: Trajectory, spans: Spans) -> np.ndarray:
    """Return the angles phi [rad] in the middle of some spans of time."""
    return np.interp(np.mean(spans, axis=1), run.time, run.phi)


def test_notes_are_there_while_it_happens() -> None:
    """Frozen beer let go on top with mu = 1 flies from 0.83 s on, and lands."""
    run = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=1.0)

    flies = noted(run, "flies")
    heavy = noted(run, "heavy")
    light = noted(run, "light")

    high = run.time[run.lift > 1e-3]
    ((first, last),) = flies
    assert 0.83 < first < high.min() < high.max() < last < 0.97
    assert np.cos(angles(run, heavy)[:3]).min() > 0.7
    assert np.cos(angles(run, light)[0]) < 0


def test_each_note_has_a_ground_of_its_own() -> None:
    """Then a colour means the same in all films."""
    assert len({note.ground for note in NOTES.values()}) == len(NOTES)


def test_a_can_slips_before_it_flies() -> None:
    """Frozen beer let go on top with mu = 1 begins to slip far at 0.83 s."""
    run = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=1.0)

    flies, slips = timed_notes(run, ["flies", "slips"])

    (takes_off, _), *_ = flies.spans
    (begins, ends), *_ = slips.spans
    assert 0.83 < begins < ends
    assert ends == pytest.approx(takes_off, abs=1e-3)
    rolls = simulate(frozen(), 0.8, math.pi, tolerance=1e-9)
    assert noted(rolls, "slips") == []


def test_one_note_is_shown_at_a_time() -> None:
    """A hoop that flies does not press either: of the two the first is shown."""
    run = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=1.0)

    flies, light = (note.spans for note in timed_notes(run, ["flies", "light"]))

    assert any(first < 0.9 < last for first, last in noted(run, "light"))
    assert not any(first < 0.9 < last for first, last in light)
    assert any(first < 0.9 < last for first, last in flies)


@pytest.mark.parametrize("make", [sliding, pendulum])
def test_a_can_hesitates_while_its_load_is_uphill(make: Callable[[], Scene]) -> None:
    """Once a swing; a pause of a few samples does not interrupt the note."""
    run = simulate(make(), 1.2, 1.0, tolerance=1e-9)

    spans = noted(run, "hesitates")

    assert len(spans) == math.ceil(1.2 / make().period(1.0))
    assert angles(run, spans)[1:-1].min() > 0.8
