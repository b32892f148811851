"""What real liquids do: the first metre against Jackson's facts and against W^1.5 itself, and how they slosh."""

import math
import pathlib
import sys

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq

from mjbeer import exact, sliding
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.liquid import FILM_LOAD, LIQUIDS
from mjbeer.theory.scene import GRAVITY
from tests.support.full_can import FullCan

sys.path.append(str(pathlib.Path(__file__).parents[2] / "docs" / "figures"))
from real_beer import CAN, DRAG, let_go, over_first_metre, times_of, water_in

pytestmark = pytest.mark.slow

INCLINES = [math.radians(degrees) for degrees in (2, 5, 10)]


def first_metre(volume: float, incline: float, friction: float = 1.0, drag: float = 0.0) -> float:
    scene = water_in(volume, incline, friction, drag)
    return over_first_metre(let_go(scene, times_of(scene)))


def footnote_4(volume: float) -> float:
    scene = water_in(volume, 0.1, friction=0.0)
    return scene.acceleration() / (scene.gravity * math.sin(scene.incline))


def test_an_even_acceleration_is_found() -> None:
    scene = sliding(can=CAN)
    run = simulate(scene, 1.5, scene.equilibrium(), tolerance=1e-9, times=np.linspace(0, 1.5, 11))
    full = scene.gravity * math.sin(scene.incline)
    assert over_first_metre(run) == pytest.approx(scene.acceleration() / full, rel=1e-9)


def test_the_can_holds_what_it_says() -> None:
    assert CAN.mass == pytest.approx(0.013, rel=1e-14)
    for volume in (0.3, 177.0, 350.0):
        assert water_in(volume, 0.1).load.mass == pytest.approx(volume * 1e-6 * LIQUIDS["water"].density, rel=1e-12)


@pytest.mark.parametrize("drag", [0.0, DRAG])
def test_the_first_metre_of_mujoco_is_that_of_exact_theory(drag: float) -> None:
    """A tolerance of 1e-6 rad at the end of some 30 rad is 3e-8 of the way, and the cubic adds less than 1e-9."""
    for volume, incline in ((0.3, INCLINES[2]), (2.0, INCLINES[0]), (177.0, INCLINES[1])):
        scene = water_in(volume, incline, drag=drag)
        times = times_of(scene)
        run = let_go(scene, times)
        assert not run.solver_warnings  # the liquid may be no lump any more
        assert over_first_metre(run) == pytest.approx(over_first_metre(exact(scene, times, -incline)), rel=1e-7)


def test_jackson_s_two_facts() -> None:
    """Nearly empty: below a half, which no can without friction is, and still where the wall cannot take all of the
    water. Nearly full: near one."""
    for incline, volume in zip(INCLINES, (8.0, 6.5, 5.0), strict=True):
        assert footnote_4(volume) > 0.5
        assert first_metre(volume, incline) < 0.5
        assert first_metre(350, incline) > 0.9
    for incline, volume in zip(INCLINES, (13.0, 9.0, 7.5), strict=True):
        assert first_metre(volume, incline, drag=DRAG) < 0.5
        assert volume > film_holds(incline)


def film_holds(incline: float) -> float:
    """The volume [mL] of water that a film on the wall can hold at the end of the first metre.

    There the can has the speed that it would have with half of g sin(alpha), sqrt(g sin(alpha) 1 m).
    """
    water, gravity = LIQUIDS["water"], GRAVITY
    speed = math.sqrt(gravity * math.sin(incline) * 1.0)
    return 1e6 * FILM_LOAD * math.sqrt(water.viscosity * speed / gravity) * CAN.radius * CAN.length


def slosh(terms: int) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues lambda of a liquid that half fills a circle of radius 1, and the shares of its mass that slosh.

    The potential is a sum of r^n sin(n theta), theta from the vertical: harmonic, and odd. By Green's theorem its
    energy and the integral over the surface give the Rayleigh quotient lambda, with the free wall as natural boundary.
    """
    with mpmath.workdps(40):
        sines = [(0, 1, 0, -1)[n % 4] for n in range(2 * terms + 1)]
        energy, surface = mpmath.matrix(terms), mpmath.matrix(terms)
        along = mpmath.matrix(terms, 1)
        for i in range(terms):
            n = i + 1
            along[i] = mpmath.mpf(2 * sines[n]) / (n + 2)
            for j in range(terms):
                k = j + 1
                part = mpmath.pi if n == k else mpmath.mpf(2 * sines[abs(n - k)]) / abs(n - k)
                energy[i, j] = part * n * k / (n + k)
                surface[i, j] = mpmath.mpf(2 * sines[n] * sines[k]) / (n + k + 1)
        whitened = mpmath.cholesky(energy) ** -1
        inverse, vectors = mpmath.eigsy(whitened * surface * whitened.T)
        projected = (whitened.T * vectors).T * along
        order = range(terms - 1, terms // 2 - 1, -1)  # even powers are zero on the surface
        values = np.array([float(1 / inverse[i]) for i in order])
        shares = np.array([float(projected[i] ** 2 / inverse[i] ** 2 / (mpmath.pi / 2)) for i in order])
    return values, shares


def test_real_beer_sloshes_one_and_a_half_times_faster() -> None:
    """lambda_1 is that of Evans and Linton's and of Faltinsen and Timokha's problem. The rest of the mass moves with
    the can, without turning."""
    values, shares = slosh(16)
    assert values[0] == pytest.approx(1.355727, rel=1e-6)
    assert shares[:3] == pytest.approx([0.5692, 0.0178, 0.0041], abs=5e-5)
    assert 1 / values[:3] == pytest.approx([0.7376, 0.2150, 0.1279], abs=5e-5)
    ratios = []
    for mass, known in ((0.0, (3.01, 1.33)), (0.08, (2.78, 1.27)), (math.inf, (1.36, 0.85))):
        offset = 4 / (3 * math.pi)
        rigid = offset / (0.5 - offset**2 / (1 + mass))
        squared = values[0] if mass == math.inf else freely(values, shares, mass)
        ratios.append(math.sqrt(squared / rigid))
        assert (squared, rigid) == pytest.approx(known, abs=6e-3)
    assert ratios == pytest.approx([1.51, 1.48, 1.26], abs=6e-3)
    one = math.sqrt(values[0] / (1 - shares[0]) / freely(values, shares, 0.0))
    assert one == pytest.approx(1.023, abs=1e-3)  # the pendulum of appendix B


def freely(values: np.ndarray, shares: np.ndarray, mass: float) -> float:
    """omega^2 a/(g cos alpha) of a can that rolls freely, whose mass and inertia make up `mass` times its liquid."""

    def force(squared: float) -> float:
        return mass + 1 + float((shares * squared / (values - squared)).sum())

    return float(brentq(force, 1.001 * values[0], 0.999 * values[1]))


def test_a_nearly_full_can_is_as_fast_as_a_full_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two theories that have nothing in common but the viscosity: of a layer that is steady, and of one that grows."""
    monkeypatch.setattr("mjbeer.theory.liquid.ENDS", 0.0)  # the exact theory has none
    lump = [first_metre(400.0, incline) for incline in INCLINES]
    exactly = []
    for incline in INCLINES:
        full = FullCan(CAN, incline=incline)
        time = brentq(lambda time, full=full: full.way(time)[0] - 1, 0.5, 5, xtol=1e-12)
        exactly.append(2 / time**2 / (full.gravity * math.sin(incline)))
    assert lump == pytest.approx(exactly, abs=4e-3)
