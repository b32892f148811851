"""All films of the report: nothing aliases, and what is told of them is so."""

import math
import pathlib
from collections.abc import Callable

import numpy as np
import pytest

from mjbeer import Scene, exact, frozen, simulate
from mjbeer.drawing.film import Film, MotionFilm
from mjbeer.drawing.quantities import INTERVALS, mean_forces
from mjbeer.drawing.race import Race
from mjbeer.drawing.words import in_words
from mjbeer.paper import stories
from mjbeer.report import films
from mjbeer.report.films import FILMS
from mjbeer.theory.liquid import liquid, liquid_in
from mjbeer.theory.liquid_properties import LIQUIDS
from mjbeer.theory.trajectory import Trajectory

OF_MOTIONS = {name: film for name, film in FILMS.items() if isinstance(film, Race | MotionFilm)}
OF_STORIES = {story.name: story.film for story in stories.STORIES if story.film}
ALL: dict[str, Film] = OF_MOTIONS | OF_STORIES
RENDERS = pathlib.Path(__file__).parents[1] / "renders"
FPS = 25
"""Pictures per second of every film of a report."""
TURN = 2 * np.pi / 9
"""Largest turn from picture to picture [rad]. From half a circle on, the eye sees it backwards."""


def motions(film: Film) -> list[Trajectory]:
    """The motions of a film: one, or those of the cans that it compares."""
    if isinstance(film, Race):
        return [runner.trajectory for runner in film.runners()]
    assert isinstance(film, MotionFilm)
    return [film.trajectory()]


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_nothing_turns_so_fast_that_the_eye_is_deceived(name: str) -> None:
    film = ALL[name]
    for motion in motions(film):
        fastest = np.maximum(np.abs(motion.roll_dot), np.abs(motion.phi_dot))
        assert fastest[motion.time <= film.plan().end].max() * film.speed / FPS < TURN


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_the_equations_of_every_film_are_solved(name: str) -> None:
    """A can that slips or hops is what a film may be about."""
    for motion in motions(ALL[name]):
        assert not motion.solver_warnings


@pytest.mark.slow
@pytest.mark.parametrize(
    "story", [story for story in stories.STORIES if story.film], ids=lambda story: story.name
)
def test_films_of_stories_show_what_they_say(story: stories.Story) -> None:
    """Each is of the scene under its plot's title.

    That of contact slips and leaves the incline; every other can be trusted.
    """
    assert story.film
    for run in motions(story.film):
        assert in_words(run.scene) in story.subtitle
        if run.rolling != "contact":
            assert run.trusted, run.warnings
        else:
            assert np.ptp(run.slip) > run.scene.can.radius / 2
            assert run.lift.max() > run.scene.can.radius / 5


@pytest.mark.slow
def test_the_race_of_liquids_ends_as_its_caption_says() -> None:
    """And with its numbers. Honey is last, also with half and twice its viscosity."""
    cans = {can.name: can for can in films.of_liquids()}
    finish = {name: can.finish(films.LENGTH) for name, can in cans.items()}
    assert sorted(finish, key=lambda name: finish[name]) == ["water", "olive oil", "ice", "honey"]
    assert finish["honey"] < np.inf
    honey = cans["honey"]
    place = honey.positions(np.array([finish["ice"]]))[0, 0]
    speed = honey.trajectory.scene.terminal_speed()
    carried = liquid_in("honey", **films.WITH_LIQUID).carried
    numbers = [cans[name].shown(time) for name, time in finish.items()]
    numbers = [number.replace("≈", "about") for number in numbers]
    numbers += [cans[name].note.split()[2] for name in ("water", "olive oil")]
    numbers += [f"{100 * place:.0f} cm", f"{100 * speed:.1f} cm/s", f"{100 * carried:.0f} %"]
    for number in numbers:
        assert f" {number}" in FILMS["liquids"].caption
    own = LIQUIDS["honey"].viscosity
    for viscosity in (own / 2, 2 * own):
        thinner = exact(
            liquid("honey", **films.WITH_LIQUID, viscosity=viscosity),
            np.array([0.0, finish["ice"]]),
            honey.trajectory.phi0,
        )
        assert thinner.u[1] - thinner.u[0] < 0.4
    for can in cans.values():
        assert not can.trajectory.solver_warnings
        assert not can.trajectory.rolling_warnings


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cans", "degrees"),
    [
        (lambda incline: frozen(incline, films._FILL, films.METAL, films._ICE), 6.93),
        (lambda incline: liquid("honey", incline, films._FILL, films.METAL), 7.38),
    ],
    ids=["ice", "honey"],
)
def test_a_can_rolls_over_the_top_from_the_incline_that_is_told(
    cans: Callable[[float], Scene], degrees: float
) -> None:
    """The race of liquids is between those of ice and of honey."""
    for error, rolls_over in ((-0.01, False), (0.01, True)):
        scene = cans(math.radians(degrees + error))
        motion = exact(scene, np.linspace(0.0, 6.0, 601), -scene.incline)
        assert (motion.phi.max() > math.pi) == rolls_over


@pytest.mark.slow
def test_the_hoop_hops_as_its_caption_says_at_any_timestep() -> None:
    """Its height converges.

    At four timesteps it is the same within 0.1 mm, a tenth of the last digit of the caption.

    The largest force is that of the chart, a mean over a fiftieth of the motion.
    """
    runs = [films.HOP(timestep=timestep) for timestep in (2e-4, 1e-4, 5e-5, 2.5e-5)]
    heights = [1e3 * run.lift.max() for run in runs]
    assert np.ptp(heights) < 0.1
    assert not any(run.solver_warnings for run in runs)
    shown = films.HOP()
    weights = mean_forces(shown).normal
    flies = np.flatnonzero(shown.lift > 1e-5)  # [m]: a contact that bears all this is not as soft
    numbers = (
        f"{1e3 * shown.scene.can.mass:.0f} g",
        f"{1e3 * shown.scene.load.mass:.0f} g",
        f"(μ = {shown.setting.friction:g})",
        f"{np.degrees(shown.phi_dot0):.0f}°",
        f"{weights.max():.1f} times",
        f"After {shown.time[flies[0]]:.2f} s",
        f"{heights[1]:.0f} mm high",
    )
    for number in numbers:
        assert f" {number}" in FILMS["hoop"].caption
    phi_at_largest = np.interp(shown.time[weights.argmax()], shown.time, shown.phi)
    assert np.degrees(phi_at_largest) == pytest.approx(0, abs=10)
    assert (np.diff(flies) == 1).all()  # it does not skim
    lands = simulate(
        shown.scene, 0.27, shown.phi0, shown.phi_dot0, "contact", timestep=1e-4, friction=0.01
    )
    assert 0 < shown.lift[-1] < shown.lift.max() / 5
    assert lands.lift[lands.time > 0.26].min() < 1e-5


@pytest.mark.skipif(not RENDERS.is_dir(), reason="a source distribution lacks them")
def test_the_documents_have_a_small_picture_of_each_film() -> None:
    pictures = list(RENDERS.glob("*.webp"))
    of_examples = {"grasp"}
    of_stories = {"rocking"}
    assert {path.stem for path in pictures} == set(FILMS) | of_stories | of_examples
    assert max(path.stat().st_size for path in pictures) < 1e6


@pytest.mark.parametrize("name", ALL)
def test_a_film_lasts_from_two_to_twelve_seconds(name: str) -> None:
    film = ALL[name]
    plan = film.plan()
    assert 2 <= len(plan.times(FPS)) / FPS <= 12
    assert film.still is None or plan.start <= film.still <= plan.end


def test_the_poster_of_a_race_to_be_predicted_shows_its_start() -> None:
    for name in ("race", "liquids"):
        assert FILMS[name].still == 0


@pytest.mark.slow
def test_the_frozen_can_wins_by_its_start_on_top_as_the_caption_of_the_race_says() -> None:
    """Without it, it would need the time of its mean acceleration."""
    cans = {can.name: can for can in films.of_beer()}
    steady = {
        name: math.sqrt(2 * films.LENGTH / can.trajectory.scene.acceleration())
        for name, can in cans.items()
    }
    partly = steady["beer frozen"]
    full = cans["beer frozen, full"].finish(films.LENGTH)
    assert f"need {partly:.2f} s, the full one {full:.2f} s" in FILMS["race"].caption
    assert cans["beer frozen"].finish(films.LENGTH) < partly - 0.2


@pytest.mark.slow
def test_the_stories_tell_the_forces_that_their_films_show() -> None:
    """Spinning beer presses with up to nearly four weights, and with a third of one on top.

    A landing is a blow of more than eight weights, as a mean over a fiftieth of the motion.
    """
    (looping,) = motions(OF_STORIES["looping"])
    (hopping,) = motions(OF_STORIES["slip-and-hop"])
    spinning = mean_forces(looping).normal
    assert 3.7 < spinning.max() < 4
    assert spinning.min() == pytest.approx(1 / 3, abs=0.05)
    assert 8 < mean_forces(hopping).normal.max() < 9
    assert np.ptp(hopping.time) / INTERVALS == pytest.approx(0.011, abs=5e-4)
