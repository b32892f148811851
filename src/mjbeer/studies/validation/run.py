"""Run every check of the validation and every row of the audit."""

from dataclasses import dataclass

from rich.console import Console
from rich.progress import Progress

from mjbeer.paper.audit import chapters
from mjbeer.paper.audit.claim import Finding
from mjbeer.studies.check import Check
from mjbeer.studies.validation import motions


@dataclass(frozen=True)
class Verdict:
    """All rows, measured."""

    checks: list[Check]
    """Those of the validation table."""
    findings: list[Finding]
    """Those of the audit of the paper."""

    @property
    def passed(self) -> bool:
        """Whether all of them did."""
        return all(each.passed for each in (*self.checks, *self.findings))


def check(console: Console) -> Verdict:
    """Run every row of the validation table and of the audit, with a progress bar on `console`."""
    rows, claims = motions.rows(), chapters.claims()
    checks, findings = [], []
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("validating", total=len(rows) + len(claims))
        for row in rows:
            progress.update(task, description=f"{row.quantity} ({row.by})")
            checks.append(row.run())
            progress.advance(task)
        for claim in claims:
            progress.update(task, description=f"{claim.equation} {claim.quantity}")
            findings.append(claim.run())
            progress.advance(task)
    return Verdict(checks, findings)
