"""Accelerations against the corrected equations, and forces against the motion of the centre of mass."""

import math

import numpy as np
import pytest

from mjbeer import Scene, frozen, hoop, paper
from mjbeer.paper.claim import Seen, relative_residual, terms
from mjbeer.theory.equations import accelerations, rolling_forces
from tests.support.scenes import SCENES

# Sums of a few terms, compared with the largest of them.
ROUNDING = 5e-15
ROWS = {row.equation: row for row in paper.claims() if "equation of motion" in row.quantity}


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
@pytest.mark.parametrize(("phi", "rate"), [(0.7, 3.0), (-2.0, -11.0)])
def test_motion_obeys_the_corrected_equations(scene: Scene, phi: float, rate: float) -> None:
    """(47), (49) and (61) as printed leave a residual that is no rounding."""
    u2, phi2 = (float(each) for each in accelerations(scene, phi, rate, 0.0))
    a, b, sin, cos = scene.can.radius, scene.load.offset, math.sin(phi), math.cos(phi)
    moved = {"theta": scene.incline + phi, "phi": phi, "phi_dot": rate, "phi_ddot": phi2}
    q = Seen.of(scene, **moved, u_ddot=u2, s_ddot=u2 - b * (cos * phi2 - sin * rate**2))

    def residual(equation: str, printed: bool = False) -> float:
        return relative_residual(terms(ROWS[equation].printed if printed else ROWS[equation].right, q))

    if scene.attachment == "frozen":
        assert u2 == pytest.approx(a * phi2, rel=ROUNDING)
        whole = q.m + q.can_mass
        resists = q.axial + q.can_inertia + whole * a**2
        pull = -whole * q.g * a * math.sin(q.alpha), q.m * q.g * b * math.sin(q.theta)
        lever = q.m * a * b
        assert relative_residual((resists * phi2, -2 * lever * cos * phi2, lever * sin * rate**2, *pull)) < ROUNDING
        if scene.can.mass == 0:  # then it is (52)
            assert residual("(52)") < ROUNDING
        return
    assert all(residual(equation) < ROUNDING for equation in ("(46)", "(47)", "(48)", "(49)"))
    assert residual("(47)", printed=True) > 0.01
    if scene.can.mass == 0:
        assert residual("(16)") < ROUNDING
    else:
        assert residual("(49)", printed=True) > 1e-3
    if scene.load.inertia == 0:
        assert all(residual(equation) < ROUNDING for equation in ("(57)", "(58)", "(60)", "(61)"))
        assert residual("(61)", printed=True) > 1e-3


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
