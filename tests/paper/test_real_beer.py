"""How fast real liquids swing, and cans with them roll, against Jackson's facts and theory."""

import math
import pathlib
import sys
import warnings

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from mjbeer import Can, LiquidWarning, Load, Scene, exact, liquid, simulate, sliding
from mjbeer.theory import slosh
from mjbeer.theory.liquid_damping import FILM_LOAD
from mjbeer.theory.liquid_properties import LIQUIDS
from mjbeer.theory.scene import GRAVITY

sys.path.append(str(pathlib.Path(__file__).parents[2] / "docs" / "figures"))
from real_beer import (
    CAN,
    DRAG,
    SWING,
    capillary_length,
    let_go,
    lump_until,
    over_first_metre,
    times_of,
    water_in,
)

pytestmark = pytest.mark.slow

INCLINES = [math.radians(degrees) for degrees in (2, 5, 10)]


def first_metre(volume: float, incline: float, friction: float = 1.0, drag: float = 0.0) -> float:
    """Return the mean acceleration of a can with some water [ml], divided by g sin(alpha)."""
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
    """The bound is 1e-7, as a tolerance of 1e-6 rad is 3e-8 of the some 30 rad of a metre.

    The interpolation by a cubic adds less than 1e-9.
    """
    for volume, incline in ((1.0, INCLINES[2]), (2.0, INCLINES[0]), (177.0, INCLINES[1])):
        scene = water_in(volume, incline, drag=drag)
        times = times_of(scene)
        run = let_go(scene, times)
        # The other warnings may come: the liquid may be no lump any more.
        assert not run.solver_warnings
        assert over_first_metre(run) == pytest.approx(
            over_first_metre(exact(scene, times, -incline)), rel=1e-7
        )


def test_jackson_s_two_facts() -> None:
    """In units of g sin(alpha) a nearly empty can is slower than 1/2, and a full one near 1.

    Without friction between water and wall no can is slower than 1/2.
    """
    for incline, volume in zip(INCLINES, (8.0, 6.5, 5.0), strict=True):
        half = 0.5 * GRAVITY * math.sin(incline)
        assert water_in(volume, incline, friction=0.0).acceleration() > half
        assert first_metre(volume, incline) < 0.5
        assert first_metre(350, incline) > 0.9


def test_the_first_fact_also_holds_where_the_wall_cannot_take_all_water() -> None:
    """The air drags, and at no speed in this metre can the film on the wall hold so much water."""
    for incline, volume in zip(INCLINES, (13.0, 9.0, 7.5), strict=True):
        assert first_metre(volume, incline, drag=DRAG) < 0.5
        # The speed after a metre with half of g sin(alpha).
        speed = math.sqrt(GRAVITY * math.sin(incline) * 1.0)
        # The largest volume of the film, divided by a l [m].
        film = FILM_LOAD * math.sqrt(LIQUIDS["water"].viscosity * speed / GRAVITY)
        assert volume > 1e6 * film * CAN.radius * CAN.length


def test_the_page_has_the_slowest_can_and_what_its_wall_can_hold() -> None:
    """In millilitres, on the gentlest incline; the wall at the end of the metre."""
    slowest = minimize_scalar(
        lambda volume: first_metre(volume, INCLINES[0]), bounds=(0.7, 4), options={"xatol": 0.02}
    )
    assert slowest.x == pytest.approx(1.2, abs=0.1)
    scene = water_in(slowest.x, INCLINES[0])
    run = let_go(scene, times_of(scene))
    speed = np.interp(1.0, run.u - run.u[0], run.u_dot)
    film = FILM_LOAD * math.sqrt(LIQUIDS["water"].viscosity * speed / GRAVITY)
    assert 1e6 * film * CAN.radius * CAN.length == pytest.approx(3.7, abs=0.05)


@pytest.mark.parametrize(
    ("volume", "reason"), [(1.0, "coats the can"), (10.0, "coats the can"), (50.0, "centrifugal")]
)
def test_a_run_that_ends_before_its_liquid_is_no_lump_has_no_warning(
    volume: float, reason: str
) -> None:
    """A hundredth before that place, and after it."""
    scene = water_in(volume, INCLINES[0])
    run = let_go(scene, times_of(scene))
    way = run.u - run.u[0]
    until = lump_until(run)
    for share, warned in ((0.99, False), (1.01, True)):
        duration = float(np.interp(share * until, way, run.time))
        short = simulate(scene, duration, -scene.incline, tolerance=1e-6)
        assert (reason in str(short.liquid_warnings)) == warned


@pytest.mark.parametrize(
    ("volume", "holds"), [(11.5, False), (12.0, True), (32.0, True), (33.0, False)]
)
def test_the_liquid_stays_one_lump_for_a_metre_from_12_to_32_ml(volume: float, holds: bool) -> None:
    scene = water_in(volume, INCLINES[0])

    run = let_go(scene, times_of(scene))

    assert (lump_until(run) > 1) == holds


@pytest.mark.parametrize("volume", [12.0, 13.0])
def test_with_air_a_can_is_slower_than_half_while_its_liquid_is_one_lump(volume: float) -> None:
    scene = water_in(volume, INCLINES[0], drag=DRAG)

    run = let_go(scene, times_of(scene))

    assert over_first_metre(run) < 0.5
    assert lump_until(run) > 1


def test_without_air_a_can_is_slower_than_half_up_to_11_ml() -> None:
    assert first_metre(11.0, INCLINES[0]) < 0.5 < first_metre(11.5, INCLINES[0])


def metre_of_a_full_can(incline: float) -> float:
    """Return the time [s] in which a full can rolls a metre.

    Its water turns in rings that drag each other, as in a long can: v(r, t) about the axis has
    dv/dt = nu (v'' + v'/r - v/r^2). With the torque of this flow on the wall, the Laplace transform
    of the can's acceleration is F/(s (M + 2 m I_2(z)/(z I_1(z)))), where z = a sqrt(s/nu).
    """
    water = LIQUIDS["water"]
    a = CAN.radius
    m = math.pi * a**2 * CAN.length * water.density
    force = (m + CAN.mass) * GRAVITY * math.sin(incline)
    mass = m + CAN.effective_mass

    def transform(s: mpmath.mpc) -> mpmath.mpc:
        """Return the Laplace transform of the distance, which has two more factors 1/s."""
        z = a * mpmath.sqrt(s / water.viscosity)
        return force / s**3 / (mass + 2 * m * mpmath.besseli(2, z) / (z * mpmath.besseli(1, z)))

    def beyond_a_metre(time: float) -> float:
        return float(mpmath.invertlaplace(transform, time, method="talbot")) - 1

    return brentq(beyond_a_metre, 0.5, 5)


@pytest.mark.parametrize("incline", INCLINES)
def test_a_nearly_full_can_is_as_fast_as_a_full_one(
    incline: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The scene has a steady layer, the exact theory one that grows: they share the viscosity."""
    # The exact theory has no ends of the can.
    monkeypatch.setattr("mjbeer.theory.liquid_damping.ENDS", 0.0)
    full = 2 / metre_of_a_full_can(incline) ** 2 / (GRAVITY * math.sin(incline))
    assert first_metre(400.0, incline) == pytest.approx(full, abs=4e-3)


def hertz_of_solid(can: Can) -> float:
    """Return the frequency [Hz] by the paper of half a can of beer on level ground."""
    return sliding(0.0, 0.5, can, LIQUIDS["beer"].density).frequency() / math.tau


def hertz_of_liquid(can: Can) -> float:
    """Return the frequency [Hz] as a liquid of half a can of beer on level ground."""
    return liquid("beer", 0.0, 0.5, can).frequency() / math.tau


@pytest.mark.parametrize(
    ("can", "by_paper", "as_liquid"),
    [(Can(), 3.2, 4.8), (CAN, 3.1, 4.5)],
    ids=["massless", "12 oz"],
)
def test_the_page_has_the_frequencies_of_a_half_full_can(
    can: Can, by_paper: float, as_liquid: float
) -> None:
    assert round(hertz_of_solid(can), 1) == by_paper
    assert round(hertz_of_liquid(can), 1) == as_liquid


def test_the_page_has_what_a_film_of_60_pictures_a_second_shows() -> None:
    """In pictures a swing, and in seconds for ten swings."""
    solid = hertz_of_solid(CAN)
    beer = hertz_of_liquid(CAN)

    assert round(60 / beer) == 13
    assert 19 < 60 / solid < 20
    assert round(10 / beer, 1) == 2.2
    assert round(10 / solid, 1) == 3.3


def test_the_page_has_how_far_the_can_rolls_in_a_swing() -> None:
    beer = liquid("beer", 0.0, 0.5, CAN)

    arm = beer.load.moment / beer.effective_mass

    assert round(1e3 * arm * 2 * SWING, 1) == 3.8


def test_the_page_s_program_finds_the_frequency() -> None:
    run = simulate(liquid("beer", incline=0.0, fill=0.5), 1.0, 0.05, tolerance=1e-6)

    assert round(run.frequency() / math.tau, 1) == 4.8


def test_the_page_has_the_damping_of_a_half_full_can() -> None:
    """Of beer's layers, of a swing on level ground, and of one in a can that rolls on."""
    beer = liquid("beer", 0.0, 0.5, CAN)
    modes = slosh.rolling(0.5, beer.effective_mass / beer.load.mass)
    nu = LIQUIDS["beer"].viscosity
    ratios = modes.damping_ratios(CAN.radius, CAN.length, GRAVITY, nu)
    assert round(ratios.layers, 4) == 0.0015
    assert round(1 - modes.energy_shares[0], 2) == 0.11
    # The wavenumber of waves on deep water that are as fast.
    wavenumber = 1 / (CAN.radius * modes.lengths[0])
    assert round((capillary_length() * wavenumber) ** 2 / 2, 3) == 0.025

    def damping(name: str, incline: float) -> float:
        with warnings.catch_warnings(action="ignore", category=LiquidWarning):
            rates = liquid(name, incline, 0.5, CAN).modes()
        swing = max(rates, key=lambda rate: rate.imag)
        return -swing.real / abs(swing)

    assert round(damping("water", 0.0), 4) == 0.0015
    assert round(damping("olive oil", 0.0), 3) == 0.037
    assert round(damping("water", INCLINES[0]), 3) == 0.018


def test_honey_with_the_inertia_of_slosh_would_be_elsewhere() -> None:
    """It is let go at 0.2 rad on level ground."""
    honey = liquid("honey", 0.0)
    load = Load.liquid(Can(), 0.5, LIQUIDS["honey"].density)
    sloshing = Scene(Can(), load, 0.0, damping=honey.damping)
    times = np.linspace(0, 2, 2001)
    apart = exact(honey, times, 0.2).phi - exact(sloshing, times, 0.2).phi
    assert round(np.abs(apart).max(), 2) == 0.12
