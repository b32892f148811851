"""Appendix A of the paper, eqs. (50)-(55) and sec. A.1 to A.3: beer frozen to a massless can.

In its equations the load has I_axis = m a^2/2, as a half cylinder has, and any b.
"""

import math
from functools import cache, partial

import mujoco
import numpy as np
from scipy.optimize import brentq

from mjbeer.model.build import build
from mjbeer.paper.claim import Bound, Claim, Limit, Misprint, Observation, Witness
from mjbeer.paper.witness import (
    CONTACT,
    DRIFT,
    EQUALITY,
    EXACT,
    FOOTNOTE_8,
    HELD,
    ROLL_DOWN,
    SMALL,
    balanced,
    footnote_scene,
    oscillate,
    simulated,
)
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.paper_scenes import frozen
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import exact

_CREEP = 1e-3
"""Slip in a second [radii] above which a can counts as slipping; one that holds creeps by 1e-7."""
_EQ_52 = (
    "3*a**2/2*phi_ddot - 2*a*b*cos(phi)*phi_ddot + {}a*b*sin(phi)*phi_dot**2 "
    "- g*a*sin(alpha) + g*b*sin(theta)"
)
"""Eq. (52); footnote 8 prints it with a factor of 0.5 in the term with phi_dot^2."""
PRINTED_8 = _EQ_52.format("0.5*")
EQ_55 = "g*b*cos(alpha + rest)/(3*a**2/2 - {}*a*b*cos(rest))"
"""omega^2 [1/s^2] by eq. (55) with the factor 2; the paper prints it with 1."""
_SINE_54 = "turn*cos(alpha + rest) + (sin(alpha + rest) - sin(alpha + rest + turn))"
"""The change of sin(alpha + phi) in a `turn` from `rest`: to first order, less the whole change."""


def equilibrium_53(scene: Scene) -> float:
    """Return phi_0 [rad] by eq. (53), extended to a can with mass.

    That is sin(alpha + phi_0) = (m + m_can) a sin(alpha) / (m b).

    Raises:
      ValueError: if the incline is too steep for an equilibrium.
    """
    sine = scene.mass * scene.can.radius * math.sin(scene.incline) / scene.load.moment
    return math.asin(sine) - scene.incline


def _acceleration(scene: Scene, phi: float) -> float:
    """Return MuJoCo's phi_ddot [rad/s^2] of a can that is let go at `phi` [rad]."""
    model = build(scene, "equality", integrator="DOP853")
    data = mujoco.MjData(model)
    data.joint("slide").qpos[0] = scene.can.radius * phi
    data.joint("roll").qpos[0] = phi
    mujoco.mj_forward(model, data)
    return float(data.joint("roll").qacc[0])


@cache
def _rest() -> Observation:
    """Return `rest` [rad], the angle from 0 to 60 degrees at which MuJoCo's acceleration is 0."""
    scene = frozen()
    rest = brentq(lambda phi: _acceleration(scene, phi), 0.0, math.pi / 3, xtol=1e-15)
    return Observation.of(scene, rest=float(rest))


@cache
def _steepest_incline() -> float:
    """Return the incline [rad] above which MuJoCo's can rolls off from any angle."""

    def largest_acceleration(incline: float) -> float:
        """Return the acceleration where the centre of mass is farthest uphill of the axis."""
        return _acceleration(frozen(incline), math.pi / 2 - incline)

    return float(brentq(largest_acceleration, 0.2, 0.8, xtol=1e-15))


@cache
def _least_friction() -> Observation:
    """Return the least friction coefficient `mu` with which the can stays for a second."""
    scene = frozen()
    low = 0.1
    high = 0.3
    while high - low > 1e-4:
        middle = (low + high) / 2
        run = simulate(scene, 1.0, scene.equilibrium(), rolling="contact", friction=middle)
        if np.abs(run.slip).max() > _CREEP * scene.can.radius:
            low = middle
        else:
            high = middle
    return Observation.of(scene, mu=high)


@cache
def _mean_acceleration(offset_factor: float = 1.0) -> Observation:
    """Return the axis's mean `acceleration` [m/s^2] in a roll-down, with b multiplied by a factor.

    The can starts at phi = pi. The mean is from the last whole turn that ends before 8 s to the
    last one that ends before 16 s. `turn` has the angles of an even turn [rad], for the mean of
    sqrt(J).
    """
    scene = footnote_scene(offset_factor)
    run = simulate(scene, 16, math.pi, rolling="equality", integrator="DOP853")
    angles = []
    times = []
    for latest in (8.0, 16.0):
        turned = float(np.interp(latest, run.time, run.phi)) - math.pi
        whole_turns = 2 * math.pi * math.floor(turned / (2 * math.pi))
        angles.append(whole_turns)
        times.append(float(np.interp(math.pi + whole_turns, run.phi, run.time)))
    # At a constant angular acceleration A the angle is A t^2/2: its square root grows evenly.
    growth = (math.sqrt(angles[1]) - math.sqrt(angles[0])) / (times[1] - times[0])
    return Observation.of(
        scene, acceleration=2 * growth**2 * scene.can.radius, turn=2 * np.pi * np.arange(64) / 64
    )


def _beside_theory() -> Observation:
    """Return the roll-down of footnote 8, with phi by exact theory as `theory` [rad]."""
    observed = FOOTNOTE_8.observe()
    return Observation(**vars(observed), theory=exact(footnote_scene(), observed.time, math.pi).phi)


@cache
def _lift_off_time() -> Observation:
    """Return when a can that rolls down in contact lifts off [s].

    `lifts` is when it is 1e-6 radii above the incline, `theory` when N = 0 by exact theory.
    """
    run = simulate(footnote_scene(), 0.9, math.pi, rolling="contact", timestep=1e-4, friction=1e3)
    lifts = float(run.time[np.argmax(run.lift > 1e-6 * run.scene.can.radius)])
    rolling = exact(run.scene, np.linspace(0, 1, 10_001), math.pi)
    return Observation.of(run.scene, lifts=lifts, theory=rolling.rolls_until())


_TOUCHES = simulated(
    frozen(), 0.0, 0.5, rolling="contact", samples=51, integrator="RK4", timestep=1e-3
)
_TAYLOR = Witness(
    "Taylor's series",
    lambda: Observation.of(frozen(), rest=frozen().equilibrium(), turn=SMALL),
)
_BALANCES = Witness(EQUALITY, _rest)
_STEEPEST = Witness(EQUALITY, _steepest_incline)
_SMALL_SWING = Witness(
    EQUALITY,
    partial(oscillate, frozen(), frozen().equilibrium() + SMALL, rolling="equality"),
)
_AMPLITUDE = Bound(1e-6, "the amplitude: 3e-7")
_SLIPS = Bound(1e-6, "the can slips a little in its soft contact")

CLAIMS = (
    Claim("(50)", "u = a phi", _TOUCHES, _SLIPS, residual="u - a*phi"),
    Claim("(50)", "s = a phi - b sin(phi)", _TOUCHES, _SLIPS, residual="s - a*phi + b*sin(phi)"),
    Claim(
        "(51)",
        "T",
        ROLL_DOWN,
        HELD,
        residual="3*m*a**2/4*phi_dot**2 - m*a*b*cos(phi)*phi_dot**2 - kinetic",
    ),
    Claim(
        "(51)",
        "V",
        ROLL_DOWN,
        EXACT,
        residual="-m*g*a*phi*sin(alpha) - m*g*b*cos(theta) - potential",
    ),
    Claim("(52)", "equation of motion of phi", ROLL_DOWN, HELD, residual=_EQ_52.format("")),
    Claim(
        "footnote 8",
        "the equation as typed in: 3(1) sin(x) (x')^2; printed 3(0.5)",
        FOOTNOTE_8,
        HELD,
        residual=_EQ_52.format(""),
        misprint=Misprint(
            0.32,
            wrong=PRINTED_8,
            about="Frozen beer: the term ab sin φ φ̇² as typed in, with a = 3 cm and b = 1 cm",
            latex=r"3(<0.5|1>)\sin(x)\,(x')^2",
        ),
        quote="3(0.5) sin(x)(x')² …, which corresponds to a = 3 cm, b = 1 cm",
    ),
    Claim(
        "(53)",
        "angle at which nothing turns the can",
        _BALANCES,
        EXACT,
        residual="sin(alpha + rest) - a*sin(alpha)/b",
    ),
    Claim(
        "(53)",
        "there the centre of mass is above the contact",
        _BALANCES,
        EXACT,
        residual="b*sin(alpha + rest) - a*sin(alpha)",
        quote="the center of mass of the half cylinder is directly above the point of contact",
    ),
    Claim(
        "sec. A.1",
        "steepest incline with an equilibrium, sin(alpha) = 4/(3 pi)",
        _STEEPEST,
        EXACT,
        residual="sin(observed) - 4/(3*pi)",
        quote="This equilibrium exists only for sin α ≤ 4/3π",
    ),
    Claim(
        "sec. A.1",
        "that is 25 degrees",
        _STEEPEST,
        Bound(2e-2, "half a unit of the last digit"),
        residual="25 - degrees(observed)",
        quote="for α ≤ 25°",
    ),
    Claim(
        "footnote 7",
        "least friction coefficient at which the can stays: tan(alpha)",
        Witness(CONTACT, _least_friction),
        Bound(1e-3, "bisection, and what counts as slipping"),
        residual="mu - tan(alpha)",
        quote="only if the coefficient μ of static friction is larger than tan α",
    ),
    Claim(
        "(54)",
        "change of cos(phi) to first order",
        _TAYLOR,
        Bound(3e-3, "the next order: swing cot(phi_0)/2 = 2e-3"),
        residual="turn*sin(rest) + (cos(rest + turn) - cos(rest))",
    ),
    Claim(
        "(54)",
        "change of sin(alpha + phi) to first order: its sign",
        _TAYLOR,
        Bound(3e-4, "the next order: swing tan(alpha + phi_0)/2 = 2e-4"),
        residual=_SINE_54,
        misprint=Misprint(
            2.0,
            wrong=f"-{_SINE_54}",
            about="Frozen beer: the sine near the equilibrium",
            latex=r"\sin(\alpha+\varphi)\approx\sin(\alpha+\varphi_0)\\ "
            r"{}<-|+>\,\epsilon\cos\omega t\,\cos(\alpha+\varphi_0)",
        ),
    ),
    Claim(
        "(55)",
        "omega of small oscillations: 2ab cos(phi_0); printed ab cos(phi_0)",
        _SMALL_SWING,
        _AMPLITUDE,
        residual=f"sqrt({EQ_55.format(2)}) - omega",
        misprint=Misprint(
            0.21,
            wrong=f"sqrt({EQ_55.format(1)}) - omega",
            about="Frozen beer: frequency of small swings",
            latex=r"\omega^2=\frac{gb\cos(\alpha+\varphi_0)}{\frac{3a^2}{2}-<|2>ab\cos\varphi_0}",
        ),
    ),
    Claim(
        "sec. A.2",
        "from phi = 0 the can rocks with omega of (55): there, and within, at 1e-3 rad",
        _SMALL_SWING,
        _AMPLITUDE,
        residual=f"sqrt({EQ_55.format(2)}) - omega",
        limit=Limit(0.0154, partial(oscillate, frozen(), 0.0, rolling="equality")),
        quote="it does not roll, but executes oscillations with frequency approximately given by "
        "eq. (55)",
    ),
    Claim(
        "footnote 9",
        "b = 0: phi = g sin(alpha) t^2/(3a)",
        simulated(balanced(0.5), 0.0),
        Bound(1e-7, DRIFT),
        residual="phi - g*sin(alpha)*time**2/(3*a)",
        quote="φ = g sin αt²/3a",
    ),
    Claim(
        "sec. A.3",
        "mean acceleration of a long roll-down (2/3) g sin(alpha): b = a/3; within, b = a/300",
        Witness(EQUALITY, partial(_mean_acceleration, 0.01)),
        Bound(1e-3, "the start, of whose waves 1e-4 is left between 8 s and 16 s"),
        residual="acceleration - 2*g*sin(alpha)/3",
        limit=Limit(0.0264, _mean_acceleration),
        quote="A solid cylinder that rolls without slipping would have acceleration (2/3)g sin α "
        "down the incline",
    ),
    Claim(
        "sec. A.3",
        "the same by exact theory: that times (3 m a^2/2)/(mean of sqrt(J))^2",
        Witness(EQUALITY, _mean_acceleration),
        Bound(1e-3, "the start, as above"),
        residual="acceleration - 2*g*sin(alpha)/3/mean(sqrt(1 - 4*b/(3*a)*cos(turn)))**2",
        quote="Angle φ varies almost quadratically in time, with a small oscillation about this",
    ),
    Claim(
        "figure of A.3",
        "phi(t) of the roll-down from phi = pi, a = 3 cm, b = 1 cm",
        Witness(EQUALITY, _beside_theory),
        Bound(1e-7, DRIFT),
        residual="phi - theory",
        quote="for a = 3 cm, b = 1 cm, α = 10°, φ(0) = π and φ̇(0) = 0",
    ),
    Claim(
        "figure of A.3",
        "time at which N = 0, after which a real can is not on the incline: 0.848 s",
        Witness(CONTACT, _lift_off_time),
        Bound(4e-3, "the soft contact, and that the can slips a moment before"),
        residual="lifts - theory",
        quote="A rigid can that is somehow constrained to roll without slipping cannot hop",
    ),
)
