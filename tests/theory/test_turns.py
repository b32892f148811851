"""Motions of up to 1e20 rad, against whole turns added up by the Hurwitz zeta function, in 35 digits.

The time of n turns is the integral over one of them of sqrt(J/2) times the sum of (E - V + k step)^(-1/2), and that sum
is (zeta(1/2, x) - zeta(1/2, x + n)) / sqrt(step) with x = (E - V) / step.
"""

import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from mpmath import MPContext

from mjbeer import Scene, exact, frozen, hoop, sliding
from mjbeer.theory.many_turns import ABOVE, _sum_of_roots
from mjbeer.theory.oscillator import Oscillator
from tests.support import gauss
from tests.support.scenes import METAL
from tests.support.taylor import coefficients

mp = MPContext()
mp.dps = 35

# Relative to the largest angle so far: phi is the square of a time that is right to a few eps. Measured: 1.4e-15.
RELATIVE = 4e-15


class Roll:
    """A motion on an incline that is not negative, as the witness sees it."""

    def __init__(self, scene: Scene, phi0: float, phi_dot0: float) -> None:
        self.form, self.phi0, self.up = coefficients(scene), mp.mpf(phi0), phi_dot0 < 0
        self.kinetic, self.step = self.inertia(self.phi0) * mp.mpf(phi_dot0) ** 2 / 2, 2 * mp.pi * self.form["slope"]
        self.depth = mp.hypot(self.form["cosine"], self.form["sine"])
        lean = mp.asin(min(self.form["slope"] / self.depth, 1)) if self.depth else mp.mpf(0)
        self.crest = mp.pi - mp.atan2(self.form["sine"], self.form["cosine"]) - lean
        # The width of the peak of 1/speed at the lowest crest that is passed is a root of the energy left there.
        lowest = self.left(self.crest) % self.step if self.up and self.step else abs(self.left(self.crest))
        narrow = (self.form["chord"] + 4 * self.form["swing"]) / self.form["base"]  # and that of a minimum of J
        self.halvings = 4 + int(mp.log(1 + max(self.depth / lowest, narrow), 4))

    def inertia(self, phi: Any) -> Any:
        return self.form["base"] + self.form["chord"] * mp.sin(phi / 2) ** 2 + self.form["swing"] * mp.sin(phi) ** 2

    def left(self, phi: Any) -> Any:
        """E - V at phi."""
        by, middle = phi - self.phi0, (phi + self.phi0) / 2
        pull = self.form["cosine"] * mp.sin(middle) + self.form["sine"] * mp.cos(middle)
        return self.kinetic + self.form["slope"] * by - 2 * pull * mp.sin(by / 2)

    def speed(self, phi: Any) -> Any:
        return mp.sqrt(2 * self.left(phi) / self.inertia(phi))

    def pieces(self, low: Any, high: Any) -> list:
        """Parts of an interval, smaller and smaller around each crest and each minimum of J."""
        ends = {low, high} | {low + (high - low) * k / 6 for k in range(1, 6)}
        for special in (self.crest, mp.mpf(0)):
            first = special + 2 * mp.pi * mp.floor((low - special) / (2 * mp.pi))
            for centre in (first, first + 2 * mp.pi, first + 4 * mp.pi):
                ends |= {centre + sign * mp.mpf(2) ** -k for k in range(0, self.halvings, 2) for sign in (-1, 1)} | {
                    centre
                }
        return sorted(end for end in ends if low <= end <= high)

    def turns(self, phi: Any, count: Any) -> Any:
        """The time of whole turns from phi on, uphill if their number is negative."""
        half = mp.mpf(1) / 2

        def total(left: Any) -> Any:
            if self.step == 0:
                return count / mp.sqrt(left)
            x = left / self.step
            if x < 1e8:
                return (mp.zeta(half, x) - mp.zeta(half, x + count)) / mp.sqrt(self.step)
            with mp.workdps(60 + int(mp.log10(x))):  # the zeta function for large x
                y = x + count
                rest = (mp.sqrt(1 / x) - mp.sqrt(1 / y)) / 2 + (x ** (-3 * half) - y ** (-3 * half)) / 24
                return (2 * (mp.sqrt(y) - mp.sqrt(x)) + rest) / mp.sqrt(self.step)

        def rate(angle: Any) -> Any:
            return mp.sqrt(self.inertia(angle) / 2) * total(self.left(angle))

        return gauss.integral(mp, rate, self.pieces(phi, phi + 2 * mp.pi)) if count else mp.mpf(0)

    def time(self, phi: Any) -> Any:
        """The time from the start to phi, without a turning point between the two."""
        count = mp.floor(abs(phi - self.phi0) / (2 * mp.pi)) * (-1 if self.up else 1)
        near = self.phi0 + 2 * mp.pi * count
        low, high = min(near, phi), max(near, phi)
        rest = gauss.integral(mp, lambda angle: 1 / self.speed(angle), self.pieces(low, high)) if low < high else 0
        return abs(self.turns(self.phi0, count)) + rest

    def time_from_turning_point(self, turn: Any, phi: Any) -> Any:
        """The time from a turning point, which has less phi, to phi."""
        count = max(mp.floor((phi - turn) / (2 * mp.pi)) - 1, mp.mpf(0))
        near = phi - 2 * mp.pi * count
        pieces = [max(mp.sqrt(end - turn), mp.mpf(10) ** -25) for end in self.pieces(turn, near)]
        pieces += [mp.sqrt(near - turn) / 2**k for k in range(1, 12, 2)]
        first = gauss.integral(mp, lambda root: 2 * root / self.speed(turn + root**2), sorted(set(pieces)))
        return first + self.turns(near, count)

    def turning_point(self) -> Any:
        """The last root of E - V before the start, by bisection between a crest too high and the equilibrium below."""
        if self.form["slope"] < self.depth:
            missed = mp.floor(self.left(self.crest) / self.step) + 1
            low = self.crest - 2 * mp.pi * missed
            high = low + mp.pi + 2 * mp.asin(self.form["slope"] / self.depth)
        else:  # V only falls, and by more than m g b until the kinetic energy is spent
            high, low = self.phi0, self.phi0 - (self.kinetic + 2 * self.depth) / self.form["slope"]
        for _ in range(160):
            middle = (low + high) / 2
            low, high = (middle, high) if self.left(middle) < 0 else (low, middle)
        return high


def errors(scene: Scene, phi0: float, phi_dot0: float, time: list[float]) -> np.ndarray:
    """The error of phi at each time, relative to the largest angle turned so far, and beyond 1 rad."""
    motion, roll = exact(scene, time, phi0, phi_dot0), Roll(scene, phi0, phi_dot0)
    # On the level a motion may be watched in a mirror, as any other.
    turn, before = roll.phi0 if phi_dot0 == 0 else None, mp.mpf(0)
    if roll.up and (motion.phi_dot > 0).any():
        turn = roll.turning_point()
        before = roll.time_from_turning_point(turn, roll.phi0)
    found, largest = [], mp.mpf(1)
    for t, phi, phi_dot in zip(time, motion.phi, motion.phi_dot, strict=True):
        largest = max(largest, abs(mp.mpf(phi) - roll.phi0))
        if turn is None or (roll.up and phi_dot < 0):
            passed = roll.time(mp.mpf(phi))
        else:
            passed = before + roll.time_from_turning_point(turn, mp.mpf(phi))
        found.append(abs(passed - t) * roll.speed(mp.mpf(phi)) / largest)
    return np.array(found, float)


QUICK = {
    "rolls down for 30 years": (frozen(), math.pi, 0.0, [1e9]),
    "thrown up": (frozen(), 1.0, -1e9, [1e-3, 200.0]),
    "level": (frozen(0.0), 0.3, -60.0, [1.0, 1e5]),
    "next to level": (frozen(1e-20), 0.3, 60.0, [1.0, 1e8]),
}
SLOW = {
    "rolls down": (frozen(), math.pi, 0.0, [0.3, 2.0, 2.5, 200.0, 1e4]),
    "thrown down": (frozen(), 1.0, 1e5, [1e-3, 200.0]),
    "up and down again": (frozen(), math.pi, -300.0, [3.0, 20.0, 1e6]),
    "steep": (frozen(0.6), 0.0, 0.0, [0.1, 1.0, 1e8]),
    "steep, up and down again": (frozen(0.6), 0.0, -1000.0, [0.1, 200.0, 1e8]),
    "next to level, up": (frozen(1e-20), 0.0, -60.0, [1.0, 1e8]),
    "far up and down again": (frozen(1e-5), 0.0, -60.0, [100.0, 1e5]),
    "balanced": (frozen(0.2, fill=1.0), 0.0, -60.0, [0.1, 100.0, 1e5]),
    "slides": (sliding(0.3, can=METAL), 0.0, 1e6, [1e-3, 100.0, 1e5]),
    "hoop": (hoop(0.01), 2.0, -100.0, [0.1, 100.0, 1e5]),
    "past a barrier by a little": (frozen(0.0), math.pi - 1e-6, 1e-4, [3.0, 1e4]),
}


@pytest.mark.parametrize(
    "motion",
    [*QUICK.values(), *(pytest.param(motion, marks=pytest.mark.slow) for motion in SLOW.values())],
    ids=[*QUICK, *SLOW],
)
def test_whole_turns_are_counted(motion: tuple) -> None:
    assert errors(*motion).max() < RELATIVE


UPHILL = [frozen(), frozen(0.6), frozen(1e-3), frozen(0.43), frozen(0.1, fill=1.0), hoop(0.01)]


@pytest.mark.parametrize("later", [0.3, 0.99, 1.7, 5.0])
@pytest.mark.parametrize("phi_dot0", [-20.0, -300.0])
@pytest.mark.parametrize("scene", UPHILL)
def test_backwards_in_time(scene: Scene, phi_dot0: float, later: float) -> None:
    """Turned round, a motion goes back to its start, whichever parts it passes uphill and downhill."""
    form = scene.oscillator
    time = [later * form.inertia(0.3) * -phi_dot0 / form.slope]  # in units of about the time that it goes uphill
    there = exact(scene, time, 0.3, phi_dot0)
    back = exact(scene, time, there.phi[0], -there.phi_dot[0])
    # Where it is turned round phi is rounded by an ulp, which is an energy, and so an angle for each radian turned.
    farthest = 300 + (1 + later) ** 2 * abs(phi_dot0) * time[0]
    rounding = farthest * math.ulp(farthest)
    assert back.phi[0] == pytest.approx(0.3, abs=rounding)
    assert back.phi_dot[0] == pytest.approx(-phi_dot0, rel=rounding)


@pytest.mark.parametrize("phi_dot0", [0.0, 1e4, -1e4])
def test_an_angle_costs_no_more_for_being_large(phi_dot0: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither evaluations of J nor memory grow with the turns: a third of a million in 200 s, and 1e19 in 30 years."""
    evaluations, inertia = [0], Oscillator.inertia_past_crest

    def counted(self: Oscillator, x: np.ndarray | float) -> np.ndarray:
        evaluations[0] += np.size(x)
        return inertia(self, x)

    monkeypatch.setattr(Oscillator, "inertia_past_crest", counted)
    for latest in (200.0, 1e9):
        time = np.linspace(0, latest, 2000)
        evaluations[0] = 0
        tracemalloc.start()
        motion = exact(frozen(), time, math.pi, phi_dot0)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert evaluations[0] < 20_000
        assert peak < 50e6
        few = exact(frozen(), time[[3, 700, 1999]], math.pi, phi_dot0)
        assert few.phi == pytest.approx(motion.phi[[3, 700, 1999]], rel=RELATIVE)
        assert (np.diff(motion.phi[motion.phi_dot > 0]) > 0).all()


@pytest.mark.parametrize("step", [1.0, -1.0, 1e-3, 1e-200, 0.0])
@pytest.mark.parametrize("count", [0, 1, 2, 10, 1e6, 1e15])
@pytest.mark.parametrize("first", [ABOVE, 31.7, 1e3, 1e6])
def test_sum_of_roots(first: float, step: float, count: float) -> None:
    """Euler and Maclaurin against zeta: a turn is right to rounding, and so is the sum of any number."""
    if step < 0:
        first += count  # down to 30 steps and less
    x, n, half = mp.mpf(first), mp.mpf(count), mp.mpf(1) / 2
    if step == 0:
        wanted = n / mp.sqrt(x)
    else:
        x /= abs(mp.mpf(step))
        low, high = (x, x + n) if step > 0 else (x - n + 1, x + 1)
        with mp.workdps(100):
            if low < 1e8:
                wanted = (mp.zeta(half, low) - mp.zeta(half, high)) / mp.sqrt(abs(mp.mpf(step)))
            elif n <= 10:
                wanted = sum((1 / mp.sqrt(first + k * mp.mpf(step)) for k in range(int(n))), start=mp.mpf(0))
            else:  # hardly any change
                return
    levels = np.array([first, first + count * step], float)
    found = float(_sum_of_roots(*levels, step, count))
    assert abs(found - wanted) <= 1e-15 * max(1, wanted)
