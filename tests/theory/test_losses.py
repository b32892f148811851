"""What damping and drag take from a motion, and what a record with it says of right and of wrong motions."""

import math
from dataclasses import replace

import numpy as np
import pytest
from mjbeer.theory.losses import followed, losses, stiffest, stiffness
from mjbeer.theory.trust import doubts
from scipy.integrate import cumulative_simpson

from mjbeer import Scene, pendulum, sliding
from mjbeer.theory.equations import Coordinates, accelerations, slip_rate
from mjbeer.theory.liquid import Damping
from mjbeer.theory.record import Record
from tests.support.damped import motion
from tests.support.scenes import METAL

MIXED = Damping(1e-4, 1e-6, 1e-7)
SCENES = {
    "linear": sliding(damping=1e-3),
    "mixed": sliding(0.3, can=METAL, damping=MIXED, drag=0.05),
    "drag": replace(pendulum(), drag=0.3),
    "hardly": sliding(damping=1e-12),
}
# Local errors of 1e-12 add up over some ten swings.
ROUNDING = 1e-10
# Where the axis or the slip turns back, a force that goes with |u_dot| or |w| has a kink in its derivative. There no
# method of high order is better than the cube of its step over the time of the motion, here (0.01 s / 0.4 s)^3, of a
# small part of the force.
KINK = 1e-7


@pytest.mark.parametrize("name", SCENES)
def test_losses_are_integrals_along_the_motion(name: str) -> None:
    """Against Simpson's rule on samples ten times as dense, for each of the three integrals and the double one."""
    scene, fine = SCENES[name], np.linspace(0, 0.4, 801)
    dense = motion(scene, fine, 2.0, 5.0)
    way = Coordinates(**{each: values[::20] for each, values in vars(dense).items()})
    found = losses(scene, way)
    radius, mass = scene.can.radius, scene.mass + scene.can.inertia / scene.can.radius**2
    slip = slip_rate(scene, dense.phi_dot, dense.u_dot)
    torque = scene.damping_law.torque(slip)
    force = torque / radius + scene.drag * dense.u_dot * np.abs(dense.u_dot)
    axis = dense.u_dot - scene.load.mass * scene.load.offset / mass * np.cos(dense.phi) * dense.phi_dot
    work = torque * slip + scene.drag * np.abs(dense.u_dot) ** 3

    def integral(values: np.ndarray) -> np.ndarray:
        return cumulative_simpson(values, x=fine, initial=0.0)

    def assert_are(values: np.ndarray, wanted: np.ndarray) -> None:
        # The rule's error, h^4/180 of a fourth derivative with rates of 25 rad/s, is 1e-10 of the integrand.
        allowed = KINK if scene.drag else 1e-9
        assert np.abs(np.cumsum(values) - wanted[20::20]).max() < allowed * np.abs(wanted).max()

    speed = integral(force / mass)
    assert_are(found.work, integral(work))
    assert_are(found.speed, speed)
    assert found.swing is not None
    # What the swing does not lose is lost by the motion at the speed of the axis without it.
    assert_are(found.swing, integral(work - force * axis))
    within = np.diff(integral(speed)[::20]) - speed[:-20:20] * np.diff(way.time)
    assert np.abs(found.way - within).max() < 1e-6 * np.abs(within).max()  # a small difference of two integrals


@pytest.mark.parametrize("name", SCENES)
def test_a_motion_by_other_means_does_not_drift(name: str) -> None:
    scene = SCENES[name]
    record = Record.of(motion(scene, np.linspace(0, 3, 301), 1.0, -4.0), scene)
    allowed = KINK if scene.drag else ROUNDING
    assert record.energy_drift < allowed
    # The path is some ten radians.
    assert record.implied_error < 20 * allowed
    assert not doubts(record, can_part=False)
    assert record.to_barrier == math.inf


@pytest.mark.parametrize("wrong", [
    replace(SCENES["mixed"], damping=Damping(1.5e-4, 1e-6, 1e-7)),
    replace(SCENES["mixed"], damping=Damping(1e-4, 1e-6, 2e-7)),
    replace(SCENES["mixed"], drag=0.06),
    replace(SCENES["mixed"], damping=0.0, drag=0.0),
])  # fmt: skip
def test_the_motion_of_another_damping_drifts(wrong: Scene) -> None:
    scene = SCENES["mixed"]
    record = Record.of(motion(wrong, np.linspace(0, 3, 301), 1.0, -4.0), scene)
    assert record.energy_drift > 1e-2
    assert doubts(record, can_part=False)


def test_an_axis_that_is_pushed_drifts() -> None:
    """By 1e-3 of g sin(alpha), with damping too weak to make up for it in the time: 5e-4 of the way."""
    scene = replace(pendulum(), damping=1e-9)
    right = motion(scene, np.linspace(0, 3, 301), 1.0)
    pushed = 1e-3 * 9.81 * math.sin(scene.incline) * right.time**2 / 2
    wrong = replace(right, u=right.u + pushed, u_dot=right.u_dot + 2 * pushed / np.maximum(right.time, 1e-9))
    assert Record.of(right, scene).axis_error < ROUNDING
    found = Record.of(wrong, scene)._axis_change
    assert found == pytest.approx(pushed[-1], rel=1e-2)


def test_strong_damping_makes_up_for_a_push() -> None:
    """An axis that is 0.1 m/s too fast for a second drifts by 0.1 m, although damping would have stopped that in 0.02 s
    and is overcome all the time. As an error of the momentum alone, that would be 2 m."""
    scene = sliding(damping=1e-2)
    right = motion(scene, np.linspace(0, 2, 401), 1.0)
    late = np.maximum(0.0, right.time - 1)
    wrong = replace(right, u_dot=right.u_dot + 0.1 * (late > 0), u=right.u + 0.1 * late)
    assert Record.of(wrong, scene)._axis_change == pytest.approx(0.1, rel=0.2)  # the load helps


def test_a_stiff_motion_is_followed_by_its_slow_part() -> None:
    """Its samples are a hundred times as far apart as can and load need to come together."""
    scene = sliding(damping=10.0)
    times = np.linspace(0, 0.5, 501)
    assert stiffest(scene) * times[1] > 50
    right = motion(scene, times, 1.0, method="Radau", fine=1e-10)
    found = losses(scene, right)
    assert found.swing is None
    record = Record.of(right, scene)
    assert record._balance is None  # of samples alone nothing is known
    every = Record(scene)
    every.add(right)
    # Trapezoids: h^2/12 of derivatives of 10 1/s is 1e-5; the first step, in which the slip rate falls, has 1e-6.
    assert every.energy_drift < 1e-5
    assert every.implied_error < 1e-4
    assert not doubts(every, can_part=False)
    slower = replace(right, phi_dot=right.phi_dot * 0.9)
    wrong = Record(scene)
    wrong.add(slower)
    assert doubts(wrong, can_part=False)


def test_samples_far_apart_tell_of_no_drift() -> None:
    scene = SCENES["linear"]
    few = motion(scene, np.linspace(0, 3, 4), 1.0)
    assert not followed(scene, few)
    record = Record.of(few, scene)
    assert (record.energy_drift, record.implied_error) == (0.0, 0.0)


@pytest.mark.parametrize("phi", [0.0, 1.0, 3.0])
def test_stiffness_is_the_fast_root(phi: float) -> None:
    """That of the linearized equations; the others are of the order of the swing's rate, 20 1/s."""
    scene, aside = sliding(0.2, can=METAL, damping=Damping(30.0, 0.2, 0.1)), 1e-6
    rates = np.array([2.0, 0.1])
    columns = []
    for change in np.eye(2) * aside:
        above, below = (accelerations(scene, phi, *(rates + sign * change)) for sign in (1, -1))
        columns.append([(up - down) / (2 * aside) for up, down in zip(above[::-1], below[::-1], strict=True)])
    root = -np.linalg.eigvals(np.array(columns).T).real.min()
    assert stiffness(scene, np.array(phi), rates[0], rates[1]) == pytest.approx(root, rel=1e-4)
