"""The domain of cans, loads and scenes, and how scenes are shown."""

import math
import pickle
import re
from collections.abc import Callable

import numpy as np
import pytest

import mjbeer
from mjbeer import Can, Damping, Load, Scene, exact, liquid, sliding
from mjbeer.exceptions import ParameterError

BEER = Load(0.2, 0.01, 1e-5)


def refuses(message: str, make: Callable[..., object], *arguments: object, **named: object) -> None:
    with pytest.raises(ParameterError, match=re.escape(message)):
        make(*arguments, **named)


def wheel(can_mass: float = 0.1, load_mass: float = 0.2, offset: float = 0.5, **named: float) -> Scene:
    """A hoop of radius 1 with a point load that slides, J(0) = m b^2 K/(m + K)."""
    return Scene(Can(1.0, 1.0, can_mass, can_mass), Load(load_mass, offset), 0.0, **named)


def shell(inertia: float) -> Scene:
    """A can of radius 1 that is lighter than its load, which has an inertia of its own."""
    return Scene(Can(1.0, 1.0, 0.1, 0.1), Load(0.2, 0.5, inertia), 0.0)


EDGES = [
    ("can radius", 1e-3, 1e2, lambda value: Can(radius=value)),
    ("can length", 1e-3, 1e2, lambda value: Can(length=value)),
    ("can mass", 1e-9, 1e4, lambda value: Can(mass=value)),
    ("can inertia", None, 1e4 * 0.1 * 0.033**2, lambda value: Can(mass=0.1, inertia=value)),
    ("load mass", 1e-9, 1e4, lambda value: Load(value, 0.01)),
    ("load offset", 0.0, 1e2, lambda value: Load(1.0, value)),
    ("load offset", 1e-14, 1.0, lambda value: wheel(offset=value)),
    ("load inertia", None, 2e3, shell),
    ("mass of the can over that of the load", 1e-4, 1e4, lambda value: wheel(value / 8, 1 / 8)),
    ("gravity", 1e-3, 1e3, lambda value: sliding(gravity=value)),
    ("phi0", -1e4, 1e4, lambda value: exact(sliding(), 0.0, value)),
    ("phi_dot0", -1e6, 1e6, lambda value: exact(sliding(), 0.0, 0.0, value)),
]
"""Names, ends of their ranges, and what takes them."""


@pytest.mark.parametrize(("name", "lowest", "highest", "make"), EDGES, ids=[name for name, *_ in EDGES])
def test_the_domain_has_its_edges_and_nothing_beyond(
    name: str, lowest: float | None, highest: float, make: Callable[[float], object]
) -> None:
    below = [] if lowest is None else [lowest - 1e-5 * (abs(lowest) or 1e-5)]
    for edge in (lowest or 0.0, highest):
        make(edge)
    for beyond in (*below, highest * (1 + 1e-5)):
        refuses(f"between {lowest or 0:.6g} and {highest:.6g}", make, beyond)
        refuses(f"{name} must be ", make, beyond)


def test_damping_and_drag_have_rates() -> None:
    """At phi = pi a wheel of 0.1 kg with K = 0.2 kg and a load of 0.2 kg at half its radius resists least."""
    rate = (0.2 * 0.25 + 2 * 0.2 * 0.5 + 0.4) / (0.4 * 0.2 * 0.25 * 0.5)
    for damping in (0.999e9 / rate, 1.001e-12 / rate, Damping(quadratic=0.999e9 / rate / 2)):
        assert wheel(damping=damping * (1 - 1e-9) if isinstance(damping, float) and damping > 1 else damping).dissipates
    wheel(drag=0.19e9)
    refuses("rate of damping must be 0, or between 1e-12 and 1e+09 [1/s], got", wheel, damping=1.01e9 / rate)
    refuses("rate of damping must be 0, or between", wheel, damping=Damping(quadratic=1e9 / rate))
    refuses("rate of drag must be 0, or between 1e-12 and 1e+09 [1/s], got 1050000000.0", wheel, drag=0.21e9)


FILL = "fill must be between 0 and 1, got {!r}"
REFUSED = [
    ("sheet thickness must be greater than 0", lambda: Can.sheet_metal(thickness=0.0)),
    ("load density must be greater than 0", lambda: sliding(density=0.0)),
    (FILL.format(math.nextafter(1, 2)), lambda: sliding(fill=math.nextafter(1, 2))),
    ("incline must be between -pi/2 and pi/2 [rad] (90 degrees), got 1.57", lambda: sliding(math.pi / 2)),
    ("attachment must be one of 'sliding', 'frozen'; got 'glued'", lambda: Scene(Can(), BEER, attachment="glued")),
    ("a can without mass has no inertia, got mass 0 kg and inertia 1e-05 kg m^2", lambda: Can(inertia=1e-5)),
    ("load mass must be between 1e-09 and 10000 [kg], got 0.0", lambda: sliding(fill=1e-300)),
    ("can must be a Can, got 'metal'", lambda: sliding(can="metal")),
    ("load must be a Load, got", lambda: Scene(Can(), Can)),
    ("viscosity must be between 1e-09 and 1e+06 [m^2/s], got 1e-10", lambda: liquid(viscosity=1e-10)),
]


@pytest.mark.parametrize(("message", "make"), REFUSED)
def test_what_is_no_scene_is_refused(message: str, make: Callable[[], object]) -> None:
    refuses(message, make)


@pytest.mark.parametrize(
    ("attachment", "offset"), [("sliding", 0.02), ("sliding", 0.0), ("frozen", 0.033)], ids=["inside", "axis", "rim"]
)
def test_something_has_to_resist_rotation(attachment: str, offset: float) -> None:
    """J(0) = 0: at phi = 0 the load neither turns nor moves, and the can weighs nothing."""
    with pytest.raises(ParameterError, match=r"nothing resists rotation at phi = 0: .* and Can\(radius"):
        Scene(Can.massless(), Load.point(0.2, offset), 0.1, attachment)


def test_a_point_frozen_to_the_rim_holds_on_any_incline() -> None:
    """Rounding of m b/m would make b/a more than 1."""
    for radius in (0.9821718891880378, 0.033, 0.1):
        scene = Scene(Can(radius), Load(1e-9, radius, 1e-9 * radius**2), 0.0, "frozen")
        assert scene.largest_incline() == math.pi / 2


@pytest.mark.parametrize(
    ("scene", "text"),
    [
        (sliding(), "sliding()"),
        (sliding(np.float64(0.17), fill=0.5, gravity=1.6), "sliding(incline=0.17, gravity=1.6)"),
        (
            Scene(Can(), BEER, damping=Damping(1e-3), attachment="sliding"),
            "Scene(can=Can(radius=0.033, length=0.12, mass=0.0, inertia=0.0), load=Load(mass=0.2, offset=0.01, "
            "inertia=1e-05, fill=None), damping=Damping(linear=0.001, quadratic=0.0, cubic=0.0))",
        ),
    ],
)
def test_a_scene_is_shown_as_the_call_that_makes_it(scene: Scene, text: str) -> None:
    assert repr(scene) == text
    assert eval(text, vars(mjbeer)) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert repr(pickle.loads(pickle.dumps(scene))) == text
