"""The film of cans that are carried."""

import numpy as np

from mjbeer.drawing.film import Film
from mjbeer.report.carry import Carry

BEER = (250, 161, 20)


def test_the_surface_rises_behind_an_accelerating_can() -> None:
    film: Film = Carry()
    plan = film.plan()
    assert (plan.start, plan.end) == (0.0, 2.0)
    first, pushed = plan.draw(np.array([0.0, 0.25]), 400, 226)
    assert first.shape == (226, 400, 3)
    rest, tilted = (_heights(picture[:75]) for picture in (first, pushed))
    assert rest[0] == rest[1]
    assert tilted[0] > rest[0] > tilted[1]


def _heights(picture: np.ndarray) -> tuple[int, int]:
    """How many pixels of beer there are at the left and at the right of the upper can."""
    columns = (np.abs(picture.astype(int) - BEER).max(axis=2) < 12).sum(axis=0)
    wet = np.flatnonzero(columns > 3)
    return int(columns[wet[0] + 1]), int(columns[wet[-1] - 1])
