"""Run every check of the validation and every row of the audit."""

from dataclasses import dataclass

from rich.console import Console

from mjbeer.output.terminal import progress_bar
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
    with progress_bar(console, len(rows) + len(claims)) as begin:
        for row in rows:
            begin(f"{row.quantity} ({row.by})")
            checks.append(row.run())
        for claim in claims:
            begin(f"{claim.equation} {claim.quantity}")
            findings.append(claim.run())
    return Verdict(checks, findings)
