"""The validation in a sentence, as tables for the terminal, for Markdown and for programs, and as JSON."""

import dataclasses
import json
import math
from importlib.metadata import version
from typing import Any

from mjbeer.output.terminal import Table
from mjbeer.paper.row import CONFIRMED, CORRECTED, LIMIT, Finding
from mjbeer.studies.check import Result
from mjbeer.studies.validation.run import Validation

_VERDICTS = {True: "[green]pass[/]", False: "[bold red]FAIL[/]"}
_FAILED = " **FAIL**"
_WORDS = {CONFIRMED: "confirmed", CORRECTED: "corrected", LIMIT: "limit"}
"""The verdicts of the audit, short enough for a terminal."""
_ROWS = (
    "part", "equation", "quantity", "by", "error", "at most", "unit", "error of what is printed", "must be", "row",
    "what dominates the error",
)  # fmt: skip


def sentence(validation: Validation) -> str:
    """Return how many checks and how many rows of the audit passed."""
    results, findings = validation.results, validation.findings
    return (
        f"{sum(result.passed for result in results)} of {len(results)} checks and "
        f"{sum(finding.passed for finding in findings)} of {len(findings)} rows of the audit passed"
    )


def failures(validation: Validation) -> list[str]:
    """Return a line for each check and each row of the audit that failed."""
    checks = [
        f"{result.quantity} ({result.by}): error {result.error:.1e}, at most {result.bound:.1e} {result.unit}".strip()
        for result in validation.results
        if not result.passed
    ]
    audit = [
        f"{finding.equation} {finding.quantity} ({finding.witness}): error {_judged(finding):.1e}, at most "
        f"{finding.bound:.1e}"
        + ("" if finding.misses_by is None else f"; as printed {finding.printed:.2g}, expected {finding.misses_by:.2g}")
        for finding in validation.findings
        if not finding.passed
    ]
    return checks + audit


def rows(validation: Validation) -> Table:
    """Return one table for programs, with all digits: a row for each check and each row of the audit."""
    checks = [
        ("check", "", result.quantity, result.by, repr(result.error), repr(result.bound), result.unit, "", "",
         _VERDICTS[result.passed], result.reason)
        for result in validation.results
    ]  # fmt: skip
    audit = [
        ("audit", finding.equation, finding.quantity, finding.witness, repr(_judged(finding)), repr(finding.bound),
         "relative", *(("", "") if finding.misses_by is None else (repr(finding.printed), repr(finding.misses_by))),
         _VERDICTS[finding.passed], finding.reason)
        for finding in validation.findings
    ]  # fmt: skip
    return Table("Validation", _ROWS, [*checks, *audit])


def _judged(finding: Finding) -> float:
    """Return the error of what is right: of the printed form, unless there is another."""
    return finding.printed if finding.right is None else finding.right


def validation(results: list[Result], document: bool = False) -> Table:
    """Return the table of checks; the last column is the verdict or, for a `document`, what dominates the error."""
    rows = [
        (
            result.quantity,
            result.by,
            f"{result.error:.1e}" + ("" if result.passed or not document else _FAILED),
            f"{result.bound:.1e} {result.unit}".strip(),
            result.reason if document else _VERDICTS[result.passed],
        )
        for result in results
    ]
    last = "what dominates the error" if document else "verdict"
    return Table("Validation against exact theory", ("check", "by", "error", "at most", last), rows, left=(0, 1, 4))


def audit(findings: list[Finding], document: bool = False) -> Table:
    """Return the table of the audit; a `document` also has the witnesses, and what dominates each error."""
    rows = []
    for finding in findings:
        errors = (
            f"{finding.printed:.1e}" if finding.misses_by is None else f"{finding.printed:.2g}",
            "" if finding.right is None else f"{finding.right:.1e}",
        )
        bound = f"{finding.bound:.1e}"
        if document:
            failed = "" if finding.passed else _FAILED
            row = (finding.verdict, finding.witness, *errors, bound + failed, finding.reason)
        else:
            row = (_WORDS[finding.verdict], *errors, bound, _VERDICTS[finding.passed])
        rows.append((finding.equation, finding.quantity, *row))
    title, columns = "The paper, equation by equation", ("equation", "quantity", "verdict")
    if document:
        columns += ("witness", "error, printed", "error, right", "at most", "what dominates")
        return Table(title, columns, rows, left=(0, 1, 2, 3, 7))
    return Table(title, (*columns, "printed", "right", "at most", "row"), rows, left=(0, 1, 2, 6))


def to_json(validation: Validation) -> str:
    """Return the results and the findings as JSON, with the versions of the packages that were used."""
    versions = {name: version(name) for name in ("mjbeer", "mujoco", "numpy", "scipy", "numba")}
    content = {
        "versions": versions,
        "passed": validation.passed,
        "checks": [_record(result) for result in validation.results],
        "audit": [_record(finding) for finding in validation.findings],
    }
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _record(row: Result | Finding) -> dict[str, Any]:
    """Return the fields of a row for JSON: infinity and NaN, which JSON lacks, become null."""
    fields = dataclasses.asdict(row) | {"passed": row.passed}
    unknown = {name for name, value in fields.items() if isinstance(value, float) and not math.isfinite(value)}
    return fields | dict.fromkeys(unknown)
