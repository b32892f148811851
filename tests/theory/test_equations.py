"""Accelerations against Lagrange's equations, and forces against the motion of the centre of mass."""

import math

import numpy as np
import pytest

from mjbeer import Scene, frozen, hoop
from mjbeer.theory.equations import accelerations, rolling_forces
from tests.support.scenes import SCENES

# Sums of a few terms, compared with the largest of them.
ROUNDING = 5e-15


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
@pytest.mark.parametrize(("phi", "rate"), [(0.7, 3.0), (-2.0, -11.0)])
def test_motion_obeys_lagrange_s_equations(scene: Scene, phi: float, rate: float) -> None:
    """Those of u and phi; rolling as one with its load, a can obeys the first times a, plus the second."""
    u_ddot, phi_ddot = (float(each) for each in accelerations(scene, phi, rate, 0.0))
    a, moment, sin, cos = scene.can.radius, scene.load.mass * scene.load.offset, math.sin(phi), math.cos(phi)
    of_u = [
        (scene.mass + scene.can.inertia / a**2) * u_ddot, -moment * cos * phi_ddot, moment * sin * rate**2,
        -scene.mass * scene.gravity * math.sin(scene.incline),
    ]  # fmt: skip
    of_phi = [
        (scene.load.inertia + moment * scene.load.offset) * phi_ddot, -moment * cos * u_ddot,
        moment * scene.gravity * math.sin(scene.incline + phi),
    ]  # fmt: skip
    equations = [of_u, of_phi]
    if scene.attachment == "frozen":
        assert u_ddot == pytest.approx(a * phi_ddot, rel=ROUNDING)
        equations = [[*(a * term for term in of_u), *of_phi]]
    for terms in equations:
        assert abs(sum(terms)) < ROUNDING * max(map(abs, terms))


@pytest.mark.parametrize("scene", [*SCENES.values(), frozen(-0.1), hoop(0.1)])
def test_forces_move_the_centre_of_mass(scene: Scene) -> None:
    """Newton's second law for the whole (38); nothing but friction turns a can alone."""
    phi, rate, b = 1.2, -7.0, scene.load.offset
    u_ddot, phi_ddot = (float(each) for each in accelerations(scene, phi, rate, 0.0))
    along = u_ddot - scene.load.mass / scene.mass * b * (math.cos(phi) * phi_ddot - math.sin(phi) * rate**2)
    away = scene.load.mass / scene.mass * b * (math.sin(phi) * phi_ddot + math.cos(phi) * rate**2)
    weight = scene.mass * scene.gravity
    scale = weight + scene.mass * (abs(away) + abs(along))
    forces = rolling_forces(scene, np.array([phi]), np.array([rate]), 0.0)
    assert forces.normal[0] == pytest.approx(weight * math.cos(scene.incline) + scene.mass * away, abs=ROUNDING * scale)
    friction = weight * math.sin(scene.incline) - scene.mass * along
    assert forces.friction[0] == pytest.approx(friction, abs=ROUNDING * scale)
    if scene.attachment == "sliding":
        turning = scene.can.inertia * u_ddot / scene.can.radius**2
        assert forces.friction[0] == pytest.approx(turning, abs=ROUNDING * scale)  # footnote 1: 0 without a can
    if scene.incline >= 0 and scene.attachment == "frozen":  # footnote 7: at rest it needs tan(alpha)
        forces = rolling_forces(scene, np.array([scene.equilibrium()]), np.zeros(1), 0.0)
        assert forces.needed_friction == pytest.approx([math.tan(scene.incline)], rel=ROUNDING, abs=ROUNDING)


def test_forces_where_the_incline_would_have_to_pull() -> None:
    forces = rolling_forces(hoop(), np.array([math.pi, 0.0]), np.full(2, 10.0 * math.sqrt(9.81 / 0.033)), 0.0)
    assert forces.normal[0] < 0 < forces.normal[1]
    assert forces.needed_friction[0] == math.inf
    assert math.isfinite(forces.needed_friction[1])
