"""Linear theory against mpmath, closed forms, and the errors of simulations; each fails on a wrong
theory."""

import math

import mpmath
import mujoco
import numpy as np
import pytest
from scipy.integrate import DOP853

from mjbeer import Can, Scene, frozen, pendulum, sliding
from mjbeer.studies import predictions
from mjbeer.studies.benchmark.timing import usual_model
from mjbeer.studies.predictions import (
    RUNGE_KUTTA,
    amplification,
    error,
    polynomial,
    reached_share,
    spectral_radius,
)
from tests.support import rows

EPS = np.finfo(float).eps
FEW = 20 * EPS
"""Rounding of sums of up to twelve terms."""
ROUNDING = 1e-9
METAL = sliding(can=Can.sheet_metal())
STAGES = {
    "RK4": ([[], [0.5], [0, 0.5], [0, 0, 1]], [1 / 6, 1 / 3, 1 / 3, 1 / 6]),
    "DOP853": ([list(DOP853.A[i, :i]) for i in range(12)], list(DOP853.B)),
}


def by_stages(integrator: str, z: complex) -> complex:
    """One step of y' = z y from 1, stage after stage, with 50 digits."""
    inner, weights = STAGES[integrator]
    with mpmath.workdps(50):
        slopes: list[mpmath.mpc] = []
        for row in inner:
            slopes.append(mpmath.mpmathify(z) * (1 + mpmath.fdot(row, slopes)))
        return complex(1 + mpmath.fdot(weights, slopes))


@pytest.mark.parametrize("integrator", RUNGE_KUTTA)
@pytest.mark.parametrize("z", [2.5j, -2.7, -0.4 + 1.1j])
def test_the_polynomial_is_a_step_of_the_method(integrator: str, z: complex) -> None:
    size = sum(abs(c * z**k) for k, c in enumerate(polynomial(integrator)))
    assert abs(by_stages(integrator, z) - np.polyval(polynomial(integrator)[::-1], z)) <= FEW * size


def test_limits_on_the_imaginary_axis() -> None:
    """Bounded just below, not just above; an eigenvalue that is almost double is known to the root
    of rounding."""
    for integrator, limit in (("Euler", 2.0), ("discrete", 2.0), ("RK4", 2 * math.sqrt(2))):
        assert spectral_radius(amplification(integrator, (limit * (1 - 1e-6)) ** 2)) <= 1 + 4 * EPS
        assert spectral_radius(amplification(integrator, (limit * (1 + 1e-6)) ** 2)) > 1 + 1e-6
        assert predictions.stable_limit(integrator) == pytest.approx(limit, rel=2e-3)
    limit = predictions.stable_limit("DOP853")
    assert (
        abs(by_stages("DOP853", 1j * limit * 0.997))
        < 1
        < abs(by_stages("DOP853", 1j * limit * 1.003))
    )


@pytest.mark.slow
@pytest.mark.parametrize("integrator", ["Euler", "RK4", "DOP853"])
def test_the_impedance_drops_out_unless_the_diagonal_is_mistaken(integrator: str) -> None:
    hard = predictions.spring(1e-3, 1.0, 0.9999)
    soft = predictions.spring(1e-3, 1.0, 0.5)

    limit = rows.stable_timestep(integrator, hard)

    assert rows.stable_timestep(integrator, soft) == pytest.approx(limit, rel=1e-7)
    assert rows.stable_timestep(integrator, soft, excess=10.0) > 2 * limit


@pytest.mark.parametrize("timestep", [1e-4, 1.0])
def test_discrete_bears_every_row(timestep: float) -> None:
    for row in (
        predictions.spring(1e-5, 1.0, 0.9),
        predictions.spring(1e-5, 0.1, 0.9999),
        predictions.direct(1e10, 0, 0.9),
    ):
        assert rows.radius("discrete", row, timestep) <= 1 + 1e-12
    assert rows.stable_ratio("discrete") == math.inf


def test_the_error_of_short_steps_of_euler_is_half_of_omega_h() -> None:
    swing = 1e-3

    # (omega h)^2/24 of phase a radian comes second.
    assert error("Euler", swing) == pytest.approx(swing / 2, rel=2e-2)


def test_the_error_of_short_steps_of_rk4_is_that_of_phase_and_damping() -> None:
    swing = 0.1
    ten_periods = 20 * math.pi
    phase = ten_periods * swing**4 / 120
    damping = ten_periods * swing**5 / 144

    # The next order is (omega h)^2 of it.
    assert error("RK4", swing) == pytest.approx(math.hypot(phase, damping), rel=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [frozen(), METAL, pendulum()])
def test_a_usual_joint_equality_has_a_share_of_its_force(scene: Scene) -> None:
    """MuJoCo takes the diagonal of M^-1 for J M^-1 J^T with J = (1, -a), whatever the units."""
    model = usual_model("equality, defaults", scene)
    jacobian = np.array([1.0, -scene.can.radius])
    data = mujoco.MjData(model)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    inverse = np.linalg.inv(mass)[:2, :2]
    predicted = reached_share(0.9, np.trace(inverse) / (jacobian @ inverse @ jacobian))

    applied = rows.applied_share(model, np.zeros(model.nq + model.nv))

    assert applied == pytest.approx(predicted, rel=ROUNDING)
