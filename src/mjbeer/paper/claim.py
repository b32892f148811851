"""A claim of the paper, its witness, and what is wrong with it, if anything is.

The terms of an equation stand on one side, so that they sum to zero where it holds. The same text
gives numbers when a claim is measured, and symbols when its equation is derived.
"""

import ast
import re
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from functools import cache
from types import CodeType, SimpleNamespace
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from mjbeer.checks.check import Result

if TYPE_CHECKING:
    from mjbeer.theory.scene import Scene

CONFIRMED = "confirmed"
CORRECTED = "confirmed after correction"
LIMIT = "limit of validity"
"""Verdicts on claims."""
MISPRINT = "misprint"
APPROXIMATION = "approximation"
CONSEQUENCE = "consequence"
"""Kinds of what is wrong: a slip; orders left out, of which the paper does not speak; what
follows from a slip."""


class Observation(SimpleNamespace):
    """The constants of a scene and what a witness measured of it, as equations name them.

    Masses are `m` of the load and `can_mass` of the can (M in appendix B) [kg]. Inertias are
    `inertia`, I_cm of the load about its centre of mass, and `can_inertia`, I_can of the can about
    its axis [kg m^2]. `a` is the can's radius, and `b` the distance of the load's centre of mass
    from the axis [m]. `g` and `alpha` are gravity and the incline.
    """

    @classmethod
    def of(cls, scene: "Scene", **measured: Any) -> Self:
        """Return the constants of a scene, with what was measured."""
        return cls(
            a=scene.can.radius,
            b=scene.load.offset,
            m=scene.load.mass,
            inertia=scene.load.inertia,
            can_mass=scene.can.mass,
            can_inertia=scene.can.inertia,
            g=scene.gravity,
            alpha=scene.incline,
            **measured,
        )

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
        """(m b^2/2)/(m b^2/2 + I_cm): how much I_C of eq. (3) varies during a turn."""
        half = self.m * self.b**2 / 2
        return half / (half + self.inertia)


class _Equation(NamedTuple):
    """An equation that can be evaluated."""

    names: set[str]
    terms: list[CodeType]


def terms(equation: str, observed: Any) -> list[Any]:
    """Return the terms of an equation: "u - s - b*sin(phi)" has three.

    It names what was observed, of which `observed` is the whole, and functions of NumPy's. What is
    in parentheses after a sign is one term.
    """
    compiled = _compiled(equation)
    named = {"observed": observed}
    for name in compiled.names:
        named[name] = getattr(observed if hasattr(observed, name) else np, name)
    return [eval(term, named) for term in compiled.terms]


@cache
def _compiled(equation: str) -> _Equation:
    whole = ast.parse(equation.strip(), mode="eval").body
    names = {node.id for node in ast.walk(whole) if isinstance(node, ast.Name)}
    codes = []
    for term in _split(whole):
        expression = ast.fix_missing_locations(ast.Expression(term))
        codes.append(compile(expression, equation, "eval"))
    return _Equation(names - {"observed"}, codes)


def _split(node: ast.expr) -> Generator[ast.expr]:
    """Yield the terms of a sum, with their signs."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
        yield from _split(node.left)
        yield node.right if isinstance(node.op, ast.Add) else ast.UnaryOp(ast.USub(), node.right)
    else:
        yield node


def value(equation: str, observed: Any) -> Any:
    """Return the sum of the terms, for a text that is one side of an equation."""
    return sum(terms(equation, observed))


def relative_residual(terms: Sequence[Any], scale: Any = None) -> float:
    """Return the largest sum of the terms at any sample, divided by the largest `scale`.

    Without a `scale` it is the largest single term. The result is NaN if that is zero.
    """
    scales = terms if scale is None else [scale]
    largest = max(float(np.abs(np.asarray(size, dtype=float)).max()) for size in scales)
    residual = np.asarray(sum(np.asarray(term, dtype=float) for term in terms))
    return float(np.abs(residual).max()) / largest if largest > 0 else float("nan")


class Witness(NamedTuple):
    """What a claim is compared with."""

    name: str
    observe: Callable[[], Any]
    """Computes what the claim names: a motion, or numbers."""


class Bound(NamedTuple):
    """The error that what is right may have."""

    error: float
    reason: str
    """What causes the error."""


class Limit(NamedTuple):
    """Where a claim that holds only in a limit no longer does."""

    expected_error: float
    """The error that the claim must have there."""
    observe: Callable[[], Any]


@dataclass(frozen=True)
class Misprint:
    """What the paper prints in place of what is right."""

    expected_error: float
    """The error that it must have."""
    wrong: str
    """The equation as it is printed."""
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
        return self._with_marked_group(1)

    @property
    def right(self) -> str:
        """The same as it is right."""
        return self._with_marked_group(2)

    def _with_marked_group(self, group: int) -> str:
        """Return the formula with the first or second of the texts that differ, marked."""

        def marked(difference: re.Match[str]) -> str:
            lines = [line for line in difference[group].split(r"\\ ") if line]
            return r"\\ ".join(rf"\textcolor{{differs}}{{{line}}}" for line in lines)

        return re.sub(r"<([^|>]*)\|([^>]*)>", marked, self.latex)


@dataclass(frozen=True)
class Claim:
    """An equation or statement of the paper that is measured.

    An error is the largest sum of an equation's terms at any sample, divided by the largest single
    term, or by `scale`.
    """

    equation: str
    """Its number, or the section, footnote or figure that it is in."""
    quantity: str
    """What is claimed of what."""
    witness: Witness
    bound: Bound
    residual: str
    """The equation as it is right, whose terms sum to zero."""
    misprint: Misprint | None = None
    """What is printed instead."""
    limit: Limit | None = None
    """Where it no longer holds."""
    quote: str = ""
    """The paper's own words, where the claim rests on these."""
    scale: str = ""
    """What an error is a share of, if not of the largest term."""

    @property
    def verdict(self) -> str:
        """What a claim that passes shows of the paper."""
        if self.limit:
            return LIMIT
        return CORRECTED if self.misprint else CONFIRMED

    @property
    def printed(self) -> str:
        """The equation as the paper prints it."""
        return self.misprint.wrong if self.misprint else self.residual

    def error(self, equation: str, observed: Any) -> float:
        """Return the error of an equation."""
        scale = value(self.scale, observed) if self.scale else None
        return relative_residual(terms(equation, observed), scale)

    def measure(self) -> Result:
        """Compute the errors of what is right, and of what is printed or beyond the limit."""
        observed = self.witness.observe()
        values: dict[str, Any] = {"verdict": self.verdict}
        if self.misprint:
            values["printed"] = self.error(self.printed, observed)
            values["expected_error"] = self.misprint.expected_error
        elif self.limit:
            values["printed"] = self.error(self.residual, self.limit.observe())
            values["expected_error"] = self.limit.expected_error
        return Result(
            group=self.equation,
            name=self.quantity,
            by=self.witness.name,
            bound=self.bound.error,
            reason=self.bound.reason,
            error=self.error(self.residual, observed),
            values=values,
        )
