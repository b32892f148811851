"""The domain of scenes and how they are shown; the segment (32)-(37) by the paper's closed forms in
60 digits."""

import math
import pickle
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from mpmath import MPContext

import mjbeer
from mjbeer import Can, Damping, Load, Scene, exact, liquid, sliding
from mjbeer.exceptions import ParameterError
from mjbeer.theory.segment import segment

BEER = Load(0.2, 0.01, 1e-5)


def refuses(message: str, make: Callable[..., object], *arguments: object, **named: object) -> None:
    with pytest.raises(ParameterError, match=re.escape(message)):
        make(*arguments, **named)


def wheel(
    can_mass: float = 0.1, load_mass: float = 0.2, offset: float = 0.5, **named: float
) -> Scene:
    """A hoop of radius 1 with a point load that slides, J(0) = m b^2 K/(m + K)."""
    return Scene(Can(1.0, 1.0, can_mass, can_mass), Load(load_mass, offset), 0.0, **named)


EDGES = [
    ("can radius", 1e-3, 1e2, lambda value: Can(radius=value)),
    ("can length", 1e-3, 1e2, lambda value: Can(length=value)),
    ("can mass", 1e-9, 1e4, lambda value: Can(mass=value)),
    (
        "can inertia with a mass of 0.1 kg",
        None,
        1e3 * 0.1 * 0.033**2,
        lambda value: Can(mass=0.1, inertia=value),
    ),
    ("load mass", 1e-9, 1e4, lambda value: Load(value, 0.01)),
    ("load offset", 0.0, 1e2, lambda value: Load(1.0, value)),
    ("load offset", 1e-14, 1.0, lambda value: wheel(offset=value)),
    (
        "load inertia",
        None,
        2e2,
        lambda value: Scene(Can(1.0, 1.0, 0.1, 0.1), Load(0.2, 0.5, value), 0.0),
    ),
    (
        "mass of the can with a load of 0.125 kg",
        1e-3 / 8,
        1e3 / 8,
        lambda value: wheel(value, 1 / 8),
    ),
    ("incline", -math.radians(85), math.radians(85), sliding),
    ("gravity", 1e-3, 1e3, lambda value: sliding(gravity=value)),
    ("phi0", -1e4, 1e4, lambda value: exact(sliding(), 0.0, value)),
    ("phi_dot0", -1e6, 1e6, lambda value: exact(sliding(), 0.0, 0.0, value)),
]
"""Names, ends of their ranges, and what takes them."""


@pytest.mark.parametrize(
    ("name", "lowest", "highest", "make"), EDGES, ids=[name for name, *_ in EDGES]
)
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
    """At phi = pi a wheel of 0.1 kg with K = 0.2 kg and a load of 0.2 kg at half its radius resists
    least."""
    rate = (0.2 * 0.25 + 2 * 0.2 * 0.5 + 0.4) / (0.4 * 0.2 * 0.25 * 0.5)
    for damping in (0.999e9 / rate, 1.001e-12 / rate, Damping(quadratic=0.999e9 / rate / 2)):
        assert wheel(damping=damping).dissipates
    wheel(drag=0.19e9)
    refuses(
        "rate of damping must be 0, or between 1e-12 and 1e+09 [1/s], got",
        wheel,
        damping=1.01e9 / rate,
    )
    refuses("rate of damping must be 0, or between", wheel, damping=Damping(quadratic=1e9 / rate))
    refuses(
        "rate of drag must be 0, or between 1e-12 and 1e+09 [1/s], got 1050000000.0",
        wheel,
        drag=0.21e9,
    )


NOTHING = "next to nothing resists rotation at phi = 0"
FRACTION = "fill must be a fraction between 0.01 and 1 (50 % is 0.5), got "
REFUSED = [
    ("sheet thickness must be greater than 0", lambda: Can.sheet_metal(thickness=0.0)),
    ("load density must be greater than 0", lambda: sliding(density=0.0)),
    (FRACTION + "1.0000000000000002", lambda: sliding(fill=math.nextafter(1, 2))),
    (FRACTION + "50", lambda: sliding(fill=50)),
    (FRACTION + "50", lambda: Load(0.2, 0.01, 1e-5, fill=50)),
    ("incline must be between -1.48353 and 1.48353 [rad], got 1.57", lambda: sliding(math.pi / 2)),
    ("incline must be between -1.48353 and 1.48353 [rad], got 10", lambda: sliding(10)),
    (
        "attachment must be one of 'sliding', 'frozen'; got 'glued'",
        lambda: Scene(Can(), BEER, attachment="glued"),
    ),
    ("can inertia must be 0 for a can without mass [kg m^2], got 1e-05", lambda: Can(inertia=1e-5)),
    (
        "can inertia with a mass of 2 kg must be between 0 and 2.178 [kg m^2], got 2.2",
        lambda: Can(mass=2, inertia=2.2),
    ),
    (FRACTION + "0.0", lambda: sliding(fill=0.0)),
    (FRACTION + "0.009", lambda: sliding(fill=0.009)),
    (
        "mass of the can with a load of 0.2 kg must be 0, or between 0.0002 and 200 [kg], "
        "got 0.0001",
        lambda: wheel(1e-4),
    ),
    ("can must be a Can, got 'metal'", lambda: sliding(can="metal")),
    ("load must be a Load, got", lambda: Scene(Can(), Can)),
    # At phi = 0 the load neither turns nor moves, and the can weighs nothing.
    (NOTHING, lambda: Scene(Can(), Load.point(0.2, 0.02))),
    (NOTHING, lambda: Scene(Can(), Load.point(0.2, 0.0))),
    (NOTHING, lambda: Scene(Can(), Load.point(0.2, 0.033), attachment="frozen")),
    (
        "viscosity must be between 1e-09 and 1e+06 [m^2/s], got 1e-10",
        lambda: liquid(viscosity=1e-10),
    ),
]


@pytest.mark.parametrize(("message", "make"), REFUSED)
def test_what_is_no_scene_is_refused(message: str, make: Callable[[], object]) -> None:
    refuses(message, make)


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
            "Scene(can=Can(radius=0.033, length=0.12, mass=0.0, inertia=0.0), "
            "load=Load(mass=0.2, offset=0.01, inertia=1e-05, fill=None, sloshes_in=None), "
            "damping=Damping(linear=0.001, quadratic=0.0, cubic=0.0))",
        ),
    ],
)
def test_a_scene_is_shown_as_the_call_that_makes_it(scene: Scene, text: str) -> None:
    assert repr(scene) == text
    assert eval(text, vars(mjbeer)) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert repr(pickle.loads(pickle.dumps(scene))) == text


mp = MPContext()
mp.dps = 60

# A double rounds beta once more than the formula has roundings.
ROUNDING = 1e-15
# The formulas subtract numbers that are alike where there is little beer. An error of eps in beta
# is one of 3/2 eps/beta^2 in its rest in (33), 2/3 beta^3; of the rest in (37), about beta^2/5, it
# is 15 eps/beta^4.
HALF_ANGLES = [
    2 * math.asin(0.1),
    *np.linspace(0.21, 3, 9),
    math.pi / 2,
    math.pi - 1e-3,
    math.pi - 1e-6,
]
"""From a fill of 0.01, the least, on."""


def fill_of(beta: float) -> float:
    """Eq. (32): h/2a, rounded to the double that is then the exact input."""
    return float((1 - mp.cos(mp.mpf(beta))) / 2)


def closed_form(fill: float) -> dict[str, Any]:
    """Eqs. (33), (35) and (37) as printed."""
    beta = mp.acos(1 - 2 * mp.mpf(fill))
    twice = 2 * beta - mp.sin(2 * beta)
    axial = (1 + 2 * mp.sin(2 * beta) * mp.sin(beta) ** 2 / (3 * twice)) / 2
    return {
        "half_angle": beta,
        "area": twice / 2,
        "offset": 4 * mp.sin(beta) ** 3 / (3 * twice),
        "inertia": axial - 16 * mp.sin(beta) ** 6 / (9 * twice**2),
    }


@pytest.mark.parametrize("beta", HALF_ANGLES)
def test_segment_is_the_closed_form(beta: float) -> None:
    """At a fill of 0.01 its area and offset have 14 digits, and its inertia 11."""
    fill = fill_of(beta)
    shape = segment(fill)
    lost = 1 + 4 / beta**2
    allowed = {
        "half_angle": ROUNDING,
        "area": ROUNDING * lost,
        "offset": ROUNDING * lost,
        "inertia": ROUNDING * lost**2,
    }
    for name, printed in closed_form(fill).items():
        assert abs(getattr(shape, name) / printed - 1) <= allowed[name], name


@pytest.mark.parametrize("fill", [0.01, 0.05, 0.3, 0.5, 0.9, 1.0])
def test_segment_s_width_is_its_integral(fill: float) -> None:
    """The mean of x^2 over strips of length 2 sin(t) at the height cos(t) is (2/3A) times the
    integral of sin^4(t)."""
    shape = segment(fill)
    fourth = mp.quad(lambda t: mp.sin(t) ** 4, [0, mp.mpf(shape.half_angle)])
    allowed = ROUNDING * (1 + 4 / shape.half_angle**2) ** 2
    assert shape.mean_square_across == pytest.approx(
        float(2 * fourth / (3 * shape.area)), rel=allowed
    )


def test_full_and_nearly_full() -> None:
    shape = segment(1.0)
    assert shape.offset == 0
    assert (shape.area, shape.inertia) == pytest.approx((math.pi, 1 / 2), rel=ROUNDING)
    gap = 2.0**-52
    # 1 - fill is exact, and b = 2 a^3 sin^3(beta) / 3A with sin(beta) = 2 sqrt(gap) to first order.
    assert segment(1 - gap).offset == pytest.approx(16 * gap**1.5 / (3 * math.pi), rel=ROUNDING)


def test_load_scales_with_the_can() -> None:
    shape = segment(0.3)
    load = Load.segment(radius=0.05, length=0.2, fill=0.3, density=900.0)
    assert load.mass == pytest.approx(900.0 * 0.2 * 0.05**2 * shape.area, rel=ROUNDING)  # (34)
    assert load.offset == pytest.approx(0.05 * shape.offset, rel=ROUNDING)
    assert load.inertia == pytest.approx(load.mass * 0.05**2 * shape.inertia, rel=ROUNDING)


def test_sheet_metal_can() -> None:
    a = 0.033
    length = 0.12
    sheet = 1e-4 * 2700.0  # [kg/m^2]
    wall = 2 * math.pi * a * length * sheet
    end = math.pi * a**2 * sheet
    can = Can.sheet_metal(a, length, thickness=1e-4, density=2700.0)
    assert can.mass == pytest.approx(wall + 2 * end, rel=ROUNDING)  # (30)
    assert can.inertia == pytest.approx(wall * a**2 + 2 * end * a**2 / 2, rel=ROUNDING)  # (31)


def test_a_hoop_has_all_its_mass_at_its_radius() -> None:
    hoop = Can.hoop(radius=0.2, length=0.1, mass=3.0)
    assert hoop.inertia == pytest.approx(3.0 * 0.2**2, rel=ROUNDING)
