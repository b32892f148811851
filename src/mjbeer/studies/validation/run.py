"""Every check of the validation, and every claim of the audit, measured."""

from dataclasses import dataclass

from rich.console import Console
from rich.progress import Progress

from mjbeer.paper.audit import chapters
from mjbeer.paper.audit.claim import Finding
from mjbeer.studies.check import Result
from mjbeer.studies.validation import motions


@dataclass(frozen=True)
class Validation:
    """What was measured."""

    results: list[Result]
    """Of the checks against exact theory."""
    findings: list[Finding]
    """Of the audit of the paper."""

    @property
    def passed(self) -> bool:
        """Whether every result and every finding passed."""
        return all(row.passed for row in (*self.results, *self.findings))


def validate(console: Console) -> Validation:
    """Measure every check and every claim, with a progress bar on `console`, and return the results."""
    checks, claims = motions.checks(), chapters.claims()
    results, findings = [], []
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("validating", total=len(checks) + len(claims))
        for check in checks:
            progress.update(task, description=f"{check.quantity} ({check.by})")
            results.append(check.measure())
            progress.advance(task)
        for claim in claims:
            progress.update(task, description=f"{claim.equation} {claim.quantity}")
            findings.append(claim.measure())
            progress.advance(task)
    return Validation(results, findings)
