"""validate(): measure every row against theory and every claim of the paper's audit; the tables of both."""

import dataclasses
import json
import math
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

from rich.console import Console

from mjbeer import paper
from mjbeer.output.terminal import Table, progress_bar
from mjbeer.paper.row import CONFIRMED, CORRECTED, LIMIT, Finding
from mjbeer.studies.rows import FAILED, PASSED, Result, Row, table, told
from mjbeer.studies.validation import damped, motions, standing

_WORDS = {CONFIRMED: "confirmed", CORRECTED: "corrected", LIMIT: "limit"}
"""The verdicts of the audit, short enough for a terminal."""


@dataclass(frozen=True)
class Validation:
    """The results of a validation."""

    results: list[Result]
    """Results of the rows against exact theory."""
    findings: list[Finding]
    """Findings of the audit of the paper."""

    @property
    def passed(self) -> bool:
        """Whether every result and every finding passed."""
        return all(row.passed for row in (*self.results, *self.findings))

    @property
    def sentence(self) -> str:
        """How many checks and how many rows of the audit passed."""
        return (
            f"{sum(result.passed for result in self.results)} of {len(self.results)} checks and "
            f"{sum(finding.passed for finding in self.findings)} of {len(self.findings)} rows of the audit passed"
        )

    @property
    def failures(self) -> list[str]:
        """A line for each check and each row of the audit that failed."""
        checks = [told(result) for result in self.results if not result.passed]
        return checks + [_failed(finding) for finding in self.findings if not finding.passed]

    def tables(self, document: bool = False) -> list[Table]:
        """Return the tables of the checks and of the audit, for a terminal or a document."""
        return [table("Validation against exact theory", self.results, document), audit(self.findings, document)]

    def json(self) -> str:
        """Return the results and the findings as JSON, with the versions of the packages that were used."""
        versions = {name: version(name) for name in ("mjbeer", "mujoco", "numpy", "scipy", "numba")}
        about = ("by", "error", "bound", "unit", "reason", "passed")
        checks = [
            {"quantity": result.name} | {name: getattr(result, name) for name in about} for result in self.results
        ]
        findings = [dataclasses.asdict(finding) | {"passed": finding.passed} for finding in self.findings]
        content = {"checks": [_finite(each) for each in checks], "audit": [_finite(each) for each in findings]}
        return json.dumps({"versions": versions, "passed": self.passed, **content}, indent=2, allow_nan=False) + "\n"


def rows() -> list[Row]:
    """Return all rows of the validation, in the order of its table."""
    return [*motions.rows(), *damped.rows(), *motions.models(), *motions.extremes(), *standing.rows()]


def validate(console: Console | None) -> Validation:
    """Measure every row and every claim, and return the results; `console` shows a progress bar."""
    listed, claims = rows(), paper.rows()
    results, findings = [], []
    with progress_bar(console, len(listed) + len(claims)) as begin:
        for row in listed:
            begin(f"{row.name} ({row.by})")
            results.append(row.result())
        for claim in claims:
            begin(f"{claim.equation} {claim.quantity}")
            findings.append(claim.measure())
    return Validation(results, findings)


def audit(findings: list[Finding], document: bool = False) -> Table:
    """Return the table of the audit; a `document` also has the witnesses, and what dominates each error."""
    lines = []
    for finding in findings:
        errors = (
            f"{finding.printed:.1e}" if finding.misses_by is None else f"{finding.printed:.2g}",
            "" if finding.right is None else f"{finding.right:.1e}",
        )
        bound = f"{finding.bound:.1e}"
        if document:
            failed = "" if finding.passed else FAILED
            line = (finding.verdict, finding.witness, *errors, bound + failed, finding.reason)
        else:
            line = (_WORDS[finding.verdict], *errors, bound, PASSED[finding.passed])
        lines.append((finding.equation, finding.quantity, *line))
    title, columns = "The paper, equation by equation", ("equation", "quantity", "verdict")
    if document:
        columns += ("witness", "error, printed", "error, right", "at most", "what dominates")
        return Table(title, columns, lines, left=(0, 1, 2, 3, 7))
    return Table(title, (*columns, "printed", "right", "at most", "row"), lines, left=(0, 1, 2, 6))


def _failed(finding: Finding) -> str:
    """Return a line about a finding that failed, with the error of what is right, which may be what is printed."""
    error = finding.printed if finding.right is None else finding.right
    line = f"{finding.equation} {finding.quantity} ({finding.witness}): error {error:.1e}, at most {finding.bound:.1e}"
    if finding.misses_by is None:
        return line
    return f"{line}; as printed {finding.printed:.2g}, expected {finding.misses_by:.2g}"


def _finite(fields: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of a row for JSON: infinity and NaN, which JSON lacks, become null."""
    unknown = {name for name, value in fields.items() if isinstance(value, float) and not math.isfinite(value)}
    return fields | dict.fromkeys(unknown)
