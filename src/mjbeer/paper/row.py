"""A row of the audit: an equation or statement of the paper, its witness, and what is wrong with it, if anything is.

The terms of an equation stand on one side, so that they sum to zero where it holds. The same function of the letters
gives numbers when a row is measured, and symbols when its equation is derived.
"""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

if TYPE_CHECKING:
    from mjbeer.theory.scene import Scene

Terms = tuple[Any, ...]
"""The terms of an equation, which sum to zero where it holds, or of a quantity, which sum to it."""

CONFIRMED = "confirmed"
CORRECTED = "confirmed after correction"
LIMIT = "limit of validity"
MISPRINT, APPROXIMATION, CONSEQUENCE = "misprint", "approximation", "consequence"
"""Kinds of what is wrong: a slip; orders left out, of which the paper does not speak; what follows from a slip."""
_AS_STATED = 0.05
"""Largest relative difference between the measured error of a misprint and the stated one, which has two digits."""


@dataclass(frozen=True)
class Letters:
    """Constants of a scene: numbers, or symbols where an equation is derived."""

    a: Any
    """Radius of the can [m]."""
    b: Any
    """Distance of the load's centre of mass from the axis [m]."""
    m: Any
    """Mass of the load [kg]."""
    inertia: Any
    """Moment of inertia I_cm of the load about its centre of mass [kg m^2]."""
    can_mass: Any
    """Mass m_can of the can [kg]; M in appendix B."""
    can_inertia: Any
    """Moment of inertia I_can of the can about its axis [kg m^2]."""
    g: Any
    alpha: Any
    sin_alpha: Any
    cos_alpha: Any

    @classmethod
    def of(cls, scene: "Scene", **motion: Any) -> Self:
        """Return the letters of a scene; `Motion.of` takes the fields of the motion as keyword arguments."""
        can, load = scene.can, scene.load
        masses = can.radius, load.offset, load.mass, load.inertia, can.mass, can.inertia
        incline = scene.incline, math.sin(scene.incline), math.cos(scene.incline)
        return cls(*masses, scene.gravity, *incline, **motion)

    @property
    def axial(self) -> Any:
        """Moment of inertia I_axis = I_cm + m b^2 of the load about the can's axis [kg m^2]."""
        return self.inertia + self.m * self.b**2

    @property
    def rolling(self) -> Any:
        """K = m_can + I_can/a^2 [kg], effective mass of the rolling can."""
        return self.can_mass + self.can_inertia / self.a**2

    @property
    def spread(self) -> Any:
        """delta = (m b^2/2)/(m b^2/2 + I_cm): how much the inertia about C of eq. (3) varies over a turn."""
        return (self.m * self.b**2 / 2) / (self.m * self.b**2 / 2 + self.inertia)


@dataclass(frozen=True, eq=False)
class Motion(Letters):
    """Letters and a motion in the coordinates of Fig. 3, in SI units: each field has one entry a sample."""

    s: Any
    s_dot: Any
    s_ddot: Any
    u: Any
    u_dot: Any
    u_ddot: Any
    phi: Any
    phi_dot: Any
    phi_ddot: Any
    sin_phi: Any
    cos_phi: Any
    sin_theta: Any
    cos_theta: Any
    theta: Any = None
    """Angle [rad] between gravity and the line from the axis to the load's centre of mass."""
    time: Any = None
    across: Any = None
    """How far the load's centre of mass is from the axis, away from the incline [m], and its two derivatives."""
    across_dot: Any = None
    across_ddot: Any = None
    height: Any = None
    """Height [m] of the load's centre of mass above where the axis starts."""
    kinetic: Any = None
    """Kinetic energy of the whole [J]."""
    potential: Any = None
    """Potential energy of the whole [J], zero where the axis starts."""
    friction: Any = None
    """Force [N] of the incline on the can, uphill, where a constraint makes the can roll; otherwise 0."""


@dataclass(frozen=True)
class Witness:
    """What a row is compared with."""

    name: str
    see: Callable[[], Any]
    """Computes what the terms are functions of: a motion, or numbers."""


@dataclass(frozen=True)
class Bound:
    """Largest error that what is right may have, and what causes it."""

    error: float
    reason: str


@dataclass(frozen=True)
class Misprint:
    """What the paper prints in place of what is right."""

    misses_by: float
    """Error that it must have."""
    terms: Callable[[Any], Terms]
    about: str
    """What the formula is of, as a heading."""
    latex: str
    r"""The formula, with `<printed|right>` where the two differ; `\\` begins a new line."""
    kind: str = MISPRINT
    of: str = ""
    """The equation that it is a consequence of."""

    @property
    def printed(self) -> str:
        r"""The formula as printed, in LaTeX; what differs stands in `\textcolor{differs}{...}`."""
        return _side(self.latex, 1)

    @property
    def right(self) -> str:
        """The same as it is right."""
        return _side(self.latex, 2)


@dataclass(frozen=True)
class Limit:
    """Where a row that holds only in a limit no longer does."""

    misses_by: float
    """Error that it must have there."""
    see: Callable[[], Any]
    """Computes what the terms are functions of, beyond the limit."""


@dataclass(frozen=True)
class Finding:
    """The result of measuring a row.

    An error is the largest sum of the equation's terms at any sample, divided by the largest single term.
    """

    equation: str
    quantity: str
    verdict: str
    witness: str
    printed: float
    """Error of the printed form; for a limit of validity, its error beyond the limit."""
    right: float | None
    """Error of the corrected form, or of the printed one within its limit; None where the paper is right."""
    bound: float
    """Largest error that what is right may have."""
    misses_by: float | None
    """Error that the misprint, or the claim beyond its limit, must have; None where the paper is right."""
    reason: str
    """What causes the remaining error, and therefore sets the bound."""

    @property
    def passed(self) -> bool:
        """Whether what is right has an error within the bound, and a misprint has the error that is stated for it."""
        if self.right is None or self.misses_by is None:
            return self.printed <= self.bound
        return self.right <= self.bound and abs(self.printed / self.misses_by - 1) <= _AS_STATED


@dataclass(frozen=True)
class Row:
    """An equation or statement of the paper that is measured."""

    equation: str
    """Its number, or the section, footnote or figure that it is in."""
    quantity: str
    """What is claimed of what."""
    witness: Witness
    bound: Bound
    terms: Callable[[Any], Terms]
    """Terms of what is right, from what the witness saw."""
    misprint: Misprint | None = None
    """What is printed instead."""
    limit: Limit | None = None
    """Where it no longer holds."""
    quote: str = ""
    """The paper's own words, where the row rests on these."""

    @property
    def verdict(self) -> str:
        """What a row that passes shows of the paper."""
        return LIMIT if self.limit else CORRECTED if self.misprint else CONFIRMED

    @property
    def printed(self) -> Callable[[Any], Terms]:
        """The terms as the paper prints them."""
        return (self.misprint or self).terms

    @property
    def misses_by(self) -> float | None:
        """Error of what is printed, or of what is beyond the limit; None where the paper is right."""
        other = self.misprint or self.limit
        return other.misses_by if other else None

    def measure(self) -> Finding:
        """Compute the errors of the printed and of the right form, and return both beside the bound."""
        seen = self.witness.see()
        error, right = miss(self.terms(seen)), None
        if self.misprint or self.limit:
            error, right = miss(self.printed(self.limit.see() if self.limit else seen)), error
        given = self.equation, self.quantity, self.verdict, self.witness.name
        return Finding(*given, error, right, self.bound.error, self.misses_by, self.bound.reason)


def miss(terms: Terms) -> float:
    """Return the largest sum of the terms at any sample, divided by the largest term; NaN if all are zero."""
    columns = [np.asarray(term, dtype=float) for term in terms]
    largest = max(float(np.abs(column).max()) for column in columns)
    return float(np.abs(np.asarray(sum(columns))).max()) / largest if largest > 0 else float("nan")


def _side(latex: str, side: int) -> str:
    """Return one side of a formula with alternatives, each line of which is marked."""

    def marked(found: re.Match[str]) -> str:
        lines = [rf"\textcolor{{differs}}{{{line}}}" for line in found[side].split(r"\\ ") if line]
        return r"\\ ".join(lines)

    return re.sub(r"<([^|>]*)\|([^>]*)>", marked, latex)
