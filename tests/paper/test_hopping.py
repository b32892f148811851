"""The hoop with a weight on its rim: closed forms and contact runs against theory.

g = r = 1, hoop m = I = 1, weight M = 3, mu = 0.2 is the setting in which W. F. D. Theron and M. F.
Maritz, "The amazing variety of motions of a loaded hoop" (2008), can be compared with.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mjbeer import exact, hoop, simulate
from mjbeer.paper import hopping
from mjbeer.theory.equations import rolling_forces

MU = 0.2
WEIGHT = 3.0
HOOP = 1.0
SCENE = hoop(hoop_mass=HOOP, load_mass=WEIGHT, radius=1.0, length=1.0, gravity=1.0)
# A contact is soft over a time constant of one timestep, 5e-4 s, in which the rim goes as many
# radians.
SOFT = 1e-3


def accelerations(phi: float, rate: float, push: float) -> np.ndarray:
    """u_ddot, phi_ddot and N with F = `push` N.

    They follow from Newton's laws for the whole and Lagrange's for phi.
    """
    sin = math.sin(phi)
    cos = math.cos(phi)
    matrix = np.array(
        [
            [HOOP + WEIGHT, -WEIGHT * cos, push],
            [-WEIGHT * cos, HOOP + WEIGHT, -push],
            [0.0, -WEIGHT * sin, 1.0],
        ]
    )
    right = [-WEIGHT * sin * rate**2, -WEIGHT * sin, HOOP + WEIGHT + WEIGHT * cos * rate**2]
    return np.linalg.solve(matrix, right)


@pytest.mark.slow
@pytest.mark.parametrize("phi_dot0", [-0.2, -0.3, -0.5])
def test_contact_rolls_slips_and_grips_as_coulomb_says(phi_dot0: float) -> None:
    """It rolls until |F| = mu N, and then slips, which SciPy integrates until the rim grips.

    In the end u and phi are some hundredths apart in the end, and N is never 0.
    """
    skids = exact(SCENE, np.linspace(0, 5, 5001), math.pi, phi_dot0).rolls_until(MU)
    start = exact(SCENE, [0.0, skids], math.pi, phi_dot0)
    sign = math.copysign(1.0, float(start.forces.friction[-1]))

    def slides(_: float, state: np.ndarray) -> list[float]:
        u_ddot, phi_ddot, _ = accelerations(state[1], state[3], sign * MU)
        return [state[2], state[3], u_ddot, phi_ddot]

    def slips(_: float, state: np.ndarray) -> float:
        """How fast the rim slides against the friction, less 1e-9 to leave the slip's start."""
        return sign * (state[2] - state[3]) + 1e-9

    slips.terminal = True  # ty: ignore[missing-attribute]
    slips.direction = -1  # ty: ignore[missing-attribute]
    state = [start.u[-1], start.phi[-1], start.u_dot[-1], start.phi_dot[-1]]
    slip = solve_ivp(
        slides, (skids, skids + 5), state, events=slips, dense_output=True, rtol=1e-10, atol=1e-12
    )
    assert len(slip.t_events[0]) == 1
    run = simulate(
        SCENE, slip.t[-1], math.pi, phi_dot0, rolling="contact", timestep=5e-4, friction=MU
    )
    rolls = run.time <= skids
    inside = ~rolls & (run.time <= slip.t[-1])
    rolling = exact(SCENE, run.time[rolls], math.pi, phi_dot0)
    u, phi, _, phi_dot = slip.sol(run.time[inside])
    assert np.abs(run.u[rolls] - rolling.u).max() < SOFT
    assert np.abs(run.phi[rolls] - rolling.phi).max() < SOFT
    assert np.abs(run.u[inside] - u).max() < SOFT
    assert np.abs(run.phi[inside] - phi).max() < SOFT
    assert abs(u[-1] - phi[-1]) > 20 * SOFT
    normal = [accelerations(*state, MU)[2] for state in zip(phi, phi_dot, strict=True)]
    assert min(normal) > 0


@pytest.mark.parametrize("ratio", [1e-3, 0.05, 0.3])
@pytest.mark.parametrize("phi", [3.0, 2.0, 1.0])
def test_closed_forms_are_the_theory_of_forces(ratio: float, phi: float) -> None:
    scene = hoop(hoop_mass=ratio, load_mass=1.0, gravity=1.0, radius=1.0, length=1.0)
    rate = math.sqrt(hopping.rate(ratio, phi))
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
