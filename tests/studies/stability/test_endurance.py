"""Energy over many swings: laws, and what theory predicts of a share."""

import numpy as np
import pytest

from mjbeer import Scene, exact, frozen, pendulum, sliding
from mjbeer.predictions.semi_implicit_euler import energy_per_swing
from mjbeer.studies.stability import endurance
from mjbeer.studies.stability.endurance import BOUNDED, LINEAR, Endurance, rounded_coefficients
from mjbeer.theory.can import Can

pytestmark = pytest.mark.slow

# Samples do not fall on whole swings where the period is not quite a number of steps.
HALF_A_STEP = 5e-3


QUICK = [each for each in endurance.cases() if each.quick_swings]


@pytest.mark.parametrize("case", QUICK, ids=lambda case: f"{case.name}, {case.integrator}, T/{case.steps}")
def test_energy_drifts_by_the_law_that_theory_gives(case: Endurance) -> None:
    found = case.measure(case.quick_swings)
    assert found["law"] == case.law
    assert found["as_expected"]
    if case.law == LINEAR and case.integrator in ("Euler", "implicit", "implicitfast", "discrete"):
        assert found["measured_per_swing"] == pytest.approx(found["predicted_per_swing"], rel=HALF_A_STEP)


def test_another_law_is_noticed() -> None:
    heavy = sliding(0.0, can=Can.hoop(mass=1e5))
    assert not Endurance("free", heavy, "Euler", 32, 100, 100, LINEAR, "").measure(100)["as_expected"]
    assert not Endurance("free", heavy, "RK4", 32, 100, 100, BOUNDED, "").measure(100)["as_expected"]


@pytest.mark.parametrize("scene", [sliding(0.0), sliding(0.2, can=Can.sheet_metal()), frozen(0.0), pendulum()])
def test_energy_that_euler_adds_is_the_integral_along_the_exact_swing(scene: Scene) -> None:
    """-h/2 times the integral of J d(v a), here over time, by the trapezoid rule on a period."""
    form, amplitude, timestep = scene.oscillator, 0.7, 1e-4
    rest, period = scene.equilibrium(), scene.period(0.7)
    time = np.linspace(0, period, 513)
    swing = exact(scene, time, rest + amplitude)
    v, a = swing.phi_dot, form.acceleration(swing.phi, swing.phi_dot)
    slope = form.chord * np.sin(swing.phi) / 2 + form.swing * np.sin(2 * swing.phi)
    gained = timestep / 2 * np.mean((slope * v**2 * a)[:-1]) * period / form.drop(rest, rest + amplitude)
    assert energy_per_swing(scene, amplitude, timestep, "Euler") == pytest.approx(float(gained), rel=1e-10, abs=1e-18)
    assert energy_per_swing(scene, amplitude, timestep, "implicit") == pytest.approx(
        -float(gained), rel=1e-10, abs=1e-18
    )
    assert energy_per_swing(scene, amplitude, timestep, "RK4") is None


def test_what_rounded_coefficients_do_is_the_stability_function_s() -> None:
    """|R(iy)|^2 - 1 of the method with the coefficients that doubles have, in 60 digits; its next term is y^2 of it."""
    import mpmath
    from scipy.integrate import DOP853

    steps = 400
    with mpmath.workdps(60):
        z, stages = mpmath.mpc(0, 2 * mpmath.pi / steps), []
        for row in DOP853.A[: len(DOP853.B)]:
            stages.append(1 + z * mpmath.fsum(mpmath.mpf(float(a)) * k for a, k in zip(row, stages, strict=False)))
        grown = (
            abs(1 + z * mpmath.fsum(mpmath.mpf(float(b)) * k for b, k in zip(DOP853.B, stages, strict=True))) ** 2 - 1
        )
        exactly = float(grown * steps)
    assert rounded_coefficients(steps) == pytest.approx(exactly, rel=2e-3)
