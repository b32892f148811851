"""A claim of the paper: an equation, the witness it is compared with, and its misprint, if any.

An equation is a text with all its terms on one side, which sum to zero where it holds. The same
text is evaluated with numbers when a claim is measured, and with symbols when it is derived.
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
"""The verdicts on a claim that passes."""
_EXPECTED_WITHIN = 0.05
"""Largest relative difference between the error of a wrong form and the expected one, which has two
digits."""
MISPRINT = "misprint"
APPROXIMATION = "approximation"
CONSEQUENCE = "consequence"
"""The kinds of errors in the paper: a slip; an approximation that leaves out orders without saying
so; a consequence of a slip elsewhere."""


class Observation(SimpleNamespace):
    """The constants of a scene and what a witness measured of it, by their names in equations.

    `m` is the mass of the load, and `can_mass` that of the can, M in appendix B [kg]. `inertia` is
    I_cm, of the load about its centre of mass, and `can_inertia` is I_can, of the can about its
    axis [kg m^2]. `a` is the can's radius, and `b` the distance of the load's centre of mass from
    the axis [m]. `g` is gravity [m/s^2], and `alpha` the incline [rad].
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
        """The moment of inertia I_axis = I_cm + m b^2 of the load about the can's axis [kg m^2]."""
        return self.inertia + self.m * self.b**2

    @property
    def rolling(self) -> Any:
        """The effective mass K = m_can + I_can/a^2 of the rolling can [kg]."""
        return self.can_mass + self.can_inertia / self.a**2

    @property
    def delta(self) -> Any:
        """(m b^2/2)/(m b^2/2 + I_cm): ripple of I_C, eq. (3), divided by its mean."""
        half = self.m * self.b**2 / 2
        return half / (half + self.inertia)


class _Equation(NamedTuple):
    """An equation that can be evaluated."""

    names: set[str]
    """The names in it, but for `observed` itself."""
    terms: list[CodeType]


def terms(equation: str, observed: Any) -> list[Any]:
    """Return the terms of an equation: "u - s - b*sin(phi)" has three.

    A name in it is that of an attribute of `observed`, of `observed` itself, or of a function of
    NumPy. A sum in parentheses that follows a sign is one term.
    """
    compiled = _compiled(equation)
    named = {"observed": observed}
    for name in compiled.names:
        owner = observed if hasattr(observed, name) else np
        named[name] = getattr(owner, name)
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
    """Return the value of one side of an equation, which is the sum of its terms."""
    return sum(terms(equation, observed))


def relative_residual(terms: Sequence[Any], scale: Any = None) -> float:
    """Return the largest sum of the terms at any sample, divided by the largest `scale`.

    Without a `scale` it is divided by the largest single term. If the divisor is zero, the result
    is NaN.
    """
    scales = terms if scale is None else [scale]
    largest = max(float(np.abs(np.asarray(size, dtype=float)).max()) for size in scales)
    residual = np.asarray(sum(np.asarray(term, dtype=float) for term in terms))
    return float(np.abs(residual).max()) / largest if largest > 0 else float("nan")


class Witness(NamedTuple):
    """What a claim is compared with."""

    name: str
    observe: Callable[[], Any]
    """Simulates or computes what the claim's equation names."""


class Bound(NamedTuple):
    """The largest error that the right equation may have."""

    error: float
    reason: str
    """What causes such an error."""


class Limit(NamedTuple):
    """A case for which a claim must fail, because it holds only in a limit."""

    expected_error: float
    """The error that the claim must have in this case."""
    observe: Callable[[], Any]
    """Simulates or computes this case."""


@dataclass(frozen=True)
class Misprint:
    """A wrong equation that the paper prints, and the formula to show it."""

    expected_error: float
    """The error that the printed equation must have."""
    wrong: str
    """The printed equation."""
    about: str
    """The heading of the formula: what it describes."""
    latex: str
    r"""The formula, with `<printed|right>` where the two differ; `\\` begins a new line."""
    kind: str = MISPRINT
    of: str = ""
    """The equation with the slip, if this is a consequence."""

    @property
    def printed_latex(self) -> str:
        r"""The printed formula; what differs stands in `\textcolor{differs}{...}`."""
        return self._with_marked_group(1)

    @property
    def right_latex(self) -> str:
        """The right formula, with the same marks."""
        return self._with_marked_group(2)

    def _with_marked_group(self, group: int) -> str:
        """Return the formula with the first or the second of each two texts that differ."""

        def marked(difference: re.Match[str]) -> str:
            lines = [line for line in difference[group].split(r"\\ ") if line]
            return r"\\ ".join(rf"\textcolor{{differs}}{{{line}}}" for line in lines)

        return re.sub(r"<([^|>]*)\|([^>]*)>", marked, self.latex)


class PrintedError(NamedTuple):
    """The error of a misprint, or of an equation beyond its limit."""

    measured: float
    expected: float
    """The error that it must have; it has two digits."""

    @property
    def is_as_expected(self) -> bool:
        """Whether the error is the expected one. NaN is not."""
        return abs(self.measured / self.expected - 1) <= _EXPECTED_WITHIN


@dataclass(frozen=True, kw_only=True)
class ClaimResult(Result):
    """The error of a claim's right equation, with the verdict on the paper."""

    verdict: str
    """The verdict on the paper if the claim passes."""
    printed: PrintedError | None = None
    """The error of what the paper prints, where that is wrong; or beyond the limit."""

    @property
    def passed(self) -> bool:
        """Whether the error is within its bound, and the wrong form's error as expected."""
        return super().passed and (self.printed is None or self.printed.is_as_expected)

    def fields(self) -> dict[str, Any]:
        """Return all fields by their names; verdict and printed error are among the `values`."""
        fields = super().fields()
        del fields["verdict"]
        del fields["printed"]
        values: dict[str, Any] = {"verdict": self.verdict}
        if self.printed is not None:
            values["printed"] = self.printed.measured
            values["expected_error"] = self.printed.expected
        return fields | {"values": values}

    def summary_line(self) -> str:
        """Return the result in a line, as for a list of failures."""
        line = super().summary_line()
        if self.printed is not None:
            measured = f"{self.printed.measured:.2g}"
            line += f"; as printed {measured}, expected {self.printed.expected:.2g}"
        return line


@dataclass(frozen=True)
class Claim:
    """An equation or statement of the paper that is measured.

    An error is the largest sum of an equation's terms at any sample, divided by the largest single
    term, or by `scale`.
    """

    equation: str
    """The number of the equation, or the section, footnote or figure of the statement."""
    quantity: str
    """What is claimed, in words."""
    witness: Witness
    bound: Bound
    residual: str
    """The right equation, whose terms sum to zero."""
    misprint: Misprint | None = None
    """What the paper prints instead."""
    limit: Limit | None = None
    """A case for which the equation no longer holds."""
    quote: str = ""
    """The paper's own words, if the claim rests on them."""
    scale: str = ""
    """What the error is divided by, if not by the largest term."""

    @property
    def verdict(self) -> str:
        """The verdict on the paper if the claim passes."""
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

    def measure(self) -> ClaimResult:
        """Measure the error of the right equation, and of the misprint or beyond the limit."""
        observed = self.witness.observe()
        printed = None
        if self.misprint:
            error = self.error(self.printed, observed)
            printed = PrintedError(error, self.misprint.expected_error)
        elif self.limit:
            error = self.error(self.residual, self.limit.observe())
            printed = PrintedError(error, self.limit.expected_error)
        return ClaimResult(
            group=self.equation,
            name=self.quantity,
            by=self.witness.name,
            bound=self.bound.error,
            reason=self.bound.reason,
            error=self.error(self.residual, observed),
            verdict=self.verdict,
            printed=printed,
        )
