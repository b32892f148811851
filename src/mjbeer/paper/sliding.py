"""Section 2 of the paper, equations (1)-(24): beer that slides without friction in a massless can."""

import math
from functools import cache, partial
from typing import Any

import numpy as np

from mjbeer.paper.claim import Bound, Claim, Limit, Misprint, Motion, SceneConstants, Terms, Witness
from mjbeer.paper.witness import (
    DRIFT,
    EQUALITY,
    EXACT,
    NARROW,
    REDUCED,
    SMALL,
    SWING,
    WIDE,
    balanced,
    frequency,
    metal,
    resting,
    simulate_motion,
    swing,
)
from mjbeer.theory.can import Can
from mjbeer.theory.scene import Scene
from mjbeer.theory.scenes import sliding


def eq_6(c: SceneConstants) -> Any:
    """Return omega^2 = m b g cos(alpha) / I_cm [1/s^2]."""
    return c.m * c.b * c.g * c.cos_alpha / c.inertia


def eq_10(c: SceneConstants, pi: Any) -> Any:
    """Return omega^2 = 24 pi g cos(alpha) / ((9 pi^2 - 32) a) [1/s^2] of a half can; corrected."""
    return printed_10(c, pi) / c.a


def printed_10(c: SceneConstants, pi: Any) -> Any:
    """Return 24 pi g cos(alpha) / (9 pi^2 - 32) [m/s^2]: the misprint lacks the radius."""
    return 24 * pi * c.g * c.cos_alpha / (9 * pi**2 - 32)


def frequency_10(scene: Scene) -> float:
    """Return omega [rad/s] by eq. (10), corrected."""
    return math.sqrt(eq_10(SceneConstants.of(scene), math.pi))


def eq_24(c: SceneConstants) -> Any:
    """Return omega^2 = 2 b g cos(alpha) / (a^2 - 2 b^2) [1/s^2] of a half can; also the first form of eq. (10)."""
    return 2 * c.b * c.g * c.cos_alpha / (c.a**2 - 2 * c.b**2)


def kinetic_11(q: Motion) -> Terms:
    """Return the terms of T [J]; they are those of the beer in any can, the second line of eq. (44)."""
    return q.m * q.s_dot**2 / 2, q.m * q.b**2 * q.sin_phi**2 * q.phi_dot**2 / 2, q.inertia * q.phi_dot**2 / 2


def potential_14(q: Motion) -> Terms:
    """Return the terms of V = -m g (s sin(alpha) + b cos(alpha) cos(phi)) [J], which (45) has too."""
    return -q.m * q.g * q.s * q.sin_alpha, -q.m * q.g * q.b * q.cos_alpha * q.cos_phi


def potential_17(q: Motion) -> Terms:
    """Return the terms of the same V [J] in u and theta, as in eqs. (17), (20) and (45)."""
    return -q.m * q.g * q.u * q.sin_alpha, -q.m * q.g * q.b * q.cos_theta


def eq_19(q: Motion, pull: float) -> Terms:
    """Return the terms of (a^2/2) phi_ddot - b cos(phi) u_ddot = -`pull` b sin(alpha + phi); `pull` should be g."""
    return q.a**2 / 2 * q.phi_ddot, -q.b * q.cos_phi * q.u_ddot, pull * q.b * q.sin_theta


def _torque(q: Motion) -> float:
    """Return the torque of gravity about C [N m], with the lever arm u - s of MuJoCo's positions."""
    return -q.m * q.g * q.cos_alpha * (q.u - q.s)


def _turns_about_c(q: Motion) -> Terms:
    """Return the terms [m/s] of: the centre of mass moves across the incline at phi_dot (u - s)."""
    return q.across_dot, -q.phi_dot * (q.u - q.s)


def _turns_about_c_of_the_caption(q: Motion) -> Terms:
    """Return the same, and the velocity along the incline that turning about a C lower by b tan(phi) sin(phi) adds."""
    return *_turns_about_c(q), -q.phi_dot * q.b * q.sin_phi**2 / q.cos_phi


@cache
def _in_a_light_can() -> Motion:
    """Return a swing in a can of a ten-thousandth of the metal can's mass."""
    return simulate_motion(sliding(can=Can.sheet_metal(thickness=1e-8)), "equality", 1.0, 2.0)


@cache
def _beer() -> SceneConstants:
    return SceneConstants.of(sliding())


_SMALL_SWING = Witness(REDUCED, lambda: frequency(sliding(), SMALL))

# fmt: off
CLAIMS = (
    Claim("(1)", "s(t) from rest", SWING, Bound(1e-12, "rounding of DOP853"),
        lambda q: (q.s, -q.g * q.sin_alpha * q.time**2 / 2)),
    Claim("footnote 1",
        "no friction between can and incline: beyond, the metal can; within, one of a ten-thousandth of it",
        Witness(EQUALITY, _in_a_light_can), Bound(1e-4, "the can's share of the mass"),
        lambda q: (q.m * q.g * q.sin_alpha, -q.friction, -q.m * q.g * q.sin_alpha),  # the error: a share of the weight
        limit=Limit(0.25, metal),
        quote="in the limit of a massless can, the force of friction is zero, so we neglect friction"),
    *(Claim("footnote 2", f"a cylinder of inertia {k:g} m a^2 has g sin(alpha)/(1 + k)",
        Witness(EQUALITY, lambda k=k: resting(balanced(k))), Bound(1e-7, DRIFT),
        lambda q, k=k: (q.u_ddot, -q.g * q.sin_alpha / (1 + k)),
        quote="a uniform cylinder with moment of inertia I = kma² about its axis has acceleration g sin α/(1 + k)")
      for k in (1.0, 0.5)),
    Claim("Fig. 1", "at phi = 0 the surface stays parallel to the incline, and u = g sin(alpha) t^2/2",
        Witness(REDUCED, lambda: resting(sliding(), "reduced")), EXACT,
        lambda q: (q.u, -q.g * q.sin_alpha * q.time**2 / 2, q.phi),
        quote="slide down a frictionless incline of angle α without oscillation if its flat side is parallel to the "
        "incline"),
    Claim("footnote 6", "sliding beer can be at rest: beyond, at 10 degrees; within, on level ground",
        Witness(REDUCED, partial(swing, incline=0.0)), EXACT, lambda q: (q.g, q.s_ddot, -q.g),
        limit=Limit(0.174, swing), quote="a stable equilibrium exists only for α = 0"),
    Claim("(2)", "torque about the instantaneous centre", SWING, EXACT, lambda q: (
        (q.inertia + q.m * q.b**2 * q.sin_phi**2) * q.phi_ddot,
        q.m * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        -_torque(q))),
    Claim("Fig. 2",
        "C moves with the centre of mass along the incline; the caption puts it on a line along the surface",
        WIDE, EXACT, _turns_about_c,
        Misprint(0.93, _turns_about_c_of_the_caption,
            "The line through the centre of mass on which the instantaneous centre C lies",
            r"<\text{along the flat surface of the beer}|\text{along the incline}>"),
        quote="the line parallel to the flat surface that passes through the center of mass"),
    Claim("(3)", "I_C, exact form", SWING, EXACT, lambda q: (
        q.inertia * q.phi_dot**2 / 2,
        q.m * q.b**2 * q.sin_phi**2 * q.phi_dot**2 / 2,
        q.m * q.s_dot**2 / 2 - q.kinetic)),
    Claim("(3)", "I_C = I_cm: beyond, a swing of 1 rad; within, of 1e-3 rad",
        NARROW, Bound(1e-6, "the amplitude: (m b^2/I_cm) phi^2 = 6e-7"),
        lambda q: (q.inertia * q.phi_dot**2 / 2, q.m * q.s_dot**2 / 2 - q.kinetic), limit=Limit(0.095, WIDE.see)),
    Claim("(4)", "torque about C, exact form", SWING, EXACT,
        lambda q: (-q.m * q.g * q.cos_alpha * q.b * q.sin_phi, -_torque(q))),
    Claim("(4)", "torque about C, linear form: its sign", NARROW, Bound(3e-7, "the amplitude: phi^2/6 = 1.7e-7"),
        lambda q: (-q.m * q.b * q.g * q.cos_alpha * q.phi, -_torque(q)),
        Misprint(2.0, lambda q: (q.m * q.b * q.g * q.cos_alpha * q.phi, -_torque(q)),
            "Torque about the instantaneous centre, for small angles",
            r"\tau_C\approx<+|->\,mbg\cos\alpha\,\varphi")),
    Claim("(5), (23)", "linear equation of motion: beyond, a swing of 1 rad; within, of 1e-3 rad",
        NARROW, Bound(1e-6, "the amplitude: (1/6 + m b^2/I_cm) phi^2 = 7e-7"),
        lambda q: (q.inertia * q.phi_ddot, q.m * q.b * q.g * q.cos_alpha * q.phi), limit=Limit(0.40, WIDE.see)),
    Claim("(6), (24)", "omega of small oscillations: beyond, a swing of 1 rad; within, of 1e-3 rad",
        _SMALL_SWING, Bound(3e-7, "the amplitude: 2e-7"),
        lambda omega: (np.sqrt([eq_6(_beer()), eq_24(_beer())]), -omega),
        limit=Limit(0.15, lambda: frequency(sliding(), 1.0))),
    Claim("(10)", "omega^2, middle form: it lacks 1/a (in SI units)", _SMALL_SWING, Bound(6e-7, "the amplitude: 4e-7"),
        lambda omega: (eq_10(_beer(), math.pi), -(omega**2)),
        Misprint(0.967, lambda omega: (printed_10(_beer(), math.pi), -(omega**2)),
            "Frequency of small swings of a half-full can",
            r"\omega^2=\frac{24\pi g\cos\alpha}{9\pi^2-32}<|\cdot\frac1a>")),
    Claim("(10)", "omega^2 = 1.33 g cos(alpha)/a", _SMALL_SWING, Bound(3.8e-3, "half a unit of the last digit"),
        lambda omega: (1.33 * _beer().g * _beer().cos_alpha / _beer().a, -(omega**2))),
    Claim("(11)", "T", SWING, EXACT, lambda q: (*kinetic_11(q), -q.kinetic)),
    Claim("(12)", "u = s + b sin(phi)", SWING, EXACT, lambda q: (q.u, -q.s, -q.b * q.sin_phi)),
    Claim("(12), Fig. 3", "theta = alpha + phi", SWING, EXACT, lambda q: (q.theta, -q.phi, -q.alpha)),
    Claim("(13)", "z in u and theta", SWING, EXACT, lambda q: (-q.u * q.sin_alpha, -q.b * q.cos_theta, -q.height)),
    Claim("(13)", "z in s and phi", SWING, EXACT,
        lambda q: (-q.s * q.sin_alpha, -q.b * q.cos_alpha * q.cos_phi, -q.height)),
    Claim("(14)", "V, its first form: -mgz for +mgz", SWING, EXACT, lambda q: (*potential_14(q), -q.potential),
        Misprint(1.92, lambda q: (*(-each for each in potential_14(q)), -q.potential),
            "Potential energy of the beer", "V=<-|+>mgz")),
    Claim("(15)", "s_ddot", SWING, EXACT, lambda q: (q.s_ddot, -q.g * q.sin_alpha)),
    Claim("(16)", "equation of motion of phi", SWING, EXACT, lambda q: (
        q.m * q.b**2 * q.sin_phi**2 * q.phi_ddot,
        q.inertia * q.phi_ddot,
        q.m * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        q.m * q.b * q.g * q.cos_alpha * q.sin_phi)),
    Claim("(17), (20)", "T", SWING, EXACT, lambda q: (
        q.m / 2 * q.u_dot**2,
        -q.m * q.b * q.cos_phi * q.u_dot * q.phi_dot,
        q.m * q.a**2 / 4 * q.phi_dot**2,
        -q.kinetic)),
    Claim("(17), (20)", "V", SWING, EXACT, lambda q: (*potential_17(q), -q.potential)),
    Claim("(18), (21)", "equation of motion of u", SWING, EXACT, lambda q: (
        q.u_ddot, -q.b * q.cos_phi * q.phi_ddot, q.b * q.sin_phi * q.phi_dot**2, -q.g * q.sin_alpha)),
    Claim("(19), (22)", "equation of motion of phi or theta: its right side lacks g (in SI units)", SWING, EXACT,
        lambda q: eq_19(q, q.g),
        Misprint(0.61, lambda q: eq_19(q, 1.0), "Equation of motion of φ, and that of θ alike",
            r"\frac{a^2}{2}\ddot\varphi-b\cos\varphi\,\ddot u=-<|g>b\sin(\alpha+\varphi)")),
)
# fmt: on
