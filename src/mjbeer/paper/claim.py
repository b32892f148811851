"""A claim of the paper, an equation or a statement: its witness, and what is wrong with it, if anything is.

The terms of an equation stand on one side, so that they sum to zero where it holds. The same text gives numbers when a
claim is measured, and symbols when its equation is derived.
"""

import ast
import re
from collections.abc import Callable, Generator
from dataclasses import dataclass
from functools import cache
from types import CodeType, SimpleNamespace
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from mjbeer.checks.check import Result

if TYPE_CHECKING:
    from mjbeer.theory.scene import Scene

CONFIRMED, CORRECTED, LIMIT = "confirmed", "confirmed after correction", "limit of validity"
MISPRINT, APPROXIMATION, CONSEQUENCE = "misprint", "approximation", "consequence"
"""Kinds of what is wrong: a slip; orders left out, of which the paper does not speak; what follows from a slip."""


class Seen(SimpleNamespace):
    """The constants of a scene and what a witness measured of it, by the names that equations have for them.

    Masses are `m` of the load and `can_mass` of the can (M in appendix B) [kg]. Inertias are `inertia`, I_cm of the
    load about its centre of mass, and `can_inertia`, I_can of the can about its axis [kg m^2]. `a` is the can's radius,
    and `b` the distance of the load's centre of mass from the axis [m]. `g` and `alpha` are gravity and the incline.
    """

    @classmethod
    def of(cls, scene: "Scene", **measured: Any) -> Self:
        """Return the constants of a scene, with what was measured."""
        can, load = scene.can, scene.load
        constants = {"a": can.radius, "b": load.offset, "m": load.mass, "inertia": load.inertia}
        constants |= {"can_mass": can.mass, "can_inertia": can.inertia, "g": scene.gravity, "alpha": scene.incline}
        return cls(**constants, **measured)

    @property
    def axial(self) -> Any:
        """Moment of inertia I_axis = I_cm + m b^2 of the load about the can's axis [kg m^2]."""
        return self.inertia + self.m * self.b**2

    @property
    def rolling(self) -> Any:
        """K = m_can + I_can/a^2 [kg], effective mass of the rolling can."""
        return self.can_mass + self.can_inertia / self.a**2

    @property
    def delta(self) -> Any:
        """(m b^2/2)/(m b^2/2 + I_cm): how much the inertia about C of eq. (3) varies over a turn."""
        return (self.m * self.b**2 / 2) / (self.m * self.b**2 / 2 + self.inertia)


def terms(equation: str, seen: Any) -> tuple[Any, ...]:
    """Return the terms of an equation: "u - s - b*sin(phi)" has three.

    It names what was seen, of which `seen` is the whole, and functions of NumPy's. What is in parentheses after a sign
    is one term.
    """
    names, codes = _compiled(equation)
    named = {name: getattr(seen if hasattr(seen, name) else np, name) for name in names}
    return tuple(eval(code, named | {"seen": seen}) for code in codes)


@cache
def _compiled(equation: str) -> tuple[set[str], list[CodeType]]:
    """Return the names in an equation, and its terms."""

    def split(node: ast.expr) -> Generator[ast.expr]:
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            yield from split(node.left)
            yield node.right if isinstance(node.op, ast.Add) else ast.UnaryOp(ast.USub(), node.right)
        else:
            yield node

    whole = ast.parse(equation.strip(), mode="eval").body
    names = {node.id for node in ast.walk(whole) if isinstance(node, ast.Name)} - {"seen"}
    found = (ast.fix_missing_locations(ast.Expression(each)) for each in split(whole))
    return names, [compile(each, equation, "eval") for each in found]


def value(equation: str, seen: Any) -> Any:
    """Return the sum of the terms, for a text that is one side of an equation."""
    return sum(terms(equation, seen))


def relative_residual(terms: tuple[Any, ...]) -> float:
    """Return the largest sum of the terms at any sample, divided by the largest term; NaN if all are zero."""
    columns = [np.asarray(term, dtype=float) for term in terms]
    largest = max(float(np.abs(column).max()) for column in columns)
    return float(np.abs(np.asarray(sum(columns))).max()) / largest if largest > 0 else float("nan")


class Witness(NamedTuple):
    """What a claim is compared with, by its name, and what computes it: a motion, or numbers."""

    name: str
    see: Callable[[], Any]


class Bound(NamedTuple):
    """Largest error that what is right may have, and what causes it."""

    error: float
    reason: str


class Limit(NamedTuple):
    """Where a claim that holds only in a limit no longer does: the error that it must have there, and what is seen."""

    expected_error: float
    see: Callable[[], Any]


@dataclass(frozen=True)
class Misprint:
    """What the paper prints in place of what is right."""

    expected_error: float  # error that it must have
    wrong: str  # the equation as it is printed
    about: str  # what the formula is of, as a heading
    latex: str  # the formula, with `<printed|right>` where the two differ; `\\` begins a new line
    kind: str = MISPRINT
    of: str = ""  # the equation that it is a consequence of

    @property
    def printed(self) -> str:
        r"""The formula as printed, in LaTeX; what differs stands in `\textcolor{differs}{...}`."""
        return self._side(1)

    @property
    def right(self) -> str:
        """The same as it is right."""
        return self._side(2)

    def _side(self, side: int) -> str:
        def marked(found: re.Match[str]) -> str:
            lines = [rf"\textcolor{{differs}}{{{line}}}" for line in found[side].split(r"\\ ") if line]
            return r"\\ ".join(lines)

        return re.sub(r"<([^|>]*)\|([^>]*)>", marked, self.latex)


@dataclass(frozen=True)
class Claim:
    """An equation or statement of the paper that is measured."""

    equation: str  # its number, or the section, footnote or figure that it is in
    quantity: str  # what is claimed of what
    witness: Witness
    bound: Bound
    right: str  # the equation as it is right, whose terms sum to zero
    misprint: Misprint | None = None  # what is printed instead
    limit: Limit | None = None  # where it no longer holds
    quote: str = ""  # the paper's own words, where the claim rests on these

    @property
    def verdict(self) -> str:
        """What a claim that passes shows of the paper."""
        return LIMIT if self.limit else CORRECTED if self.misprint else CONFIRMED

    @property
    def printed(self) -> str:
        """The equation as the paper prints it."""
        return self.misprint.wrong if self.misprint else self.right

    def measure(self) -> Result:
        """Compute the errors of what is right and of what is printed, or of what is beyond the limit.

        An error is the largest sum of the terms at any sample, divided by the largest single term.
        """
        seen, wrong = self.witness.see(), self.misprint or self.limit
        values: dict[str, Any] = {"verdict": self.verdict}
        if wrong:
            printed = terms(self.printed, self.limit.see() if self.limit else seen)
            values |= {"printed": relative_residual(printed), "expected_error": wrong.expected_error}
        given = self.equation, self.quantity, self.witness.name, self.bound.error, "", self.bound.reason
        return Result(*given, relative_residual(terms(self.right, seen)), values)
