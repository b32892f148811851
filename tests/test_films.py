"""All films of the report: nothing aliases, and what is told of them is so."""

import pathlib

import numpy as np
import pytest

from mjbeer import exact, frozen
from mjbeer.drawing.film import Film, MotionFilm
from mjbeer.drawing.race import Race
from mjbeer.paper import stories
from mjbeer.report import films
from mjbeer.report.films import FILMS
from mjbeer.theory.liquid import LIQUIDS, liquid_in

ALL: dict[str, tuple[Film, float]] = {
    **{name: (film, 30.0) for name, film in FILMS.items() if isinstance(film, Race | MotionFilm)},
    **{f"paper/{order.path.stem}": (order.film, order.fps) for order in stories.films(pathlib.Path())},
}
TIMES = np.linspace(0.0, 2.3, 1151)
TURN = 0.6
"""Largest turn from picture to picture [rad]: a tenth of a circle. From half a circle on, the eye sees it backwards."""


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_nothing_turns_so_fast_that_the_eye_is_deceived(name: str) -> None:
    film, fps = ALL[name]
    assert isinstance(film, Race | MotionFilm)
    motions = [runner.trajectory for runner in film.runners()] if isinstance(film, Race) else [film.trajectory()]
    for motion in motions:
        fastest = np.maximum(np.abs(motion.roll_dot), np.abs(motion.phi_dot))
        assert fastest[motion.time <= film.plan().end].max() * film.speed / fps < TURN


@pytest.mark.slow
def test_the_race_of_liquids_ends_as_its_caption_says() -> None:
    """All of its numbers are those of the simulated cans, and honey is last with half and twice its viscosity."""
    cans = {can.name: can for can in films.of_liquids()}
    finish = {name: can.finish(films.LENGTH) for name, can in cans.items()}
    assert sorted(finish, key=lambda name: finish[name]) == ["water", "olive oil", "ice", "honey"]
    assert finish["honey"] < np.inf
    way, speed = cans["honey"].positions(np.array([finish["ice"]]))[0, 0], films.with_liquid("honey").terminal_speed()
    told = films.told_of_liquids()
    honey = liquid_in("honey", cans["honey"].trajectory.scene.incline, 0.75, films.METAL)
    for words in (
        f"the wall carries up to {100 * honey.carried:.0f} % round with it",
        f"Water wins after {finish['water']:.2f} s",
        f"oil follows after {finish['olive oil']:.2f} s",
        f"finishes after {finish['ice']:.2f} s",
        f"it has come {100 * way:.0f} cm, and it needs {finish['honey']:.2f} s",
        f"creeps with {100 * speed:.1f} cm/s",
    ):
        assert words in told
    own = LIQUIDS["honey"].viscosity
    for viscosity in (own / 2, 2 * own):
        thinner = exact(
            films.with_liquid("honey", viscosity), np.array([0.0, finish["ice"]]), cans["honey"].trajectory.phi0
        )
        assert thinner.u[1] - thinner.u[0] < 0.4
    assert not any(can.trajectory.solver_warnings or can.trajectory.rolling_warnings for can in cans.values())


def test_ice_rolls_over_and_honey_does_not_because_of_the_incline() -> None:
    """Let go with a level surface, ice would swing back on up to 6.93 degrees; here it hesitates on top."""
    ice = exact(films.with_ice(), TIMES, -films.with_ice().incline)
    slowest = np.abs(ice.u_dot[TIMES > 0.3]).min()
    assert slowest < 0.1
    for incline, swings in ((6.93, True), (6.94, False)):
        level = frozen(np.radians(incline), 0.75, films.METAL, 917.0)
        assert (level.separatrix()[0] < -level.incline < level.separatrix()[1]) is swings
    honey = exact(films.with_liquid("honey"), TIMES, -films.with_ice().incline)
    assert np.abs(honey.phi).max() < np.pi
    assert np.abs(ice.phi).max() > 2 * np.pi


def test_the_documents_have_a_small_picture_of_each_film() -> None:
    pictures = list((pathlib.Path(__file__).parents[1] / "renders").glob("*.webp"))
    assert {path.stem for path in pictures} == set(FILMS)
    assert max(path.stat().st_size for path in pictures) < 1.5e6


@pytest.mark.parametrize("name", ALL)
def test_a_film_lasts_from_two_to_twelve_seconds_and_says_what_is_seen(name: str) -> None:
    film, fps = ALL[name]
    plan = film.plan()
    assert 2 <= len(plan.times(fps)) / fps <= 12
    assert plan.start <= film.still <= plan.end
    if isinstance(film, MotionFilm) and film.look is not None:
        assert len(film.look.title) > 10
