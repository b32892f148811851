"""Exact motions against the witness's quadrature, against a Taylor integrator, and against closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, exact, frozen, hoop, pendulum, sliding
from tests.scenes import METAL, SCENES
from tests.test_motion import Witness, mp

# The project's own demand. Rounding of the time, times phi_dot, after 100 periods: 40 s, eps/2 and 20 rad/s
# are 1e-13 rad. Measured: 1.4e-13.
ANGLE = 1e-11
# phi_dot is off by phi's error times the frequency, 20/s or less.
RATE = 20 * ANGLE
# Sums and products of a few terms each.
ROUNDING = 2e-15
BIG_KICK = Scene(Can.massless(), Load(0.2, 0.02, 1e-4), math.radians(10), "frozen")


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
@pytest.mark.parametrize(("share", "phi_dot0"), [(0.5, 0.0), (-0.9, 0.0), (0.6, 1e-6), (0.0, -3.0), (-0.3, 4.0)])
def test_hundred_swings(scene: Scene, share: float, phi_dot0: float) -> None:
    rest, (low, high) = scene.equilibrium(), scene.separatrix()
    phi0 = rest + share * (high - rest if share > 0 else rest - low)
    swing = Witness(scene).swing(phi0, phi_dot0)
    period = 2 * swing.time(mp.pi / 2, -mp.pi / 2)
    centre, width = swing.angle(0), swing.advance(0)
    time = np.array([0.3, 49.62, 99.9]) * float(period)
    motion = exact(scene, time, phi0, phi_dot0)
    for t, phi, phi_dot in zip(time, motion.phi, motion.phi_dot, strict=True):
        guess = mp.asin((mp.mpf(phi) - centre) / width)
        guess = mp.pi - guess if phi_dot < 0 else guess
        expected = swing.state(mp.mpf(t) % period, guess)
        assert abs(phi - expected[0]) < ANGLE
        assert abs(phi_dot - expected[1]) < RATE


ROLLS = {
    "down from the top": (frozen(), math.pi, 0.0),
    "down, pushed a little": (frozen(), math.pi, 1e-9),
    "up, pushed a little": (frozen(), math.pi, -1e-9),
    "up and down again": (frozen(), math.pi, -10.0),
    "up a long way": (BIG_KICK, 0.3, -100.0),
    "down a slope too steep to rest on": (frozen(0.6), 0.0, 0.0),
    "up such a slope": (frozen(0.6, can=METAL), 0.0, -3.0),
    "from another turn": (hoop(0.3), 11 * math.pi + 0.1, -30.0),
    "balanced": (frozen(fill=1.0), 1.0, -5.0),
}


@pytest.mark.parametrize(("scene", "phi0", "phi_dot0"), ROLLS.values(), ids=ROLLS.keys())
def test_roll(scene: Scene, phi0: float, phi_dot0: float) -> None:
    time = np.array([0.05, 0.3, 1.2])
    motion = exact(scene, time, phi0, phi_dot0)
    witness, turn = Witness(scene), mp.mpf(phi0)
    if phi_dot0:  # the last root of E - V before phi0, searched for in steps of a tenth of a radian and finer
        kinetic = witness.run(phi0, phi_dot0).kinetic
        outer, step = mp.mpf(phi0), min(mp.mpf("0.1"), mp.mpf(phi_dot0) ** 2 / 100)
        while kinetic(outer - step) > 0:
            outer, step = outer - step, min(2 * step, mp.mpf("0.1"))
        turn = witness.turn(phi0, phi_dot0, outer - step, outer)
    roll = witness.roll(phi0, phi_dot0, turn)
    for t, phi, phi_dot in zip(time, motion.phi, motion.phi_dot, strict=True):
        guess = mp.sqrt(abs(mp.mpf(phi) - turn)) * (1 if phi_dot > 0 else -1)
        expected = roll.state(mp.mpf(t), guess)
        assert abs(phi - expected[0]) < ANGLE
        assert abs(phi_dot - expected[1]) < RATE
    behind = exact(replace(scene, incline=-scene.incline), time, -phi0, -phi_dot0)
    assert (behind.phi == -motion.phi).all()
    assert (behind.phi_dot == -motion.phi_dot).all()


@pytest.mark.parametrize(
    ("scene", "phi0", "phi_dot0"),
    [
        (sliding(), 0.3, 60.0),
        (sliding(can=METAL), -2.0, -45.0),
        (pendulum(-0.3), 20.0, 70.0),
        (frozen(0.0), 0.0, 60.0),
        (frozen(), math.pi, 200.0),
        (sliding(gravity=0.0), 0.3, 2.0),
        (frozen(gravity=0.0), 0.3, -2.0),
    ],
)
def test_loop_the_loop(scene: Scene, phi0: float, phi_dot0: float) -> None:
    time = np.array([0.01, 0.2])
    motion, spin = exact(scene, time, phi0, phi_dot0), Witness(scene).run(phi0, phi_dot0)
    for t, phi, phi_dot in zip(time, motion.phi, motion.phi_dot, strict=True):
        expected = spin.state(mp.mpf(t), abs(mp.mpf(phi) - phi0))
        assert abs(phi - expected[0]) < ANGLE
        assert abs(phi_dot - expected[1]) < RATE


@pytest.mark.parametrize(
    ("scene", "phi0", "phi_dot0"),
    [
        (sliding(can=METAL), 1.5, 0.0),
        (pendulum(), 0.3, 60.0),
        (frozen(can=METAL), 0.0, 0.0),
        (frozen(), math.pi, 0.0),
    ],
    ids=["slides", "loops", "rocks", "rolls down"],
)
def test_taylor_series(scene: Scene, phi0: float, phi_dot0: float) -> None:
    """Both coordinates by (46) and (47) corrected, or (52): no reduction, no quadrature, u and its start included."""
    can, load = scene.can, scene.load
    a, can_mass, can_inertia, m, b, inertia, g, alpha = (
        mp.mpf(each)
        for each in (
            can.radius,
            can.mass,
            can.inertia,
            load.mass,
            load.offset,
            load.inertia,
            scene.gravity,
            scene.incline,
        )  # fmt: skip
    )
    axial, rolling = inertia + m * b**2, can_mass + can_inertia / a**2

    def derivative(_: object, state: list) -> list:
        phi, u_dot, phi_dot = state[1:]
        sin, cos = mp.sin(phi), mp.cos(phi)
        along = (m + can_mass) * g * mp.sin(alpha) - m * b * sin * phi_dot**2
        around = -m * g * b * mp.sin(alpha + phi)
        if scene.attachment == "frozen":
            resists = axial + (m + rolling) * a**2 - 2 * m * a * b * cos
            phi_ddot = (around + a * along + 2 * m * a * b * sin * phi_dot**2 - m * a * b * sin * phi_dot**2) / resists
            return [u_dot, phi_dot, a * phi_ddot, phi_ddot]
        whole = m + rolling
        phi_ddot = (whole * around + m * b * cos * along) / (whole * axial - (m * b * cos) ** 2)
        return [u_dot, phi_dot, (along + m * b * cos * phi_ddot) / whole, phi_ddot]

    phi0_, rate = mp.mpf(phi0), mp.mpf(phi_dot0)
    start = [b * mp.sin(phi0_), phi0_, b * mp.cos(phi0_) * rate, rate]
    if scene.attachment == "frozen":
        start = [a * phi0_, phi0_, a * rate, rate]
    time = 0.05
    with mp.workdps(16):
        expected = mp.odefun(derivative, 0, start)(time)
    motion = exact(scene, [time], phi0, phi_dot0)
    found = (motion.u[0] / can.radius, motion.phi[0], motion.u_dot[0] / can.radius, motion.phi_dot[0])
    for value, wanted, scale, tolerance in zip(found, expected, (a, 1, a, 1), (ANGLE, ANGLE, RATE, RATE), strict=True):
        assert abs(value - wanted / scale) < tolerance
