"""Beside a separatrix: right to rounding where doubles know the barrier, and refused where its rounding matters."""

import functools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, exact, frozen, hoop, sliding
from mjbeer.exceptions import NoLibrationError
from mjbeer.theory.motion import UNCERTAIN
from tests.support import taylor
from tests.support.scenes import METAL
from tests.support.taylor import mp

NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)

# The distance from the barrier is right to an eps, and what follows is so late by an eps of 1/lambda; the sum of the
# times of 60 panels, up to 3 s, is good to a few eps. phi falls at 20 rad/s. Measured: 1.1e-13.
ANGLE = 5e-13


def barrier(scene: Scene) -> Any:
    """The top of V in 40 digits, at the very doubles of the scene, for an incline that is not negative."""
    return taylor.well(taylor.coefficients(scene))[2]


@dataclass(frozen=True)
class Fall:
    """A fall from rest beside a barrier: J, and V in a form that cancels nowhere, from coefficients in 40 digits.

    At the barrier the slope of V is 0, so that V(beside) - V(beside + by) is
    slope (by - sin(beside + by) + sin(beside)) + 2 grip sin(beside + by/2) sin(by/2), with grip^2 = depth^2 - slope^2.
    """

    scene: Scene
    phi0: float

    @functools.cached_property
    def form(self) -> dict[str, Any]:
        return taylor.coefficients(self.scene)

    @functools.cached_property
    def beside(self) -> Any:
        """How far the start is from the next barrier [rad], in 40 digits."""
        beside = mp.mpf(self.phi0) - barrier(self.scene)
        return beside - 2 * mp.pi * mp.nint(beside / (2 * mp.pi))

    def inertia(self, by: np.ndarray) -> np.ndarray:
        phi = self.phi0 + by
        base, chord, swing = (float(self.form[name]) for name in ("base", "chord", "swing"))
        return base + chord * np.sin(phi / 2) ** 2 + swing * np.sin(phi) ** 2

    def fallen(self, by: np.ndarray) -> np.ndarray:
        """By how much V is less at phi0 + by than at phi0 [J]."""
        slope, beside = float(self.form["slope"]), float(self.beside)
        grip = float(mp.sqrt(mp.hypot(self.form["cosine"], self.form["sine"]) ** 2 - self.form["slope"] ** 2))
        bend = sine_gap(beside + by) - sine_gap(beside)
        return slope * bend + 2 * grip * np.sin(beside + by / 2) * np.sin(by / 2)

    def time(self, turned: float) -> float:
        """The time [s] in which phi changes by that much, by Gauss-Legendre with 24 nodes in each piece."""
        end = math.sqrt(abs(turned))
        doubled = math.sqrt(abs(self.beside)) / 4 * 2.0 ** np.arange(60)
        pieces = np.unique([*np.linspace(0, end, 9), *doubled[doubled < end]])
        half = np.diff(pieces)[:, np.newaxis] / 2
        root = pieces[:-1, np.newaxis] + half * (1 + NODES)  # of the change of phi: at rest its rate is finite
        by = math.copysign(1, turned) * root**2
        return float(np.sum(half * WEIGHTS * 2 * root * np.sqrt(self.inertia(by) / (2 * self.fallen(by)))))


def sine_gap(x: np.ndarray | float) -> np.ndarray:
    """x - sin(x), by its series where the difference would cancel."""
    near = np.where(np.abs(x) < 2, x, 0)
    series = np.ones_like(near)
    for k in range(26, 2, -2):  # the last term is below 1e-18 of the first
        series = 1 - near**2 / (k * (k + 1)) * series
    return np.where(np.abs(x) < 2, near**3 / 6 * series, x - np.sin(x))


def error_of_a_fall(scene: Scene, phi0: float, phi: float, time: float) -> float:
    """By how much phi [rad] is off at a time [s] in the fall from rest at phi0, before the next turning point."""
    fall, turned = Fall(scene, phi0), float(mp.mpf(phi) - mp.mpf(phi0))
    if turned * fall.beside <= 0:  # it fell to the other side
        return math.inf
    speed = math.sqrt(2 * fall.fallen(np.array(turned)) / fall.inertia(np.array(turned)))
    return abs(fall.time(turned) - time) * speed


NEAR = [5e-15, -1e-10, -1e-2]


@pytest.mark.parametrize("beside", NEAR)
@pytest.mark.parametrize("scene", [frozen(0.0), hoop(0.5), frozen(frozen().largest_incline() * (1 - 1e-6))])
def test_the_witness_loses_no_digits(scene: Scene, beside: float) -> None:
    """Its V against the difference of two values of V in 70 digits."""
    fall = Fall(scene, float(barrier(scene) + beside))
    by = math.copysign(1, beside) * 10 ** np.linspace(-14, 0.4, 20)
    with mp.workdps(70):
        start = mp.mpf(fall.phi0)
        plain = [float(taylor.fall(fall.form, start, start + mp.mpf(angle))) for angle in by.tolist()]
    assert fall.fallen(by) == pytest.approx(plain, rel=1e-14)


@pytest.mark.parametrize("beside", NEAR)
@pytest.mark.parametrize("scene", [frozen(0.0), sliding(-0.3), hoop(), frozen(0.0, can=METAL)])
def test_beside_a_barrier_at_pi(scene: Scene, beside: float) -> None:
    """pi is no double, but how far a double is from it is known, and so is the motion."""
    phi0, slowness = math.pi + beside, math.sqrt(scene.oscillator.inertia(math.pi) / scene.oscillator.stiffness())
    for share in (0.5, 1.02):
        time = share * slowness * math.log(4 / abs(beside))
        phi = float(exact(scene, [time], phi0).phi[0])
        assert error_of_a_fall(scene, phi0, phi, time) < ANGLE


@pytest.mark.filterwarnings("ignore::mjbeer.AngleWarning")
@pytest.mark.parametrize("turns", [-3, 1500])
def test_beside_a_barrier_many_turns_away(turns: int) -> None:
    scene = frozen(0.0)
    phi0 = (2 * turns + 1) * math.pi * (1 + 1e-15)
    beside = abs(float(mp.mpf(phi0) - (2 * turns + 1) * mp.pi))
    time = math.sqrt(scene.oscillator.inertia(math.pi) / scene.oscillator.stiffness()) * math.log(4 / beside)
    phi = float(exact(scene, [time], phi0).phi[0])
    assert error_of_a_fall(scene, phi0, phi, time) < ANGLE + math.ulp(phi0)


def random_slope(pick: np.random.Generator) -> Scene:
    """A scene whose barrier is where only its own numbers say."""
    can = [Can(), METAL, Can(0.05, 0.1, 10 ** pick.uniform(-3, 2)), Can.hoop(mass=0.1)][pick.integers(4)]
    while True:
        made = [
            frozen(math.radians(pick.uniform(0, 24)), can=can),
            sliding(math.radians(pick.uniform(0, 80)), can=can),
            frozen(10 ** pick.uniform(-18, -2), can=can),
            hoop(math.radians(pick.uniform(0.1, 60))),
        ][pick.integers(4)]
        if made.oscillator.slope < made.oscillator.depth:
            return made


@pytest.mark.parametrize("count", [15, pytest.param(300, marks=pytest.mark.slow)])
def test_on_a_slope_a_motion_is_right_or_refused(count: int) -> None:
    """The barrier is rounded by up to 1e-15 rad, and more near the steepest slope: who starts so near is told so."""
    pick, refused, checked = np.random.default_rng(count), 0, 0
    for _ in range(count):
        scene = random_slope(pick)
        form = scene.oscillator
        phi0 = scene.separatrix()[1] + 10 ** pick.uniform(-15, -7) * pick.choice([-1, 1])
        phi0 = float(phi0 + 2 * math.pi * pick.integers(-3, 4))
        beside = float(abs(math.remainder(phi0 - scene.separatrix()[1], 2 * math.pi))) + 1e-16
        time = math.sqrt(form.inertia(form.barrier()) / form.stiffness()) * (-math.log(beside) + pick.uniform(-2, 1))
        try:
            motion = exact(scene, [time], phi0)
        except NoLibrationError:
            refused += 1
            continue
        phi, phi_dot = float(motion.phi[0]), float(motion.phi_dot[0])
        if phi_dot * (phi - phi0) > 0:  # still falling, and not resting on the top
            checked += 1
            assert error_of_a_fall(scene, phi0, phi, time) < UNCERTAIN * max(1, abs(phi - phi0))
    assert refused > 0.1 * count
    assert checked > 0.4 * count


@pytest.mark.parametrize("sign", [1, -1])
def test_what_a_refusal_says(sign: int) -> None:
    scene = frozen(sign * math.radians(10))
    phi0 = sign * (frozen().separatrix()[1] - 4e-15)
    assert exact(scene, [1.0], phi0).phi[0] == pytest.approx(phi0, abs=1e-9)
    message = (
        rf"phi0 = {phi0!r} rad, phi_dot0 = 0\.0 rad/s is too near a separatrix: rounding of start and scene changes "
        r"phi by .* rad \(relative beyond 1 rad\) until 6 s, where at most 0\.0001 is allowed"
    )
    with pytest.raises(NoLibrationError, match=message):
        exact(scene, [1.0, 6.0], phi0)


def test_on_the_separatrix_the_motion_is_known_until_it_is_not() -> None:
    """From the bottom with just the energy of the top: phi = 2 arctan(sinh(t)) with J and m g b of 1, for a while."""
    scene = Scene(Can(), Load(1.0, 0.02, 1.0), 0.0, "sliding", 50.0)
    time = np.array([0.5, 1.0, 3.0])
    # J is 1 + m b^2 sin^2(phi), 4e-4 more than 1 at most.
    assert exact(scene, time, 0.0, 2.0).phi == pytest.approx(2 * np.arctan(np.sinh(time)), abs=4e-4)
    with pytest.raises(NoLibrationError, match=r"phi0 = 0\.0 rad, phi_dot0 = 2\.0 rad/s is too near a separatrix"):
        exact(scene, [40.0], 0.0, 2.0)


@pytest.mark.filterwarnings("ignore::mjbeer.AngleWarning")
def test_on_the_top() -> None:
    """As far as a double tells, an odd multiple of pi is the unstable equilibrium on level ground, and three ulps off
    it is not; so it is with the double nearest to the barrier of a slope."""
    for scene in (frozen(), sliding(can=METAL), hoop(0.2)):
        assert (exact(scene, [0.0, 100.0], scene.separatrix()[1]).phi == scene.separatrix()[1]).all()
    for scene in (sliding(), frozen(0.0)):
        for top in (-1001 * math.pi, 7 * math.pi):
            assert (exact(scene, [0.0, 9.0], top).phi == top).all()
            assert exact(scene, 1e-3, top + 3 * math.ulp(top)).phi_dot[0] != 0


def test_thrown_onto_the_top_of_another_turn() -> None:
    """Uphill so fast that it all but stops on the barrier three turns further up."""
    scene, form = frozen(), frozen().oscillator
    phi0 = scene.equilibrium()
    needed = float(form.drop(form.barrier() - 8 * math.pi, phi0))
    speed = math.sqrt(-2 * needed / float(form.inertia(phi0)))
    assert exact(scene, [0.1], phi0, -speed).phi[0] < phi0
    with pytest.raises(NoLibrationError, match="too near a separatrix"):
        exact(scene, [10.0], phi0, -speed)
    for faster in (1 - 1e-9, 1 + 1e-9):
        exact(scene, [10.0], phi0, -speed * faster)


@pytest.mark.parametrize("gap", [1e-15, 1e-13])
def test_period_beside_the_separatrix_of_a_slope(gap: float) -> None:
    scene = frozen()
    amplitude = scene.separatrix()[1] - scene.equilibrium() - gap
    with pytest.raises(NoLibrationError, match=rf"amplitude {amplitude!r} rad is (too near|not inside) the separatrix"):
        scene.period(amplitude)
    for end in scene.separatrix():
        with pytest.raises(NoLibrationError):
            scene.period(end - scene.equilibrium() + math.copysign(1e-15, end))
