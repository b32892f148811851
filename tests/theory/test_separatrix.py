"""Beside a separatrix: right to rounding where doubles know the barrier, and refused where its rounding matters."""

import math
from typing import Any

import numpy as np
import pytest
from mpmath import MPContext

from mjbeer import Can, Load, Scene, exact, frozen, hoop, sliding
from mjbeer.exceptions import NoLibrationError, ToleranceError
from mjbeer.theory.certainty import UNCERTAIN
from tests.support.scenes import METAL
from tests.support.taylor import coefficients

mp = MPContext()
mp.dps = 30

# The distance from the barrier is right to an eps, and what follows is so late by an eps of 1/lambda; the sum of the
# times of 60 panels, up to 3 s, is good to a few eps. phi falls at 20 rad/s. Measured: 1.1e-13.
ANGLE = 5e-13


def barrier(scene: Scene) -> Any:
    """The top of V in 30 digits, at the very doubles of the scene, for an incline that is not negative."""
    form = coefficients(scene)
    depth = mp.hypot(form["cosine"], form["sine"])
    return mp.pi - mp.atan2(form["sine"], form["cosine"]) - mp.asin(form["slope"] / depth)


def error_of_a_fall(scene: Scene, phi0: float, phi: float, time: float) -> float:
    """By how much phi [rad] is off at a time [s] in the fall from rest at phi0, before the next turning point."""
    form = coefficients(scene)
    turned = mp.mpf(phi) - mp.mpf(phi0)
    beside = mp.mpf(phi0) - barrier(scene)
    beside -= 2 * mp.pi * mp.nint(beside / (2 * mp.pi))
    if turned * beside <= 0:  # it fell to the other side
        return math.inf
    side = mp.sign(turned)

    def inertia(x: Any) -> Any:
        return form["base"] + form["chord"] * mp.sin(x / 2) ** 2 + form["swing"] * mp.sin(x) ** 2

    def fallen(by: Any) -> Any:
        """V(phi0) - V(phi0 + by), as a product where it would cancel."""
        middle = mp.mpf(phi0) + by / 2
        pull = form["cosine"] * mp.sin(middle) + form["sine"] * mp.cos(middle)
        return form["slope"] * by - 2 * pull * mp.sin(by / 2)

    def rate(root: Any) -> Any:
        by = side * root**2
        return 2 * root * mp.sqrt(inertia(phi0 + by) / (2 * fallen(by)))

    end, pieces = mp.sqrt(abs(turned)), [mp.mpf(10) ** -24]  # the rate does not change below
    pieces += [end * k / 8 for k in range(1, 9)]
    while (piece := mp.sqrt(abs(beside)) / 4 * 2 ** len(pieces[9:])) < end:
        pieces.append(piece)
    passed = mp.quad(rate, sorted(pieces), method="gauss-legendre", maxdegree=4)  # 24 nodes in each piece
    return float(abs(passed - time) * mp.sqrt(2 * fallen(turned) / inertia(mp.mpf(phi))))


AT_PI = [frozen(0.0), sliding(), sliding(-0.3), hoop(), frozen(0.0, can=METAL)]
NEAR = [5e-15, -5e-15, 1e-13, -1e-10, 1e-6, -1e-2]


@pytest.mark.parametrize(
    ("scene", "beside"),
    [(frozen(0.0), 5e-15), (sliding(), -1e-10)]
    + [pytest.param(scene, beside, marks=pytest.mark.slow) for scene in AT_PI for beside in NEAR],
)
def test_beside_a_barrier_at_pi(scene: Scene, beside: float) -> None:
    """pi is no double, but how far a double is from it is known, and so is the motion."""
    phi0, slowness = math.pi + beside, math.sqrt(scene.oscillator.inertia(math.pi) / scene.oscillator.stiffness())
    for share in (0.5, 1.02):
        time = share * slowness * math.log(4 / abs(beside))
        phi = float(exact(scene, [time], phi0).phi[0])
        assert error_of_a_fall(scene, phi0, phi, time) < ANGLE


@pytest.mark.parametrize("turns", [-3, 50, 10**6])
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


@pytest.mark.parametrize("count", [15, pytest.param(1000, marks=pytest.mark.slow)])
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


def test_on_the_top_of_a_slope() -> None:
    """The double nearest to the barrier is the barrier, and so are its neighbours."""
    for scene in (frozen(), frozen(-0.1, can=METAL), sliding(can=METAL), hoop(0.2)):
        for top in scene.separatrix() if scene.attachment == "sliding" else [scene.oscillator.barrier()]:
            if scene.oscillator.slope >= 0:
                assert (exact(scene, [0.0, 100.0], top).phi == top).all()


@pytest.mark.parametrize("beside", [-1e-9, -1e-12, 1e-12, 1e-9])
@pytest.mark.parametrize(("past", "phi_dot0"), [(1e-9, -3e-8), (-1e-9, 3e-8), (1e-9, 0.0), (0.0, -1e-9)])
def test_where_hardly_a_torque_acts(beside: float, past: float, phi_dot0: float) -> None:
    """Beside the steepest incline the torque at the crest all but vanishes, and for a while only speed counts."""
    scene = frozen(frozen().largest_incline() * (1 + beside))
    form, time = scene.oscillator, np.array([0.0, 0.1, 1.0])
    phi0 = math.pi + form.crest.offset + past
    motion = exact(scene, time, phi0, phi_dot0)
    # It moves by its acceleration, which is at most that of the torque where it may get to.
    farthest = abs(past) + 2 * abs(phi_dot0) + 1e-7
    fall = max(abs(form.crest.torque(x)) for x in (-farthest, farthest)) / float(form.inertia(phi0)) * time**2 / 2
    assert (np.abs(motion.phi - phi0 - phi_dot0 * time) <= fall + 1e-15).all()


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


def test_a_swing_outlasts_what_is_known_of_its_period() -> None:
    assert abs(exact(frozen(), [1e8], 1.0).phi[0]) < 1.1
    with pytest.raises(
        ToleranceError, match=r"phi is not known until 1e\+13 s: rounding of the scene changes its speed"
    ):
        exact(frozen(), [1e13], 1.0)


@pytest.mark.parametrize("gap", [1e-15, 1e-13])
def test_period_beside_the_separatrix_of_a_slope(gap: float) -> None:
    scene = frozen()
    amplitude = scene.separatrix()[1] - scene.equilibrium() - gap
    with pytest.raises(NoLibrationError, match=rf"amplitude {amplitude!r} rad is (too near|not inside) the separatrix"):
        scene.period(amplitude)
