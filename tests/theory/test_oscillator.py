"""J, V and what follows from them, against the Lagrangian of the whole system, and V's differences in 40 digits."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import MPContext

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.exceptions import NoEquilibriumError
from mjbeer.theory.oscillator import TURN, Crest, reduced, sinc, sinc_gap
from tests.support import taylor
from tests.support.scenes import METAL, SCENES, scenes

# J is a sum of positive terms and V' a difference of two, each of a few roundings; measured: 1e-15.
ROUNDING = 3e-15
# Angles are good to a few eps, and an equilibrium near the steepest incline to the root of that.
ANGLE = 5e-15

# Sums of three terms of which one may be half of another, of a few roundings each. Measured: 2e-15.
DIFFERENCE = 5e-15

mp = MPContext()
mp.dps = 30
mpf = Any  # numbers of that context

PARAMETERS = RADIUS, CAN, CAN_INERTIA, LOAD, OFFSET, INERTIA, GRAVITY, INCLINE = sp.symbols(
    "a m_can I_can m b I_cm g alpha"
)
PHI, RATE = sp.symbols("phi phi_dot")


@cache
def reduced_form(attachment: str) -> tuple[sp.Expr, sp.Expr]:
    """J and V' of the paper's coordinates (Fig. 3), the axis eliminated by its own equation or by rolling (50)."""
    t = sp.Symbol("t")
    phi, u = (each(t) for each in sp.symbols("phi u", cls=sp.Function))
    if attachment == "frozen":
        u = RADIUS * phi
    along, away = u - OFFSET * sp.sin(phi), -OFFSET * sp.cos(phi)
    speed = along.diff(t) ** 2 + away.diff(t) ** 2
    roll = u.diff(t) / RADIUS
    kinetic = (CAN * u.diff(t) ** 2 + CAN_INERTIA * roll**2 + LOAD * speed + INERTIA * phi.diff(t) ** 2) / 2
    height = away * sp.cos(INCLINE) - along * sp.sin(INCLINE)
    lagrangian = kinetic - GRAVITY * (LOAD * height - CAN * u * sp.sin(INCLINE))

    def equation(coordinate: sp.Expr) -> sp.Expr:
        return lagrangian.diff(coordinate.diff(t)).diff(t) - lagrangian.diff(coordinate)

    motion = equation(phi)
    if attachment == "sliding":
        motion = motion.subs(u.diff(t, 2), sp.solve(equation(u), u.diff(t, 2))[0])
    motion = sp.expand(motion.doit()).subs(phi.diff(t, 2), sp.Symbol("phi_ddot"))
    motion = motion.subs(phi.diff(t), RATE).subs(phi, PHI)
    inertia, rest = motion.coeff("phi_ddot"), motion.coeff("phi_ddot", 0)
    assert sp.simplify(rest.coeff(RATE, 2) - inertia.diff(PHI) / 2) == 0  # so 1/2 J phi_dot^2 + V is conserved
    return inertia, rest.coeff(RATE, 0)


@cache
def compiled(attachment: str) -> tuple[Callable[..., mpf], ...]:
    inertia, pull = reduced_form(attachment)
    names = {"sin": mp.sin, "cos": mp.cos}
    forms = (inertia, inertia.diff(PHI), pull, sp.integrate(pull, PHI))
    return tuple(sp.lambdify([*PARAMETERS, PHI], form, modules=[names]) for form in forms)


def values(scene: Scene, phi: float) -> tuple[mpf, ...]:
    """J, J', V' and V, up to a constant, in 30 digits at the very doubles of the scene."""
    can, load = scene.can, scene.load
    numbers = (can.radius, can.mass, can.inertia, load.mass, load.offset, load.inertia, scene.gravity, scene.incline)
    exact = [mp.mpf(number) for number in (*numbers, phi)]
    return tuple(form(*exact) for form in compiled(scene.attachment))


@pytest.mark.slow
@settings(max_examples=100, deadline=None, derandomize=True)
@given(scenes(), st.floats(-4, 4), st.floats(-5, 5))
def test_reduction_is_the_lagrangian_s(scene: Scene, phi: float, swing: float) -> None:
    form = scene.oscillator
    inertia, steepening, pull, potential = values(scene, phi)
    torque = form.depth + abs(form.slope)
    rate = swing * math.sqrt(torque / form.base)
    assert abs(form.inertia(phi) - inertia) <= ROUNDING * inertia
    acceleration = -(pull + steepening * mp.mpf(rate) ** 2 / 2) / inertia
    scale = (torque + (form.chord + form.swing) * rate**2) / inertia
    assert abs(form.acceleration(phi, rate) - acceleration) <= ROUNDING * scale
    # V only ever appears as a difference.
    fall = values(scene, 0.5)[3] - potential
    known = taylor.letters(scene)  # of the other tests' witnesses; 30 digits less those that a difference loses
    assert abs(taylor.inertia(known, mp.mpf(phi)) - inertia) <= 1e-20 * inertia
    assert abs(taylor.fall(known, mp.mpf(0.5), mp.mpf(phi)) - fall) <= 1e-20 * torque * (1 + abs(phi))
    assert abs(form.drop(phi, 0.5) - fall) <= ROUNDING * torque * (1 + abs(phi))


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
def test_equilibrium_and_frequency(scene: Scene) -> None:
    phi = scene.equilibrium()
    inertia, _, pull, _ = values(scene, phi)
    assert abs(pull) < ANGLE * scene.oscillator.depth
    stiffness = mp.diff(lambda x: values(scene, x)[2], phi)
    assert abs(scene.frequency() / mp.sqrt(stiffness / inertia) - 1) < ANGLE


def test_steepest_incline() -> None:
    limit = frozen().largest_incline()
    assert limit == pytest.approx(math.asin(4 / (3 * math.pi)), rel=ANGLE)
    assert math.degrees(limit) == pytest.approx(25.1, abs=0.05)
    assert sliding().largest_incline() == math.pi / 2
    for sign in (1, -1):
        # There sin(alpha + phi) is 1, and 1 - x^2/2 tells angles apart only to the root of the distance.
        assert frozen(sign * limit * (1 - 1e-8)).equilibrium() == pytest.approx(
            sign * (math.pi / 2 - limit), abs=2 * math.sqrt(1e-8)
        )
        for ask in (Scene.equilibrium, Scene.frequency, Scene.separatrix, lambda scene: scene.period(0.1)):
            with pytest.raises(NoEquilibriumError, match=r"incline of -?26 degrees: .* only up to 25\.1 degrees"):
                ask(frozen(sign * math.radians(26)))


@pytest.mark.parametrize("scene", [sliding(fill=1.0), frozen(fill=1.0), sliding(gravity=0.0), frozen(gravity=0.0)])
def test_nothing_restores(scene: Scene) -> None:
    with pytest.raises(NoEquilibriumError, match=r"balanced about the axis \(offset 0 m\) or gravity is 0 m/s\^2"):
        scene.equilibrium()


@pytest.mark.parametrize("scene", [frozen(), frozen(0.01, can=METAL), sliding(can=METAL), pendulum(0.4)])
def test_separatrix_and_mirror(scene: Scene) -> None:
    low, high = scene.separatrix()
    top = mp.findroot(lambda x: values(scene, x)[2], high)
    assert abs(high - top) < ANGLE
    if scene.attachment == "sliding":
        assert abs(low - (top - 2 * mp.pi)) < ANGLE
    else:
        height = values(scene, top)[3]
        assert abs(low - mp.findroot(lambda x: values(scene, x)[3] - height, low)) < ANGLE
    behind = replace(scene, incline=-scene.incline)
    assert behind.separatrix() == (-high, -low)
    assert (behind.equilibrium(), behind.frequency()) == (-scene.equilibrium(), scene.frequency())


slopes = st.one_of(st.just(0.0), st.floats(-300, 0).map(lambda power: 10**power), st.floats(0, 3))
sizes = st.floats(-30, 0).map(lambda power: 10**power)


def below(crest: Crest, x: Any) -> Any:
    """V(crest) - V(crest + x), from the torque that defines the crest, integrated by hand."""
    x = mp.mpf(x)
    return (crest.excess + crest.ramp) * x - crest.ramp * mp.sin(x) + mp.mpf(crest.curvature) * (1 - mp.cos(x))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(slopes, sizes, st.sampled_from([-1, 1]), st.floats(0, 1))
def test_heights_and_mean_torque(slope: float, size: float, sign: int, share: float) -> None:
    """Every term of the mean torque is positive as long as the torque is downhill: up to the next equilibrium."""
    crest, x = Crest(slope, 1.0, -0.2), sign * 3 * size
    turn, length = size * (math.pi - crest.well / 2), share * (math.pi - crest.well / 2)
    with mp.workdps(400):  # 1e-300 of a slope beside 1e-60 of a cosine
        scale = (crest.excess + crest.ramp * x**2) * abs(x) + crest.curvature * x**2
        assert abs(crest.below(x) - below(crest, x)) <= DIFFERENCE * scale
        torque = crest.excess + crest.ramp * (1 - mp.cos(mp.mpf(x))) + crest.curvature * mp.sin(mp.mpf(x))
        scale = crest.excess + crest.ramp * x**2 + crest.curvature * abs(x)
        assert abs(crest.torque(x) - torque) <= DIFFERENCE * scale
        mean = (below(crest, mp.mpf(turn) + length) - below(crest, turn)) / length if length else crest.torque(turn)
        assert abs(crest.mean_torque(turn, length) - mean) <= 2 * DIFFERENCE * mean


@pytest.mark.parametrize("slope", [0.0, 1e-12, 0.99, 2.0])
@pytest.mark.parametrize("angle", [0.3, math.pi, -3.0, 40.0, -1e4, 12345 * math.pi])
def test_place(slope: float, angle: float) -> None:
    """Both distances are those of the angle, and lie in the well and in the turn that belong together."""
    crest = Crest(slope, 1.0, -0.1)
    past, from_rest = crest.place(angle)
    with mp.workdps(60):
        assert abs(mp.sin(mp.mpf(angle)) - mp.sin(reduced(angle))) <= 4e-16 * abs(reduced(angle))
        for distance, origin in ((past, mp.pi + crest.offset), (from_rest, mp.mpf(crest.rest))):
            turns = (mp.mpf(angle) - origin - distance) / (2 * mp.pi)
            assert abs(turns - mp.nint(turns)) < DIFFERENCE
        ahead = below(crest, past if past < 0 else mp.mpf(from_rest) - crest.well)
    if slope < 1:
        assert abs(crest.below_ahead(past, from_rest) - ahead) < 4 * DIFFERENCE
    assert crest.begins <= past <= crest.begins + TURN
    assert from_rest == pytest.approx(past + crest.well - (TURN if past >= 0 else 0), abs=1e-15)


@pytest.mark.parametrize("x", [0.0, 1e-100, 1e-8, 0.999, 1.001, 6.0])
def test_sinc(x: float) -> None:
    with mp.workdps(700):
        exact = mp.sin(mp.mpf(x)) / x if x else mp.mpf(1)
        assert abs(sinc(x) - exact) <= 3e-16
        assert abs(sinc_gap(x) - (1 - exact)) <= 1e-15 * (1 - exact)
