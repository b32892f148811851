"""Rigid prisms by theory, beside what is known of them, MuJoCo's meshes and PhysX's hulls."""

import math

import numpy as np
import pytest

from mjbeer import ParameterError, exact, sliding
from mjbeer.exceptions import UnsupportedError
from mjbeer.studies import polygon
from mjbeer.studies.can_test import ROCK, ROLL
from mjbeer.theory import prism
from mjbeer.theory.can import RADIUS, Can, Load
from mjbeer.theory.prism import regular
from mjbeer.theory.scene import Scene

SOLID = Scene(Can.massless(), Load(0.2, 0.0, 0.1 * RADIUS**2), attachment="frozen")
"""A full cylinder."""


def test_an_edge_that_lands_keeps_the_angular_momentum_about_it() -> None:
    """A solid prism loses (1 - cos(2 pi/n))/1.5 of its rate. A hundredth of a radian before and
    after the impact its rate has hardly changed."""
    facets = 12
    fast = 15.0  # [rad/s], with which it stays on the ground and gravity changes little
    edges = regular(facets)
    level = Scene(SOLID.can, SOLID.load, incline=0.0, attachment="frozen")
    before = prism.roll(level, edges, 1e-6, phi0=math.pi / facets - 2e-5, phi_dot0=fast)
    after = prism.roll(level, edges, 3e-6, phi0=math.pi / facets - 2e-5, phi_dot0=fast)
    assert (before.impacts, after.impacts) == (0, 1)
    at_impact, at_end = after.time[-2:]
    rate = (after.phi[-1] - after.phi[-2]) / (at_end - at_impact)
    lost = (1 - math.cos(math.tau / facets)) / 1.5
    assert rate == pytest.approx(fast * (1 - lost), rel=1e-4)


def test_a_prism_that_is_held_down_brakes_as_facets_and_speed_say() -> None:
    """Impacts in a row take w dw/dphi = -k w^2, with k = n (1 - cos(2 pi/n))/(2 pi 1.5). With the
    torque of the weight, w' = p - k w^2, and phi = ln cosh(sqrt(p k) t)/k. Of n = 60 facets the
    swing on each is left out, which is 1/n of what is lost."""
    facets = 60
    braking = facets * (1 - math.cos(math.tau / facets)) / (math.tau * 1.5)
    pull = SOLID.gravity * math.sin(SOLID.incline) / (1.5 * RADIUS)
    expected = math.log(math.cosh(math.sqrt(pull * braking) * 2.0)) / braking
    motion = prism.roll(SOLID, regular(facets), 2.0, flies=False)
    assert motion.flights == 0
    assert motion.phi[-1] == pytest.approx(expected, rel=1 / facets)
    of_a_facet = 2 * RADIUS * math.sin(math.pi / facets)
    at_impacts = motion.u[1:-1]
    assert np.diff(at_impacts) == pytest.approx(of_a_facet, rel=1e-9)
    round_end = exact(SOLID, [2.0], 0.0).phi[-1]
    assert motion.phi[-1] < 0.7 * round_end


@pytest.mark.parametrize("phi0", [0.0, 0.2])
def test_a_prism_flies_when_its_weight_no_longer_holds_it(phi0: float) -> None:
    """Its edge, a from the centre of mass, is accelerated by a w^2. Free of it, the prism flies in
    a parabola."""
    alpha = SOLID.incline
    fastest = math.sqrt(SOLID.gravity * math.cos(alpha) / (RADIUS * math.cos(phi0)))
    duration = 1e-3
    held = prism.roll(SOLID, regular(8), 1e-4, phi0, 0.999 * fastest)
    flown = prism.roll(SOLID, regular(8), duration, phi0, 1.001 * fastest)
    assert (held.flights, flown.flights) == (0, 1)
    turned = 1.001 * fastest * duration
    fallen = SOLID.gravity * math.sin(alpha) * duration**2 / 2
    assert flown.phi[-1] - phi0 == pytest.approx(turned, rel=1e-12)
    way = flown.u[-1] - RADIUS * phi0
    assert way == pytest.approx(RADIUS * math.cos(phi0) * turned + fallen, rel=1e-12)


def test_on_an_edge_a_prism_swings_like_an_inverted_pendulum() -> None:
    """From rest at the angle -alpha to the upright it has turned by alpha (cosh(w t) - 1), where
    w^2 = g/(1.5 a). The sines of angles up to 0.04 rad are taken as the angles: 2e-4."""
    incline = math.radians(1)
    gentle = Scene(SOLID.can, SOLID.load, incline=incline, attachment="frozen")
    motion = prism.roll(gentle, regular(200), 0.1, flies=False)
    first_impact = motion.time[1]
    fastness = math.sqrt(gentle.gravity / (1.5 * RADIUS))
    turned = incline * (math.cosh(fastness * first_impact) - 1)
    assert turned == pytest.approx(math.pi / 200, rel=5e-4)
    assert motion.phi[1] == pytest.approx(math.pi / 200, rel=1e-12)


@pytest.mark.slow
def test_mujocos_mesh_rolls_like_a_rigid_prism_if_its_contact_is_stiff() -> None:
    """Theory's own scatter is 0.3 %: a start 1e-9 rad aside lands other edges. The rest is the time
    that an impact takes."""
    facets = 48
    stiff = polygon.mujoco_end(facets, 4e-4, timestep=2e-4, duration=1.2)
    theory = polygon.theory_end(regular(facets).tolist(), duration=1.2)
    assert stiff == pytest.approx(theory, rel=0.03)
    held = polygon.theory_end(regular(facets).tolist(), flies=False, duration=1.2)
    assert held < 0.95 * theory


@pytest.mark.costly
@pytest.mark.parametrize("facets", polygon.FACETS)
def test_mujocos_meshes_of_the_table_end_where_theory_says(facets: int) -> None:
    stiff = polygon.mujoco_end(facets, polygon.TIME_CONSTANTS[0])
    theory = polygon.theory_end(regular(facets).tolist())
    assert stiff == pytest.approx(theory, rel=0.05)
    assert polygon.mujoco_end(facets, polygon.TIME_CONSTANTS[-1]) > theory


def physx_as_theory(rolled: polygon.PhysxPrism) -> None:
    """A prism with two ends that differ rolls on lines between their corners, which theory does not
    have: the mean of two prisms is meant."""
    theory = np.mean([polygon.theory_end(edges) for edges in (rolled.left, rolled.right)])
    within = 0.01 if rolled.left == rolled.right else 0.07
    assert theory == pytest.approx(rolled.end["1e-4"], rel=within)


@pytest.mark.slow
@pytest.mark.parametrize("rolled", polygon.physx_prisms()[:3], ids=lambda rolled: rolled.asked)
def test_physx_rolls_the_hull_that_it_has_kept(rolled: polygon.PhysxPrism) -> None:
    physx_as_theory(rolled)
    if rolled.asked > 16:
        whole = polygon.theory_end(regular(rolled.asked).tolist(), flies=False)
        assert whole > 1.15 * rolled.end["1e-4"]


@pytest.mark.costly
@pytest.mark.parametrize("rolled", polygon.physx_prisms()[3:], ids=lambda rolled: rolled.asked)
def test_so_does_it_with_more_facets_and_in_a_larger_world(rolled: polygon.PhysxPrism) -> None:
    physx_as_theory(rolled)


def test_what_is_no_prism_or_does_not_roll_is_refused() -> None:
    with pytest.raises(UnsupportedError, match="only a frozen load rolls here, got 'sliding'"):
        prism.roll(sliding(), regular(12), 1.0)
    with pytest.raises(ParameterError, match="edges must surround the axis, got 2"):
        prism.roll(ROLL.scene, [0.0, 1.0], 1.0)
    with pytest.raises(ParameterError, match=r"facets must be a whole number, got 12\.5"):
        regular(12.5)
    with pytest.raises(UnsupportedError, match="the prism falls back at phi = 1 rad"):
        prism.roll(ROCK.scene, regular(40), 1.0, phi0=1.0)
