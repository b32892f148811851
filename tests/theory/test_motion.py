"""Periods and motions against quadrature in 40 digits, Taylor series, and small and far motions."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.theory.motion import solve
from tests.support import taylor
from tests.support.scenes import METAL, SCENES
from tests.support.taylor import mp

# A quadrature of a smooth function sums roundings of both signs; measured: 4e-15 up to 0.99 of the
# separatrix.
PERIOD = 2e-14
# A few roundings of an angle of up to 70 rad. Measured: 3e-14 rad.
ANGLE = 2e-13
# phi_dot is off by phi's error times the frequency, 20/s or less.
RATE = 20 * ANGLE
# Sums and products of a few terms each.
ROUNDING = 2e-15


def period(scene: Scene, amplitude: float | Any) -> Any:
    """Twice the integral of dt from end to end, with phi = c + d sin(phase), and E - V as the plain
    difference that loses up to half of the 40 digits near a turning point."""
    form = taylor.letters(scene)
    low, rest, high = taylor.well(form)
    one = rest + mp.mpf(amplitude)
    beyond_other = low if amplitude > 0 else high
    other = mp.findroot(
        lambda phi: taylor.fall(form, one, phi),
        (beyond_other, rest),
        solver="bisect",
        tol=1e-60,
        maxsteps=150,
    )
    centre = (one + other) / 2
    width = abs(one - other) / 2
    energy = taylor.height(form, one)

    def rate(phase: Any) -> Any:
        cos, sin = mp.cos_sin(phase)
        return width * cos * taylor.slowness(form, energy, centre + width * sin)

    # Halved towards the ends, where a barrier may be as near as 1e-10 rad, which is 1e-5 of the
    # phase.
    upper = [mp.pi / 2 - mp.mpf(2) ** -k for k in range(20)] + [mp.pi / 2]
    lower = [-phase for phase in reversed(upper)]
    return 2 * taylor.integral(rate, [*lower, 0, *upper])


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
def test_period(scene: Scene) -> None:
    low, high = (end - scene.equilibrium() for end in scene.separatrix())
    for amplitude in (-1.3, 3.0):
        if low < amplitude < high:
            assert abs(scene.period(amplitude) / period(scene, amplitude) - 1) < PERIOD
            continue
        message = (
            "amplitude {} rad is not inside the separatrix, or too near it "
            ".* between {:.6g} and {:.6g} rad"
        )
        with pytest.raises(NoLibrationError, match=message.format(amplitude, low, high)):
            scene.period(amplitude)
        with pytest.raises(NoLibrationError, match=message.format(-amplitude, -high, -low)):
            replace(scene, incline=-scene.incline).period(-amplitude)


@pytest.mark.slow
@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-10])
@pytest.mark.parametrize("degrees", [0, 10])
def test_period_beside_the_separatrix(degrees: float, gap: float) -> None:
    scene = sliding(math.radians(degrees))
    amplitude = math.pi - gap
    assert abs(scene.period(amplitude) / period(scene, amplitude) - 1) < PERIOD


@pytest.mark.parametrize("scene", [sliding(), frozen(), frozen(-0.2, can=METAL), pendulum()])
def test_small_swings(scene: Scene) -> None:
    """T grows by a share of the order of the amplitude squared: under an eps at 1e-9."""
    rest = scene.equilibrium()
    omega = scene.frequency()
    time = np.linspace(0, 1, 9)
    for amplitude in (0.0, 1e-9, -1e-13, 1e-200):
        assert scene.period(amplitude) == pytest.approx(2 * math.pi / omega, rel=PERIOD)
    for meant in (0.0, 1e-17, -1e-15, 1e-10):
        turn = (rest + meant) - rest  # what is left of it in a double
        for phi_dot0 in (0.0, 1e-160, -1e-14, 1e-9):
            motion = exact(scene, time, rest + turn, phi_dot0)
            sway = turn * np.cos(omega * time) + phi_dot0 / omega * np.sin(omega * time)
            assert motion.phi - rest == pytest.approx(sway, abs=ROUNDING)
            sway_dot = phi_dot0 * np.cos(omega * time) - omega * turn * np.sin(omega * time)
            assert motion.phi_dot == pytest.approx(sway_dot, abs=20 * ROUNDING)


ROLLS = [  # scene, phi0 and phi_dot0
    (frozen(), math.pi, -1e-9),  # up from the top, pushed a little
    (Scene(Can(), Load(0.2, 0.02, 1e-4), 0.2, "frozen"), 0.3, -100.0),  # up a long way
    (frozen(0.6, can=METAL), 0.0, -3.0),  # up a slope too steep to rest on
    (hoop(0.3), 11 * math.pi + 0.1, -30.0),
    (frozen(0.0), math.pi - 1e-6, 1e-4),  # past a barrier by a little
    (sliding(0.3, can=METAL), 0.0, 6.0),
    (pendulum(-0.3), 2.0, 30.0),
]


@taylor.NEEDED
@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::mjbeer.AngleWarning")
def test_rolls_up_and_down() -> None:
    """And as seen from behind."""
    time = np.array([0.05, 0.3, 1.2])
    for scene, phi0, phi_dot0 in ROLLS:
        radius = scene.can.radius
        delta_phi, u, rate, speed = taylor.motion(scene, time, phi0, phi_dot0).astype(float).T

        motion = exact(scene, time, phi0, phi_dot0)

        # The axis comes down with a constant acceleration, besides what the load does to it.
        assert np.abs(motion.phi - phi0 - delta_phi).max() < ANGLE
        assert np.abs(motion.u - u).max() < ANGLE * max(radius, np.abs(u).max())
        assert np.abs(motion.phi_dot - rate).max() < RATE
        assert np.abs(motion.u_dot - speed).max() < RATE * max(radius, np.abs(speed).max())

        behind = exact(replace(scene, incline=-scene.incline), time, -phi0, -phi_dot0)
        assert (behind.phi == -motion.phi).all()
        assert (behind.phi_dot == -motion.phi_dot).all()


@pytest.mark.parametrize("incline", [0.1, -0.1])
def test_the_domain_has_an_edge(incline: float) -> None:
    """Ten thousand turns of an incline are followed."""
    scene = frozen(incline)
    fast = math.copysign(100.0, incline)
    assert abs(exact(scene, 20.0, 0.0, fast).phi[0]) > 1e3
    too_long = r"has at most 10000 turns, which end at .* got 1e\+06 s"
    with pytest.raises(ParameterError, match=too_long):
        exact(scene, 1e6, 0.0, fast)


@pytest.mark.parametrize("incline", [0.1, -0.1])
def test_a_swing_is_followed_until_rounding_shows(incline: float) -> None:
    scene = frozen(incline)
    start = scene.equilibrium() + 0.3
    latest = 1e6 * scene.period(0.3)
    # At the turning point an error of the time, some eps of it, counts with its square.
    assert exact(scene, latest, start).phi[0] == pytest.approx(start, abs=ANGLE)
    with pytest.raises(NoLibrationError, match="or the motion too long"):
        exact(scene, 1e6 * latest + 0.1, start)


@pytest.mark.parametrize("phi0", [1e4, -1e4, 1234.5])
@pytest.mark.parametrize(
    ("scene", "phi_dot0"),
    [(frozen(), 0.0), (frozen(), -30.0), (sliding(), 60.0), (frozen(0.6), 0.0)],
)
def test_a_start_many_turns_away(scene: Scene, phi_dot0: float, phi0: float) -> None:
    """It is that very double, less whole turns of the true 2 pi: what phi turns by, and phi_dot,
    are as from there."""
    near = float(mp.mpf(phi0) - 2 * mp.pi * mp.nint(mp.mpf(phi0) / (2 * mp.pi)))
    time = np.array([0.0, 0.3, 1.7])

    phi, phi_dot = solve(scene.oscillator, time, phi0, phi_dot0)
    near_phi, near_phi_dot = solve(scene.oscillator, time, near, phi_dot0)

    # The nearer start is rounded to a double, by up to 2e-16 rad. Measured: 4e-13 rad/s of 60.
    assert phi_dot == pytest.approx(near_phi_dot, rel=1e-12, abs=1e-12)
    assert phi == pytest.approx(phi0 + (near_phi - near), abs=math.ulp(phi0))


def test_times_increase() -> None:
    """A frequency was measured on unsorted samples: -11.6, -34.7 and 27.0 rad/s for 11.57."""
    message = "time must increase, but "
    with pytest.raises(ParameterError, match=message + r"time\[1\] is 0.0 s after 0.3 s"):
        exact(sliding(), [0.3, 0.0, 2.0], 1.0)
    with pytest.raises(ParameterError, match=message + r"time\[2\] is 0.3 s after 0.3 s"):
        exact(sliding(), [0.0, 0.3, 0.3], 1.0)


def test_other_times_do_not_change_a_sample() -> None:
    alone = exact(frozen(), 2.0, math.pi)
    last = exact(frozen(), [0.0, 0.3, 2.0], math.pi)
    assert alone.phi[0] == pytest.approx(last.phi[2], rel=ROUNDING)


def test_a_start_on_the_edge_of_a_turn() -> None:
    """Half a turn from the crest, rounding may put the start before its leg, where no path has a
    place for it."""
    steep = [frozen(incline) for incline in np.linspace(0.5, 1.4, 10)]
    level = [pendulum(0.0, load_mass=mass) for mass in np.linspace(0.1, 2.0, 10)]
    for scene in (*steep, *level, frozen(0.0), sliding(), sliding(0.5)):
        edge = scene.oscillator.potential.crest_past_pi  # the crest is at pi more
        for phi0 in (edge, edge + 2 * math.pi):
            for phi_dot0 in (5.0, -5.0, -20.0, 80.0, -110.0):
                phi, phi_dot = solve(scene.oscillator, np.array([0.0]), phi0, phi_dot0)
                assert phi == pytest.approx(phi0, abs=ANGLE)
                assert phi_dot == pytest.approx(phi_dot0, rel=ROUNDING)
