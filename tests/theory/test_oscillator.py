"""Equilibrium, frequency, separatrix and steepest incline, against J and V in 40 digits."""

import math
from dataclasses import replace
from typing import Any

import pytest

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.exceptions import NoEquilibriumError
from tests.support import taylor
from tests.support.scenes import METAL, SCENES
from tests.support.taylor import mp

# Angles are good to a few eps, and an equilibrium near the steepest incline to the root of that.
ANGLE = 5e-15


def pull(scene: Scene, phi: Any) -> Any:
    """V' at an angle in 40 digits."""
    form = taylor.letters(scene)
    return form["cosine"] * mp.sin(phi) + form["sine"] * mp.cos(phi) - form["slope"]


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
def test_equilibrium_and_frequency(scene: Scene) -> None:
    phi = scene.equilibrium()
    form = taylor.letters(scene)
    assert abs(pull(scene, phi)) < ANGLE * scene.oscillator.depth
    stiffness = form["cosine"] * mp.cos(phi) - form["sine"] * mp.sin(phi)
    assert abs(scene.frequency() / mp.sqrt(stiffness / taylor.inertia(form, mp.mpf(phi))) - 1) < ANGLE


def test_steepest_incline() -> None:
    limit = frozen().largest_incline()
    assert limit == pytest.approx(math.asin(4 / (3 * math.pi)), rel=ANGLE)
    assert math.degrees(limit) == pytest.approx(25.1, abs=0.05)
    assert sliding().largest_incline() == math.pi / 2
    for sign in (1, -1):
        # There sin(alpha + phi) is 1, and 1 - x^2/2 tells angles apart only to the root of the distance.
        assert frozen(sign * limit * (1 - 1e-8)).equilibrium() == pytest.approx(
            sign * (math.pi / 2 - limit), abs=2 * math.sqrt(1e-8)
        )
        for ask in (Scene.equilibrium, Scene.frequency, Scene.separatrix, lambda scene: scene.period(0.1)):
            with pytest.raises(NoEquilibriumError, match=r"incline of -?26 degrees: .* only up to 25\.1 degrees"):
                ask(frozen(sign * math.radians(26)))


@pytest.mark.parametrize("scene", [sliding(fill=1.0), frozen(fill=1.0), sliding(gravity=0.0), frozen(gravity=0.0)])
def test_nothing_restores(scene: Scene) -> None:
    with pytest.raises(NoEquilibriumError, match=r"balanced about the axis \(offset 0 m\) or gravity is 0 m/s\^2"):
        scene.equilibrium()


@pytest.mark.parametrize("scene", [frozen(), frozen(0.01, can=METAL), sliding(can=METAL), pendulum(0.4)])
def test_separatrix_and_mirror(scene: Scene) -> None:
    low, high = scene.separatrix()
    top = mp.findroot(lambda x: pull(scene, x), high)
    assert abs(high - top) < ANGLE
    if scene.attachment == "sliding":
        assert abs(low - (top - 2 * mp.pi)) < ANGLE
    else:
        form = taylor.letters(scene)
        assert abs(low - mp.findroot(lambda x: taylor.fall(form, top, x), low)) < ANGLE
    behind = replace(scene, incline=-scene.incline)
    assert behind.separatrix() == (-high, -low)
    assert (behind.equilibrium(), behind.frequency()) == (-scene.equilibrium(), scene.frequency())


@pytest.mark.parametrize("short", [1e-4, 1e-8, 1e-11, 1e-13])
@pytest.mark.parametrize("sign", [1, -1])
def test_separatrix_beside_the_steepest_incline(short: float, sign: int) -> None:
    """V is a cubic in a narrow well: as far uphill as half the way downhill to the barrier it is as high as there."""
    scene = frozen(sign * frozen().largest_incline() * (1 - short))
    low, high = (sign * each - abs(scene.equilibrium()) for each in scene.separatrix()[::sign])
    well = scene.oscillator.potential.well  # its own square is a difference of slope and depth
    assert high == pytest.approx(well, abs=ANGLE)
    assert low == pytest.approx(-well / 2, rel=well, abs=ANGLE)
