"""validate(): measure every check against theory and every row of the paper's audit."""

from dataclasses import dataclass

from rich.console import Console

from mjbeer import paper
from mjbeer.output.terminal import progress_bar
from mjbeer.paper.row import Finding
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
    """Measure every check and every row of the audit, and return the results; `console` shows a progress bar."""
    checks, rows = motions.checks(), paper.rows()
    results, findings = [], []
    with progress_bar(console, len(checks) + len(rows)) as begin:
        for check in checks:
            begin(f"{check.quantity} ({check.by})")
            results.append(check.measure())
        for row in rows:
            begin(f"{row.equation} {row.quantity}")
            findings.append(row.measure())
    return Validation(results, findings)
