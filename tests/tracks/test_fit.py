"""The fit finds what was in the can within its errors, and says what a track cannot tell and which model is wrong."""

import math
import pathlib
from dataclasses import replace
from typing import Any
from unittest import mock

import numpy as np
import pytest

import mjbeer
from mjbeer import Can, Scene, Track, exact, fit, frozen, liquid, sliding
from mjbeer.cli.app import main
from mjbeer.exceptions import ParameterError
from mjbeer.studies.validation import track_checks
from mjbeer.tracks.track_model import with_parameters
from mjbeer.tracks.unknowns import FITTABLE

pytestmark = pytest.mark.slow
METAL = Can.sheet_metal()
WATER, OIL = (liquid(name, math.radians(2), can=METAL) for name in ("water", "olive oil"))
ICE = frozen(math.radians(5), can=METAL)
KNOWN = {"fill": (0.5, 0.005)}


def filmed(scene: Scene, phi0: float | None = None, noise: float = 1e-3, seed: int = 0, seconds: float = 3.0) -> Track:
    """The track of a can that is let go at 17.4 s, by exact theory, with a gap; the camera runs from 17 s on."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(60 * seconds)) / 60
    rolls = time > 0.4
    way = np.zeros(len(time))
    way[rolls] = exact(scene, time[rolls] - 0.4, -scene.incline if phi0 is None else phi0).distance
    kept = (time < 1.5) | (time > 1.7)
    return Track(17 + time[kept], 0.1 + way[kept] + noise * rng.standard_normal(kept.sum()))


def found(track: Track, scene: Scene, *free: str, **others: Any) -> mjbeer.Fit:
    return fit(track, scene, free or ("incline",), progress=False, **others)


@pytest.mark.parametrize("scene", [WATER, OIL, ICE])
def test_the_truth_is_within_the_errors(scene: Scene) -> None:
    """Four standard errors are passed once in 10,000 times; and a right model is not said to be wrong."""
    guess = with_parameters(scene, {"incline": scene.incline + 0.01})
    phi0, other, known = (-1.5, "fill", None) if scene is ICE else (None, "damping", KNOWN)
    result = found(filmed(scene, phi0), guess, "incline", other, known=known, phi0="level" if phi0 is None else phi0)
    truth = {"incline": scene.incline, "damping": 1.0, "fill": 0.5, "released": 17.4, "place": 0.1, "bend": 0.0}
    for name, value in result.values.items():
        assert abs(value - truth[name]) < 4 * result.errors[name], name
    assert result.noise["along"] == pytest.approx(1e-3, rel=0.25)
    assert result.scene.incline == result.values["incline"]
    assert not [each for each in result.warnings if "model is wrong" in each or "does not tell" in each]


def test_the_start_of_a_search_is_not_its_answer() -> None:
    """A fill of 0.30 is nearly in step with these many swings of ice; the truth is between the fills 0.10 and 0.15."""
    scene, guess = frozen(math.radians(3.084), 0.1271, METAL), frozen(math.radians(3.4), 0.1598, METAL)
    result = found(filmed(scene, seconds=5.0), guess, "incline", "fill")
    for name, truth in {"incline": scene.incline, "fill": 0.1271, "released": 17.4}.items():
        assert abs(result.values[name] - truth) < 4 * result.errors[name], name


@pytest.mark.parametrize(
    ("degrees", "fill", "phi0", "noise"),
    [
        (2.557, 0.5033, None, 1e-3),  # it rocks 30 times: let go a swing too late it would be nearly the same
        (2.955, 0.5734, None, 1e-3),
        (6.603, 0.4142, -2.2, 3e-4),  # 24 m and 115 turns
    ],
)
def test_white_noise_of_a_long_track_is_no_wrong_model(
    degrees: float, fill: float, phi0: float | None, noise: float
) -> None:
    scene = frozen(math.radians(degrees), fill, METAL)
    guess = with_parameters(scene, {"incline": scene.incline + 0.01})
    result = found(filmed(scene, phi0, noise, seconds=8.0), guess, phi0="level" if phi0 is None else phi0)
    assert not [each for each in result.warnings if "N < 0" not in each]
    assert abs(result.values["incline"] - scene.incline) < 4 * result.errors["incline"]
    assert abs(result.values["released"] - 17.4) < 4 * result.errors["released"]


SMOOTH, FULL, MISTAKEN = sliding(WATER.incline, can=METAL), frozen(math.radians(3), 0.6, METAL), filmed(OIL)
MISTAKEN.along[[30, 100]] += 0.05
RESISTED = filmed(with_parameters(WATER, {"incline": WATER.incline - 0.01}))  # a resistance of 0.01 looks like less incline
WARNED: dict[str, tuple[Track, Scene, tuple[str, ...], dict[str, Any]]] = {
    "the model is wrong, or what was known: bend": (filmed(WATER), SMOOTH, (), {"known": KNOWN}),
    "the model is wrong": (filmed(ICE, -1.5), OIL, (), {"known": KNOWN}),
    "model is wrong": (filmed(OIL), WATER, (), {"known": KNOWN}),
    "what was known: incline": (RESISTED, WATER, ("damping",), {"known": KNOWN | {"incline": (WATER.incline, 0.002)}}),
    "this track does not tell damping from drag": (filmed(WATER, noise=3e-3), WATER, FITTABLE, {"known": KNOWN}),
    # Cans with a little and with much ice rock alike on other inclines.
    "another motion is as near": (filmed(FULL, 1.0, noise=3e-3), FULL, ("incline", "fill"), {"phi0": 1.0}),
    "2 points are far": (MISTAKEN, OIL, ("incline",), {"known": KNOWN}),
}


@pytest.mark.parametrize("words", WARNED)
def test_what_does_not_hold_is_told(words: str) -> None:
    """And points that were mistaken change nothing, and of two minima the one near to the guess is taken."""
    track, scene, free, others = WARNED[words]
    result = found(track, scene, *free, **others)
    assert any(words in each for each in result.warnings), result
    if track is MISTAKEN:
        assert abs(result.values["incline"] - OIL.incline) < 4 * result.errors["incline"]
    if scene is FULL:
        assert result.values["fill"] == pytest.approx(0.6, abs=0.1)


def test_tracked_angles_give_the_scale_and_the_start() -> None:
    """The mark turns by the way over the radius; the load is let go 0.3 rad beyond the level."""
    start, true = 0.3 - OIL.incline, filmed(OIL, 0.3 - OIL.incline, noise=0.0)
    noise = 1e-3 * np.random.default_rng(1).standard_normal((3, len(true.time)))
    rolls = true.time > 17.4
    phi = np.full(len(true.time), start)
    phi[rolls] = exact(OIL, true.time[rolls] - 17.4, start).phi
    phi += 10 * noise[2]
    roll = 0.7 + (true.along - 0.1) / 0.033 + noise[1] / 0.033
    result = found(Track(true.time, 1.02 * true.along + noise[0], roll, phi), OIL, "incline", "damping", phi0="free")
    for name, truth in {"scale": 1.02, "turned": 0.7, "incline": OIL.incline, "phi0": start}.items():
        assert abs(result.values[name] - truth) < 4 * result.errors[name] < 0.1


@pytest.mark.parametrize(
    ("scene", "others", "message"),
    [
        (ICE, {"free": ("damping",)}, "damping is sought, which this scene was made without"),
        (mjbeer.pendulum(), {"free": ("fill",)}, "fill is sought"),
        (WATER, {"free": ("mass",)}, "free must be one of"),
        (WATER, {"known": {"fill": (0.5, 0.0)}}, "a value and its error"),
        (WATER, {"known": {"mass": (0.5, 0.1)}}, "must be one of 'incline', .* got 'mass'"),
        (WATER, {"phi0": "flat"}, "phi0, if it is no number, must be one of"),
        (with_parameters(WATER, {"incline": -0.03}), {}, "does not roll down the scene's incline"),
    ],
)
def test_what_cannot_be_fitted_is_refused(scene: Scene, others: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        fit(filmed(OIL), scene, **others)


def test_the_plot_and_the_command_show_the_fit(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    track, table, plot = filmed(WATER), tmp_path / "can.csv", tmp_path / "fit.svg"
    np.savetxt(table, np.stack([track.time, track.along], axis=1), header="t,x", comments="", delimiter=",")
    options = f"--can metal --incline 2.5 --free incline damping --known fill=0.5±0.005 --output {plot}"
    assert main(f"fit {table} liquid {options}".split()) == 0
    result = found(track, liquid("water", math.radians(2.5), can=METAL), "incline", "damping", known=KNOWN)
    assert capsys.readouterr().out == "\n".join([result.title, *result.lines()]) + "\n"
    assert f"incline, less rolling resistance: {math.degrees(result.values['incline']):.3f}°" in plot.read_text()
    assert np.std(result.plot()[1].get_lines()[0].get_ydata()) == pytest.approx(1e3 * result.noise["along"], rel=0.05)


@pytest.mark.parametrize("suffix", ["svg", "mp4"])
def test_a_file_that_cannot_be_written_is_refused_before_the_fit(
    suffix: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fitted = mock.Mock(side_effect=AssertionError("the fit began"))
    monkeypatch.setattr("mjbeer.tracks.fit.fit", fitted)
    track, table = filmed(ICE), tmp_path / "can.csv"
    np.savetxt(table, np.stack([track.time, track.along], axis=1), header="t,x", comments="", delimiter=",")
    assert main(["fit", str(table), "frozen", "--output", str(tmp_path / "nowhere" / f"x.{suffix}")]) == 2
    assert f"there is no folder {tmp_path / 'nowhere'}" in capsys.readouterr().err.replace("\n", " ")


def test_the_film_has_the_tracked_places_as_marks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the model is the track, they are where the can is."""
    film = mock.Mock()
    monkeypatch.setattr("mjbeer.drawing.film.MotionFilm", film)
    monkeypatch.setattr("mjbeer.drawing.video.write", mock.Mock())
    result = found(filmed(OIL, noise=0.0), OIL, bend=0.0)
    result.video("can.mp4")
    time, u = film.call_args.args[1].measured[50:].T  # it moves from 0.4 s on
    assert u == pytest.approx(np.interp(time, result.run.time, result.run.u), abs=1e-6)


def test_errors_that_are_too_small_are_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the validation: here the errors are half of what they should be."""

    def sure(*words: Any, right: Any = track_checks.fitted) -> mjbeer.Fit:
        result = right(*words)
        return replace(result, errors={name: error / 2 for name, error in result.errors.items()})

    monkeypatch.setattr(track_checks, "fitted", sure)
    assert not next(each for each in track_checks.checks() if each.bound > 0.1).result().passed
