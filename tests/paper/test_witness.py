"""What MuJoCo says of a motion: consistent with itself, whichever way the can is made to roll."""

import math

import numpy as np
import pytest

from mjbeer import Can, Scene, exact, frozen, pendulum, simulate, sliding
from mjbeer.paper.audit.witness import Witness, examine, watch
from mjbeer.theory.equations import accelerations, rolling_forces

# MuJoCo takes the drift of its joint equality back: 3e-9 of the accelerations.
DRIFT = 2e-8
SCENES = {
    "sliding": (sliding(), "reduced"),
    "metal": (sliding(can=Can.sheet_metal()), "equality"),
    "frozen": (frozen(), "equality"),
    "pendulum": (pendulum(-0.2), "equality"),
    "frozen, reduced": (frozen(), "reduced"),
}


@pytest.fixture(params=SCENES)
def seen(request: pytest.FixtureRequest) -> Witness:
    return watch(*SCENES[request.param], 0.5, 1.2, samples=11)


def slopes(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Derivative by sixth-order differences, but for three samples at either end."""
    h = time[1] - time[0]
    inner = [values[3 + k : len(values) - 3 + k] for k in (-3, -2, -1, 1, 2, 3)]
    return sum(w * each for w, each in zip((-1, 9, -45, 45, -9, 1), inner, strict=True)) / (60 * h)


@pytest.mark.parametrize("name", ["sliding", "metal", "frozen", "pendulum"])
def test_velocities_and_accelerations_are_slopes(name: str) -> None:
    """At 0.2 ms the differences are good to (omega h)^6, some 1e-13, and to rounding over h, 1e-11."""
    scene, rolling = SCENES[name]
    run = simulate(scene, 0.01, 1.2, 3.0, rolling, "DOP853", timestep=2e-4)
    seen = examine(run)
    q, inner = seen.quantities, slice(3, -3)
    for position, rate, acceleration in (
        (q.s, q.s_dot, q.s_ddot),
        (q.u, q.u_dot, q.u_ddot),
        (q.phi, q.phi_dot, q.phi_ddot),
        tuple(seen.across),
    ):
        assert slopes(seen.time, position) == pytest.approx(rate[inner], abs=1e-8 * np.abs(rate).max())
        assert slopes(seen.time, rate) == pytest.approx(acceleration[inner], abs=1e-6 * np.abs(acceleration).max())


def test_it_agrees_with_theory(seen: Witness) -> None:
    q = seen.quantities
    u_ddot, phi_ddot = accelerations(seen.scene, q.phi, q.phi_dot, q.u_dot)
    if seen.scene.attachment == "frozen" and not q.u_ddot.any():
        u_ddot = q.u_ddot  # the reduced can turns on the spot
    assert q.phi_ddot == pytest.approx(phi_ddot, abs=DRIFT * np.abs(phi_ddot).max())
    assert q.u_ddot == pytest.approx(u_ddot, abs=DRIFT * max(np.abs(u_ddot).max(), 1.0))
    assert seen.theta == pytest.approx(q.phi + seen.scene.incline, abs=1e-14)


@pytest.mark.parametrize("name", ["sliding", "metal", "frozen", "pendulum"])
def test_its_energy_is_that_of_the_trajectory(name: str) -> None:
    scene, rolling = SCENES[name]
    run = simulate(scene, 0.3, 1.2, rolling=rolling)
    seen = examine(run)
    energy = seen.kinetic + seen.potential
    assert energy == pytest.approx(run.energy, abs=1e-11 * seen.kinetic.max())


@pytest.mark.parametrize("name", ["metal", "frozen", "pendulum"])
def test_friction_is_what_rolling_needs(name: str) -> None:
    seen = watch(*SCENES[name], 0.3, 1.2, samples=11)
    q = seen.quantities
    needed = rolling_forces(seen.scene, q.phi, q.phi_dot, q.u_dot).friction
    assert seen.friction == pytest.approx(needed, abs=1e-6 * np.abs(needed).max())


def test_height_is_against_gravity() -> None:
    scene = Scene(Can.massless(), sliding().load, math.radians(30))
    seen = watch(scene, "reduced", 0.2, 1.2, samples=3)
    b = scene.load.offset
    fell = exact(scene, seen.time, 1.2)
    assert seen.height == pytest.approx(-fell.u * 0.5 - b * np.cos(fell.phi + math.pi / 6), abs=1e-10)
