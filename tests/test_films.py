"""All films of the report: no text covers what moves, nothing aliases, and what is shown can be trusted."""

import numpy as np
import pytest

from mjbeer.drawing.film import Film, Take
from mjbeer.drawing.race import Race
from mjbeer.paper.stories import report
from mjbeer.report.films import FILMS
from tests.support.labels import faults

ALL: dict[str, tuple[Film, float]] = {
    **{name: (film, 30.0) for name, film in FILMS.items()},
    **{f"paper/{order.path.stem}": (order.film, order.fps) for order in report.orders(report.pathlib.Path())},
}
TURN = 0.6
"""Largest turn from picture to picture [rad]: a tenth of a circle. From half a circle on, the eye sees it backwards."""


@pytest.mark.parametrize("name", ALL)
def test_no_text_covers_what_moves_or_another_text(name: str) -> None:
    assert faults(ALL[name][0]) == []


@pytest.mark.parametrize("name", ALL)
def test_nothing_turns_so_fast_that_the_eye_is_deceived(name: str) -> None:
    film, fps = ALL[name]
    assert isinstance(film, Race | Take)
    motions = [runner.trajectory for runner in film.runners()] if isinstance(film, Race) else [film.trajectory()]
    for motion in motions:
        fastest = max(np.abs(motion.roll_dot).max(), np.abs(motion.phi_dot).max())
        assert fastest * film.speed / fps < TURN


@pytest.mark.parametrize("name", ALL)
def test_a_film_lasts_from_two_to_twelve_seconds_and_says_what_is_seen(name: str) -> None:
    film, fps = ALL[name]
    reel = film.reel()
    assert 2 <= len(reel.times(fps)) / fps <= 12
    assert reel.start <= film.still <= reel.end
    if isinstance(film, Take) and film.look is not None:
        assert len(film.look.title) > 10
