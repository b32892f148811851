"""The tables of the validation, for the terminal, Markdown and JSON."""

import dataclasses
import json
import math

from mjbeer.output.table import Table
from mjbeer.paper.audit.claim import Finding
from mjbeer.studies.check import Check

_VERDICTS = {True: "[green]pass[/]", False: "[bold red]FAIL[/]"}
_FAILED = " **FAIL**"
_SHORT = ("printed", "right", "at most", "row")


def validation(checks: list[Check], document: bool = False) -> Table:
    """Return the table of checks: with a verdict for the terminal, with what dominates the error for a `document`."""
    rows = [
        (
            check.quantity,
            check.by,
            f"{check.error:.1e}" + ("" if check.passed or not document else _FAILED),
            f"{check.bound:.1e} {check.unit}".strip(),
            check.reason if document else _VERDICTS[check.passed],
        )
        for check in checks
    ]
    last = "what dominates the error" if document else "verdict"
    return Table("Validation against exact theory", ("check", "by", "error", "at most", last), rows, left=(0, 1, 4))


def audit(findings: list[Finding], document: bool = False) -> Table:
    """Return the audit of the paper: with a verdict on each row for the terminal, with its reason for a `document`."""
    columns = ("equation", "quantity", "verdict", "witness")
    columns += ("error, printed", "error, right", "at most", "what dominates") if document else _SHORT
    rows = []
    for finding in findings:
        failed = "" if finding.passed or not document else _FAILED
        rows.append((
            finding.equation,
            finding.quantity,
            finding.verdict,
            finding.witness,
            f"{finding.printed:.1e}" if finding.misses_by is None else f"{finding.printed:.2g}",
            "" if finding.right is None else f"{finding.right:.1e}",
            f"{finding.bound:.1e}{failed}",
            finding.reason if document else _VERDICTS[finding.passed],
        ))  # fmt: skip
    return Table("The paper, equation by equation", columns, rows, left=(0, 1, 2, 3, 7))


def to_json(checks: list[Check], findings: list[Finding]) -> str:
    """The validation table and the audit as JSON, with the versions that they were measured with."""
    from importlib.metadata import version

    versions = {each: version(each) for each in ("mjbeer", "mujoco", "numpy", "scipy", "numba")}
    rows = [{**dataclasses.asdict(check), "error": _number(check.error), "passed": check.passed} for check in checks]
    numbers = ("printed", "right", "bound", "misses_by")
    audited = [
        {
            **dataclasses.asdict(each),
            **{name: None if getattr(each, name) is None else _number(getattr(each, name)) for name in numbers},
            "passed": each.passed,
        }
        for each in findings
    ]
    passed = all(each.passed for each in (*checks, *findings))
    content = {"versions": versions, "passed": passed, "checks": rows, "audit": audited}
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _number(value: float) -> float | None:
    """JSON has no number for what is infinite or none."""
    return value if math.isfinite(value) else None
