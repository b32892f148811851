"""Motions against quadrature in 40 digits and Taylor series, also beside a separatrix; and their
quadrature."""

import contextlib
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import NoLibrationError, ParameterError, ToleranceError
from mjbeer.theory.motion import UNCERTAIN, solve
from mjbeer.theory.travel_time import TravelTime
from tests.support import taylor
from tests.support.scenes import METAL, SCENES
from tests.support.taylor import mp


class Case(NamedTuple):
    """A motion and the increasing times at which it is asked for [s]."""

    scene: Scene
    phi0: float
    phi_dot0: float
    time: np.ndarray


# A quadrature of a smooth function sums roundings of both signs; measured: 4e-15 up to 0.99 of the
# separatrix.
PERIOD = 2e-14
# A few roundings of an angle of up to 70 rad. Measured: 3e-14 rad.
ANGLE = 2e-13
# phi_dot is off by phi's error times the frequency, 20/s or less.
RATE = 20 * ANGLE
# Sums and products of a few terms each.
ROUNDING = 2e-15
# Random motions against series: a few eps, more where J has a narrow minimum, which magnifies the
# rounding of phi.
RANDOM = 2e-12
USUAL = 1e-14
# Beside the steepest incline, what rounding changes is divided by the distance from it. Measured:
# 5e-12 for 90 %.
BESIDE_STEEPEST = 5e-11


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
        delta_phi, u, rate, speed = taylor.motion(scene, time, phi0, phi_dot0).astype(float).T
        motion = exact(scene, time, phi0, phi_dot0)
        radius = scene.can.radius
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
    """Ten thousand turns of an incline are followed, and swings until rounding shows."""
    scene = frozen(incline)
    fast = math.copysign(100.0, incline)
    assert abs(exact(scene, 20.0, 0.0, fast).phi[0]) > 1e3
    too_long = r"has at most 10000 turns, which end at .* got 1e\+06 s"
    with pytest.raises(ParameterError, match=too_long):
        exact(scene, 1e6, 0.0, fast)
    start = scene.equilibrium() + 0.3
    latest = 1e6 * scene.period(0.3)
    # At the turning point an error of the time, some eps of it, counts with its square.
    assert exact(scene, latest, start).phi[0] == pytest.approx(start, abs=ANGLE)
    with pytest.raises(NoLibrationError, match="or the motion too long"):
        exact(scene, 1e6 * latest + 0.1, start)


def random_scene(pick: np.random.Generator) -> Scene:
    """Any size of can, ratio of masses, incline and gravity that is allowed."""

    def decades(low: float, high: float) -> float:
        return 10 ** pick.uniform(low, high)

    def one_of(*values: float) -> float:
        return float(pick.choice(values))

    radius = decades(-3, 1.5)
    load_mass = decades(-2, 2)
    can_mass = one_of(0.0, load_mass * decades(-3, 3))
    can_inertia = can_mass * radius**2 * one_of(0.0, 0.5, 1.0, pick.uniform())
    offset = radius * one_of(0.0, 1.0, decades(-9, 0), pick.uniform(), pick.uniform())
    load_inertia = load_mass * radius**2 * one_of(0.0, decades(-6, 0), pick.uniform())
    flat = one_of(0.0, 0.0, 1e-8, decades(-20, 0))
    degrees = one_of(flat, flat, pick.uniform(-30, 30), pick.uniform(-85, 85))
    gravity = one_of(9.81, 9.81, 0.0, decades(-3, 3))
    attachment = str(pick.choice(["sliding", "frozen"]))
    can = Can(radius, 3 * radius, can_mass, can_inertia)
    load = Load(load_mass, offset, load_inertia)
    return Scene(can, load, math.radians(degrees), attachment, gravity)


def case(pick: np.random.Generator, longest: float) -> Case:
    """A start at rest, slow or fast, and up to `longest` times the time in which something
    happens."""
    scene = None
    while scene is None:
        with contextlib.suppress(ParameterError):  # no inertia, or too small a share of it
            scene = random_scene(pick)
    form = scene.oscillator
    torque = max(form.depth, abs(form.ramp))
    pace = math.sqrt(torque / (form.base + form.chord + form.coupling)) if torque > 0 else 1.0
    far = pick.choice([3, 100, 1e4])
    angles = [0.0, 1.0, 10 ** pick.uniform(-9, 1), *pick.uniform(-far, far, 3)]
    fast = 10 ** pick.uniform(-3, 3)
    speeds = [0.0, 0.0, pick.uniform(-3, 3), fast, -fast]
    phi_dot0 = float(pace * pick.choice(speeds))
    duration = longest * 10 ** pick.uniform(-4, 0) / (abs(phi_dot0) + pace)
    times = np.sort(duration * pick.uniform(0, 1, 4))
    return Case(scene, float(pick.choice(angles)), phi_dot0, times)


def errors(cases: list[Case], steps: int = 4000) -> np.ndarray:
    """The largest error, relative beyond 1 rad, of each motion that is not refused and that the
    witness follows."""
    found = []
    for scene, phi0, phi_dot0, time in cases:
        try:
            phi, _ = solve(scene.oscillator, time, phi0, phi_dot0)
        except (NoLibrationError, ParameterError):
            continue  # beside a separatrix, or beyond the turns that are followed
        turned = taylor.motion(scene, time, phi0, phi_dot0, steps)[:, 0].astype(float)
        # phi is rounded beside its start, as a sum of the two.
        scale = np.maximum(max(1, abs(phi0)), np.maximum.accumulate(np.abs(turned)))
        found.append(np.max(np.abs(phi - phi0 - turned) / scale))
    largest = np.array(found)
    return largest[~np.isnan(largest)]


@taylor.NEEDED
@pytest.mark.slow
def test_any_motion() -> None:
    pick = np.random.default_rng(1500)
    count = 400
    found = errors([case(pick, 500.0) for _ in range(count)])
    assert len(found) > 0.9 * count
    assert found.max() < RANDOM
    assert np.quantile(found, 0.95) < USUAL


@taylor.NEEDED
@pytest.mark.slow
def test_beside_the_steepest_incline() -> None:
    """There a well of no depth, or a slope of no torque, decides for how long the load
    hesitates."""
    pick = np.random.default_rng(230)
    steepest = frozen().largest_incline()
    cases = []
    for _ in range(120):
        beside = 10 ** pick.uniform(-11, -1)
        scene = frozen(steepest * (1 + pick.choice([-1, 1]) * beside))
        width = math.sqrt(beside)
        slowness = 0.1 / math.sqrt(width)
        phi0 = (
            math.pi / 2
            - steepest
            + width * pick.choice([0.0, pick.uniform(-3, 3), pick.uniform(-100, 100)])
        )
        phi_dot0 = pick.choice([0.0, width / slowness * pick.uniform(-3, 3), pick.uniform(-20, 20)])
        time = slowness * np.sort(pick.uniform(0, 2, 3))
        cases.append(Case(scene, float(phi0), float(phi_dot0), time))
    found = errors(cases, steps=1000)
    assert len(found) > 0.5 * len(cases)  # others turn so often that the witness takes more steps
    assert found.max() < UNCERTAIN
    assert np.quantile(found, 0.9) < BESIDE_STEEPEST


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


# Times and phases are sums of a few dozen panels, each good to its rounding. Measured: 1e-15.
TIME = 1e-14


@pytest.mark.parametrize(
    ("rate", "time"),
    [
        (
            lambda psi: np.exp(np.sin(psi)) * np.cos(psi) + 3,
            lambda psi: np.exp(np.sin(psi)) + 3 * psi,
        ),
        # A peak as a motion has that hardly passes a barrier, and another one much sharper.
        (lambda psi: 1 / np.hypot(psi, 1e-3), lambda psi: np.arcsinh(psi / 1e-3)),
        (lambda psi: 1 / np.hypot(psi, 1e-18), lambda psi: np.arcsinh(psi / 1e-18)),
        # A small fast ripple is no rounding noise, however alike they look at first.
        (lambda psi: 1 + 1e-6 * np.cos(500 * psi), lambda psi: psi + 2e-9 * np.sin(500 * psi)),
    ],
    ids=["waves", "peak", "needle", "ripple"],
)
def test_round_trip(rate: Callable, time: Callable) -> None:
    """From edges at which doubles are dense: the peaks are at 0."""
    clock = TravelTime(rate, -3.0, 0.0, 30.0)
    psi = np.linspace(-3, 30, 67)[::-1]
    elapsed = time(psi) - time(-3.0)
    slowest = np.array([float(rate(np.array(place))) for place in psi])
    # What the times themselves are rounded by comes back divided by the rate.
    tolerance = TIME * (30 + 1 / slowest + elapsed.max() / slowest)
    assert (np.abs(clock.psi_at(elapsed)[0] - psi) < tolerance).all()
    backwards = np.array([clock.time_at(float(place)) for place in psi])
    assert (np.abs(backwards - elapsed) < tolerance * slowest).all()


@pytest.mark.parametrize(
    "rate",
    [
        lambda psi: 1 + 1e-6 * np.cos(1e12 * psi),
        # Beside its peaks, which are 1e-6 wide, 1 - m sin^2 psi as it stands has only four digits.
        lambda psi: 1 / np.sqrt(1 - (1 - 1e-12) * np.sin(psi) ** 2),
        lambda psi: 1 / psi,
        lambda psi: np.where(psi > 1, math.inf, 1.0),
        lambda psi: np.full_like(psi, math.nan),
    ],
    ids=["noise", "cancellation", "pole", "infinite", "not a number"],
)
def test_what_is_no_smooth_function_is_refused(rate: Callable) -> None:
    """A number that is wrong and says nothing would be worse; and halving panels must come to an
    end."""
    with (
        np.errstate(over="ignore"),
        pytest.raises(ToleranceError, match="too many different orders of magnitude"),
    ):
        TravelTime(rate, 0.0, 2 * math.pi)


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
