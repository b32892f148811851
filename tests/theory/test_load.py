"""The circular segment, eqs. (32)-(37), against the paper's closed forms in 60 digits; the metal can, (30) and (31)."""

import math
from typing import Any

import numpy as np
import pytest
from mpmath import MPContext

from mjbeer import Can, Load
from mjbeer.theory.can import segment

mp = MPContext()
mp.dps = 60

# NumPy's 40 Gauss weights carry errors of some 1e-15 each and not all of them cancel; measured: 3.9e-15.
QUADRATURE = 1e-14
# A double rounds beta once more than the formula has roundings.
ROUNDING = 1e-15

HALF_ANGLES = [*np.geomspace(1e-6, 3, 9), math.pi / 2, math.pi - 1e-3, math.pi - 1e-6]


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
    fill = fill_of(beta)
    shape = segment(fill)
    for name, exact in closed_form(fill).items():
        tolerance = ROUNDING if name == "half_angle" else QUADRATURE
        assert abs(getattr(shape, name) / exact - 1) <= tolerance, name


def test_full_and_nearly_full() -> None:
    shape = segment(1.0)
    assert shape.offset == 0
    assert (shape.area, shape.inertia) == pytest.approx((math.pi, 1 / 2), rel=QUADRATURE)
    gap = 2.0**-52
    # 1 - fill is exact, and b = 2 a^3 sin^3(beta) / 3A with sin(beta) = 2 sqrt(gap) to first order.
    assert segment(1 - gap).offset == pytest.approx(16 * gap**1.5 / (3 * math.pi), rel=QUADRATURE)


@pytest.mark.parametrize("fill", [1e-30, 1e-300])
def test_film(fill: float) -> None:
    """A film of liquid is a parabola's segment: b = a, I_cm = m beta^2 a^2 / 5, however thin."""
    shape = segment(fill)
    assert shape.offset == pytest.approx(1, rel=QUADRATURE)
    assert shape.inertia == pytest.approx(shape.half_angle**2 / 5, rel=QUADRATURE)


def test_load_scales_with_the_can() -> None:
    shape, load = segment(0.3), Load.segment(radius=0.05, length=0.2, fill=0.3, density=900.0)
    mass = 900.0 * 0.2 * 0.05**2 * shape.area  # (34)
    assert (load.mass, load.offset, load.inertia) == pytest.approx(
        (mass, 0.05 * shape.offset, mass * 0.05**2 * shape.inertia), rel=ROUNDING
    )


def test_sheet_metal_can() -> None:
    a, length, thickness, density = 0.033, 0.12, 1e-4, 2700.0
    can = Can.sheet_metal(a, length, thickness, density)
    wall, end = 2 * math.pi * a * length * thickness * density, math.pi * a**2 * thickness * density
    assert can.mass == pytest.approx(wall + 2 * end, rel=ROUNDING)  # (30)
    assert can.inertia == pytest.approx(wall * a**2 + 2 * end * a**2 / 2, rel=ROUNDING)  # (31)
    assert Can.hoop(radius=0.2, length=0.1, mass=3.0).inertia == pytest.approx(3.0 * 0.2**2, rel=ROUNDING)
    assert can.inertia / (can.mass * a**2) == pytest.approx(0.89, abs=0.005)  # (31) as printed
