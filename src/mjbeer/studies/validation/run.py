"""validate(): measure every check against theory and every claim of the paper's audit."""

from dataclasses import dataclass

from rich.console import Console

from mjbeer.output.terminal import progress_bar
from mjbeer.paper.audit import chapters
from mjbeer.paper.audit.claim import Finding
from mjbeer.studies.check import Result
from mjbeer.studies.validation import motions


@dataclass(frozen=True)
class Validation:
    """The results of a validation."""

    results: list[Result]
    """Results of the checks against exact theory."""
    findings: list[Finding]
    """Findings of the audit of the paper."""

    @property
    def passed(self) -> bool:
        """Whether every result and every finding passed."""
        return all(row.passed for row in (*self.results, *self.findings))


def validate(console: Console) -> Validation:
    """Measure every check and every claim, and return the results; `console` shows a progress bar."""
    checks, claims = motions.checks(), chapters.claims()
    results, findings = [], []
    with progress_bar(console, len(checks) + len(claims)) as begin:
        for check in checks:
            begin(f"{check.quantity} ({check.by})")
            results.append(check.measure())
        for claim in claims:
            begin(f"{claim.equation} {claim.quantity}")
            findings.append(claim.measure())
    return Validation(results, findings)
