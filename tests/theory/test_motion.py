"""Periods against quadrature in 40 digits that knows nothing of how mjbeer arranges the theory."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import MPContext

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError
from mjbeer.theory.motion import solve
from tests.support import taylor
from tests.support.scenes import METAL, SCENES, scenes

mp = MPContext()
# E - V is a plain difference here and loses up to half the digits near a turning point.
mp.dps = 40
mpf = Any  # numbers of that context

# A quadrature of a smooth function sums roundings of both signs; measured: 4e-15 up to 0.99 of the separatrix.
PERIOD = 2e-14


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


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
@pytest.mark.parametrize("amplitude", [1e-3, -1e-3, 1.0, -1.3, 2.0, 3.0])
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


@pytest.mark.slow
@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-10])
@pytest.mark.parametrize("degrees", [0, 10])
def test_period_beside_the_separatrix(degrees: float, gap: float) -> None:
    scene, amplitude = sliding(math.radians(degrees)), math.pi - gap
    witness = Witness(scene)
    swing = witness.swing(mp.mpf(amplitude))
    pieces = [mp.pi / 2 - mp.mpf(10) ** -k for k in range(int(1 - math.log10(gap) / 2))]
    quarter = mp.quad(swing.rate, [0, *pieces, mp.pi / 2], method="gauss-legendre")
    assert abs(scene.period(amplitude) - 4 * quarter) < PERIOD


def test_period_diverges_as_the_logarithm_of_the_gap() -> None:
    scene = sliding()
    slower = scene.period(math.pi - 1e-6) - scene.period(math.pi - 1e-4)
    # What follows the logarithm is of order gap^2 log(gap); a gap of 1e-6 is rounded by 2e-16, half an ulp of pi.
    assert slower == pytest.approx(4 / scene.frequency() * math.log(100), rel=1e-7)


@pytest.mark.parametrize("scene", [sliding(), frozen(), frozen(-0.2, can=METAL), pendulum()])
def test_small_swings(scene: Scene) -> None:
    harmonic = 2 * math.pi / scene.frequency()
    assert scene.period(0) == harmonic
    # T grows by a share of the order of the amplitude squared: under an eps at 1e-9.
    for amplitude in (1e-9, -1e-9, 1e-13, 1e-200):
        assert scene.period(amplitude) == pytest.approx(harmonic, rel=PERIOD)


def test_at_the_separatrix_there_is_no_period() -> None:
    scene = frozen()
    for end in scene.separatrix():
        with pytest.raises(NoLibrationError):
            scene.period(end - scene.equilibrium() + math.copysign(1e-15, end))


@pytest.mark.parametrize("phi_dot0", [0.0, 1e-300, 1e-8, -1e-8, 3.0, -3.0])
@pytest.mark.parametrize(("scene", "phi0"), [(frozen(), 1.0), (frozen(), -0.7), (sliding(), math.pi - 1e-9)])
def test_a_motion_begins_at_its_start(scene: Scene, phi0: float, phi_dot0: float) -> None:
    """phi and phi_dot at time 0 are those of the start, right beside a turning point too."""
    phi, phi_dot = solve(scene.oscillator, np.zeros(1), phi0, phi_dot0)
    assert phi[0] == pytest.approx(phi0, abs=2e-15)
    # phi_dot is a rate, up to 15 rad/s, times the sine of an angle that is good to an eps.
    assert phi_dot[0] == pytest.approx(phi_dot0, rel=1e-13, abs=1e-14)


@pytest.mark.parametrize("phi0", [1e15, -1e15, 12345678.9, 1e50])
@pytest.mark.parametrize(
    ("scene", "phi_dot0"), [(frozen(), 0.0), (frozen(), -30.0), (sliding(), 60.0), (frozen(0.6), 0.0)]
)
def test_a_start_many_turns_away(scene: Scene, phi_dot0: float, phi0: float) -> None:
    """It is that very double, less whole turns of the true 2 pi: what phi turns by, and phi_dot, are as from there."""
    with mp.workdps(80):
        near = float(mp.mpf(phi0) - 2 * mp.pi * mp.nint(mp.mpf(phi0) / (2 * mp.pi)))
    time = np.array([0.0, 0.3, 1.7])
    there, here = solve(scene.oscillator, time, phi0, phi_dot0), solve(scene.oscillator, time, near, phi_dot0)
    assert there[1] == pytest.approx(here[1], rel=1e-12, abs=1e-12)
    assert (there[0] == phi0 + (here[0] - near)).all()


def test_a_start_many_turns_away_against_series() -> None:
    """Released at 1e15 rad: the load swings, and it did so already without any word when it was a radian off."""
    motion = [taylor.Case(frozen(), 1e15, 0.0, np.array([0.1, 0.9]))]
    turned, phi_dot = (each[0].astype(float) for each in taylor.integrate(motion))
    found = solve(frozen().oscillator, motion[0].time, 1e15, 0.0)
    assert found[1] == pytest.approx(phi_dot, rel=1e-12)
    assert np.abs(found[0] - 1e15 - turned).max() <= math.ulp(1e15) / 2


@pytest.mark.parametrize("scene", [frozen(), frozen(-0.1, can=METAL), sliding()])
def test_speed_of_light_swings(scene: Scene) -> None:
    """From the smallest amplitudes to those that turn: no two neighbours differ by more than they should."""
    form, time = scene.oscillator, np.array([0.37])
    for power in (-160, -52, -50, -48, -12, -6, -3):
        amplitude = 10.0**power
        turned = solve(form, time, scene.equilibrium(), amplitude * scene.frequency())[0][0] - scene.equilibrium()
        sway = amplitude * math.sin(scene.frequency() * 0.37)
        # anharmonic from the square of the amplitude on
        assert turned == pytest.approx(sway, abs=3e-16 + amplitude**2)
