"""Section 2 of the paper, eqs. (1)-(24): beer that slides without friction in a massless can."""

from functools import partial

from mjbeer.paper.claim import Bound, Claim, Limit, Misprint, Witness
from mjbeer.paper.witness import (
    DRIFT,
    EXACT,
    METAL,
    NARROW,
    REDUCED,
    SMALL,
    SWING,
    WIDE,
    balanced,
    oscillate,
    simulated,
)
from mjbeer.theory.can import Can
from mjbeer.theory.paper_scenes import sliding

EQ_6 = "m*b*g*cos(alpha)/inertia"
"""omega^2 [1/s^2] of small swings."""
PRINTED_10 = "24*pi*g*cos(alpha)/(9*pi**2 - 32)"
EQ_10 = f"{PRINTED_10}/a"
"""omega^2 of a half can; the misprint lacks the radius."""
EQ_24 = "2*b*g*cos(alpha)/(a**2 - 2*b**2)"
"""omega^2 of a half can; also the first form of eq. (10)."""
KINETIC_11 = "m*s_dot**2/2 + m*b**2*sin(phi)**2*phi_dot**2/2 + inertia*phi_dot**2/2"
"""T [J] of the beer in any can, also the second line of eq. (44)."""
POTENTIAL_14 = "- m*g*s*sin(alpha) - m*g*b*cos(alpha)*cos(phi)"
POTENTIAL_17 = "- m*g*u*sin(alpha) - m*g*b*cos(theta)"
"""V [J] of the beer in s and phi, and in u and theta, as also in eqs. (20) and (45)."""
_EQ_19 = "a**2/2*phi_ddot - b*cos(phi)*u_ddot + {}*b*sin(theta)"
"""Eqs. (19) and (22); the gap is for g, which the paper does not print."""
_TORQUE = "m*g*cos(alpha)*(u - s)"
"""Clockwise torque of gravity about C [N m]; its lever arm u - s is from MuJoCo's positions."""
_TURNS_ABOUT_C = "across_dot - phi_dot*(u - s)"
"""The centre of mass moves across the incline at phi_dot (u - s) [m/s]."""

# This can has a thousandth of the mass of its load.
_LIGHT_CAN = simulated(sliding(can=Can.sheet_metal(thickness=2.5e-6)), 2.0)
_LEVEL = simulated(sliding(0.0), 2.0)
_SMALL_SWING = Witness(REDUCED, partial(oscillate, sliding(), SMALL))


def _cylinder(k: float) -> Claim:
    """Return the claim of footnote 2 about a cylinder of inertia k m a^2."""
    return Claim(
        "footnote 2",
        f"a cylinder of inertia {k:g} m a^2 has g sin(alpha)/(1 + k)",
        simulated(balanced(k), 0.0),
        Bound(1e-7, DRIFT),
        residual=f"u_ddot - g*sin(alpha)/(1 + {k})",
        quote="a uniform cylinder with moment of inertia I = kma² about its axis has acceleration "
        "g sin α/(1 + k)",
    )


CLAIMS = (
    Claim(
        "(1)",
        "s(t) from rest",
        SWING,
        Bound(1e-12, "rounding of DOP853"),
        residual="s - g*sin(alpha)*time**2/2",
    ),
    Claim(
        "footnote 1",
        "no friction between can and incline: beyond, the metal can; within, one of a 40th of its "
        "mass",
        _LIGHT_CAN,
        Bound(7e-3, "the can's share of the mass, 1e-3, in a swing of 7 times g sin(alpha)"),
        residual="friction",
        scale="m*g*sin(alpha)",
        limit=Limit(0.25, METAL.observe),
        quote="in the limit of a massless can, the force of friction is zero, so we neglect "
        "friction",
    ),
    _cylinder(1.0),
    _cylinder(0.5),
    Claim(
        "Fig. 1",
        "at phi = 0 the surface stays parallel to the incline, and u = g sin(alpha) t^2/2",
        simulated(sliding(), sliding().equilibrium()),
        EXACT,
        residual="u - g*sin(alpha)*time**2/2 + phi",
        quote="slide down a frictionless incline of angle α without oscillation if its flat side "
        "is parallel to the incline",
    ),
    Claim(
        "footnote 6",
        "sliding beer can be at rest: beyond, at 10 degrees; within, on level ground",
        _LEVEL,
        EXACT,
        residual="s_ddot",
        scale="g",
        limit=Limit(0.174, SWING.observe),
        quote="a stable equilibrium exists only for α = 0",
    ),
    Claim(
        "(2)",
        "torque about the instantaneous centre",
        SWING,
        EXACT,
        residual=f"(inertia + m*b**2*sin(phi)**2)*phi_ddot + m*b**2*sin(phi)*cos(phi)*phi_dot**2 + "
        f"{_TORQUE}",
    ),
    Claim(
        "Fig. 2",
        "C moves with the centre of mass along the incline; the caption puts it on a line along "
        "the surface",
        WIDE,
        EXACT,
        residual=_TURNS_ABOUT_C,
        # Turning about a C that is lower by b tan(phi) sin(phi) adds a velocity along the incline.
        misprint=Misprint(
            0.93,
            wrong=_TURNS_ABOUT_C + " - phi_dot*b*sin(phi)**2/cos(phi)",
            about="The line through the centre of mass on which the instantaneous centre C lies",
            latex=r"<\text{along the flat surface of the beer}|\text{along the incline}>",
        ),
        quote="the line parallel to the flat surface that passes through the center of mass",
    ),
    Claim(
        "(3)",
        "I_C, exact form",
        SWING,
        EXACT,
        residual="inertia*phi_dot**2/2 + m*b**2*sin(phi)**2*phi_dot**2/2 + (m*s_dot**2/2 - "
        "kinetic)",
    ),
    Claim(
        "(3)",
        "I_C = I_cm: beyond, a swing of 1 rad; within, of 1e-3 rad",
        NARROW,
        Bound(1e-6, "the amplitude: (m b^2/I_cm) phi^2 = 6e-7"),
        residual="inertia*phi_dot**2/2 + (m*s_dot**2/2 - kinetic)",
        limit=Limit(0.095, WIDE.observe),
    ),
    Claim(
        "(4)",
        "torque about C, exact form",
        SWING,
        EXACT,
        residual=f"-m*g*cos(alpha)*b*sin(phi) + {_TORQUE}",
    ),
    Claim(
        "(4)",
        "torque about C, linear form: its sign",
        NARROW,
        Bound(3e-7, "the amplitude: phi^2/6 = 1.7e-7"),
        residual=f"-m*b*g*cos(alpha)*phi + {_TORQUE}",
        misprint=Misprint(
            2.0,
            wrong=f"m*b*g*cos(alpha)*phi + {_TORQUE}",
            about="Torque about the instantaneous centre, for small angles",
            latex=r"\tau_C\approx<+|->\,mbg\cos\alpha\,\varphi",
        ),
    ),
    Claim(
        "(5), (23)",
        "linear equation of motion: beyond, a swing of 1 rad; within, of 1e-3 rad",
        NARROW,
        Bound(1e-6, "the amplitude: (1/6 + m b^2/I_cm) phi^2 = 7e-7"),
        residual="inertia*phi_ddot + m*b*g*cos(alpha)*phi",
        limit=Limit(0.40, WIDE.observe),
    ),
    Claim(
        "(6), (24)",
        "omega of small oscillations: beyond, a swing of 1 rad; within, of 1e-3 rad",
        _SMALL_SWING,
        Bound(3e-7, "the amplitude: 2e-7"),
        residual=f"sqrt(array([{EQ_6}, {EQ_24}])) - omega",
        limit=Limit(0.15, partial(oscillate, sliding(), 1.0)),
    ),
    Claim(
        "(10)",
        "omega^2, middle form: it lacks 1/a (in SI units)",
        _SMALL_SWING,
        Bound(6e-7, "the amplitude: 4e-7"),
        residual=f"{EQ_10} - omega**2",
        misprint=Misprint(
            0.967,
            wrong=f"{PRINTED_10} - omega**2",
            about="Frequency of small swings of a half-full can",
            latex=r"\omega^2=\frac{24\pi g\cos\alpha}{9\pi^2-32}<|\cdot\frac1a>",
        ),
    ),
    Claim(
        "(10)",
        "omega^2 = 1.33 g cos(alpha)/a",
        _SMALL_SWING,
        Bound(3.8e-3, "half a unit of the last digit"),
        residual="1.33*g*cos(alpha)/a - omega**2",
    ),
    Claim("(11)", "T", SWING, EXACT, residual=f"{KINETIC_11} - kinetic"),
    Claim("(12)", "u = s + b sin(phi)", SWING, EXACT, residual="u - s - b*sin(phi)"),
    Claim("(12), Fig. 3", "theta = alpha + phi", SWING, EXACT, residual="theta - phi - alpha"),
    Claim(
        "(13)", "z in u and theta", SWING, EXACT, residual="-u*sin(alpha) - b*cos(theta) - height"
    ),
    Claim(
        "(13)",
        "z in s and phi",
        SWING,
        EXACT,
        residual="-s*sin(alpha) - b*cos(alpha)*cos(phi) - height",
    ),
    Claim(
        "(14)",
        "V, its first form: -mgz for +mgz",
        SWING,
        EXACT,
        residual=f"{POTENTIAL_14} - potential",
        misprint=Misprint(
            1.92,
            wrong="m*g*s*sin(alpha) + m*g*b*cos(alpha)*cos(phi) - potential",
            about="Potential energy of the beer",
            latex="V=<-|+>mgz",
        ),
    ),
    Claim("(15)", "s_ddot", SWING, EXACT, residual="s_ddot - g*sin(alpha)"),
    Claim(
        "(16)",
        "equation of motion of phi",
        SWING,
        EXACT,
        residual="m*b**2*sin(phi)**2*phi_ddot + inertia*phi_ddot + "
        "m*b**2*sin(phi)*cos(phi)*phi_dot**2 + m*b*g*cos(alpha)*sin(phi)",
    ),
    Claim(
        "(17), (20)",
        "T",
        SWING,
        EXACT,
        residual="m/2*u_dot**2 - m*b*cos(phi)*u_dot*phi_dot + m*a**2/4*phi_dot**2 - kinetic",
    ),
    Claim("(17), (20)", "V", SWING, EXACT, residual=f"{POTENTIAL_17} - potential"),
    Claim(
        "(18), (21)",
        "equation of motion of u",
        SWING,
        EXACT,
        residual="u_ddot - b*cos(phi)*phi_ddot + b*sin(phi)*phi_dot**2 - g*sin(alpha)",
    ),
    Claim(
        "(19), (22)",
        "equation of motion of phi or theta: its right side lacks g (in SI units)",
        SWING,
        EXACT,
        residual=_EQ_19.format("g"),
        misprint=Misprint(
            0.61,
            wrong=_EQ_19.format("1"),
            about="Equation of motion of φ, and that of θ alike",
            latex=r"\frac{a^2}{2}\ddot\varphi-b\cos\varphi\,\ddot u=-<|g>b\sin(\alpha+\varphi)",
        ),
    ),
)
