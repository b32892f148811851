"""Exact motions against quadrature in 40 digits and Taylor series in extended precision, which know no arrangement."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import MPContext

from mjbeer import Can, Load, Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError
from mjbeer.theory.equations import kinetic_energy
from mjbeer.theory.motion import UNCERTAIN, solve
from tests.support import gauss, taylor
from tests.support.scenes import METAL, SCENES, scenes

mp = MPContext()
# E - V is a plain difference here and loses up to half the digits near a turning point.
mp.dps = 40
mpf = Any  # numbers of that context

# A quadrature of a smooth function sums roundings of both signs; measured: 4e-15 up to 0.99 of the separatrix.
PERIOD = 2e-14
# A hundred periods of some seconds are late by 1e-14 s, at 20 rad/s and with a well ten times as sensitive at 0.9 of
# the separatrix. Measured: 4e-13 rad.
ANGLE = 2e-12
# phi_dot is off by phi's error times the frequency, 20/s or less.
RATE = 20 * ANGLE
# Sums and products of a few terms each.
ROUNDING = 2e-15
# The sum of the times of a hundred turns is right to a few eps, and an angle is as its square. Measured: 1e-15.
RELATIVE = 1e-14
# Random motions against series: a few eps, more where J has a narrow minimum, which magnifies the rounding of phi.
RANDOM, USUAL = 2e-12, 1e-14
# Beside the steepest incline, what rounding changes is divided by the distance from it. Measured: 5e-12 for 90 %.
BESIDE_STEEPEST = 5e-11
LONG_DOUBLE = pytest.mark.skipif(not taylor.ENOUGH, reason="long double has no more digits than double")


@dataclass
class Motion:
    """A motion as the witness sees it: phi is `angle` of a phase from `begin` on, whose slope is `advance`."""

    inertia: Callable[[mpf], mpf]
    kinetic: Callable[[mpf], mpf]
    angle: Callable[[mpf], mpf]
    advance: Callable[[mpf], mpf]
    begin: mpf

    def rate(self, phase: mpf) -> mpf:
        phi = self.angle(phase)
        return abs(self.advance(phase)) * mp.sqrt(self.inertia(phi) / (2 * self.kinetic(phi)))

    def time(self, phase: mpf, begin: mpf) -> mpf:
        """By Gauss-Legendre, on pieces of half a radian of the phase and of phi at most."""
        span = max(abs(phase - begin), abs(self.angle(phase) - self.angle(begin)), 1)
        return mp.quad(self.rate, mp.linspace(begin, phase, int(2 * span) + 1), method="gauss-legendre")

    def state(self, time: mpf, guess: mpf) -> tuple[mpf, mpf]:
        """phi and phi_dot at a time. Newton's method on an increasing function: no matter where it starts."""
        phase, passed = guess, self.time(guess, self.begin)
        for _ in range(10):
            step = (time - passed) / self.rate(phase)
            passed += self.time(phase + step, phase)
            phase += step
            if abs(step) < mp.mpf(10) ** -18:  # and the error now its square
                return self.angle(phase), self.advance(phase) / self.rate(phase)
        raise ArithmeticError("the witness does not converge")


class Witness:
    """J and V as the paper's Lagrangians give them, (16), (46), (47) and (52) corrected and with the can's mass."""

    def __init__(self, scene: Scene) -> None:
        can, load = scene.can, scene.load
        a, can_mass, can_inertia = (mp.mpf(each) for each in (can.radius, can.mass, can.inertia))
        m, b, inertia = (mp.mpf(each) for each in (load.mass, load.offset, load.inertia))
        g, alpha = mp.mpf(scene.gravity), mp.mpf(scene.incline)
        drive = (m + can_mass) * g * mp.sin(alpha)
        if scene.attachment == "sliding":
            whole = m + can_mass + can_inertia / a**2
            self.inertia = lambda phi: inertia + m * b**2 - (m * b * mp.cos(phi)) ** 2 / whole
            self.potential = lambda phi: -m * b * (g * mp.cos(alpha + phi) + drive / whole * mp.sin(phi))
            self.rest = mp.atan((drive / whole - g * mp.sin(alpha)) / (g * mp.cos(alpha))) if g else mp.mpf(0)
            self.top = self.rest + mp.pi
        else:
            axial = inertia + m * b**2 + can_inertia + can_mass * a**2 + m * a**2
            self.inertia = lambda phi: axial - 2 * m * a * b * mp.cos(phi)
            self.potential = lambda phi: -drive * a * phi - m * g * b * mp.cos(alpha + phi)
            held = drive * a / (m * g * b) if m * g * b else mp.mpf(2)
            if abs(held) < 1:
                self.rest = mp.asin(held) - alpha
                self.top = (mp.pi if drive >= 0 else -mp.pi) - mp.asin(held) - alpha

    def _motion(self, phi0: float | mpf, phi_dot0: float, *shape: Any) -> Motion:
        energy = self.inertia(phi0) * mp.mpf(phi_dot0) ** 2 / 2 + self.potential(phi0)
        return Motion(self.inertia, lambda phi: energy - self.potential(phi), *shape)

    def turn(self, phi0: float | mpf, phi_dot0: float, outer: float | mpf, inner: float | mpf) -> mpf:
        kinetic = self._motion(mp.mpf(phi0), phi_dot0, *[None] * 3).kinetic
        return mp.findroot(kinetic, (outer, inner), solver="bisect", tol=1e-60, maxsteps=150)

    def swing(self, phi0: float | mpf, phi_dot0: float = 0.0) -> Motion:
        """phi = c + d sin(phase)."""
        phi0, ends = mp.mpf(phi0), sorted([self.top, self.top - 2 * mp.pi * mp.sign(self.top - self.rest)])
        low = high = phi0
        if phi_dot0 or phi0 < self.rest:
            high = self.turn(phi0, phi_dot0, ends[1], self.rest)
        if phi_dot0 or phi0 > self.rest:
            low = self.turn(phi0, phi_dot0, ends[0], self.rest)
        centre, width = (low + high) / 2, (high - low) / 2
        begin = mp.asin((phi0 - centre) / width) if phi_dot0 else mp.sign(phi0 - self.rest) * mp.pi / 2
        begin = mp.pi - begin if phi_dot0 < 0 else begin
        swing = (lambda phase: centre + width * mp.sin(phase)), (lambda phase: width * mp.cos(phase))
        return self._motion(phi0, phi_dot0, *swing, begin)

    def roll(self, phi0: float, phi_dot0: float, turn: float | mpf) -> Motion:
        """phi = turn + phase^2."""
        begin = mp.sqrt(mp.mpf(phi0) - turn) * (mp.sign(phi_dot0) or 1)
        return self._motion(mp.mpf(phi0), phi_dot0, lambda phase: turn + phase**2, lambda phase: 2 * phase, begin)

    def run(self, phi0: float, phi_dot0: float) -> Motion:
        """phi = phi0 +- phase."""
        sign = mp.sign(phi_dot0)
        return self._motion(mp.mpf(phi0), phi_dot0, lambda phase: phi0 + sign * phase, lambda phase: sign, mp.mpf(0))

    def period(self, amplitude: float) -> mpf:
        swing = self.swing(self.rest + mp.mpf(amplitude))
        return 2 * swing.time(mp.pi / 2, -mp.pi / 2)


@pytest.mark.slow
@settings(max_examples=20, deadline=None, derandomize=True)
@given(scenes(), st.floats(1e-3, 0.99), st.booleans())
def test_period_of_any_swing(scene: Scene, share: float, uphill: bool) -> None:
    try:
        rest, ends = scene.equilibrium(), scene.separatrix()
    except NoEquilibriumError:
        assume(False)
    amplitude = share * (ends[0 if uphill else 1] - rest)
    assume(abs(amplitude) > 1e-3)
    assert abs(scene.period(amplitude) / Witness(scene).period(amplitude) - 1) < PERIOD


@pytest.mark.parametrize(
    ("scene", "amplitude"),
    [(sliding(), 1.0), (frozen(), 1.0)]
    + [pytest.param(scene, each, marks=pytest.mark.slow) for scene in SCENES.values() for each in (1e-3, -1.3, 2.0, 3)],
)
def test_period_of_the_paper_s_scenes(scene: Scene, amplitude: float) -> None:
    low, high = (end - scene.equilibrium() for end in scene.separatrix())
    if low < amplitude < high:
        assert abs(scene.period(amplitude) / Witness(scene).period(amplitude) - 1) < PERIOD
    else:
        message = "amplitude {:.6g} rad is not inside the separatrix: .* between {:.6g} and {:.6g} rad"
        with pytest.raises(NoLibrationError, match=message.format(amplitude, low, high)):
            scene.period(amplitude)
        with pytest.raises(NoLibrationError, match=message.format(-amplitude, -high, -low)):
            replace(scene, incline=-scene.incline).period(-amplitude)


@pytest.mark.parametrize("gap", [1e-3, *(pytest.param(gap, marks=pytest.mark.slow) for gap in (1e-6, 1e-10))])
@pytest.mark.parametrize("degrees", [0, 10])
def test_period_beside_the_separatrix(degrees: float, gap: float) -> None:
    scene, amplitude = sliding(math.radians(degrees)), math.pi - gap
    swing = Witness(scene).swing(mp.mpf(amplitude))
    pieces = [mp.pi / 2 - mp.mpf(10) ** -k for k in range(int(1 - math.log10(gap) / 2))]
    quarter = mp.quad(swing.rate, [0, *pieces, mp.pi / 2], method="gauss-legendre")
    assert abs(scene.period(amplitude) - 4 * quarter) < PERIOD


@pytest.mark.parametrize("scene", [sliding(), frozen(), frozen(-0.2, can=METAL), pendulum()])
def test_small_swings(scene: Scene) -> None:
    """T grows by a share of the order of the amplitude squared: under an eps at 1e-9."""
    rest, omega, time = scene.equilibrium(), scene.frequency(), np.linspace(0, 1, 9)
    for amplitude in (0.0, 1e-9, -1e-9, 1e-13, 1e-200):
        assert scene.period(amplitude) == pytest.approx(2 * math.pi / omega, rel=PERIOD)
    for turn in ((rest + each) - rest for each in (0.0, 1e-17, -1e-15, 1e-10)):
        for phi_dot0 in (0.0, 1e-160, 1e-129, -1e-14, 1e-11, 1e-9):
            motion = exact(scene, time, rest + turn, phi_dot0)
            sway = turn * np.cos(omega * time) + phi_dot0 / omega * np.sin(omega * time)
            assert motion.phi - rest == pytest.approx(sway, abs=ROUNDING)
            sway_dot = phi_dot0 * np.cos(omega * time) - omega * turn * np.sin(omega * time)
            assert motion.phi_dot == pytest.approx(sway_dot, abs=20 * ROUNDING)


@pytest.mark.parametrize(
    ("scene", "share", "phi_dot0"),
    [(frozen(), 0.5, 0.0), (sliding(can=METAL), -0.3, 4.0)]
    + [
        pytest.param(scene, *start, marks=pytest.mark.slow)
        for scene in SCENES.values()
        for start in ((0.5, 0.0), (-0.9, 0.0), (0.6, 1e-6), (0.0, -3.0))
    ],
)
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
    "up, pushed a little": (frozen(), math.pi, -1e-9),
    "up and down again": (frozen(), math.pi, -10.0),
    "up a long way": (Scene(Can(), Load(0.2, 0.02, 1e-4), 0.2, "frozen"), 0.3, -100.0),
    "down a slope too steep to rest on": (frozen(0.6), 0.0, 0.0),
    "up such a slope": (frozen(0.6, can=METAL), 0.0, -3.0),
    "from another turn": (hoop(0.3), 11 * math.pi + 0.1, -30.0),
    "balanced": (frozen(fill=1.0), 1.0, -5.0),
}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::mjbeer.AngleWarning")
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


TURNS = {
    "rolls down": (frozen(), 0.3, 60.0),
    "up": (frozen(1e-3), 0.3, -200.0),
    "steep": (frozen(0.6), 0.0, 5.0),
    "hoop": (hoop(0.01), 2.0, -1000.0),
    "level": (frozen(0.0), 0.3, -60.0),
    "slides": (sliding(0.3, can=METAL), 0.0, 60.0),
    "pendulum": (pendulum(-0.3), 2.0, 70.0),
    "past a barrier by a little": (frozen(0.0), math.pi - 1e-6, 1e-4),
    "without gravity": (sliding(gravity=0.0), 0.3, 2.0),
}


@pytest.mark.parametrize(
    ("scene", "phi0", "phi_dot0"),
    [
        pytest.param(*each, id=name, marks=[pytest.mark.slow] if k > 0 else [])
        for k, (name, each) in enumerate(TURNS.items())
    ],
)
def test_a_hundred_turns(scene: Scene, phi0: float, phi_dot0: float) -> None:
    """Each of them is one turn lower, so that one integral over a turn has the time of all."""
    sign = math.copysign(1, phi_dot0)
    run = Witness(scene).run(phi0, phi_dot0)
    fall = run.kinetic(phi0 + sign * 2 * mp.pi) - run.kinetic(phi0)

    def rate(angle: mpf) -> mpf:
        return mp.sqrt(run.inertia(angle) / 2) * sum(1 / mp.sqrt(run.kinetic(angle) + k * fall) for k in range(100))

    crest = (mp.pi - sign * phi0) % (2 * mp.pi)
    pieces = {k * mp.pi / 3 for k in range(7)} | {
        crest + turn + side * mp.mpf(2) ** -k for turn in (0, 2 * mp.pi) for side in (-1, 1) for k in range(0, 30, 2)
    }
    with mp.workdps(25):
        pieces = sorted(phi0 + sign * each for each in pieces if 0 <= each <= 2 * mp.pi)
        time = float(gauss.integral(mp, rate, pieces))
    motion = exact(scene, [time], phi0, phi_dot0)
    assert motion.phi[0] - phi0 == pytest.approx(sign * 200 * math.pi, rel=RELATIVE + math.ulp(time) * 100)
    end = float(mp.sqrt(2 * run.kinetic(phi0 + sign * 200 * mp.pi) / run.inertia(mp.mpf(phi0))))
    assert abs(motion.phi_dot[0]) == pytest.approx(end, rel=1e-11)


@pytest.mark.parametrize("later", [0.3, 0.99, 1.7, 5.0])
@pytest.mark.parametrize("phi_dot0", [-20.0, -300.0])
@pytest.mark.parametrize("scene", [frozen(), frozen(0.6), frozen(0.43), frozen(0.1, fill=1.0), hoop(0.01)])
@pytest.mark.filterwarnings("ignore::mjbeer.AngleWarning")
def test_backwards_in_time(scene: Scene, phi_dot0: float, later: float) -> None:
    """Turned round, a motion goes back to its start, whichever paths it takes uphill and downhill."""
    form = scene.oscillator
    time = [later * form.inertia(0.3) * -phi_dot0 / form.slope]  # in units of about the time that it goes uphill
    there = exact(scene, time, 0.3, phi_dot0)
    if abs(there.phi[0]) > 1e4:  # no start is so far out
        return
    back = exact(scene, time, there.phi[0], -there.phi_dot[0])
    # Where it is turned round phi is rounded by an ulp, which is an energy, and so an angle for each radian turned.
    farthest = 300 + (1 + later) ** 2 * abs(phi_dot0) * time[0]
    rounding = farthest * math.ulp(farthest)
    assert back.phi[0] == pytest.approx(0.3, abs=rounding)
    assert back.phi_dot[0] == pytest.approx(-phi_dot0, rel=rounding)


@pytest.mark.parametrize("incline", [0.0, 0.1, -0.1])
def test_the_domain_has_an_edge(incline: float) -> None:
    """Ten thousand turns and a million periods are followed, and no more."""
    scene, fast = frozen(incline), math.copysign(100.0, incline)
    assert abs(exact(scene, 20.0, 0.0, fast).phi[0]) > 1e3
    with pytest.raises(ParameterError, match=r"an exact motion has at most 10000 turns, which end at .* got 1e\+06 s"):
        exact(scene, 1e6, 0.0, fast)
    latest = 1e6 * scene.period(0.3)
    assert abs(exact(scene, latest * (1 - 1e-9), scene.equilibrium() + 0.3).phi[0]) < 1
    with pytest.raises(ParameterError, match=r"an exact motion has at most 1000000 periods, which end at .* time must"):
        exact(scene, latest * (1 + 1e-9), scene.equilibrium() + 0.3)


def random_scene(pick: np.random.Generator) -> Scene:
    """Cans of 0.1 mm to 100 m, masses up to 1e6 times as large or small as the load, inclines up to 89.9 degrees."""

    def decades(low: float, high: float) -> float:
        return 10 ** pick.uniform(low, high)

    radius, load_mass = decades(-4, 1.5), decades(-2, 2)
    mass = pick.choice([0.0, load_mass * decades(-6, 6)])
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.choice([0.0, 0.5, 1.0, pick.uniform()]))
    offset = radius * pick.choice([0.0, 1.0, decades(-9, 0), pick.uniform(), pick.uniform()])
    load = Load(load_mass, offset, load_mass * radius**2 * pick.choice([0.0, decades(-6, 0), pick.uniform()]))
    degrees = pick.choice([0.0, 0.0, 1e-8, decades(-20, 0), pick.uniform(-30, 30), pick.uniform(-89.9, 89.9)])
    gravity = pick.choice([9.81, 9.81, 0.0, decades(-3, 3)])
    return Scene(can, load, math.radians(degrees), str(pick.choice(["sliding", "frozen"])), float(gravity))


def case(pick: np.random.Generator, longest: float) -> taylor.Case:
    """A start at rest, slow or fast, and up to `longest` times the time in which something happens."""
    while True:
        try:
            made = random_scene(pick)
            break
        except ParameterError:  # no inertia, or too small a share of it
            continue
    form = made.oscillator
    torque = max(form.depth, abs(form.slope))
    pace = math.sqrt(torque / (form.base + form.chord + form.swing)) if torque > 0 else 1.0
    angles = [0.0, 1.0, 10 ** pick.uniform(-9, 1), *(pick.uniform(-most, most) for most in (3, 100, 1e4))]
    speeds = [0.0, 0.0, pick.uniform(-3, 3), 10 ** pick.uniform(-3, 3), -(10 ** pick.uniform(-3, 3))]
    phi_dot0 = float(pace * pick.choice(speeds))
    duration = longest * 10 ** pick.uniform(-4, 0) / (abs(phi_dot0) + pace)
    return taylor.Case(made, float(pick.choice(angles)), phi_dot0, np.sort(duration * pick.uniform(0, 1, 4)))


def errors(cases: list[taylor.Case], steps: int = 4000) -> np.ndarray:
    """The largest error, relative beyond 1 rad, of each motion that is not refused and that the witness follows."""
    turns, _ = taylor.integrate(cases, steps)
    found = []
    for each, turned in zip(cases, turns, strict=True):
        try:
            phi, _ = solve(each.scene.oscillator, each.time, each.phi0, each.phi_dot0)
        except (NoLibrationError, ParameterError):  # beside a separatrix, or beyond the turns that are followed
            continue
        off = np.abs(phi - each.phi0 - turned.astype(float))
        # phi is rounded beside its start, as a sum of the two.
        scale = np.maximum(max(1, abs(each.phi0)), np.maximum.accumulate(np.abs(turned.astype(float))))
        found.append(np.max(off / scale))
    return np.array([each for each in found if not np.isnan(each)])


@LONG_DOUBLE
@pytest.mark.parametrize(("count", "longest"), [(80, 5.0), pytest.param(1500, 500.0, marks=pytest.mark.slow)])
def test_any_motion(count: int, longest: float) -> None:
    pick = np.random.default_rng(count)
    found = errors([case(pick, longest) for _ in range(count)])
    assert len(found) > 0.9 * count
    assert found.max() < RANDOM
    assert np.quantile(found, 0.95) < USUAL


@LONG_DOUBLE
@pytest.mark.parametrize("count", [20, pytest.param(230, marks=pytest.mark.slow)])
def test_beside_the_steepest_incline(count: int) -> None:
    """There a well of no depth, or a slope of no torque, decides for how long the load hesitates."""
    pick, steepest, cases = np.random.default_rng(230), frozen().largest_incline(), []
    while len(cases) < count:
        beside = 10 ** pick.uniform(-11, -1)
        made, width = frozen(steepest * (1 + pick.choice([-1, 1]) * beside)), math.sqrt(beside)
        slowness = 0.1 / math.sqrt(width)
        phi0 = math.pi / 2 - steepest + width * pick.choice([0.0, pick.uniform(-3, 3), pick.uniform(-100, 100)])
        phi_dot0 = pick.choice([0.0, width / slowness * pick.uniform(-3, 3), pick.uniform(-20, 20)])
        time = slowness * np.sort(pick.uniform(0, 2, 3))
        cases.append(taylor.Case(made, float(phi0), float(phi_dot0), time))
    found = errors(cases, steps=1000)
    assert len(found) > 0.5 * len(cases)  # others turn so often that the witness takes more steps
    assert found.max() < UNCERTAIN
    assert np.quantile(found, 0.9) < BESIDE_STEEPEST


@settings(max_examples=60, deadline=None, derandomize=True)
@given(scenes(), st.floats(-6, 6), st.floats(-8, 8))
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


@pytest.mark.parametrize("phi_dot0", [0.0, 1e-300, 1e-8, -1e-8, 3.0, -3.0])
@pytest.mark.parametrize(("scene", "phi0"), [(frozen(), 1.0), (frozen(), -0.7), (sliding(), math.pi - 1e-9)])
def test_a_motion_begins_at_its_start(scene: Scene, phi0: float, phi_dot0: float) -> None:
    """phi and phi_dot at time 0 are those of the start, right beside a turning point too."""
    phi, phi_dot = solve(scene.oscillator, np.zeros(1), phi0, phi_dot0)
    assert phi[0] == pytest.approx(phi0, abs=2e-15)
    # phi_dot is a rate, up to 15 rad/s, times the sine of an angle that is good to an eps.
    assert phi_dot[0] == pytest.approx(phi_dot0, rel=1e-13, abs=1e-14)


@pytest.mark.parametrize("phi0", [1e4, -1e4, 1234.5])
@pytest.mark.parametrize(
    ("scene", "phi_dot0"), [(frozen(), 0.0), (frozen(), -30.0), (sliding(), 60.0), (frozen(0.6), 0.0)]
)
def test_a_start_many_turns_away(scene: Scene, phi_dot0: float, phi0: float) -> None:
    """It is that very double, less whole turns of the true 2 pi: what phi turns by, and phi_dot, are as from there."""
    near = float(mp.mpf(phi0) - 2 * mp.pi * mp.nint(mp.mpf(phi0) / (2 * mp.pi)))
    time = np.array([0.0, 0.3, 1.7])
    there, here = solve(scene.oscillator, time, phi0, phi_dot0), solve(scene.oscillator, time, near, phi_dot0)
    assert there[1] == pytest.approx(here[1], rel=1e-12, abs=1e-12)
    assert there[0] == pytest.approx(phi0 + (here[0] - near), abs=math.ulp(phi0))


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


@pytest.mark.parametrize("time", [[-1e-9, 1.0], [math.nan], [0.0, math.inf], [[0.0, 1.0]]])
def test_times_are_finite_and_after_the_start(time: list) -> None:
    with pytest.raises(ParameterError, match=r"time(\[\d\])? must be "):
        exact(sliding(), time, 0.1)


def test_times_in_any_order() -> None:
    time = np.array([0.3, 0.0, 2.0, 0.3])
    for scene, phi0 in ((sliding(), 1.0), (frozen(), math.pi)):
        motion = exact(scene, time, phi0)
        assert motion.phi[0] == motion.phi[3]
        assert motion.phi[1] == pytest.approx(phi0, rel=ROUNDING)
        assert float(exact(scene, 2.0, phi0).phi[0]) == pytest.approx(motion.phi[2], rel=ROUNDING)
