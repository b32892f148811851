"""The validation: every check and every claim of the paper is measured, and tabulated."""

from dataclasses import dataclass

from rich.console import Console

from mjbeer import paper
from mjbeer.checks.as_json import to_json
from mjbeer.checks.check import Check, Result
from mjbeer.output.terminal import Table, progress_bar
from mjbeer.paper.claim import CORRECTED, ClaimResult
from mjbeer.studies.study import FAILED, machine
from mjbeer.studies.validation import motion_checks, standing_checks, track_checks


@dataclass(frozen=True)
class Validation:
    """The results of a validation."""

    results: list[Result]
    """Results of the checks against exact theory."""
    audit: list[ClaimResult]
    """Results of the claims of the paper."""

    @property
    def failures(self) -> list[str]:
        """A line for each check and each claim that failed."""
        return [
            result.summary_line() for result in (*self.results, *self.audit) if not result.passed
        ]

    @property
    def passed(self) -> bool:
        """Whether all passed."""
        return not self.failures

    @property
    def sentence(self) -> str:
        """How many checks passed, and how many claims came out as expected, and in which way."""
        checks = sum(result.passed for result in self.results)
        expected = [result for result in self.audit if result.passed]
        corrected = sum(result.verdict == CORRECTED for result in expected)
        return (
            f"{checks} of {len(self.results)} checks passed, and "
            f"{len(expected)} of {len(self.audit)} claims of the paper came out as expected "
            f"({len(expected) - corrected} hold as printed, {corrected} only after a correction)"
        )

    def tables(self) -> list[Table]:
        """Return the tables of the checks and of the audit."""
        rows = []
        for result in self.results:
            error = _error(result) + FAILED[result.passed]
            bound = f"{result.bound:.1e} {result.unit}".strip()
            rows.append((result.name, result.by, error, bound, result.reason))
        columns = ("check", "by", "error", "at most", "what dominates the error")
        checks = Table("Validation against exact theory", columns, rows, left=(0, 1, 4))
        return [checks, audit(self.audit)]

    def json(self) -> str:
        """Return the results as JSON, with the versions of the packages that were used."""
        content = {
            "versions": machine()["versions"],
            "passed": self.passed,
            "checks": [{**result.fields(), "passed": result.passed} for result in self.results],
            "audit": [{**result.fields(), "passed": result.passed} for result in self.audit],
        }
        return to_json(content, indent=2)


def checks() -> list[Check]:
    """Return all checks of the validation, in the order of its table."""
    return [
        *motion_checks.checks(),
        *motion_checks.damped_checks(),
        *motion_checks.order_checks(),
        *standing_checks.checks(),
        *track_checks.checks(),
    ]


def validate(console: Console | None) -> Validation:
    """Measure every check and every claim; `console` shows a progress bar."""
    all_checks = checks()
    claims = paper.claims()
    results = []
    audited = []
    with progress_bar(console, len(all_checks) + len(claims)) as begin:
        for check in all_checks:
            begin(f"{check.name} ({check.by})")
            results.append(check.result())
        for claim in claims:
            begin(f"{claim.equation} {claim.quantity}")
            audited.append(claim.measure())
    return Validation(results, audited)


def audit(results: list[ClaimResult]) -> Table:
    """Return the table of the audit: verdicts, witnesses, and what dominates each error."""
    lines = []
    for result in results:
        # Only what is wrong somewhere has two errors: where it is, and as it should be.
        errors = (_error(result), "")
        if result.printed is not None:
            errors = (f"{result.printed.measured:.2g}", _error(result))
        bound = f"{result.bound:.1e}" + FAILED[result.passed]
        heading = (result.group, result.name, result.verdict, result.by)
        lines.append((*heading, *errors, bound, result.reason))
    columns = (
        "equation",
        "quantity",
        "verdict",
        "witness",
        "error, printed",
        "error, right",
        "at most",
        "what dominates",
    )
    return Table("The paper, equation by equation", columns, lines, left=(0, 1, 2, 3, 7))


def _error(result: Result) -> str:
    """Return an error with two digits."""
    return "-" if result.error is None else f"{result.error:.1e}"
