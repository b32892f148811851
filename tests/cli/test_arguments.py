"""The options of a scene and of a run: their units, their defaults, and the values that arrive."""

import inspect
import math
import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from mjbeer import Can, build, frozen, render, simulate
from mjbeer.cli.app import SCENES_OF, main, parse
from mjbeer.cli.arguments import (
    SCENES,
    angle,
    angles,
    model_arguments,
    numbers,
    scene,
    scene_options,
    start_arguments,
)
from mjbeer.model.export import export

OWN: dict[str, Any] = {
    "name": "honey",
    "incline": math.radians(-20),
    "fill": 0.3,
    "can": Can.sheet_metal(0.04, 0.2),
    "density": 900.0,
    "viscosity": 1e-5,
    "gravity": 1.6,
    "damping": 1e-3,
    "drag": 1e-4,
    "wheel_mass": 0.5,
    "hoop_mass": 0.4,
    "load_mass": 0.6,
    "offset": 0.03,
    "radius": 0.04,
    "length": 0.2,
}
"""For each parameter of a scene a value that is not its default."""
PURE_NUMBERS = {"--fill", "--friction", "--speed", "--damping-ratio"}


def test_help_states_the_unit_of_every_number() -> None:
    for command, scenes in SCENES_OF.items():
        for name in scenes:
            for option in scene_options(name, command):
                if option.read in (angle, angles):
                    assert "[degrees" in option.help, option.name
                elif option.read in (float, numbers) and not (option.flag or option.choices):
                    has_unit = re.search(r"\[\S", option.help)
                    assert has_unit or option.name in PURE_NUMBERS, option.name


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_is_that_of_python(name: str) -> None:
    """With its defaults, and with a value of its own for each parameter."""
    assert scene(parse(["simulate", name])) == SCENES[name]()
    values = OWN | {"can": "metal", "liquid": "honey", "incline": -20}
    words = []
    for option in scene_options(name, "simulate"):
        parameter = option.name.removeprefix("--").replace("-", "_")
        if parameter in values:
            words.append(f"{option.name}={values[parameter]}")
    arguments = {
        parameter: OWN[parameter] for parameter in inspect.signature(SCENES[name]).parameters
    }
    assert scene(parse(["simulate", name, *words])) == SCENES[name](**arguments)


@pytest.mark.parametrize("name", ["sliding", "frozen", "liquid", "standing"])
def test_a_can_of_one_s_own_has_the_shape_of_metal_sheet(name: str) -> None:
    words = f"simulate {name} --can-mass 0.013 --can-radius 0.0331 --length 0.115".split()
    if name == "standing":
        words[0] = "export"

    can = scene(parse(words)).can

    sheet = Can.sheet_metal(0.0331, 0.115)
    assert (can.radius, can.length, can.mass) == (0.0331, 0.115, 0.013)
    assert can.inertia / can.mass == pytest.approx(sheet.inertia / sheet.mass, rel=1e-12)


def test_the_options_of_the_run_arrive() -> None:
    words = (
        "simulate frozen --phi0 -30 --phi-dot0 180 --duration 0.5 --rolling contact "
        "--integrator discrete --timestep 2e-3 --tolerance 1e-8 --friction 0.4 --output motion.csv"
    )
    given = parse(words.split())
    assert start_arguments(given) == {"phi0": math.radians(-30), "phi_dot0": math.pi}
    assert model_arguments(given) == {
        "rolling": "contact",
        "integrator": "discrete",
        "timestep": 2e-3,
        "tolerance": 1e-8,
        "friction": 0.4,
    }
    assert given.duration == 0.5
    assert str(given.output) == "motion.csv"


MODEL = ("rolling", "integrator", "timestep", "friction", "phi_dot0")


@pytest.mark.parametrize(
    ("words", "function", "names"),
    [
        ("simulate frozen", simulate, [*MODEL, "tolerance"]),
        ("export frozen", build, MODEL),
        ("export frozen", export, [*MODEL, "looks", "portable"]),
        ("render frozen", render, ["camera", "height", "speed", "width"]),
    ],
)
def test_the_defaults_are_those_of_python(
    words: str, function: Callable[..., Any], names: Sequence[str]
) -> None:
    given = parse(words.split())
    parameters = inspect.signature(function).parameters
    for name in names:
        # None leaves the value to Python's default.
        assert getattr(given, name) in (parameters[name].default, None), name


def test_the_default_duration_is_that_of_python() -> None:
    """Python has it in no signature, since there the times of the samples may give the duration."""
    assert parse(["simulate", "frozen"]).duration == simulate(frozen(), phi0=1.0).time[-1]


def test_a_range_a_list_or_a_number() -> None:
    given = parse(
        ["sweep", "frozen", "--incline", "-1:1:5", "--fill", "0.1,0.2", "--phi0", "-.3e1"]
    )
    assert np.array_equal(given.incline, np.radians([-1.0, -0.5, 0.0, 0.5, 1.0]))
    assert np.array_equal(given.fill, [0.1, 0.2])
    assert given.phi0 == np.radians(-3.0)


@pytest.mark.parametrize(
    "text", ["", "x", "1:2", "1:2:0", "1:2:0.5", "1:2:3:4", "1,,2", "nan", "0:1:-1"]
)
def test_what_is_none_of_these_is_refused(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", "frozen", "--fill", text]) == 2
    allowed = "it must be a number, a list such as 1,2,5, or a range such as 1:20:39"
    message = f"argument --fill: {allowed} (39 numbers from 1 to 20), got {text!r}; "
    assert capsys.readouterr().err.startswith(f"mjbeer: {message}")
