"""Damped motions against Taylor series, closed forms and limits; steady rolling and its modes."""

import json
import math
import os
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mjbeer import Can, Load, Scene, exact, frozen, sliding
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError, ToleranceError
from mjbeer.theory import damped_motion
from mjbeer.theory.can import Damping
from mjbeer.theory.damped_motion import Equations
from mjbeer.theory.equations import accelerations
from tests.support import processes, taylor
from tests.support.scenes import METAL, scenes

# Sines, products and sums of some ten roundings an eps each, in up to a hundred steps; measured
# 6e-14 at most.
ANGLE = 1e-12
# A few roundings.
ROUNDING = 4e-15


def natural(scene: Scene) -> tuple[float, float]:
    """Return a time [s] and a damping [N m s] made of a scene's own sizes."""
    clock = math.sqrt(scene.can.radius / scene.gravity)
    mass = scene.mass + scene.can.inertia / scene.can.radius**2
    return clock, mass * scene.can.radius**2 / clock


def require_taylor(scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float) -> None:
    expected = taylor.motion(scene, time, phi0, phi_dot0)
    found = exact(scene, time, phi0, phi_dot0)
    radius = scene.can.radius
    clock, _ = natural(scene)
    size = max(1.0, float(np.abs(expected[:, 0]).max()), float(np.ptp(expected[:, 1])) / radius)
    rates = np.abs(expected[:, 2:]).max(axis=0) * [clock, clock / radius]
    bound = ANGLE * size * max(1.0, float(rates.max()))

    assert np.abs(found.phi - phi0 - expected[:, 0]).max() < bound
    assert np.abs(found.u - expected[:, 1]).max() < bound * radius
    assert np.abs(found.phi_dot - expected[:, 2]).max() < bound * 10 / clock
    assert np.abs(found.u_dot - expected[:, 3]).max() < bound * 10 / clock * radius


@pytest.mark.slow
@taylor.NEEDED
@settings(max_examples=16, deadline=None, derandomize=True)
@given(
    scenes(),
    st.floats(-3, 3),
    st.floats(-8, 8),
    st.floats(-3, 3),
    st.sampled_from([0.0, 0.03]),
    st.booleans(),
)
def test_any_motion_is_that_of_a_taylor_series(
    scene: Scene, phi0: float, swing: float, power: float, drag: float, law: bool
) -> None:
    """The damping has six decades.

    The stronger it is, the shorter is the time that a Taylor series can follow.
    """
    scene = replace(scene, attachment="sliding")
    clock, unit = natural(scene)
    linear = 10**power * unit
    damping = Damping(linear / 2, 0.3 * linear * clock, 0.1 * linear * clock**2) if law else linear
    scene = replace(scene, damping=damping, drag=drag * scene.mass / scene.can.radius)
    clock, unit = natural(scene)
    share = scene.oscillator.base / unit / clock  # how light the load is to turn
    swing *= min(1.0, math.sqrt(share))
    latest = 6 * clock * min(1.0, share / 10**power)

    require_taylor(scene, latest * np.array([0.0, 0.17, 0.5, 1.0]), phi0, swing / clock)


CASES = {
    "hardly damped": (sliding(damping=1e-6), 1.0, 0.0, 2.0),
    "corners of both": (
        sliding(damping=Damping(1e-4, 1e-5, 1e-6), drag=0.01, can=METAL),
        1.0,
        -40.0,
        1.0,
    ),
    "nothing linear": (sliding(damping=Damping(0, 1e-4, 0), drag=0.01), 1.0, 0.0, 2.0),
    "very stiff": (sliding(damping=1e3, drag=0.01), 1.0, 5.0, 1e-4),
    "uphill": (sliding(-0.5, damping=1e-3, drag=0.001), 0.3, 60.0, 1.0),
}


@pytest.mark.slow
@taylor.NEEDED
@pytest.mark.parametrize(("scene", "phi0", "phi_dot0", "latest"), CASES.values(), ids=CASES.keys())
def test_motion_is_that_of_a_taylor_series(
    scene: Scene, phi0: float, phi_dot0: float, latest: float
) -> None:
    require_taylor(scene, np.linspace(0, latest, 5), phi0, phi_dot0)


def test_rates_have_the_derivatives_that_are_derived() -> None:
    """Central differences have them, away from the corners; measured: 2e-10 of the rates."""
    scene = sliding(0.3, can=METAL, damping=Damping(1e-3, 1e-5, 1e-6), drag=0.05)
    accelerations_of = Equations(scene).accelerations
    # By curvature the differences lose the square of it, and by rounding eps divided by it.
    step = 1e-5
    pick = np.random.default_rng(4407)

    for _ in range(20):
        state = pick.uniform([-3, 5, 5], [3, 20, 20]) * pick.choice([-1, 1], 3)
        if abs(state[1] + state[2]) < 1:  # near the corner of the drag
            continue

        values, jacobian = accelerations_of(*state)

        allowed = 1e-9 * (1 + np.abs(values).max())
        for variable, change in enumerate(step * np.eye(3)):
            ahead, _ = accelerations_of(*(state + change))
            behind, _ = accelerations_of(*(state - change))
            difference = (ahead - behind) / (2 * step)
            assert jacobian[:, variable] == pytest.approx(difference, abs=allowed)


def test_balanced_load_is_two_inertias() -> None:
    """With b = 0 the slip rate decays towards G/k, and the common rate grows."""
    time = np.linspace(0, 3, 7)
    c = 2e-4
    a = METAL.radius
    load = Load(0.3, 0.0, 1e-4)
    scene = Scene(METAL, load, 0.2, damping=c)
    axle = (scene.mass + METAL.inertia / a**2) * a**2
    whole = axle + load.inertia
    push = scene.mass * scene.gravity * a * math.sin(0.2)
    rate = c * (1 / axle + 1 / load.inertia)
    steady = push / axle / rate
    slip = steady + (2 - steady) * np.exp(-rate * time)  # u_dot = 0 and phi_dot = -2 at the start
    slipped = steady * time - (2 - steady) * np.expm1(-rate * time) / rate
    # (axle roll + I phi)/whole
    together = -2 * load.inertia / whole * time + push / whole * time**2 / 2

    motion = exact(scene, time, 1.0, -2.0)

    size = np.abs(motion.phi).max()
    assert motion.phi - 1 == pytest.approx(together - axle / whole * slipped, abs=ROUNDING * size)
    assert motion.u / a == pytest.approx(
        together + load.inertia / whole * slipped, abs=ROUNDING * size
    )
    assert motion.u_dot / a - motion.phi_dot == pytest.approx(slip, rel=ROUNDING)


def test_motion_seen_from_behind() -> None:
    scene = sliding(0.3, can=METAL, damping=Damping(1e-3, 1e-5), drag=0.01)
    time = np.linspace(0, 1, 5)

    motion = exact(scene, time, 1.0, 7.0)
    behind = exact(replace(scene, incline=-0.3), time, -1.0, -7.0)

    assert (behind.phi == -motion.phi).all()
    assert (behind.u == -motion.u).all()


def test_a_damping_of_zeros_is_no_damping() -> None:
    scene = sliding(0.3, can=METAL)
    time = np.linspace(0, 1, 5)

    without = exact(replace(scene, damping=0.0), time, 1.0)
    zeros = exact(replace(scene, damping=Damping()), time, 1.0)

    assert (without.phi == zeros.phi).all()


ON_TOP = sliding(0.0, damping=1e-3)
"""A can on level ground, for whose load the top is an equilibrium; beside it rounding decides."""


def test_a_load_on_top_stays() -> None:
    assert (exact(ON_TOP, [0.0, 9.0], 3 * math.pi).phi == 3 * math.pi).all()


def test_a_time_after_rounding_has_decided_is_refused() -> None:
    with pytest.raises(
        ToleranceError, match=r"phi is not known later than at \d.* s: rounding of start and scene"
    ):
        exact(ON_TOP, 3.0, math.nextafter(math.pi, 0) - 1e-15)


@pytest.mark.slow
def test_beside_the_top_a_time_is_refused_before_rounding_counts_but_not_long_before() -> None:
    """Rounding must not have changed phi by 1e-4, and it grows tenfold in 0.13 s."""
    start = math.pi - 1e-13
    with pytest.raises(ToleranceError):
        exact(ON_TOP, 2.0, start)

    known = 0.0
    for time in np.linspace(0.5, 2.0, 31):
        try:
            motion = exact(ON_TOP, time, start)
        except ToleranceError:
            break
        known = float(time)
        assert abs(exact(ON_TOP, time, start + 4.4e-16).phi[0] - motion.phi[0]) < 1e-4

    assert known > 0.8


@pytest.mark.slow
@taylor.NEEDED
def test_an_axis_that_hardly_moves_keeps_its_digits_under_a_fast_load() -> None:
    """The load is a hundred times as fast, and the axis changes its direction in most turns of it.

    There the drag has a corner, at which a step must end.
    """
    can = Can(0.16774472, 0.60388099, 0.2195832373, 0.00550709956)
    scene = Scene(can, Load(52.892768, 0.0014955071, 0.7378145), 1.39933904, drag=730.309)
    time = np.array([7.7e-4, 3.29e-3])
    expected = taylor.motion(scene, time, -3.19918658, -45535.5727)
    rolled = (expected[:, 1] / can.radius).astype(float)

    found = exact(scene, time, -3.19918658, -45535.5727)

    assert found.u / can.radius == pytest.approx(rolled, abs=ANGLE)


TOO_LONG = [
    pytest.param(1e-6, 0.0, 0.0, id="swings"),
    pytest.param(1e-3, 1e-3, 1e6, id="turns"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("damping", "drag", "phi_dot0"), TOO_LONG)
def test_what_takes_too_long_is_refused_and_until_when_it_can_be_followed(
    damping: float, drag: float, phi_dot0: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Newton's method has a tenth of its corrections here, to use them up sooner."""
    monkeypatch.setattr(damped_motion, "_MOST_CORRECTIONS", 600)
    scene = sliding(damping=damping, drag=drag)

    with pytest.raises(
        ToleranceError, match=r"too many steps: .* it can be followed until"
    ) as refused:
        exact(scene, 1e4, 1.0, phi_dot0)

    until = float(str(refused.value).split()[-2])
    assert np.isfinite(exact(scene, until, 1.0, phi_dot0).phi).all()


@pytest.mark.costly
def test_beer_is_followed_for_forty_seconds() -> None:
    """So long its swings of a radian go on."""
    assert np.isfinite(exact(sliding(damping=1e-6), 40.0, 1.0).phi).all()


@pytest.mark.costly
def test_beer_is_not_followed_for_eighty_seconds() -> None:
    """All corrections are used up soon after forty."""
    with pytest.raises(ToleranceError, match="too many steps"):
        exact(sliding(damping=1e-6), 80.0, 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("c", [3e-5, 1e-1])
def test_what_dies_away_is_followed_to_steady_rolling(c: float) -> None:
    """With the weaker damping there are so many swings at first that as many more are too many."""
    scene = sliding(damping=c)

    motion = exact(scene, 1e4, 1.0)

    assert motion.phi[0] == pytest.approx(scene.terminal_tilt(), abs=ANGLE)
    assert motion.u_dot[0] == pytest.approx(scene.terminal_speed(), rel=ANGLE)


def test_a_correction_that_does_not_square_the_error_is_made_again() -> None:
    """Drag that holds the axis nearly still leaves corners beside the ends of steps.

    There Newton's method is slower: with one correction less, roll is 1.3e-8 rad off. The expected
    value is that of steps with a tenth of the error.
    """
    can = Can(4.30961039959089, 12.92883119877267, 57.396512594314174, 533.0053042100473)
    load = Load(2330.2253124251843, 0.42231642502907396)
    law = Damping(0.0, 1467.6514717634452, 127937.00677462741)
    scene = Scene(can, load, 0.0, damping=law, drag=168099.39765763373)

    assert exact(scene, 6441.820106246289, 1.0).roll == pytest.approx(0.06348692167474, abs=ANGLE)


def balanced() -> list[list[float]]:
    """Return phi and u/a of 200 loads that are nearly balanced and have no inertia, with drag.

    Their phi_dot + w is rounding.
    """
    random = np.random.default_rng(3)
    angles = []
    for _ in range(200):
        can_mass = 10 ** random.uniform(-1, 0)
        load = Load(10 ** random.uniform(-2, -1), 10 ** random.uniform(-12, -8))
        incline = random.uniform(-0.4, 0.4)
        drag = 10 ** random.uniform(-3, 0)
        phi0 = random.uniform(-3, 3)
        can = Can(0.033, 0.099, can_mass, 6e-4 * can_mass)
        motion = exact(Scene(can, load, incline, drag=drag), 1e-5, phi0)
        angles.append([float(motion.phi[0]), float(motion.u[0] / can.radius)])
    return angles


# Four seconds, for a fault that only another order of BLAS's sums could bring back.
@pytest.mark.costly
def test_nearly_balanced_loads_are_followed_alike_on_other_processors() -> None:
    """BLAS sums as on this processor, and in another process as on any of x86.

    Another BLAS sums in one order. The motions were 6e-14 rad apart.
    """
    code = """
import json
from tests.theory.test_damped_motion import balanced
print(json.dumps(balanced()))
"""
    environment = os.environ | {"OPENBLAS_CORETYPE": "Prescott"}

    _, printed, _ = processes.run([], code, environment)

    assert np.abs(np.array(balanced()) - json.loads(printed)).max() < ANGLE


LAWS = {
    "linear": 2e-3,
    "every power": Damping(1e-3, 1e-5, 1e-7),
    "no linear part": Damping(0, 1e-4, 0),
}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
@pytest.mark.parametrize("drag", [0.0, 0.02])
@pytest.mark.parametrize("incline", [0.2, -0.3, 0.0])
def test_nothing_accelerates(law: float | Damping, drag: float, incline: float) -> None:
    scene = sliding(incline, can=METAL, damping=law, drag=drag)

    found = accelerations(scene, scene.terminal_tilt(), 0.0, scene.terminal_speed())

    assert np.array(found) / [scene.gravity, scene.gravity / 0.033] == pytest.approx(
        [0, 0], abs=ROUNDING
    )
    assert scene.equilibrium() == scene.terminal_tilt()
    assert scene.acceleration() == 0


either_can = pytest.mark.parametrize("can", [Can(), METAL], ids=["massless", "metal"])
from_weak_to_strong = pytest.mark.parametrize("c", [1e-9, 1e-3, 1e4])


@either_can
@from_weak_to_strong
def test_tilt_and_largest_incline_are_those_of_the_frozen_can(can: Can, c: float) -> None:
    scene = sliding(can=can, damping=c)

    assert scene.terminal_tilt() == frozen(can=can).equilibrium()
    assert scene.largest_incline() == frozen(can=can).largest_incline()


@either_can
@from_weak_to_strong
def test_speed_and_slip_rate_are_closed_forms(can: Can, c: float) -> None:
    scene = sliding(can=can, damping=c)

    speed = scene.mass * 9.81 * math.sin(scene.incline) * 0.033**2 / c

    assert scene.terminal_speed() == pytest.approx(speed, rel=ROUNDING)
    assert scene.mean_slip_rate() == pytest.approx(speed / 0.033, rel=ROUNDING)


@pytest.mark.parametrize(
    "scene",
    [sliding(damping=1e-3), sliding(can=METAL, damping=Damping(1e-3, 1e-5), drag=0.05)],
    ids=["linear", "all laws"],
)
def test_steady_rolling_ends_at_the_largest_incline(scene: Scene) -> None:
    limit = scene.largest_incline()
    assert limit < math.pi / 2
    above = replace(scene, incline=limit * (1 + 1e-9))

    assert replace(scene, incline=limit * (1 - 1e-9)).terminal_tilt() > 0
    for ask in (
        above.terminal_speed,
        above.terminal_tilt,
        above.modes,
        above.frequency,
        above.equilibrium,
    ):
        with pytest.raises(
            NoEquilibriumError, match=rf"only up to {math.degrees(limit):.1f} degrees"
        ):
            ask()


def test_with_drag_alone_the_load_hangs_on_any_incline() -> None:
    scene = sliding(1.4, drag=0.01)

    assert scene.largest_incline() == math.pi / 2
    assert scene.terminal_tilt() == pytest.approx(-1.4, rel=ROUNDING)


@pytest.mark.slow
@settings(max_examples=60, deadline=None, derandomize=True)
@given(scenes(), st.floats(-3, 3), st.sampled_from([0.0, 1.0, 100.0]), st.floats(-0.94, 0.94))
def test_modes_are_eigenvalues(scene: Scene, power: float, drag: float, steep: float) -> None:
    """They are those of the Jacobian of the accelerations, over six decades of damping."""
    scene = replace(scene, attachment="sliding")
    a = scene.can.radius
    clock, unit = natural(scene)
    scene = replace(scene, damping=10**power * unit, drag=drag * scene.mass / a)
    scene = replace(scene, incline=steep * scene.largest_incline())
    state = np.array([scene.terminal_tilt(), 0.0, scene.terminal_speed()])

    def slope(state: np.ndarray) -> np.ndarray:
        u_ddot, phi_ddot = accelerations(scene, state[0], state[1], state[2])
        return np.array([state[1], float(phi_ddot), float(u_ddot)])

    # The law is linear and the drag a square, of which central differences are exact; phi's is of
    # third order.
    steps = np.array([1e-5, 1e-4 / clock, 0.1 * abs(state[2]) if drag else 1e-4 * a / clock])
    # At rest the drag has a corner, of which central differences see a slope.
    assume(not drag or abs(steep) > 0.05)

    columns = []
    for step in np.diag(steps):
        columns.append((slope(state + step) - slope(state - step)) / (2 * step.sum()))
    jacobian = np.stack(columns, axis=1)
    units = np.array([1.0, 1 / clock, a / clock])
    expected = np.sort_complex(np.linalg.eigvals(jacobian * units / units[:, np.newaxis]))
    largest = np.abs(expected).max()
    # A double root is as uncertain as the square root of the Jacobian's error.
    spread = np.abs(np.subtract.outer(expected, expected))[~np.eye(3, dtype=bool)].min()
    assume(spread > 1e-2 * largest)

    # The differences err by 1e-10 to 1e-8, and roots a hundredth apart magnify that a hundredfold.
    assert np.abs(scene.modes() - expected).max() < 1e-6 * largest


def test_modes_of_strong_damping() -> None:
    """A root is good to some eps of its size.

    A real part that is 1e-7 of that keeps eight digits.
    """
    c = 1e4
    scene = sliding(can=METAL, damping=c)
    a = scene.can.radius
    m = scene.load.mass
    b = scene.load.offset
    tilt = scene.terminal_tilt()
    mass = scene.effective_mass
    moment = m * b * math.cos(tilt)
    inertia = scene.load.inertia + m * b**2
    k = m * b * scene.gravity * math.cos(scene.incline + tilt)
    swinging = mass * inertia - moment**2
    stiff = mass * a**2 + inertia - 2 * moment * a
    decay = a**2 * k * (mass * a - moment) ** 2 / (2 * c * stiff**2)

    together, swing, _ = scene.modes()

    assert together.real == pytest.approx(-c * stiff / (a**2 * swinging), rel=1e-12)
    assert swing.real == pytest.approx(-decay, rel=1e-8)
    assert abs(swing.imag) == pytest.approx(math.sqrt(k / stiff), rel=1e-12)


def test_frequency_with_weak_damping_is_that_of_sliding_beer() -> None:
    """Eq. (10) holds on level ground, where both tilts are 0."""
    weak = sliding(0.0, can=METAL, damping=1e-12)

    assert weak.frequency() == pytest.approx(sliding(0.0, can=METAL).frequency(), rel=1e-12)


def test_frequency_with_strong_damping_is_that_of_frozen_beer() -> None:
    """Eq. (55) as corrected holds on any incline."""
    strong = sliding(0.2, can=METAL, damping=1e4)

    assert strong.frequency() == pytest.approx(frozen(0.2, can=METAL).frequency(), rel=1e-12)


@pytest.mark.slow
def test_mean_slip() -> None:
    """Above the largest incline the load loops.

    The mean of the u-equation over a second gives the mean slip rate, whatever phi does.
    """
    a = 0.033
    c = 1e-2
    scene = sliding(math.radians(30), damping=c)

    motion = exact(scene, [1.0, 2.0], 0.0, 112.7)

    moment = scene.load.mass * scene.load.offset
    momentum = scene.mass * motion.u_dot - moment * np.cos(motion.phi) * motion.phi_dot
    slipped = np.diff(motion.u)[0] / a - np.diff(motion.phi)[0]
    mean = slipped + np.diff(momentum)[0] * a / c
    # It slips by 3 rad, the difference of two angles of 184 rad. Measured: 5e-15.
    assert mean == pytest.approx(scene.mean_slip_rate(), rel=ANGLE)


PLAIN = sliding()
DAMPED = sliding(damping=1e-3)
MIXED = sliding(damping=1e-3, drag=0.01)


@pytest.mark.parametrize(
    "ask", [PLAIN.terminal_speed, PLAIN.terminal_tilt, PLAIN.modes, frozen().terminal_speed]
)
def test_without_damping_there_is_no_steady_rolling(ask: Callable[[], object]) -> None:
    with pytest.raises(ParameterError, match="damping and drag are 0"):
        ask()


@pytest.mark.parametrize(
    "scene", [PLAIN, MIXED, sliding(damping=Damping(1e-3, 1e-5)), frozen()], ids=repr
)
def test_without_linear_damping_alone_there_is_no_mean_slip_rate(scene: Scene) -> None:
    with pytest.raises(
        ParameterError, match=r"no mean slip rate .* linear damping without drag, got"
    ):
        scene.mean_slip_rate()


@pytest.mark.parametrize("scene", [DAMPED, MIXED], ids=["damped", "damped and dragged"])
def test_a_damped_swing_has_no_period(scene: Scene) -> None:
    with pytest.raises(ParameterError, match=r"no period.*scene\.modes\(\) has the rates"):
        scene.period(0.1)


@pytest.mark.parametrize("scene", [DAMPED, MIXED], ids=["damped", "damped and dragged"])
def test_a_damped_can_has_no_largest_swing(scene: Scene) -> None:
    with pytest.raises(ParameterError, match="no largest swing"):
        scene.separatrix()


@pytest.mark.parametrize(
    "scene",
    [Scene(METAL, Load(0.3, 0.0, 1e-4), 0.2, damping=1e-3), replace(DAMPED, gravity=0.0)],
    ids=["balanced", "weightless"],
)
def test_a_load_that_nothing_restores_has_no_steady_rolling(scene: Scene) -> None:
    with pytest.raises(NoEquilibriumError, match="nothing restores the load"):
        scene.terminal_speed()


def test_a_load_that_creeps_has_no_frequency() -> None:
    heavy = Scene(Can.hoop(mass=100.0), Load(0.3, 0.01, 1e-6), 0.0, damping=1e-2)

    with pytest.raises(NoLibrationError, match="the load creeps back without a swing"):
        heavy.frequency()
