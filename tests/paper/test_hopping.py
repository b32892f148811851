"""The hoop with a weight on its rim: closed forms and contact runs against theory.

The hoop has g = r = 1, m = I = 1, a weight M = 3 and mu = 0.2, as in W. F. D. Theron and M. F.
Maritz, "The amazing variety of motions of a loaded hoop" (2008).
"""

import math
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mjbeer import exact, hoop, simulate
from mjbeer.paper import hopping
from mjbeer.theory.equations import rolling_forces
from mjbeer.theory.trajectory import Trajectory

MU = 0.2
WEIGHT = 3.0
HOOP = 1.0
SCENE = hoop(hoop_mass=HOOP, load_mass=WEIGHT, radius=1.0, length=1.0, gravity=1.0)
SOFT = 1e-3
"""A contact is soft for about a timestep of 5e-4 s, in which the rim moves by about 5e-4."""


class Accelerations(NamedTuple):
    """The accelerations of a hoop that slides, and the normal force."""

    u_ddot: float
    phi_ddot: float
    normal: float


def sliding(phi: float, phi_dot: float, friction: float) -> Accelerations:
    """Return the motion of a hoop whose friction is F = `friction` N.

    The three equations are Newton's for the whole, along and across the ground, and Lagrange's for
    phi.
    """
    sin = math.sin(phi)
    cos = math.cos(phi)
    matrix = np.array(
        [
            [HOOP + WEIGHT, -WEIGHT * cos, friction],
            [-WEIGHT * cos, HOOP + WEIGHT, -friction],
            [0.0, -WEIGHT * sin, 1.0],
        ]
    )
    right = [
        -WEIGHT * sin * phi_dot**2,
        -WEIGHT * sin,
        HOOP + WEIGHT + WEIGHT * cos * phi_dot**2,
    ]
    return Accelerations(*np.linalg.solve(matrix, right))


def slide_until_it_grips(rolling: Trajectory, friction: float) -> Any:
    """Return SciPy's solution of u, phi and their rates, from the end of a rolling motion on."""
    began = rolling.time[-1]

    def rates(_: float, state: np.ndarray) -> list[float]:
        _, phi, u_dot, phi_dot = state
        motion = sliding(phi, phi_dot, friction)
        return [u_dot, phi_dot, motion.u_ddot, motion.phi_ddot]

    def grips(_: float, state: np.ndarray) -> float:
        """Return how fast the rim slides against the friction, and 1e-9 for the start of it."""
        _, _, u_dot, phi_dot = state
        return math.copysign(1.0, friction) * (u_dot - phi_dot) + 1e-9

    grips.terminal = True  # ty: ignore[missing-attribute]
    grips.direction = -1  # ty: ignore[missing-attribute]
    state = [rolling.u[-1], rolling.phi[-1], rolling.u_dot[-1], rolling.phi_dot[-1]]
    solution = solve_ivp(
        rates, (began, began + 5), state, events=grips, dense_output=True, rtol=1e-10, atol=1e-12
    )
    assert len(solution.t_events[0]) == 1
    return solution


@pytest.mark.slow
@pytest.mark.parametrize("phi_dot0", [-0.2, -0.3, -0.5])
def test_contact_rolls_slips_and_grips_as_coulomb_says(phi_dot0: float) -> None:
    """The hoop rolls until |F| = mu N, and then slips until its rim grips.

    By then u and phi are some hundredths apart, and N was never 0.
    """
    skids = exact(SCENE, np.linspace(0, 5, 5001), math.pi, phi_dot0).rolls_until(MU)
    before = exact(SCENE, [0.0, skids], math.pi, phi_dot0)
    friction = math.copysign(MU, float(before.forces.friction[-1]))
    slip = slide_until_it_grips(before, friction)
    run = simulate(
        SCENE, slip.t[-1], math.pi, phi_dot0, rolling="contact", timestep=5e-4, friction=MU
    )

    rolls = run.time <= skids
    rolling = exact(SCENE, run.time[rolls], math.pi, phi_dot0)
    assert np.abs(run.u[rolls] - rolling.u).max() < SOFT
    assert np.abs(run.phi[rolls] - rolling.phi).max() < SOFT

    slips = ~rolls & (run.time <= slip.t[-1])
    u, phi, _, phi_dot = slip.sol(run.time[slips])
    assert np.abs(run.u[slips] - u).max() < SOFT
    assert np.abs(run.phi[slips] - phi).max() < SOFT
    assert abs(u[-1] - phi[-1]) > 20 * SOFT
    normal = [sliding(*state, friction).normal for state in zip(phi, phi_dot, strict=True)]
    assert min(normal) > 0


@pytest.mark.parametrize("ratio", [1e-3, 0.05, 0.3])
@pytest.mark.parametrize("phi", [3.0, 2.0, 1.0])
def test_closed_forms_are_the_theory_of_forces(ratio: float, phi: float) -> None:
    scene = hoop(hoop_mass=ratio, load_mass=1.0, gravity=1.0, radius=1.0, length=1.0)
    rate = math.sqrt(hopping.rate_squared(ratio, phi))
    forces = rolling_forces(scene, phi, rate, rate)
    assert hopping.normal(ratio, phi) == pytest.approx(float(forces.normal), rel=1e-12, abs=1e-14)
    assert hopping.friction(ratio, phi) == pytest.approx(
        float(forces.friction), rel=1e-12, abs=1e-14
    )
    assert hopping.acceleration(ratio, phi) == pytest.approx(
        float(scene.oscillator.acceleration(phi, rate)), rel=1e-12
    )


def test_it_slips_before_it_lifts_off_at_any_friction_and_stays_above_a_thirteenth() -> None:
    angles = [hopping.slip(0.05, mu) for mu in (0.2, 0.8, 5.0, 100.0)]
    assert angles == sorted(angles)
    assert angles[-1] < hopping.lift_off(0.05) < hopping.lift_off(0.0769)
    assert math.isnan(hopping.lift_off(0.08))
