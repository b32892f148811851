"""Masses, centres of mass and inertias of beer and can: eqs. (7)-(9) and (30)-(38) of the paper.

Eqs. (7)-(9) are for a half cylinder, (30) and (31) for a can of sheet metal, (32)-(38) for a
segment.

Lengths are in can radii a, areas in a^2 and inertias in m a^2, unless a unit is given. beta [rad]
is half the angle that the beer subtends at the axis.
"""

import math
from functools import cache, partial
from types import SimpleNamespace
from typing import Any, NamedTuple

import mujoco
import numpy as np

from mjbeer.model.build import build
from mjbeer.paper.claim import Bound, Claim, Misprint, Witness
from mjbeer.theory.can import ALUMINIUM, BEER, LENGTH, RADIUS, THICKNESS, Can
from mjbeer.theory.paper_scenes import sliding

FILLS = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)
"""Fills at which the formulas of section 3 are compared with quadrature, on both sides of a
half-full can."""
_TWICE_AREA = "(2*beta - sin(2*beta))"
"""Twice the area by the last form of eq. (33)."""
_SECOND_36 = (
    "4/3*(pi/4 - cos(beta)*sin(beta)/2 - arcsin(cos(beta))/2 + pi/8 + cos(beta)*sin(beta)**3/2 "
    f"- cos(beta)*sin(beta)/4 - arcsin(cos(beta))/4)/{_TWICE_AREA}"
)
_THIRD_36 = f"4/3*(3*beta/4 - 3*sin(2*beta)/8 + sin(2*beta)*sin(beta)**2/{{}})/{_TWICE_AREA}"
_LAST_36 = f"(1 + 2*sin(2*beta)*sin(beta)**2/(3*{_TWICE_AREA}))/2"
"""I_axis/(m a^2) by three forms of eq. (36): the second line, with its integrals evaluated; the
third line, with a gap for the divisor, which is 4 and printed 8; and the last form."""
_LESS_AXIAL = " - (inertia + b**2)"
"""Less I_axis/(m a^2) by quadrature."""

_PAPER = {"a": RADIUS, "l": LENGTH, "t": THICKNESS, "rho": ALUMINIUM, "rho_beer": BEER}
"""Sizes [m] and densities [kg/m^3] by the paper's letters."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)
"""Nodes and weights of Gauss quadrature; 24 points already give the segment's integrals to
rounding."""


class _Segment(NamedTuple):
    """Beer in cross-section, for one fill or for several, as arrays."""

    fill: Any
    """h/(2a)."""
    beta: Any
    area: Any
    b: Any
    inertia: Any
    """I_cm."""
    mass: Any
    """[kg]."""


def _segments(*fills: float) -> SimpleNamespace:
    """Return the segments of some fills, by quadrature, with sizes and densities."""
    columns = _Segment(*np.transpose([_segment(fill) for fill in fills]))
    return SimpleNamespace(**columns._asdict(), **_PAPER)


def _segment(fill: float) -> _Segment:
    """Return the segment of one fill, by integrals over strips along the flat side.

    A strip spans the angles -t to t, seen from the axis, with t <= beta. For a = 1 it is at the
    distance cos(t) from the axis, and its area is dA = 2 sin^2(t) dt.
    """
    beta = 2 * math.atan2(math.sqrt(fill), math.sqrt(1 - fill))
    angle = beta / 2 * (1 + _NODES)
    across = np.sin(angle)
    strip = beta * _WEIGHTS * across**2
    area = float(strip.sum())
    # The height of a strip above the bottom, 1 - cos(angle), in a form without cancellation.
    height = 2 * np.sin(angle / 2) ** 2
    centroid = float(strip @ height) / area
    inertia = float(strip @ (across**2 / 3 + (height - centroid) ** 2)) / area
    mass = BEER * LENGTH * RADIUS**2 * area
    return _Segment(fill, beta, area, 1 - centroid, inertia, mass)


@cache
def _shell() -> SimpleNamespace:
    """Return mass [kg] and axial inertia [kg m^2] of a can of sheet metal, by MuJoCo."""
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="can").add_geom(
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[RADIUS, LENGTH / 2, 0],
        density=THICKNESS * ALUMINIUM,
        typeinertia=mujoco.mjtGeomInertia.mjINERTIA_SHELL,
    )
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    can = model.body("can")
    axes = data.body("can").ximat.reshape(3, 3)
    inertia = float((axes @ np.diag(can.inertia) @ axes.T)[2, 2])
    return SimpleNamespace(mass=float(can.mass[0]), inertia=inertia, **_PAPER)


def _centre_of_mass() -> SimpleNamespace:
    """Return the distance of the common centre of mass from the axis [m], and what (38) names."""
    scene = sliding(can=Can.sheet_metal())
    model = build(scene, "equality")
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    common = data.subtree_com[model.body("can").id]
    return SimpleNamespace(
        distance=float(np.linalg.norm(common - data.body("can").xpos)),
        m=scene.load.mass,
        can_mass=scene.can.mass,
        b=scene.load.offset,
    )


def _by_quadrature(*fills: float) -> Witness:
    """Return the witness of segments of some fills."""
    return Witness("segment quadrature", partial(_segments, *fills))


_HALF = _by_quadrature(0.5)
_FILLED = _by_quadrature(*FILLS)
_THOUSAND = _by_quadrature(*np.linspace(1e-3, 1, 1000))
_SHELL = Witness("MuJoCo's shell of a cylinder", _shell)
_CLOSED = Bound(1e-13, "rounding; the closed forms cancel at small fills")
_ROUNDING = Bound(1e-13, "rounding")
_DIGIT = "half a unit of the last digit"

CLAIMS = (
    Claim("(7)", "b/a of a half cylinder", _HALF, _CLOSED, residual="4/(3*pi) - b"),
    Claim(
        "(8)", "I_axis/(m a^2) of a half cylinder", _HALF, _CLOSED, residual="0.5 - inertia - b**2"
    ),
    Claim(
        "(9)",
        "I_cm/(m a^2) of a half cylinder",
        _HALF,
        _CLOSED,
        residual="-inertia + (0.5 - (4/(3*pi))**2)",
    ),
    Claim("(9)", "I_cm = 0.32 m a^2", _HALF, Bound(1.6e-2, _DIGIT), residual="0.32 - inertia"),
    Claim("(30)", "m_can", _SHELL, _ROUNDING, residual="2*pi*a*t*(l + a)*rho - mass"),
    Claim("(31)", "I_can", _SHELL, _ROUNDING, residual="pi*a**3*t*(2*l + a)*rho - inertia"),
    Claim(
        "(31)",
        "I_can/(m_can a^2)",
        _SHELL,
        _ROUNDING,
        residual="(2*l + a)/(2*(l + a)) - inertia/(mass*a**2)",
    ),
    Claim(
        "(31)",
        "I_can = 0.89 m_can a^2",
        _SHELL,
        Bound(5.6e-3, _DIGIT),
        residual="0.89 - inertia/(mass*a**2)",
    ),
    Claim(
        "(32)",
        "h/a",
        Witness("chord of a circle", _FILLED.observe),
        _CLOSED,
        residual="2*fill - (1 - cos(beta))",
    ),
    Claim(
        "(34)",
        "mass of the beer",
        _FILLED,
        _CLOSED,
        residual=f"a**2*l*rho_beer*{_TWICE_AREA}/2 - mass",
    ),
    Claim(
        "(33)",
        "area, middle form",
        _FILLED,
        _CLOSED,
        residual="-area + (pi/2 - cos(beta)*sin(beta) - arcsin(cos(beta)))",
    ),
    Claim("(33)", "area, last form", _FILLED, _CLOSED, residual=f"{_TWICE_AREA}/2 - area"),
    Claim(
        "(35)", "b, with A", _FILLED, _CLOSED, residual=f"2*sin(beta)**3/(3*({_TWICE_AREA}/2)) - b"
    ),
    Claim(
        "(35)", "b, last form", _FILLED, _CLOSED, residual=f"4*sin(beta)**3/(3*{_TWICE_AREA}) - b"
    ),
    Claim("(36)", "I_axis, second line", _FILLED, _CLOSED, residual=_SECOND_36 + _LESS_AXIAL),
    Claim("(36)", "I_axis, last form", _FILLED, _CLOSED, residual=_LAST_36 + _LESS_AXIAL),
    Claim(
        "(37)",
        "I_cm",
        _FILLED,
        _CLOSED,
        residual=f"-inertia + ({_LAST_36} - 16*sin(beta)**6/(9*{_TWICE_AREA}**2))",
    ),
    Claim(
        "(36)",
        "I_axis, third line: sin(2 beta) sin^2(beta)/4; printed /8",
        _FILLED,
        _CLOSED,
        residual=_THIRD_36.format(4) + _LESS_AXIAL,
        misprint=Misprint(
            0.23,
            wrong=_THIRD_36.format(8) + _LESS_AXIAL,
            about="The beer's inertia about the can's axis, third line",
            latex=r"\frac{2\rho_{\text{beer}}a^4l}{3}\Bigl(\frac{3\beta}{4}-\frac{3\sin2\beta}{8}"
            r"+\frac{\sin2\beta\,\sin^2\!\beta}{<8|4>}\Bigr)",
        ),
    ),
    Claim(
        "(38)",
        "centre of mass of can and beer",
        Witness("MuJoCo, subtree_com", _centre_of_mass),
        _ROUNDING,
        residual="m*b/(m + can_mass) - distance",
    ),
    Claim(
        "figure of (36)",
        "k is 1/2 at beta = pi/2 and at pi",
        _by_quadrature(0.5, 1.0),
        _CLOSED,
        residual="0.5" + _LESS_AXIAL,
        quote="k decreases from 1 … to 1/2 at β = π/2 …, then dips slightly and returns to k = 1/2 "
        "at β = π",
    ),
    Claim(
        "figure of (36)",
        "k is 1 for a film (fill 1e-5)",
        _by_quadrature(1e-5),
        Bound(1e-4, "the film's height"),
        residual="1" + _LESS_AXIAL,
        quote="decreases from 1 (for a point mass at distance a from the axis)",
    ),
    Claim(
        "figure of (36)",
        "in between k dips, to 0.456 at 115 degrees",
        _THOUSAND,
        Bound(2e-3, f"{_DIGIT}; the paper gives no number"),
        residual="0.456 - min(inertia + b**2)",
        quote="then dips slightly",
    ),
    Claim(
        "figure of (37)",
        "k rises all the way: it is never below what it was",
        _THOUSAND,
        _ROUNDING,
        residual="inertia - maximum.accumulate(inertia)",
        quote="as angle β increases from 0 to π, k increases",
    ),
    Claim(
        "figure of (37)",
        "k goes from 0 by 0.32 at beta = pi/2 to 0.5",
        _by_quadrature(1e-5, 0.5, 1.0),
        Bound(1e-3, _DIGIT),
        residual="array([0, 0.32, 0.5]) - inertia",
        quote="k increases from 0 … to 0.32 at β = π/2 …, and then continues to increase to 0.5 at "
        "β = π",
    ),
)
