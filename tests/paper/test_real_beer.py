"""What real liquids do in the first metre, against Jackson's facts and exact theory."""

import math
import pathlib
import sys

import mpmath
import pytest
from scipy.optimize import brentq

from mjbeer import exact
from mjbeer.theory.liquid import FILM_LOAD, LIQUIDS
from mjbeer.theory.scene import GRAVITY

sys.path.append(str(pathlib.Path(__file__).parents[2] / "docs" / "figures"))
from real_beer import CAN, DRAG, let_go, over_first_metre, times_of, water_in

pytestmark = pytest.mark.slow

INCLINES = [math.radians(degrees) for degrees in (2, 5, 10)]


def first_metre(volume: float, incline: float, friction: float = 1.0, drag: float = 0.0) -> float:
    scene = water_in(volume, incline, friction, drag)
    return over_first_metre(let_go(scene, times_of(scene)))


def test_the_can_holds_what_it_says() -> None:
    assert CAN.mass == pytest.approx(0.013, rel=1e-14)
    for volume in (1.0, 177.0, 350.0):
        assert water_in(volume, 0.1).load.mass == pytest.approx(
            volume * 1e-6 * LIQUIDS["water"].density, rel=1e-12
        )


@pytest.mark.parametrize("drag", [0.0, DRAG])
def test_the_first_metre_of_mujoco_is_that_of_exact_theory(drag: float) -> None:
    """A tolerance of 1e-6 rad at the end of some 30 rad is 3e-8 of the way.

    The cubic adds less than 1e-9.
    """
    for volume, incline in ((1.0, INCLINES[2]), (2.0, INCLINES[0]), (177.0, INCLINES[1])):
        scene = water_in(volume, incline, drag=drag)
        times = times_of(scene)
        run = let_go(scene, times)
        assert not run.solver_warnings  # the liquid may be no lump any more
        assert over_first_metre(run) == pytest.approx(
            over_first_metre(exact(scene, times, -incline)), rel=1e-7
        )


def test_jackson_s_two_facts() -> None:
    """A nearly empty can is below a half, which no can without friction is; a full one near one.

    The first is so still where the wall cannot take all of the water.
    """
    for incline, volume in zip(INCLINES, (8.0, 6.5, 5.0), strict=True):
        assert water_in(volume, incline, friction=0.0).acceleration() > 0.5 * GRAVITY * math.sin(
            incline
        )
        assert first_metre(volume, incline) < 0.5
        assert first_metre(350, incline) > 0.9
    for incline, volume in zip(INCLINES, (13.0, 9.0, 7.5), strict=True):
        assert first_metre(volume, incline, drag=DRAG) < 0.5
        # With half of g sin(alpha), after a metre.
        speed = math.sqrt(GRAVITY * math.sin(incline) * 1.0)
        # At most, divided by a l [m].
        film = FILM_LOAD * math.sqrt(LIQUIDS["water"].viscosity * speed / GRAVITY)
        assert volume > 1e6 * film * CAN.radius * CAN.length


def metre_of_a_full_can(incline: float) -> float:
    """The time [s] of a full can for a metre, whose water turns in rings that drag each other.

    The flow is that in a long can, v(r, t) about the axis with dv/dt = nu (v'' + v'/r - v/r^2).
    With its torque on the wall, the Laplace transform of the can's acceleration is F/(s (M + 2 m
    I_2(z)/(z I_1(z)))) with z = a sqrt(s/nu).
    """
    water = LIQUIDS["water"]
    a = CAN.radius
    m = math.pi * a**2 * CAN.length * water.density
    force = (m + CAN.mass) * GRAVITY * math.sin(incline)
    mass = m + CAN.effective_mass

    def transform(s: mpmath.mpc) -> mpmath.mpc:
        z = a * mpmath.sqrt(s / water.viscosity)
        return force / s**3 / (mass + 2 * m * mpmath.besseli(2, z) / (z * mpmath.besseli(1, z)))

    return brentq(
        lambda time: float(mpmath.invertlaplace(transform, time, method="talbot")) - 1, 0.5, 5
    )


@pytest.mark.parametrize("incline", INCLINES)
def test_a_nearly_full_can_is_as_fast_as_a_full_one(
    incline: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By theories of a steady layer and of one that grows, which share only the viscosity."""
    monkeypatch.setattr("mjbeer.theory.liquid.ENDS", 0.0)  # the exact theory has none
    full = 2 / metre_of_a_full_can(incline) ** 2 / (GRAVITY * math.sin(incline))
    assert first_metre(400.0, incline) == pytest.approx(full, abs=4e-3)
