"""The tables of the validation, for the terminal, Markdown and JSON."""

import dataclasses
import json
import math

from rich.table import Table

from mjbeer.paper.audit.claim import Finding
from mjbeer.studies.check import Check


def validation(checks: list[Check]) -> Table:
    """The validation table for the terminal."""
    table = Table(title="Validation against exact theory")
    for name in ("check", "by", "error", "at most", "verdict"):
        table.add_column(name, justify="right" if name in ("error", "at most") else "left")
    for check in checks:
        verdict = "[green]pass[/]" if check.passed else "[bold red]FAIL[/]"
        table.add_row(check.quantity, check.by, f"{check.error:.1e}", f"{check.bound:.1e} {check.unit}", verdict)
    return table


def validation_markdown(checks: list[Check]) -> str:
    """The validation table as Markdown."""
    lines = ["| check | by | error | at most | what dominates the error |", "|---|---|---|---|---|"]
    for check in checks:
        bound = f"{check.bound:.1e} {check.unit}".strip()
        failed = "" if check.passed else " **FAIL**"
        lines.append(f"| {check.quantity} | {check.by} | {check.error:.1e}{failed} | {bound} | {check.reason} |")
    return "\n".join(lines) + "\n"


def audit(findings: list[Finding]) -> Table:
    """The audit of the paper for the terminal."""
    table = Table(title="The paper, equation by equation")
    for name in ("equation", "quantity", "verdict", "witness", "printed", "right", "at most", "row"):
        table.add_column(name, justify="right" if name in ("printed", "right", "at most") else "left")
    for each in findings:
        passed = "[green]pass[/]" if each.passed else "[bold red]FAIL[/]"
        table.add_row(*_audited(each), passed)
    return table


def audit_markdown(findings: list[Finding]) -> str:
    """The audit of the paper as Markdown."""
    lines = [
        "| equation | quantity | verdict | witness | error, printed | error, right | at most | what dominates |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for each in findings:
        failed = "" if each.passed else " **FAIL**"
        lines.append(f"| {' | '.join(_audited(each))}{failed} | {each.reason} |")
    return "\n".join(lines) + "\n"


def _audited(finding: Finding) -> tuple[str, ...]:
    right = "" if finding.right is None else f"{finding.right:.1e}"
    printed = f"{finding.printed:.1e}" if finding.misses_by is None else f"{finding.printed:.2g}"
    about = finding.equation, finding.quantity, finding.verdict, finding.witness
    return (*about, printed, right, f"{finding.bound:.1e}")


def validation_json(checks: list[Check], findings: list[Finding]) -> str:
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
