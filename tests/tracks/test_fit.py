"""The fit finds what was in the can within its errors, and says what speaks against it."""

import inspect
import json
import math
import pathlib
import re
import shlex
import shutil
from dataclasses import replace
from types import SimpleNamespace
from typing import Any
from unittest import mock

import numpy as np
import pytest

import mjbeer
from mjbeer import Can, Fit, Scene, Track, exact, fit, frozen, liquid, read_track, sliding
from mjbeer.cli.app import main
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.studies.validation import track_checks
from mjbeer.tracks.track_model import with_parameters
from mjbeer.tracks.unknowns import FITTABLE
from tests.tracks.filmed import PLACE, RELEASED, Camera, filmed

pytestmark = pytest.mark.slow
METAL = Can.sheet_metal()
WATER = liquid("water", math.radians(2), can=METAL)
OIL = liquid("olive oil", math.radians(2), can=METAL)
ICE = frozen(math.radians(5), can=METAL)
KNOWN = {"fill": (0.5, 0.005)}


def steeper(scene: Scene) -> Scene:
    """A guess that is 0.6 degrees off."""
    return with_parameters(scene, {"incline": scene.incline + 0.01})


def fitted(track: Track, guess: Scene, *free: str, **others: Any) -> Fit:
    """The fit without a progress bar, of the incline alone if nothing else is named."""
    return fit(track, guess, free or ("incline",), progress=False, **others)


def assert_within_errors(result: Fit, **truth: float) -> None:
    """A normal error is more than four standard errors once in 10,000 times."""
    for name, value in truth.items():
        assert abs(result.values[name] - value) < 4 * result.errors[name], name


def warned(result: Fit, words: str) -> bool:
    return any(words in warning for warning in result.warnings)


@pytest.fixture(scope="module")
def water_fit() -> Fit:
    """What the command of `test_the_command_shows_the_fit` finds."""
    guess = liquid("water", math.radians(2.5), can=METAL)
    return fitted(filmed(WATER), guess, "incline", "damping", known=KNOWN)


def assert_good(result: Fit, **truth: float) -> None:
    """All values are within their errors, the noise is 1 mm, and no warning says otherwise."""
    usual = {"released": RELEASED, "place": PLACE, "bend": 0.0}
    assert result.values.keys() == {*usual, *truth}
    assert_within_errors(result, **usual, **truth)
    # Four standard deviations of that of 168 points are 22 %.
    assert result.noise["along"] == pytest.approx(1e-3, rel=0.25)
    assert result.scene.incline == result.values["incline"]
    assert not warned(result, "model is wrong")
    assert not warned(result, "does not tell")


def test_the_truth_of_water_is_within_the_errors(water_fit: Fit) -> None:
    assert_good(water_fit, incline=WATER.incline, fill=0.5, damping=1.0)


def test_a_fit_says_what_the_polynomial_adds_where_there_is_one(water_fit: Fit) -> None:
    own = water_fit.scene.damping_law
    linear = replace(water_fit.scene, damping=replace(own, quadratic=0.0))

    assert "as a polynomial stands for w^1.5" in str(water_fit)
    assert "polynomial" not in str(replace(water_fit, scene=linear))


def test_the_truth_of_oil_is_within_the_errors() -> None:
    result = fitted(filmed(OIL), steeper(OIL), "incline", "damping", known=KNOWN)
    assert_good(result, incline=OIL.incline, fill=0.5, damping=1.0)


def test_the_incline_of_ice_is_within_its_error() -> None:
    result = fitted(filmed(ICE, phi0=-1.5), steeper(ICE), phi0=-1.5)
    assert_good(result, incline=ICE.incline)


@pytest.mark.costly
def test_incline_and_fill_of_ice_are_within_their_errors() -> None:
    result = fitted(filmed(ICE, phi0=-1.5), steeper(ICE), "incline", "fill", phi0=-1.5)
    assert_good(result, incline=ICE.incline, fill=0.5)


@pytest.mark.costly
def test_the_start_of_a_search_is_not_its_answer() -> None:
    """A fill of 0.30 is nearly in step with these swings; the truth is between 0.10 and 0.15."""
    scene = frozen(math.radians(3.084), 0.1271, METAL)
    guess = frozen(math.radians(3.4), 0.1598, METAL)
    result = fitted(filmed(scene, seconds=5.0), guess, "incline", "fill")
    assert_within_errors(result, incline=scene.incline, fill=0.1271, released=RELEASED)


@pytest.mark.parametrize(
    ("degrees", "fill", "phi0", "noise"),
    [
        # It rocks 30 times: let go a swing too late it would be nearly the same.
        (2.557, 0.5033, None, 1e-3),
        pytest.param(2.955, 0.5734, None, 1e-3, marks=pytest.mark.costly),
        pytest.param(6.603, 0.4142, -2.2, 3e-4, marks=pytest.mark.costly),  # 24 m and 115 turns
    ],
)
def test_white_noise_of_a_long_track_is_no_wrong_model(
    degrees: float, fill: float, phi0: float | None, noise: float
) -> None:
    scene = frozen(math.radians(degrees), fill, METAL)
    track = filmed(scene, phi0, noise, seconds=8.0)
    result = fitted(track, steeper(scene), phi0="level" if phi0 is None else phi0)
    assert all("N < 0" in warning for warning in result.warnings)
    assert_within_errors(result, incline=scene.incline, released=RELEASED)


def test_water_without_friction_is_doubted() -> None:
    """What it lacks is taken for a bend of the track."""
    result = fitted(filmed(WATER), sliding(WATER.incline, can=METAL), known=KNOWN)
    assert warned(result, "the model is wrong, or what was known: bend"), result


def test_ice_fitted_as_oil_is_doubted() -> None:
    result = fitted(filmed(ICE, phi0=-1.5), OIL, known=KNOWN)
    assert warned(result, "the model is wrong, or the track"), result


def test_water_that_sloshes_is_not_the_lump_of_the_paper() -> None:
    """Let go with a level surface, it swings through as much as the incline, and faster."""
    water = liquid("water", math.radians(5), can=METAL)
    lump = sliding(water.incline, can=METAL, density=998.2, damping=water.damping_law)
    result = fitted(filmed(water, seconds=2.5), lump, "incline", "damping")
    assert warned(result, "their difference is not like noise"), result


def test_oil_fitted_as_water_is_doubted() -> None:
    result = fitted(filmed(OIL), WATER, known=KNOWN)
    assert warned(result, "the model is wrong, or the track"), result


def seen_obliquely(folder: pathlib.Path) -> tuple[pathlib.Path, np.ndarray]:
    """A table in pixels of the track of water, seen at 20 degrees, and marks on its board.

    Both have errors of a pixel in x and y, as large as 1.4 mm.
    """
    camera = Camera(yaw=math.radians(20))
    rng = np.random.default_rng(5)
    track = filmed(WATER, noise=0.0)
    axis = camera.picture(track.along, METAL.radius, WATER.incline, 0.6)
    axis += rng.standard_normal(axis.shape)
    places = np.array([0.0, 0.6, 1.2])
    marks = camera.picture(places, 0.0, WATER.incline, 0.6)
    marks += rng.standard_normal(marks.shape)
    path = folder / "can.csv"
    table = np.column_stack([track.time, axis])
    np.savetxt(path, table, header="t,x,y", comments="", delimiter=",")
    return path, np.column_stack([marks, places])


def test_marks_on_the_board_undo_an_oblique_camera(tmp_path: pathlib.Path) -> None:
    path, marks = seen_obliquely(tmp_path)
    track = read_track(path, marks=marks)
    result = fitted(track, steeper(WATER), "incline", "damping")
    assert_within_errors(result, incline=WATER.incline, damping=1.0, released=RELEASED, scale=1.0)
    # Larger errors would say little.
    assert result.errors["damping"] < 0.2
    # The clicks of the outer marks have errors of 1.4 mm each, over 1.2 m.
    assert result.errors["scale"] == pytest.approx(math.sqrt(2) * 1.4e-3 / 1.2, rel=0.2)
    assert not warned(result, "model is wrong"), result


@pytest.mark.costly
def test_an_oblique_camera_is_doubted_without_marks(tmp_path: pathlib.Path) -> None:
    path, marks = seen_obliquely(tmp_path)
    scale = float(np.hypot(*(marks[2] - marks[0])[:2])) / 1.2
    track = read_track(path, scale=scale)
    result = fitted(track, steeper(WATER), "incline", "damping")
    assert abs(result.values["damping"] - 1) > 4 * result.errors["damping"]
    assert warned(result, "an oblique camera bends a track"), result


def test_a_resistance_contradicts_a_measured_incline() -> None:
    """A resistance of 0.01 looks like so much less incline."""
    braked = with_parameters(WATER, {"incline": WATER.incline - 0.01})
    known = KNOWN | {"incline": (WATER.incline, 0.002)}
    result = fitted(filmed(braked), WATER, known=known)
    assert warned(result, "the model is wrong, or what was known: incline"), result


@pytest.mark.costly
def test_damping_and_drag_look_alike() -> None:
    result = fitted(filmed(WATER, noise=3e-3), WATER, *FITTABLE, known=KNOWN)
    assert warned(result, "this track does not tell damping from drag"), result


@pytest.mark.costly
def test_of_two_motions_alike_the_one_near_the_guess_is_taken() -> None:
    """Cans with a little and with much ice rock alike on other inclines."""
    scene = frozen(math.radians(3), 0.6, METAL)
    track = filmed(scene, phi0=1.0, noise=3e-3, seconds=2.0)
    result = fitted(track, scene, "incline", "fill", phi0=1.0)
    assert warned(result, "another motion is as near to the track: incline 5."), result
    assert result.values["fill"] == pytest.approx(0.6, abs=0.1)


def test_points_that_were_mistaken_change_nothing() -> None:
    track = filmed(OIL)
    track.along[[30, 100]] += 0.05
    result = fitted(track, OIL, known=KNOWN)
    assert warned(result, "2 points are far from all others"), result
    assert_within_errors(result, incline=OIL.incline)


@pytest.mark.parametrize(
    "free", [("incline",), pytest.param(("incline", "damping"), marks=pytest.mark.costly)]
)
def test_tracked_angles_give_the_scale_and_the_start(free: tuple[str, ...]) -> None:
    """The mark turns by the way over the radius; the load is let go 0.3 rad beyond the level."""
    start = 0.3 - OIL.incline
    true = filmed(OIL, start, noise=0.0, seconds=2.0)
    since = true.time - RELEASED
    phi = np.full(len(since), start)
    phi[since > 0] = exact(OIL, since[since > 0], start).phi
    roll = 0.7 + (true.along - PLACE) / METAL.radius
    noise = 1e-3 * np.random.default_rng(1).standard_normal((3, len(since)))
    track = Track(
        true.time,
        along=1.02 * true.along + noise[0],
        roll=roll + noise[1] / METAL.radius,
        phi=phi + 10 * noise[2],
    )
    result = fitted(track, OIL, *free, phi0="free")
    assert_within_errors(result, scale=1.02, turned=0.7, incline=OIL.incline, phi0=start)
    # Four errors are as much as 0.1 at most, or all of this would say nothing.
    assert max(result.errors[name] for name in ("scale", "turned", "incline", "phi0")) < 0.025


@pytest.mark.parametrize(
    ("scene", "others", "message"),
    [
        (ICE, {"free": ("damping",)}, "damping is sought, which this scene was made without"),
        (mjbeer.pendulum(), {"free": ("fill",)}, "fill is sought"),
        (mjbeer.pendulum(), {"known": KNOWN}, "fill is sought"),
        (WATER, {"free": ("mass",)}, "free must be one of"),
        (WATER, {"known": {"fill": (0.5, 0.0)}}, "a value and its error"),
        (WATER, {"known": {"fill": (0.5, 0.1, 0.2)}}, "a value and its error"),
        (WATER, {"known": {"mass": (0.5, 0.1)}}, "must be one of 'incline', .* got 'mass'"),
        (WATER, {"known": {"damping": (0.0, 0.1)}}, "known damping must be greater than 0"),
        (WATER, {"phi0": "flat"}, "phi0, if it is no number, must be one of"),
        (with_parameters(WATER, {"incline": -0.03}), {}, "does not roll down the scene's incline"),
    ],
)
def test_what_cannot_be_fitted_is_refused(
    scene: Scene, others: dict[str, Any], message: str
) -> None:
    with pytest.raises(ParameterError, match=message):
        fit(filmed(OIL), scene, **others)


def test_a_scene_that_cannot_be_is_refused() -> None:
    """A fill of 50 is none; who means percent does not get a fit."""
    with pytest.raises(MjbeerError, match="no motion of such a scene is like the track"):
        fitted(filmed(OIL), OIL, known={"fill": (50.0, 0.5)})


def table_of(track: Track, folder: pathlib.Path) -> pathlib.Path:
    """A file with the track, to the last digit."""
    path = folder / "can.csv"
    columns = np.stack([track.time, track.along], axis=1)
    np.savetxt(path, columns, header="t,x", comments="", delimiter=",")
    return path


def test_the_command_shows_the_fit(
    water_fit: Fit,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """It is asked for what the fixture was asked for, and shows what it is answered."""
    asked = mock.Mock(return_value=water_fit)
    monkeypatch.setattr("mjbeer.tracks.fit.fit", asked)
    table = table_of(water_fit.track, tmp_path)
    plot = tmp_path / "fit.svg"
    options = "--can metal --incline 2.5 --free incline damping --known fill=0.5±0.005"
    assert main(f"fit {table} liquid {options} --output {plot}".split()) == 0

    given = inspect.signature(fit).bind(*asked.call_args.args, **asked.call_args.kwargs).arguments
    assert given["scene"] == liquid("water", math.radians(2.5), can=METAL)
    assert list(given["free"]) == ["incline", "damping"]
    assert given["known"] == KNOWN
    assert given.get("phi0", "level") == "level"
    assert given.get("bend") is None
    assert np.array_equal(given["track"].time, water_fit.track.time)
    assert np.array_equal(given["track"].along, water_fit.track.along)
    printed = capsys.readouterr().out
    assert "% full can of 8.57 g, water, incline 2°; 167 points with a noise of" in printed
    assert printed == "\n".join([water_fit.title, *water_fit.lines()]) + "\n"
    degrees = math.degrees(water_fit.values["incline"])
    assert f"incline, less rolling resistance: {degrees:.3f}°" in plot.read_text()


def test_the_command_reads_marks_and_makes_a_can_of_one_s_own(
    water_fit: Fit, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = mock.Mock(return_value=water_fit)
    monkeypatch.setattr("mjbeer.tracks.fit.fit", asked)
    path, marks = seen_obliquely(tmp_path)
    words = [f"{x},{y}={place}" for x, y, place in marks.tolist()]
    can = "--can metal --can-mass 0.013 --can-radius 0.0331 --length 0.115"
    assert main(["fit", str(path), "liquid", "--marks", *words, *can.split()]) == 0
    track, guess = asked.call_args.args[:2]
    read = read_track(path, marks=marks)
    assert np.array_equal(track.along, read.along)
    assert track.scale_error == read.scale_error
    sheet = Can.sheet_metal(0.0331, 0.115)
    assert (guess.can.radius, guess.can.length, guess.can.mass) == (0.0331, 0.115, 0.013)
    assert guess.can.inertia / 0.013 == pytest.approx(sheet.inertia / sheet.mass, rel=1e-12)

    assert main(["fit", str(path), "liquid", "--scale", "700"]) == 0
    track, _ = asked.call_args.args[:2]
    assert np.array_equal(track.along, read_track(path, scale=700).along)


def test_the_command_fits(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = table_of(filmed(ICE, phi0=math.radians(-80)), tmp_path)
    options = "--can metal --incline 5.5 --phi0 -80 --json"
    assert main(f"fit {table} frozen {options}".split()) == 0
    found = json.loads(capsys.readouterr().out)
    assert abs(found["values"]["incline"] - ICE.incline) < 4 * found["errors"]["incline"]


def test_the_plot_shows_what_is_left(water_fit: Fit) -> None:
    _, rests, _ = water_fit.plot()
    shown = np.asarray(rests.get_lines()[0].get_ydata())  # [mm]
    # A noise is divided by the points less their share of the unknowns: 2 % more than the rms.
    assert np.std(shown) == pytest.approx(1e3 * water_fit.noise["along"], rel=0.05)


@pytest.mark.parametrize("suffix", ["svg", "mp4"])
def test_a_file_that_cannot_be_written_is_refused_before_the_fit(
    suffix: str,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("mjbeer.tracks.fit.fit", mock.Mock(side_effect=AssertionError("it began")))
    table = table_of(filmed(ICE), tmp_path)
    output = tmp_path / "nowhere" / f"x.{suffix}"
    assert main(["fit", str(table), "frozen", "--output", str(output)]) == 2
    message = capsys.readouterr().err.replace("\n", " ")
    assert f"there is no folder {output.parent}" in message


def test_the_film_has_the_tracked_places_as_marks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the model is the track, they are where the can is."""
    film = mock.Mock()
    monkeypatch.setattr("mjbeer.drawing.film.MotionFilm", film)
    monkeypatch.setattr("mjbeer.drawing.video.write", mock.Mock())
    result = fitted(filmed(OIL, noise=0.0), OIL, bend=0.0)
    result.video("can.mp4")
    look = film.call_args.args[1]
    moving = look.measured[:, 0] > 0.4
    time, place = look.measured[moving].T
    assert len(time) > 100
    assert place == pytest.approx(np.interp(time, result.run.time, result.run.u), abs=1e-6)


@pytest.mark.parametrize(("scatter", "passes"), [(1.0, True), (2.0, False)])
def test_the_validation_finds_errors_that_are_too_small(
    scatter: float, passes: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pretended fits are off by once or twice the errors that they state."""
    check = next(check for check in track_checks.checks() if check.bound > 0.1)  # in squares
    incline = track_checks.SCENES["water on 2 degrees"][0].incline
    pretended = SimpleNamespace(
        values={"incline": incline + 1e-3 * scatter, "damping": 1 - 0.05 * scatter},
        errors={"incline": 1e-3, "damping": 0.05},
        correlation=np.eye(2),
    )
    monkeypatch.setattr(track_checks, "fitted", mock.Mock(return_value=pretended))
    assert check.result().passed == passes


NUMBER = re.compile(r"\d+\.?\d*")


def test_the_page_shows_what_its_command_prints(
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Its words are those that are printed; a last digit may be another on another machine."""
    checkout = pathlib.Path(__file__).parents[2]
    page = (checkout / "docs" / "your-video.md").read_text()
    blocks = re.findall(r"^```console\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    assert blocks
    monkeypatch.chdir(tmp_path)
    shutil.copytree(checkout / "examples", "examples")
    for block in blocks:
        command, *shown = block.splitlines()
        assert main(shlex.split(command.removeprefix("$ mjbeer "))) == 0
        printed = capsys.readouterr()
        lines = [*printed.out.splitlines(), *printed.err.splitlines()]
        for line in shown:
            alike = [other for other in lines if NUMBER.sub("#", other) == NUMBER.sub("#", line)]
            assert alike, line
            numbers = zip(NUMBER.findall(line), NUMBER.findall(alike[0]), strict=True)
            for on_page, now in numbers:
                _, _, decimals = on_page.partition(".")
                last_digit = 10.0 ** -len(decimals)
                assert float(now) == pytest.approx(float(on_page), rel=1e-3, abs=1.5 * last_digit)
