"""What strip charts show, checked against exact theory."""

import math

import numpy as np
import pytest

from mjbeer import Can, exact, frozen, simulate, sliding
from mjbeer.drawing.overlay import quantity
from mjbeer.drawing.overlay.quantity import QUANTITIES

TIMES = np.linspace(0, 1, 2001)


@pytest.mark.parametrize("make", [frozen, sliding])
def test_forces_of_a_rolling_can_are_those_that_rolling_needs(make) -> None:
    """The mean over a width w is off by N'' w^2/24: N changes by a weight at up to 50 rad/s, and w is 5 ms, so 3e-3."""
    motion = exact(make(can=Can.sheet_metal()), TIMES, 1.0)
    normal, friction = quantity.forces(motion.scene, motion)
    weight, inner = motion.scene.mass * 9.81, slice(20, -20)
    assert np.abs(normal - motion.forces.normal)[inner].max() < 3e-3 * weight
    assert np.abs(friction - motion.forces.friction)[inner].max() < 3e-3 * weight


def test_a_can_in_the_air_has_no_forces_and_a_slipping_one_mu_times_n() -> None:
    run = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4)
    normal, friction = quantity.forces(run.scene, run)
    weight = run.scene.mass * 9.81
    flying = run.lift > 4e-3  # and not about to land
    assert flying.sum() > 20
    assert np.abs(normal[flying]).max() < 1e-3 * weight
    assert np.abs(friction[flying]).max() < 1e-3 * weight
    scene = frozen()
    slides = simulate(scene, 0.5, scene.equilibrium(), rolling="contact", friction=0.1)
    normal, friction = quantity.forces(scene, slides)
    touching = slides.time < 0.3
    assert (friction / normal)[touching] == pytest.approx(0.1, rel=1e-4)  # what a contact this stiff leaves out


def test_ahead_is_the_swing_of_eq_12() -> None:
    """u = s + b sin(phi), and s accelerates with g sin(alpha): what is left is b sin(phi), in a massless can."""
    motion = exact(sliding(), TIMES, 1.2, 3.0)
    expected = 1e3 * motion.scene.load.offset * np.sin(motion.phi)
    assert QUANTITIES["ahead"].of(motion.scene, motion) == pytest.approx(expected, abs=1e-9)


def test_a_damped_can_is_behind_the_one_that_accelerates_evenly() -> None:
    """By what damping costs: the even one is that without damping, and starts alike."""
    free, damped = sliding(can=Can.sheet_metal()), sliding(can=Can.sheet_metal(), damping=1e-3, drag=1e-4)
    motion, without = exact(damped, TIMES, 1.2, 3.0), exact(free, TIMES, 1.2, 3.0)
    even = quantity.even(damped, motion, TIMES)
    assert even == pytest.approx(quantity.even(free, without, TIMES), abs=1e-12)
    assert even[-1] - motion.u[-1] > 0.2


def test_even_acceleration_of_a_full_can_is_its_own() -> None:
    motion = exact(frozen(fill=1.0), TIMES, 0.3)
    assert QUANTITIES["ahead"].of(motion.scene, motion) == pytest.approx(np.zeros_like(TIMES), abs=1e-9)


def test_angles_are_between_plus_and_minus_180_degrees() -> None:
    assert quantity.wrapped(np.radians([0, 179, 181, -181, 540.5])) == pytest.approx([0, 179, -179, 179, -179.5])


def test_slip_begins_at_zero_and_is_what_the_can_did_not_roll() -> None:
    run = simulate(frozen(), 0.5, frozen().equilibrium(), rolling="contact", friction=0.1)
    slid = QUANTITIES["slip"].of(run.scene, run)
    assert slid[0] == 0
    assert slid == pytest.approx(1e3 * (run.slip - run.slip[0]), abs=1e-9)
    assert slid[-1] > 10
