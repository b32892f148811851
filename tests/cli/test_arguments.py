"""What the command line says about a scene and a run: units, defaults, and that all of it arrives."""

import inspect
import math
import re

import numpy as np
import pytest

from mjbeer import Can, Scene, build, frozen, hoop, liquid, pendulum, render, simulate, sliding
from mjbeer.cli.app import OF_SCENES, main, parse
from mjbeer.cli.arguments import angle, angles, numbers, of_scene, scene, start, steps
from mjbeer.model.export import export

PURE_NUMBERS = {"--fill", "--friction", "--speed", "--damping-ratio"}


def test_help_states_the_unit_of_every_number() -> None:
    for command, scenes in OF_SCENES.items():
        for name, meaning, default, kind in (option for of in scenes for option in of_scene(of, command)):
            if kind in (angle, angles):
                assert "[degrees" in meaning, name
            elif kind in (float, numbers) and default is not False:
                assert name in PURE_NUMBERS or re.search(r"\[\S", meaning), name


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        ("sliding", sliding()),
        ("frozen", frozen()),
        ("pendulum", pendulum()),
        ("hoop", hoop()),
        ("liquid", liquid()),
        (
            "sliding --incline -2e1 --radius 0.04 --length 0.2 --gravity 1.6 --fill 0.3 --can metal --density 900 "
            "--damping 1e-3 --drag 1e-4",
            sliding(math.radians(-20), 0.3, Can.sheet_metal(0.04, 0.2), 900, 1.6, 1e-3, 1e-4),
        ),
        (
            "liquid --liquid honey --incline 5 --radius 0.04 --length 0.2 --gravity 1.6 --fill 0.3 --can metal "
            "--density 900 --viscosity 1e-5 --drag 1e-4",
            liquid("honey", math.radians(5), 0.3, Can.sheet_metal(0.04, 0.2), 900, 1e-5, 1.6, 1e-4),
        ),
        (
            "frozen --incline 5 --radius 0.04 --length 0.2 --gravity 1.6 --fill 0.3 --density 900",
            frozen(math.radians(5), 0.3, Can.massless(0.04, 0.2), 900, 1.6),
        ),
        (
            "pendulum --incline 20 --radius 0.04 --length 0.2 --gravity 1.6 --wheel-mass 0.5 --load-mass 0.6 "
            "--offset 0.03",
            pendulum(math.radians(20), 0.5, 0.6, 0.03, 0.04, 0.2, 1.6),
        ),
        (
            "hoop --incline 7 --radius 0.04 --length 0.2 --gravity 1.6 --hoop-mass 0.5 --load-mass 0.6",
            hoop(math.radians(7), 0.5, 0.6, 0.04, 0.2, 1.6),
        ),
    ],
)
def test_a_scene_is_that_of_python(words: str, meant: Scene) -> None:
    given = parse(["simulate", *words.split()])
    assert scene(given) == meant


def test_the_options_of_the_run_arrive() -> None:
    words = (
        "simulate frozen --phi0 -30 --phi-dot0 180 --duration 0.5 --rolling contact --integrator discrete "
        "--timestep 2e-3 --tolerance 1e-8 --friction 0.4 --output motion.csv"
    )
    given = parse(words.split())
    assert start(given) == {"phi0": math.radians(-30), "phi_dot0": math.pi}
    assert steps(given) == {
        "rolling": "contact", "integrator": "discrete", "timestep": 2e-3, "tolerance": 1e-8, "friction": 0.4,
    }  # fmt: skip
    assert (given.duration, str(given.output)) == (0.5, "motion.csv")


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        ("simulate frozen", simulate),
        ("export frozen", build),
        ("export frozen", export),
        ("render frozen", render),
    ],
)
def test_the_defaults_are_those_of_python(words: str, meant: object) -> None:
    given = parse(words.split())
    for name, parameter in inspect.signature(meant).parameters.items():
        if hasattr(given, name) and name not in ("scene", "phi0", "output"):
            assert getattr(given, name) in (parameter.default, None), name  # which is left to Python's default


def test_a_range_a_list_or_a_number() -> None:
    given = parse(["sweep", "frozen", "--incline", "-1:1:5", "--fill", "0.1,0.2", "--phi0", "-.3e1"])
    assert np.array_equal(given.incline, np.radians([-1.0, -0.5, 0.0, 0.5, 1.0]))
    assert np.array_equal(given.fill, [0.1, 0.2])
    assert given.phi0 == np.radians(-3.0)


@pytest.mark.parametrize("text", ["", "x", "1:2", "1:2:0", "1:2:0.5", "1:2:3:4", "1,,2", "nan", "0:1:-1"])
def test_what_is_none_of_these_is_refused(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", "frozen", "--fill", text]) == 2
    assert "is no number, no list as 1,2,5, and no range as 1:20:39" in capsys.readouterr().err
