"""What a can, a load and a scene refuse, and what they say about it."""

import dataclasses
import math
import re
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

from mjbeer import Can, Load, MjbeerError, Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import ParameterError
from mjbeer.messages import shown
from mjbeer.require import LARGEST, SMALLEST

NAN, INFINITY = math.nan, math.inf
BEER = Load(0.2, 0.01, 1e-5)


def refuses(message: str, make: Callable[..., object], *arguments: object, **named: object) -> None:
    with pytest.raises(ParameterError, match=re.escape(message)):
        make(*arguments, **named)


@pytest.mark.parametrize("bad", [-1.0, 0.0, -0.0])
@pytest.mark.parametrize(
    ("name", "unit", "make"),
    [
        ("can radius", "m", lambda bad: Can(radius=bad)),
        ("can length", "m", lambda bad: Can(length=bad)),
        ("can radius", "m", lambda bad: Can.sheet_metal(radius=bad)),
        ("can length", "m", lambda bad: Can.sheet_metal(length=bad)),
        ("sheet thickness", "m", lambda bad: Can.sheet_metal(thickness=bad)),
        ("sheet density", "kg/m^3", lambda bad: Can.sheet_metal(density=bad)),
        ("hoop radius", "m", lambda bad: Can.hoop(radius=bad)),
        ("hoop mass", "kg", lambda bad: Can.hoop(mass=bad)),
        ("load mass", "kg", lambda bad: Load(bad, 0.01)),
        ("load mass", "kg", lambda bad: Load.point(bad, 0.01)),
        ("load radius", "m", lambda bad: Load.segment(radius=bad)),
        ("load length", "m", lambda bad: Load.segment(length=bad)),
        ("load density", "kg/m^3", lambda bad: Load.segment(density=bad)),
        ("load density", "kg/m^3", lambda bad: sliding(density=bad)),
        ("wheel mass", "kg", lambda bad: pendulum(wheel_mass=bad)),
        ("wheel radius", "m", lambda bad: pendulum(radius=bad)),
        ("load mass", "kg", lambda bad: hoop(load_mass=bad)),
    ],
)
def test_must_be_positive(name: str, unit: str, make: Callable[[float], object], bad: float) -> None:
    refuses(f"{name} must be greater than 0 [{unit}], got {bad!r}", make, bad)


@pytest.mark.parametrize(
    ("name", "unit", "make"),
    [
        ("can mass", "kg", lambda bad: Can(mass=bad)),
        ("can inertia", "kg m^2", lambda bad: Can(mass=1.0, inertia=bad)),
        ("load offset", "m", lambda bad: Load(1.0, bad)),
        ("load inertia", "kg m^2", lambda bad: Load(1.0, 0.01, bad)),
        ("gravity", "m/s^2", lambda bad: sliding(gravity=bad)),
    ],
)
def test_must_not_be_negative(name: str, unit: str, make: Callable[[float], object]) -> None:
    refuses(f"{name} must be 0 or greater [{unit}], got -1e-09", make, -1e-9)


@pytest.mark.parametrize(
    "bad",
    [
        NAN,
        INFINITY,
        -INFINITY,
        "0.033",
        "wide",
        b"1",
        None,
        True,
        1j,
        [1.0],
        10**400,
        np.True_,
        np.ma.masked,
        np.array([1.0]),
        Decimal("NaN"),
        np.timedelta64(1, "s"),
    ],
    ids=shown,
)
@pytest.mark.parametrize(
    ("name", "unit", "make"),
    [
        ("can radius", " [m]", lambda bad: Can(radius=bad)),
        ("can mass", " [kg]", lambda bad: Can(mass=bad)),
        ("load offset", " [m]", lambda bad: Load(1.0, bad)),
        ("fill", "", lambda bad: Load.segment(fill=bad)),
        ("fill", "", lambda bad: frozen(fill=bad)),
        ("incline", " [rad]", sliding),
        ("gravity", " [m/s^2]", lambda bad: hoop(gravity=bad)),
        ("amplitude", " [rad]", lambda bad: sliding().period(bad)),
        ("phi0", " [rad]", lambda bad: exact(sliding(), np.zeros(1), bad)),
        ("phi_dot0", " [rad/s]", lambda bad: exact(sliding(), np.zeros(1), 0.0, bad)),
    ],
)
def test_must_be_a_finite_number(name: str, unit: str, make: Callable[[object], object], bad: object) -> None:
    refuses(f"{name} must be a finite number{unit}, got {shown(bad)}", make, bad)


@pytest.mark.parametrize("bad", [0, 0.0, -0.1, 1.2, math.nextafter(1, 2)])
@pytest.mark.parametrize("make", [Load.segment, sliding, frozen, partial(Load, 1.0, 0.01)])
def test_fill_is_a_share(make: Callable[..., object], bad: float) -> None:
    refuses(f"fill (height of the beer over the can's diameter) must be in (0, 1], got {bad!r}", make, fill=bad)


@pytest.mark.parametrize("bad", [math.pi / 2, -math.pi / 2, 2.0, 10])
def test_incline_is_less_than_vertical(bad: float) -> None:
    refuses(f"incline must be between -pi/2 and pi/2 [rad] (90 degrees), got {bad!r}", sliding, bad)


@pytest.mark.parametrize("bad", ["glued", "Frozen", "", 3, None])
def test_attachment_is_one_of_two(bad: str) -> None:
    refuses(f"attachment must be one of 'sliding', 'frozen'; got {bad!r}", Scene, Can(), BEER, attachment=bad)


def test_load_is_inside_the_can() -> None:
    assert Scene(Can(radius=0.01), BEER).load.offset == 0.01  # on the rim is inside
    refuses("offset must be at most the radius 0.009 m, got 0.01 m", Scene, Can(radius=0.009), BEER)


def test_can_without_mass_has_no_inertia() -> None:
    refuses("a can without mass has no inertia, got mass 0 kg and inertia 1e-05 kg m^2", Can, inertia=1e-5)


@pytest.mark.parametrize(
    ("attachment", "offset"), [("sliding", 0.02), ("sliding", 0.0), ("frozen", 0.033)], ids=["inside", "axis", "rim"]
)
def test_something_has_to_resist_rotation(attachment: str, offset: float) -> None:
    """J(0) = 0: at phi = 0 the load neither turns nor moves, and the can weighs nothing."""
    with pytest.raises(ParameterError, match=r"nothing resists rotation at phi = 0: .* can mass 0(\.0)? kg"):
        Scene(Can.massless(), Load.point(0.2, offset), 0.1, attachment)


def test_frozen_point_off_the_rim_needs_no_can() -> None:
    assert Scene(Can.massless(), Load.point(0.2, 0.02), 0.1, "frozen").frequency() > 0


def test_film_too_thin_to_weigh_anything() -> None:
    follows = "which follows from radius = 0.033, length = 0.12, fill = 1e-300, density = 1000.0"
    refuses(f"load mass must be greater than 0 [kg], got 0.0, {follows}", sliding, fill=1e-300)


@pytest.mark.parametrize("bad", [1e160, 1e51, 1e-51, 1e-320])
@pytest.mark.parametrize(
    ("allowed", "unit", "make"),
    [
        ("can radius must be", "m", lambda bad: Can(radius=bad)),
        ("can mass must be 0, or", "kg", lambda bad: Can(mass=bad)),
        ("load mass must be", "kg", lambda bad: Load(bad, 0.01)),
        ("load inertia must be 0, or", "kg m^2", lambda bad: Load(1.0, 0.01, bad)),
        ("gravity must be 0, or", "m/s^2", lambda bad: frozen(gravity=bad)),
        ("load density must be", "kg/m^3", lambda bad: frozen(density=bad)),
    ],
)
def test_magnitudes_have_limits(allowed: str, unit: str, make: Callable[[float], object], bad: float) -> None:
    refuses(f"{allowed} between 1e-50 and 1e+50 [{unit}], got {bad!r}", make, bad)


def test_a_product_of_six_numbers_within_the_limits_is_a_normal_double() -> None:
    tiny, huge = np.finfo(float).tiny, np.finfo(float).max
    assert tiny < math.prod([SMALLEST] * 6) < SMALLEST
    assert LARGEST < math.prod([LARGEST] * 6) < huge
    largest = Scene(Can(LARGEST, LARGEST, LARGEST, LARGEST), Load(LARGEST, LARGEST, LARGEST), 1.5, "frozen", LARGEST)
    smallest = Scene(Can(SMALLEST, SMALLEST, SMALLEST), Load(SMALLEST, SMALLEST, SMALLEST), 1e-300, "sliding", SMALLEST)
    for scene in (largest, smallest):
        numbers = [*dataclasses.astuple(scene.oscillator), scene.acceleration(), scene.mass]
        assert all(abs(each) < huge for each in numbers)


@pytest.mark.parametrize(
    "number", [Decimal("0.25"), Fraction(1, 4), np.float16(0.25), np.float64(0.25), np.longdouble(0.25), np.array(0.25)]
)
def test_numbers_of_any_kind_become_doubles(number: object) -> None:
    scene = Scene(Can(number, number, number, number), Load(number, number, number, number), number, gravity=number)
    for values in (dataclasses.astuple(scene.can), dataclasses.astuple(scene.load), (scene.incline, scene.gravity)):
        assert all(type(each) is float and each == 0.25 for each in values)


@pytest.mark.parametrize("bad", ["metal", 3, Can, BEER, [Can()]])
def test_a_can_is_a_can(bad: object) -> None:
    refuses(f"can must be a Can, got {shown(bad)}", sliding, can=bad)
    refuses(f"can must be a Can, got {shown(bad)}", Scene, bad, BEER)


@pytest.mark.parametrize("bad", ["beer", None, Can(), Load])
def test_a_load_is_a_load(bad: object) -> None:
    refuses(f"load must be a Load, got {shown(bad)}", Scene, Can(), bad)


def test_parameters_are_frozen() -> None:
    scene = sliding()
    for each, name in ((scene.can, "mass"), (scene.load, "mass"), (scene, "incline"), (scene.oscillator, "base")):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(each, name, 1.0)


def test_errors_are_value_errors_too() -> None:
    assert issubclass(ParameterError, MjbeerError)
    assert issubclass(ParameterError, ValueError)


def test_equal_parameters_make_equal_scenes() -> None:
    assert sliding(0.1) == sliding(0.1)
    assert hash(sliding(0.1)) == hash(sliding(0.1))
    assert sliding(0.1) != frozen(0.1)
