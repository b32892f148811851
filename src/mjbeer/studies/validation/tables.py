"""The tables of the validation, for the terminal and for Markdown, and its results as JSON."""

import dataclasses
import json
import math
from importlib.metadata import version
from typing import Any

from mjbeer.output.table import Table
from mjbeer.paper.audit.claim import Finding
from mjbeer.studies.check import Result
from mjbeer.studies.validation.run import Validation

_VERDICTS = {True: "[green]pass[/]", False: "[bold red]FAIL[/]"}
_FAILED = " **FAIL**"
_SHORT = ("printed", "right", "at most", "row")


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
    """Return the table of the audit; the last column has a verdict or, for a `document`, what dominates the error."""
    columns = ("equation", "quantity", "verdict", "witness")
    columns += ("error, printed", "error, right", "at most", "what dominates") if document else _SHORT
    rows = [
        (
            finding.equation,
            finding.quantity,
            finding.verdict,
            finding.witness,
            f"{finding.printed:.1e}" if finding.misses_by is None else f"{finding.printed:.2g}",
            "" if finding.right is None else f"{finding.right:.1e}",
            f"{finding.bound:.1e}" + ("" if finding.passed or not document else _FAILED),
            finding.reason if document else _VERDICTS[finding.passed],
        )
        for finding in findings
    ]
    return Table("The paper, equation by equation", columns, rows, left=(0, 1, 2, 3, 7))


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
