"""What the command line says about a scene and a run: units, defaults, and that all of it arrives."""

import inspect
import math
import pathlib
import re
from typing import get_args

import pytest

from mjbeer import Can, Scene, build, frozen, hoop, liquid, pendulum, render, simulate, sliding
from mjbeer.cli.app import Command, main, parse
from mjbeer.cli.arguments import Common, Frozen, Hoop, Integrator, Liquid, Motion, Pendulum, Rolling, Sliding, radians
from mjbeer.cli.motions import Export, Render, Simulate
from mjbeer.exceptions import ParameterError
from mjbeer.model.export import export
from mjbeer.model.setting import INTEGRATORS, OWN, ROLLINGS

UNITS = {
    "phi0": "degrees", "phi-dot0": "degrees/s", "incline": "degrees", "duration": "s", "timestep": "s",
    "tolerance": "rad", "radius": "m", "length": "m", "offset": "m", "gravity": "m/s^2", "density": "kg/m^3",
    "hoop-mass": "kg", "wheel-mass": "kg", "load-mass": "kg", "width": "pixels", "height": "pixels",
    "damping": "N m s", "drag": "kg/m", "viscosity": "m^2/s",
}  # fmt: skip
PURE_NUMBERS = {"fill", "friction", "speed"}
SCENES = ("sliding", "liquid", "frozen", "pendulum", "hoop")
NUMBER = re.compile(r"--(?P<name>[\w-]+) (?:FLOAT|INT)\s(?P<text>.*?)(?=\(default|\(required)", re.DOTALL)


@pytest.mark.parametrize("command", ["simulate", "render", "export"])
@pytest.mark.parametrize("scene", SCENES)
def test_help_states_the_unit_of_every_number(
    command: str, scene: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "250")
    with pytest.raises(SystemExit) as ended:
        main([command, scene, "--help"])
    numbers = {each["name"]: each["text"] for each in NUMBER.finditer(capsys.readouterr().out)}
    assert ended.value.code == 0
    assert {"phi0", "phi-dot0", "incline", "radius", "timestep", "friction"} <= set(numbers)
    assert set(numbers) <= set(UNITS) | PURE_NUMBERS
    for name in set(numbers) - PURE_NUMBERS:
        assert f"[{UNITS[name]}]" in numbers[name], name


@pytest.mark.parametrize("command", [[], *([each.__name__.lower()] for each in get_args(Command))])
def test_every_command_has_help(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main([*command, "--help"])
    assert ended.value.code == 0
    assert " ".join(["usage: mjbeer", *command]) in capsys.readouterr().out


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        (Sliding(), sliding()),
        (Frozen(), frozen()),
        (Pendulum(), pendulum()),
        (Hoop(), hoop()),
        (
            Sliding(-20, 0.04, 0.2, 1.6, 0.3, "metal", 900, 1e-3, 1e-4),
            sliding(math.radians(-20), 0.3, Can.sheet_metal(0.04, 0.2), 900, 1.6, 1e-3, 1e-4),
        ),
        (Liquid(), liquid()),
        (
            Liquid(5, 0.04, 0.2, 1.6, 0.3, "metal", "olive oil", 900, 1e-5, 1e-4),
            liquid("olive oil", math.radians(5), 0.3, Can.sheet_metal(0.04, 0.2), 900, 1e-5, 1.6, 1e-4),
        ),
        (Frozen(5, 0.04, 0.2, 1.6, 0.3, density=900), frozen(math.radians(5), 0.3, Can.massless(0.04, 0.2), 900, 1.6)),
        (Pendulum(20, 0.04, 0.2, 1.6, 0.5, 0.6, 0.03), pendulum(math.radians(20), 0.5, 0.6, 0.03, 0.04, 0.2, 1.6)),
        (Hoop(7, 0.04, 0.2, 1.6, 0.5, 0.6), hoop(math.radians(7), 0.5, 0.6, 0.04, 0.2, 1.6)),
    ],
)
def test_a_scene_is_that_of_python(said: Sliding | Liquid | Frozen | Pendulum | Hoop, meant: Scene) -> None:
    assert said.scene() == meant


def test_the_defaults_are_those_of_python() -> None:
    for said, meant in (
        (Motion(Sliding()), simulate),
        (Export(Sliding(), pathlib.Path("model.xml")), build),
        (Export(Sliding(), pathlib.Path("model.xml")), export),
        (Render(Sliding()), render),
    ):
        for name, parameter in inspect.signature(meant).parameters.items():
            if hasattr(said, name) and parameter.default is not parameter.empty and name != "phi0":
                default = getattr(said, name)
                # An integrator that is not given is left to Python's default, and to the tolerance.
                assert default == parameter.default or (name == "integrator" and default is None), name


def test_the_names_are_those_of_python() -> None:
    assert get_args(Rolling) == ROLLINGS
    assert get_args(Integrator) == (*INTEGRATORS, *OWN)


def test_every_option_arrives() -> None:
    words: str = (
        "simulate frozen --incline 3 --radius 0.04 --length 0.2 --gravity 1.6 --fill 0.3 --density 900 --can metal "
        "--phi0 -30 --phi-dot0 12 --duration 0.5 --rolling contact --integrator discrete --timestep 2e-3 "
        "--tolerance 1e-8 --friction 0.4 --output motion.csv"
    )
    command = parse(words.split())
    assert isinstance(command, Simulate)
    assert command.scene == Frozen(3, 0.04, 0.2, 1.6, 0.3, "metal", 900)
    settings = {
        "phi0": -30, "phi_dot0": 12, "duration": 0.5, "rolling": "contact", "integrator": "discrete",
        "timestep": 2e-3, "tolerance": 1e-8, "friction": 0.4,
    }  # fmt: skip
    assert {name: getattr(command, name) for name in settings} == settings
    assert str(command.output) == "motion.csv"


@pytest.mark.parametrize("command", ["simulate", "render", "export --output model.xml"])
def test_options_of_the_run_stand_before_or_after_the_scene(command: str) -> None:
    before = f"{command} --phi0 30 --timestep 2e-3 sliding --fill 0.3"
    after = f"{command} sliding --fill 0.3 --timestep 2e-3 --phi0 30"
    assert parse(before.split()) == parse(after.split())
    assert parse(after.split()) != parse(f"{command} sliding".split())


def test_angles_are_degrees() -> None:
    assert radians("phi0", 180) == math.pi
    assert Common(incline=90 / math.pi).alpha == pytest.approx(0.5, rel=1e-15)  # two roundings


def test_a_run_has_its_angles_in_degrees() -> None:
    run = Motion(Frozen(), phi0=30, phi_dot0=90, duration=0.01).simulate()
    same = simulate(frozen(), 0.01, math.radians(30), math.radians(90))
    assert (run.phi == same.phi).all()
    assert run.phi_dot[0] == math.pi / 2


@pytest.mark.parametrize("incline", [90.0, -90.0, 100.0, math.nan, math.inf])
def test_an_incline_is_refused_in_degrees(incline: float) -> None:
    with pytest.raises(ParameterError) as caught:
        Sliding(incline=incline).scene()
    assert str(caught.value) == f"incline must be between -90 and 90 [degrees], got {incline!r}"


def test_an_angle_that_is_none_is_refused_in_degrees() -> None:
    for run, message in (
        (Motion(Frozen(), phi0=math.nan), "phi0 must be a finite number [degrees], got nan"),
        (Motion(Frozen(), phi_dot0=math.inf), "phi_dot0 must be a finite number [degrees/s], got inf"),
    ):
        with pytest.raises(ParameterError) as caught:
            run.simulate()
        assert str(caught.value) == message
