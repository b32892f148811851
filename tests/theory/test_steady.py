"""Steady rolling of a damped can and the modes of small motions about it: closed forms against what they stand for."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mjbeer import Can, Load, Scene, exact, frozen, sliding
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError
from mjbeer.theory.can import Damping
from mjbeer.theory.equations import accelerations
from tests.support.scenes import METAL, scenes

# A few sums and products.
ROUNDING = 4e-15
LAWS = {"linear": 2e-3, "every power": Damping(1e-3, 1e-5, 1e-7), "no linear part": Damping(0, 1e-4, 0)}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
@pytest.mark.parametrize("drag", [0.0, 0.02])
@pytest.mark.parametrize("incline", [0.2, -0.3, 0.0])
def test_nothing_accelerates(law: float | Damping, drag: float, incline: float) -> None:
    scene = sliding(incline, can=METAL, damping=law, drag=drag)
    found = accelerations(scene, scene.terminal_tilt(), 0.0, scene.terminal_speed())
    assert np.array(found) / [scene.gravity, scene.gravity / 0.033] == pytest.approx([0, 0], abs=ROUNDING)
    assert scene.equilibrium() == scene.terminal_tilt()
    assert scene.acceleration() == 0


def test_tilt_is_that_of_the_frozen_can_and_speed_a_closed_form() -> None:
    for can in (Can(), METAL):
        for c in (1e-9, 1e-3, 1e4):
            scene = sliding(can=can, damping=c)
            assert scene.terminal_tilt() == frozen(can=can).equilibrium()
            speed = scene.mass * 9.81 * math.sin(scene.incline) * 0.033**2 / c
            assert scene.terminal_speed() == pytest.approx(speed, rel=ROUNDING)
            assert scene.slip_rate() == pytest.approx(speed / 0.033, rel=ROUNDING)
            assert scene.largest_incline() == frozen(can=can).largest_incline()


def test_steady_rolling_ends_at_the_largest_incline() -> None:
    for scene in (sliding(damping=1e-3), sliding(can=METAL, damping=Damping(1e-3, 1e-5), drag=0.05)):
        limit = scene.largest_incline()
        assert limit < math.pi / 2
        assert replace(scene, incline=limit * (1 - 1e-9)).terminal_tilt() > 0
        above = replace(scene, incline=limit * (1 + 1e-9))
        for ask in (above.terminal_speed, above.terminal_tilt, above.modes, above.frequency, above.equilibrium):
            with pytest.raises(NoEquilibriumError, match=rf"only up to {math.degrees(limit):.1f} degrees"):
                ask()
    assert sliding(1.5, drag=0.01).largest_incline() == math.pi / 2
    assert sliding(1.5, drag=0.01).terminal_tilt() == pytest.approx(-1.5, rel=ROUNDING)  # the load hangs down


@pytest.mark.slow
@settings(max_examples=60, deadline=None, derandomize=True)
@given(scenes(), st.floats(-3, 3), st.sampled_from([0.0, 1.0, 100.0]), st.floats(-0.95, 0.95))
def test_modes_are_eigenvalues(scene: Scene, power: float, drag: float, steep: float) -> None:
    """Of the Jacobian of the accelerations, by central differences, over six decades of damping."""
    scene = replace(scene, attachment="sliding")
    a = scene.can.radius
    clock = math.sqrt(a / scene.gravity)
    mass = scene.mass + scene.can.inertia / a**2
    scene = replace(scene, damping=10**power * mass * a**2 / clock, drag=drag * scene.mass / a)
    scene = replace(scene, incline=steep * scene.largest_incline())
    state = np.array([scene.terminal_tilt(), 0.0, scene.terminal_speed()])

    def slope(state: np.ndarray) -> np.ndarray:
        u_ddot, phi_ddot = accelerations(scene, state[0], state[1], state[2])
        return np.array([state[1], float(phi_ddot), float(u_ddot)])

    # The law is linear and the drag a square, of which central differences are exact; phi's is of third order.
    steps = np.array([1e-5, 1e-4 / clock, 0.1 * abs(state[2]) if drag else 1e-4 * a / clock])
    assume(not drag or abs(steep) > 0.05)  # at rest the drag has a corner, of which central differences see a slope
    jacobian = np.stack(
        [(slope(state + step) - slope(state - step)) / (2 * step.sum()) for step in np.diag(steps)], axis=1
    )
    units = np.array([1.0, 1 / clock, a / clock])
    roots, expected = scene.modes(), np.sort_complex(np.linalg.eigvals(jacobian * units / units[:, np.newaxis]))
    spread = np.abs(np.subtract.outer(expected, expected))[~np.eye(3, dtype=bool)].min()
    assume(spread > 1e-2 * np.abs(expected).max())  # double roots are as uncertain as the root of a Jacobian
    assert np.abs(roots - expected).max() < 1e-6 * np.abs(expected).max()


def test_modes_of_weak_and_strong_damping() -> None:
    """The slowest decay keeps its digits beside a fast one, and both limits are known."""
    scene = sliding(can=METAL, damping=1e4)
    m, b, a, tilt = scene.load.mass, scene.load.offset, scene.can.radius, scene.terminal_tilt()
    mass, moment, inertia = scene.effective_mass, m * b * math.cos(tilt), scene.load.inertia + m * b**2
    k = m * b * scene.gravity * math.cos(scene.incline + tilt)
    swinging, stiff = mass * inertia - moment**2, mass * a**2 + inertia - 2 * moment * a
    strong = scene.modes()
    assert strong[0].real == pytest.approx(-1e4 * stiff / (a**2 * swinging), rel=1e-12)
    assert strong[1].real == pytest.approx(-(a**2) * k * (mass * a - moment) ** 2 / (2 * 1e4 * stiff**2), rel=1e-12)
    assert abs(strong[1].imag) == pytest.approx(math.sqrt(k / stiff), rel=1e-12)
    # (10) on level ground, where both tilts are 0, and (55) corrected on any
    slow, fast = sliding(0.0, can=METAL, damping=1e-12), sliding(0.2, can=METAL, damping=1e4)
    assert slow.frequency() == pytest.approx(sliding(0.0, can=METAL).frequency(), rel=1e-12)
    assert fast.frequency() == pytest.approx(frozen(0.2, can=METAL).frequency(), rel=1e-12)


@pytest.mark.slow
def test_mean_slip() -> None:
    """Above the largest incline the load loops: the mean of the u-equation over a second, whatever phi does."""
    scene, c, a = sliding(math.radians(30), damping=1e-2), 1e-2, 0.033
    motion = exact(scene, [1.0, 2.0], 0.0, 112.7)
    momentum = scene.mass * motion.u_dot - scene.load.mass * scene.load.offset * np.cos(motion.phi) * motion.phi_dot
    slipped = np.diff(motion.u)[0] / a - np.diff(motion.phi)[0]
    assert slipped + np.diff(momentum)[0] * a / c == pytest.approx(scene.slip_rate(), rel=1e-11)  # 18 turns a second


def test_what_has_no_answer_says_so() -> None:
    plain, damped, mixed = sliding(), sliding(damping=1e-3), sliding(damping=1e-3, drag=0.01)
    for ask in (plain.terminal_speed, plain.terminal_tilt, plain.modes, frozen().terminal_speed):
        with pytest.raises(ParameterError, match="damping and drag are 0"):
            ask()
    for scene in (plain, mixed, sliding(damping=Damping(1e-3, 1e-5)), frozen()):
        with pytest.raises(ParameterError, match=r"no mean slip rate .* linear damping without drag, got"):
            scene.slip_rate()
    for scene in (damped, mixed):
        with pytest.raises(ParameterError, match=r"no period.*scene\.modes\(\) has the rates"):
            scene.period(0.1)
        with pytest.raises(ParameterError, match="no largest swing"):
            scene.separatrix()
    balanced = Scene(METAL, Load(0.3, 0.0, 1e-4), 0.2, damping=1e-3)
    for scene in (balanced, replace(damped, gravity=0.0)):
        with pytest.raises(NoEquilibriumError, match="nothing restores the load"):
            scene.terminal_speed()
    heavy = Scene(Can.hoop(mass=100.0), Load(0.3, 0.01, 1e-6), 0.0, damping=1e-2)
    with pytest.raises(NoLibrationError, match="no frequency: the load creeps back without a swing"):
        heavy.frequency()
