"""Accelerations by Lagrange's equations, forces by Newton's; equilibrium, frequency and separatrix
by 40 digits."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mjbeer import Scene, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import NoEquilibriumError
from mjbeer.theory.equations import accelerations, rolling_forces
from tests.support import taylor
from tests.support.scenes import METAL, SCENES
from tests.support.taylor import mp

# Sums of a few terms, compared with the largest of them.
ROUNDING = 5e-15


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
@pytest.mark.parametrize(("phi", "rate"), [(0.7, 3.0), (-2.0, -11.0)])
def test_motion_obeys_lagrange_s_equations(scene: Scene, phi: float, rate: float) -> None:
    """Those of u and phi; rolling as one with its load, a can obeys the first times a, plus the
    second."""
    a = scene.can.radius
    moment = scene.load.mass * scene.load.offset
    weight = scene.mass * scene.gravity

    u_ddot, phi_ddot = map(float, accelerations(scene, phi, rate, 0.0))

    of_u = [
        (scene.mass + scene.can.inertia / a**2) * u_ddot,
        -moment * math.cos(phi) * phi_ddot,
        moment * math.sin(phi) * rate**2,
        -weight * math.sin(scene.incline),
    ]
    of_phi = [
        (scene.load.inertia + moment * scene.load.offset) * phi_ddot,
        -moment * math.cos(phi) * u_ddot,
        moment * scene.gravity * math.sin(scene.incline + phi),
    ]
    equations = [of_u, of_phi]
    if scene.attachment == "frozen":
        assert u_ddot == pytest.approx(a * phi_ddot, rel=ROUNDING)
        equations = [[a * term for term in of_u] + of_phi]
    for terms in equations:
        assert abs(sum(terms)) < ROUNDING * max(abs(term) for term in terms)


@pytest.mark.parametrize("scene", [*SCENES.values(), frozen(-0.1), hoop(0.1)])
def test_forces_move_the_centre_of_mass(scene: Scene) -> None:
    """Newton's second law for the whole (38); nothing but friction turns a can alone."""
    phi = 1.2
    rate = -7.0
    weight = scene.mass * scene.gravity
    u_ddot, phi_ddot = map(float, accelerations(scene, phi, rate, 0.0))
    depth = scene.load.mass / scene.mass * scene.load.offset  # of the common centre of mass
    along = u_ddot - depth * (math.cos(phi) * phi_ddot - math.sin(phi) * rate**2)
    away = depth * (math.sin(phi) * phi_ddot + math.cos(phi) * rate**2)
    normal = weight * math.cos(scene.incline) + scene.mass * away
    friction = weight * math.sin(scene.incline) - scene.mass * along

    forces = rolling_forces(scene, np.array([phi]), np.array([rate]), 0.0)

    allowed = ROUNDING * (weight + scene.mass * (abs(away) + abs(along)))
    assert forces.normal[0] == pytest.approx(normal, abs=allowed)
    assert forces.friction[0] == pytest.approx(friction, abs=allowed)
    if scene.attachment == "sliding":  # footnote 1: no friction without a can
        turning = scene.can.inertia * u_ddot / scene.can.radius**2
        assert forces.friction[0] == pytest.approx(turning, abs=allowed)


def test_forces_where_the_incline_would_have_to_pull() -> None:
    top_and_bottom = np.array([math.pi, 0.0])
    rate = 10.0 * math.sqrt(9.81 / 0.033)
    forces = rolling_forces(hoop(), top_and_bottom, np.array([rate, rate]), 0.0)
    assert forces.normal[0] < 0 < forces.normal[1]
    assert forces.needed_friction[0] == math.inf
    assert math.isfinite(forces.needed_friction[1])


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
    frequency = mp.sqrt(stiffness / taylor.inertia(form, mp.mpf(phi)))
    assert abs(scene.frequency() / frequency - 1) < ANGLE


def test_steepest_incline() -> None:
    limit = frozen().largest_incline()
    assert limit == pytest.approx(math.asin(4 / (3 * math.pi)), rel=ANGLE)
    assert math.degrees(limit) == pytest.approx(25.1, abs=0.05)
    assert sliding().largest_incline() == math.pi / 2
    for sign in (1, -1):
        # There sin(alpha + phi) is 1, and 1 - x^2/2 tells angles apart only to the root of the
        # distance.
        assert frozen(sign * limit * (1 - 1e-8)).equilibrium() == pytest.approx(
            sign * (math.pi / 2 - limit), abs=2 * math.sqrt(1e-8)
        )
        for ask in (
            Scene.equilibrium,
            Scene.frequency,
            Scene.separatrix,
            lambda scene: scene.period(0.1),
        ):
            with pytest.raises(
                NoEquilibriumError, match=r"incline of -?26 degrees: .* only up to 25\.1 degrees"
            ):
                ask(frozen(sign * math.radians(26)))


@pytest.mark.parametrize(
    "scene", [sliding(fill=1.0), frozen(fill=1.0), sliding(gravity=0.0), frozen(gravity=0.0)]
)
def test_nothing_restores(scene: Scene) -> None:
    with pytest.raises(
        NoEquilibriumError, match=r"balanced about the axis \(offset 0 m\) or gravity is 0 m/s\^2"
    ):
        scene.equilibrium()


@pytest.mark.parametrize(
    "scene", [frozen(), frozen(0.01, can=METAL), sliding(can=METAL), pendulum(0.4)]
)
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
    """V is a cubic in a narrow well: as far uphill as half the way downhill to the barrier it is as
    high as there."""
    scene = frozen(sign * frozen().largest_incline() * (1 - short))
    rest = abs(scene.equilibrium())
    low, high = sorted(sign * barrier - rest for barrier in scene.separatrix())
    well = scene.oscillator.potential.well  # its own square is a difference of slope and depth
    assert high == pytest.approx(well, abs=ANGLE)
    assert low == pytest.approx(-well / 2, rel=well, abs=ANGLE)
