"""Motions beside a separatrix and on the top are right, or refused: by quadrature in 60 digits."""

import math
from typing import Any

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, exact, frozen, hoop, sliding
from mjbeer.exceptions import NoLibrationError
from mjbeer.theory.motion import UNCERTAIN
from tests.support import taylor
from tests.support.scenes import METAL
from tests.support.taylor import mp

# The distance from the barrier is right to an eps, and what follows is so late by an eps of
# 1/lambda; the sum of the times of 60 panels, up to 3 s, is good to a few eps. phi falls at 20
# rad/s. Measured: 1.1e-13.
FALL = 5e-13


def error_of_a_fall(scene: Scene, phi0: float, phi: float, time: float) -> float:
    """By how much phi [rad] is off at a time [s] in the fall from rest at phi0, before the next
    turning point.

    The time by quadrature at the very doubles of the scene, for a sliding load,
    or an incline that is not negative.
    The integral is over the root of the change of phi, of which the rate is finite at rest, in
    pieces that are doubled from there on.
    """
    form = taylor.letters(scene)
    with mp.workdps(60):  # beside the barrier V falls by 1e-36 of itself up to the first node
        begin = mp.mpf(phi0)
        turned = mp.mpf(phi) - begin
        beside = begin - taylor.well(form)[2]
        beside -= 2 * mp.pi * mp.nint(beside / (2 * mp.pi))
        if turned * beside <= 0:  # it fell to the other side
            return math.inf

        energy = taylor.height(form, begin)

        def slowness(root: Any) -> Any:
            return taylor.slowness(form, energy, begin + mp.sign(turned) * root**2)

        end = mp.sqrt(abs(turned))
        pieces = {k * end / 8 for k in range(9)}
        for k in range(60):
            doubled = mp.sqrt(abs(beside)) / 4 * 2**k
            if doubled < end:
                pieces.add(doubled)
        late = taylor.integral(lambda root: 2 * root * slowness(root), sorted(pieces)) - time
        return float(abs(late) / slowness(end))


@pytest.mark.slow
@pytest.mark.parametrize("beside", [5e-15, -1e-10, -1e-2])
@pytest.mark.parametrize("scene", [sliding(-0.3), frozen(0.0, can=METAL)])
def test_beside_a_barrier_at_pi(scene: Scene, beside: float) -> None:
    """pi is no double, but how far a double is from it is known, and so is the motion."""
    form = scene.oscillator
    phi0 = math.pi + beside
    slowness = math.sqrt(form.inertia(math.pi) / form.potential.curvature)
    for share in (0.5, 1.02):
        time = share * slowness * math.log(4 / abs(beside))
        phi = float(exact(scene, [time], phi0).phi[0])
        assert error_of_a_fall(scene, phi0, phi, time) < FALL


SLOPES = [
    frozen(0.2),
    frozen(0.1, can=METAL),
    sliding(1.0, can=Can.hoop(mass=0.1)),
    frozen(1e-9),
    hoop(0.5),
]
"""Scenes whose barriers are where only their own numbers say."""


@pytest.mark.slow
def test_on_a_slope_a_motion_is_right_or_refused() -> None:
    """The barrier is rounded by up to 1e-15 rad, and more near the steepest slope: who starts so
    near is told so."""
    count = 20
    refused = 0
    checked = 0
    pick = np.random.default_rng(count)
    for scene in SLOPES * (count // len(SLOPES)):
        form = scene.oscillator
        _, top = scene.separatrix()
        phi0 = top + 10 ** pick.uniform(-15, -7) * pick.choice([-1, 1])
        phi0 = float(phi0 + 2 * math.pi * pick.integers(-3, 4))
        beside = float(abs(math.remainder(phi0 - top, 2 * math.pi))) + 1e-16
        slowness = math.sqrt(form.inertia(top) / form.potential.curvature)
        time = slowness * (-math.log(beside) + pick.uniform(-2, 1))
        try:
            motion = exact(scene, [time], phi0)
        except NoLibrationError:
            refused += 1
            continue
        phi = float(motion.phi[0])
        if motion.phi_dot[0] * (phi - phi0) > 0:  # still falling, and not resting on the top
            checked += 1
            assert error_of_a_fall(scene, phi0, phi, time) < UNCERTAIN * max(1, abs(phi - phi0))
    assert refused > 0.1 * count
    assert checked > 0.4 * count


def test_on_the_separatrix_a_motion_is_refused_and_beside_it_is_known() -> None:
    """From the bottom with just the energy of the top: phi = 2 arctan(sinh(t)) with J and m g b of
    1."""
    scene = Scene(Can(), Load(1.0, 0.02, 1.0), 0.0, "sliding", 50.0)
    time = np.array([0.5, 1.0, 3.0])
    # J is 1 + m b^2 sin^2(phi), 4e-4 more than 1 at most.
    for beside in (-1e-9, 1e-9):
        assert exact(scene, time, 0.0, 2.0 + beside).phi == pytest.approx(
            2 * np.arctan(np.sinh(time)), abs=4e-4
        )
    with pytest.raises(
        NoLibrationError, match=r"phi0 = 0\.0 rad, phi_dot0 = 2\.0 rad/s is too near a separatrix"
    ):
        exact(scene, time, 0.0, 2.0)


@pytest.mark.filterwarnings("ignore::mjbeer.AngleWarning")
def test_on_the_top() -> None:
    """As far as a double tells, an odd multiple of pi is the unstable equilibrium on level ground,
    and three ulps off it is not; so it is with the double nearest to the barrier of a slope."""
    for scene in (frozen(), sliding(can=METAL), hoop(0.2)):
        assert (
            exact(scene, [0.0, 100.0], scene.separatrix()[1]).phi == scene.separatrix()[1]
        ).all()
    for scene in (sliding(), frozen(0.0)):
        for top in (-1001 * math.pi, 7 * math.pi):
            assert (exact(scene, [0.0, 9.0], top).phi == top).all()
            assert exact(scene, 1e-3, top + 3 * math.ulp(top)).phi_dot[0] != 0


@pytest.mark.parametrize("gap", [1e-15, 1e-13])
def test_period_beside_the_separatrix_of_a_slope(gap: float) -> None:
    scene = frozen()
    amplitude = scene.separatrix()[1] - scene.equilibrium() - gap
    with pytest.raises(
        NoLibrationError, match=rf"amplitude {amplitude!r} rad is not inside the separatrix"
    ):
        scene.period(amplitude)
    for end in scene.separatrix():
        with pytest.raises(NoLibrationError):
            scene.period(end - scene.equilibrium() + math.copysign(1e-15, end))
