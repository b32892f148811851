"""A claim of the paper, an equation or a statement: its witness, and what is wrong with it, if anything is.

The terms of an equation stand on one side, so that they sum to zero where it holds. The same function of the constants
gives numbers when a claim is measured, and symbols when its equation is derived.
"""

import ast
import math
import re
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from mjbeer.checks import Result

if TYPE_CHECKING:
    from mjbeer.theory.scene import Scene

Terms = tuple[Any, ...]  # the terms of an equation, which sum to zero where it holds, or of a quantity, which sum to it

CONFIRMED, CORRECTED, LIMIT = "confirmed", "confirmed after correction", "limit of validity"
MISPRINT, APPROXIMATION, CONSEQUENCE = "misprint", "approximation", "consequence"
"""Kinds of what is wrong: a slip; orders left out, of which the paper does not speak; what follows from a slip."""


@dataclass(frozen=True)
class SceneConstants:
    """Constants of a scene: numbers, or symbols where an equation is derived."""

    a: Any  # radius of the can [m]
    b: Any  # distance of the load's centre of mass from the axis [m]
    m: Any  # mass of the load [kg]
    inertia: Any  # moment of inertia I_cm of the load about its centre of mass [kg m^2]
    can_mass: Any  # mass m_can of the can [kg]; M in appendix B
    can_inertia: Any  # moment of inertia I_can of the can about its axis [kg m^2]
    g: Any
    alpha: Any
    sin_alpha: Any
    cos_alpha: Any

    @classmethod
    def of(cls, scene: "Scene", **motion: Any) -> Self:
        """Return the constants of a scene; `Motion.of` takes the fields of the motion as keyword arguments."""
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
class Motion(SceneConstants):
    """The constants of a scene and a motion in the coordinates of Fig. 3, in SI units, with one entry a sample."""

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
    theta: Any = None  # angle [rad] between gravity and the line from the axis to the load's centre of mass
    time: Any = None
    across: Any = None  # how far the load's centre of mass is from the axis, away from the incline [m]
    across_dot: Any = None
    across_ddot: Any = None
    height: Any = None  # height [m] of the load's centre of mass above where the axis starts
    kinetic: Any = None  # kinetic energy of the whole [J]
    potential: Any = None  # potential energy of the whole [J], zero where the axis starts
    friction: Any = None  # force [N] of the incline on the can, uphill, where a constraint makes it roll; otherwise 0


def equation(text: str) -> Callable[[Any], Terms]:
    """Return what gives the terms of an equation from a motion, whose fields it names: "u - s - b*sin_phi" has three.

    What is in parentheses after a sign is one term; functions are NumPy's.
    """

    def split(node: ast.expr) -> Generator[ast.expr]:
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            yield from split(node.left)
            yield node.right if isinstance(node.op, ast.Add) else ast.UnaryOp(ast.USub(), node.right)
        else:
            yield node

    terms = [ast.fix_missing_locations(ast.Expression(each)) for each in split(ast.parse(text, mode="eval").body)]
    codes = [compile(each, text, "eval") for each in terms]

    def evaluate(motion: Any) -> Terms:
        names = {name for code in codes for name in code.co_names}
        named = {name: getattr(motion if hasattr(motion, name) else np, name) for name in names}
        return tuple(eval(code, named) for code in codes)

    return evaluate


@dataclass(frozen=True)
class Witness:
    """What a claim is compared with, by its name, and what computes it: a motion, or numbers."""

    name: str
    see: Callable[[], Any]


@dataclass(frozen=True)
class Bound:
    """Largest error that what is right may have, and what causes it."""

    error: float
    reason: str


@dataclass(frozen=True)
class Limit:
    """Where a claim that holds only in a limit no longer does: the error that it must have there, and what is seen."""

    expected_error: float
    see: Callable[[], Any]


@dataclass(frozen=True)
class Misprint:
    """What the paper prints in place of what is right."""

    expected_error: float  # error that it must have
    terms: Callable[[Any], Terms]
    about: str  # what the formula is of, as a heading
    latex: str  # the formula, with `<printed|right>` where the two differ; `\\` begins a new line
    kind: str = MISPRINT
    of: str = ""  # the equation that it is a consequence of

    @property
    def printed(self) -> str:
        r"""The formula as printed, in LaTeX; what differs stands in `\textcolor{differs}{...}`."""
        return _side(self.latex, 1)

    @property
    def right(self) -> str:
        """The same as it is right."""
        return _side(self.latex, 2)


@dataclass(frozen=True)
class Claim:
    """An equation or statement of the paper that is measured."""

    equation: str  # its number, or the section, footnote or figure that it is in
    quantity: str  # what is claimed of what
    witness: Witness
    bound: Bound
    terms: Callable[[Any], Terms]  # terms of what is right, from what the witness saw
    misprint: Misprint | None = None  # what is printed instead
    limit: Limit | None = None  # where it no longer holds
    quote: str = ""  # the paper's own words, where the claim rests on these

    @property
    def verdict(self) -> str:
        """What a claim that passes shows of the paper."""
        return LIMIT if self.limit else CORRECTED if self.misprint else CONFIRMED

    @property
    def printed(self) -> Callable[[Any], Terms]:
        """The terms as the paper prints them."""
        return (self.misprint or self).terms

    @property
    def expected_error(self) -> float | None:
        """Error of what is printed, or of what is beyond the limit; None where the paper is right."""
        other = self.misprint or self.limit
        return other.expected_error if other else None

    def measure(self) -> Result:
        """Compute the errors of what is right and of what is printed, or of what is beyond the limit.

        An error is the largest sum of the terms at any sample, divided by the largest single term.
        """
        seen = self.witness.see()
        error = relative_residual(self.terms(seen))
        values: dict[str, Any] = {"verdict": self.verdict}
        if self.misprint or self.limit:
            printed = relative_residual(self.printed(self.limit.see() if self.limit else seen))
            values |= {"printed": printed, "expected_error": self.expected_error}
        given = self.equation, self.quantity, self.witness.name, self.bound.error, "", self.bound.reason
        return Result(*given, error, values)


def relative_residual(terms: Terms) -> float:
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
