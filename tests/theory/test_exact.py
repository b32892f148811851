"""Exact motions against the witness's quadrature, against a Taylor integrator, and against closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import Can, Load, Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.theory.equations import kinetic_energy
from tests.support.scenes import METAL, SCENES, scenes
from tests.theory.test_motion import Witness, mp

# The period is right to an eps or two, and after 100 periods that is 40 s late by 1e-14 s, at some 20 rad/s and
# with a well that is ten times as sensitive at 0.9 of the separatrix. Measured: 4e-13 rad, where 1e-11 is wanted.
ANGLE = 2e-12
# phi_dot is off by phi's error times the frequency, 20/s or less.
RATE = 20 * ANGLE
# Sums and products of a few terms each.
ROUNDING = 2e-15


@pytest.mark.slow
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
        guess += 2 * mp.pi * mp.ceil((swing.begin - guess) / (2 * mp.pi))
        expected = swing.state(mp.mpf(t) % period, guess)
        assert abs(phi - expected[0]) < ANGLE
        assert abs(phi_dot - expected[1]) < RATE


ROLLS = {
    "down from the top": (frozen(), math.pi, 0.0),
    "down, pushed a little": (frozen(), math.pi, 1e-9),
    "up, pushed a little": (frozen(), math.pi, -1e-9),
    "up and down again": (frozen(), math.pi, -10.0),
    "up a long way": (Scene(Can(), Load(0.2, 0.02, 1e-4), 0.2, "frozen"), 0.3, -100.0),
    "down a slope too steep to rest on": (frozen(0.6), 0.0, 0.0),
    "up such a slope": (frozen(0.6, can=METAL), 0.0, -3.0),
    "from another turn": (hoop(0.3), 11 * math.pi + 0.1, -30.0),
    "balanced": (frozen(fill=1.0), 1.0, -5.0),
}


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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
    a, can_mass, can_inertia = (mp.mpf(each) for each in (can.radius, can.mass, can.inertia))
    m, b, inertia = (mp.mpf(each) for each in (load.mass, load.offset, load.inertia))
    g, alpha = mp.mpf(scene.gravity), mp.mpf(scene.incline)
    axial, rolling = inertia + m * b**2, can_mass + can_inertia / a**2

    def derivative(_: object, state: list) -> list:
        phi, u_dot, phi_dot = state[1:]
        sin, cos = mp.sin(phi), mp.cos(phi)
        along = (m + can_mass) * g * mp.sin(alpha) - m * b * sin * phi_dot**2
        around = -m * g * b * mp.sin(alpha + phi)
        if scene.attachment == "frozen":
            resists = axial + (m + rolling) * a**2 - 2 * m * a * b * cos
            phi_ddot = (around + a * along) / resists
            return [u_dot, phi_dot, a * phi_ddot, phi_ddot]
        whole = m + rolling
        phi_ddot = (whole * around + m * b * cos * along) / (whole * axial - (m * b * cos) ** 2)
        return [u_dot, phi_dot, (along + m * b * cos * phi_ddot) / whole, phi_ddot]

    phi0_, rate = mp.mpf(phi0), mp.mpf(phi_dot0)
    start = [b * mp.sin(phi0_), phi0_, b * mp.cos(phi0_) * rate, rate]
    if scene.attachment == "frozen":
        start = [a * phi0_, phi0_, a * rate, rate]
    time = 0.03
    with mp.workdps(15):
        expected = mp.odefun(derivative, 0, start)(time)
    motion = exact(scene, [time], phi0, phi_dot0)
    found = (motion.u[0] / can.radius, motion.phi[0], motion.u_dot[0] / can.radius, motion.phi_dot[0])
    for value, wanted, scale, tolerance in zip(found, expected, (a, 1, a, 1), (ANGLE, ANGLE, RATE, RATE), strict=True):
        assert abs(value - wanted / scale) < tolerance


@settings(max_examples=60, deadline=None, derandomize=True)
@given(scenes(), st.floats(-10, 10), st.floats(-8, 8))
def test_energy_and_momentum(scene: Scene, phi0: float, swing: float) -> None:
    can, load = scene.can, scene.load
    clock = math.sqrt(can.radius / scene.gravity)
    motion = exact(scene, np.linspace(0, 10 * clock, 50), phi0, swing / clock)
    weight = scene.gravity * (scene.mass * np.abs(motion.u).max() + load.mass * can.radius)
    # phi has angles of up to 100 rad behind it, and J depends on it.
    assert np.ptp(motion.energy) < 100 * ROUNDING * (kinetic_energy(motion.scene, motion).max() + weight)
    if scene.attachment == "frozen":
        assert (motion.u == can.radius * motion.phi).all()
        assert (motion.u_dot == can.radius * motion.phi_dot).all()
    else:  # (46), integrated once
        whole = scene.mass + can.inertia / can.radius**2
        impulse = whole * motion.u_dot - load.mass * load.offset * np.cos(motion.phi) * motion.phi_dot
        impulse -= scene.mass * scene.gravity * math.sin(scene.incline) * motion.time
        most = whole * np.abs(motion.u_dot).max() + load.mass * load.offset * np.abs(motion.phi_dot).max()
        assert np.ptp(impulse) <= 10 * ROUNDING * most
    assert (motion.roll == motion.u / can.radius).all()
    assert not motion.lift.any()


def test_centre_of_mass_of_a_sliding_load_in_a_massless_can() -> None:
    """Eqs. (1) and (12): s = g sin(alpha) t^2 / 2, whatever phi does."""
    time = np.linspace(0, 3, 20)
    for start in ((0.7, 0.0), (0.0, 60.0)):
        motion = exact(sliding(0.2), time, *start)
        s = motion.u - sliding().load.offset * np.sin(motion.phi)
        assert s == pytest.approx(9.81 * math.sin(0.2) * time**2 / 2, rel=ROUNDING, abs=1e-17)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
def test_rest(scene: Scene) -> None:
    time, rest = np.linspace(0, 100, 5), scene.equilibrium()
    motion = exact(scene, time, rest)
    assert motion.phi == pytest.approx(np.full(5, rest), abs=ROUNDING)
    # u_ddot of footnote 4 if the load slides, none if it is frozen
    steady = scene.acceleration() if scene.attachment == "sliding" else 0.0
    start = scene.start(rest, 0.0)[0]
    assert motion.u == pytest.approx(start + steady * time**2 / 2, rel=ROUNDING, abs=ROUNDING)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [sliding(0.0), frozen(), frozen(-0.2, can=METAL), pendulum()])
@pytest.mark.parametrize("turn", [0.0, 1e-120, 1e-17, -1e-15, 1e-10])
@pytest.mark.parametrize("phi_dot0", [0.0, 1e-160, 1e-129, -1e-14, 1e-9])
def test_tiny_swing_is_harmonic(scene: Scene, turn: float, phi_dot0: float) -> None:
    rest, omega, time = scene.equilibrium(), scene.frequency(), np.linspace(0, 1, 9)
    turn = rest + turn - rest
    motion = exact(scene, time, rest + turn, phi_dot0)
    sway = turn * np.cos(omega * time) + phi_dot0 / omega * np.sin(omega * time)
    assert motion.phi - rest == pytest.approx(sway, abs=ROUNDING)
    sway_dot = phi_dot0 * np.cos(omega * time) - omega * turn * np.sin(omega * time)
    assert motion.phi_dot == pytest.approx(sway_dot, abs=20 * ROUNDING)


@pytest.mark.parametrize("scene", [sliding(0.0), frozen(0.0), pendulum(0.0), hoop(), sliding()])
@pytest.mark.parametrize("turns", [-1001, -3, 1, 7, 101])
def test_on_the_top(scene: Scene, turns: int) -> None:
    """For all that a double can tell, an odd multiple of pi is the unstable equilibrium."""
    motion = exact(scene, np.linspace(0, 9, 4), turns * math.pi)
    assert (motion.phi == turns * math.pi).all()


@pytest.mark.parametrize("scene", [sliding(0.0), sliding(can=METAL), frozen(0.0), frozen(), hoop(0.2)])
def test_within_a_few_ulps_of_the_separatrix(scene: Scene) -> None:
    """If nobody can tell which side the motion falls to, there is an error; or else it is one of this scene's."""
    for end in scene.separatrix():
        for ulps in (-4, -2, -1, 0, 1, 2, 4):
            for phi_dot0 in (0.0, 1e-300, math.copysign(1e-12, end)):
                try:
                    motion = exact(scene, np.linspace(0, 2, 20), end + ulps * math.ulp(end), phi_dot0)
                except NoLibrationError:
                    continue
                assert np.ptp(motion.energy) < 100 * ROUNDING * (kinetic_energy(motion.scene, motion).max() + 1)


@pytest.mark.parametrize(("scene", "start"), [(sliding(), (1.0, 2.0)), (frozen(), (0.4, 1.0)), (frozen(), (2.6, 9.0))])
def test_other_turns_are_alike(scene: Scene, start: tuple[float, float]) -> None:
    time = np.linspace(0, 1, 11)
    for turns in (-2, 5):
        there = exact(scene, time, start[0] + 2 * math.pi * turns, start[1])
        here = exact(scene, time, *start)
        assert there.phi - 2 * math.pi * turns == pytest.approx(here.phi, abs=ANGLE)


@pytest.mark.parametrize("fill", [1.0, None])
def test_balanced_load(fill: float | None) -> None:
    load = Load.segment(fill=1.0) if fill else Load(0.3, 0.0, 1e-4)
    time, g = np.linspace(0, 4, 9), 9.81
    slides = exact(Scene(METAL, load, 0.2, "sliding"), time, 1.0, -2.0)
    assert slides.phi == pytest.approx(1 - 2 * time, rel=ROUNDING, abs=ROUNDING)
    for can in (Can(), METAL):
        scene = Scene(can, load, 0.2, "frozen")
        inertia = load.inertia + can.inertia + scene.mass * can.radius**2
        angular = scene.mass * g * can.radius * math.sin(0.2) / inertia
        rolls = exact(scene, time, 1.0, -2.0)
        assert rolls.phi == pytest.approx(1 - 2 * time + angular * time**2 / 2, rel=5 * ROUNDING, abs=10 * ROUNDING)
        assert scene.acceleration() == pytest.approx(can.radius * angular, rel=ROUNDING)
        if fill and not can.mass:
            assert scene.acceleration() == pytest.approx(2 / 3 * g * math.sin(0.2), rel=ROUNDING)  # A.3


@pytest.mark.parametrize("time", [[-1e-9, 1.0], [math.nan], [0.0, math.inf], [[0.0, 1.0]]])
def test_times_are_finite_and_after_the_start(time: list) -> None:
    with pytest.raises(ParameterError, match=r"time\[\d\] must be (a finite number|0 or greater) \[s\], got "):
        exact(sliding(), time, 0.1)


def test_times_in_any_order() -> None:
    time = np.array([0.3, 0.0, 2.0, 0.3])
    for scene, phi0 in ((sliding(), 1.0), (frozen(), math.pi)):
        motion = exact(scene, time, phi0)
        assert motion.phi[0] == motion.phi[3]
        assert motion.phi[1] == pytest.approx(phi0, rel=ROUNDING)
        assert float(exact(scene, 2.0, phi0).phi[0]) == pytest.approx(motion.phi[2], rel=ROUNDING)
