"""validate(): measure every check against theory and every claim of the paper; the tables of both."""

from dataclasses import dataclass

from rich.console import Console

from mjbeer import paper
from mjbeer.checks.as_json import to_json
from mjbeer.checks.check import Check, Result
from mjbeer.output.terminal import Table, progress_bar
from mjbeer.studies.study import FAILED, machine
from mjbeer.studies.validation import motion_checks, standing_checks, track_checks


@dataclass(frozen=True)
class Validation:
    """The results of a validation."""

    results: list[Result]
    """Results of the checks against exact theory."""
    audit: list[Result]
    """Results of the claims of the paper."""

    @property
    def failures(self) -> list[str]:
        """A line for each check and each claim that failed."""
        return [result.summary_line() for result in (*self.results, *self.audit) if not result.passed]

    @property
    def passed(self) -> bool:
        """Whether all passed."""
        return not self.failures

    @property
    def sentence(self) -> str:
        """How many checks and how many claims passed."""
        checks, claims = (sum(result.passed for result in listed) for listed in (self.results, self.audit))
        total = len(self.results), len(self.audit)
        return f"{checks} of {total[0]} checks and {claims} of {total[1]} claims of the paper passed"

    def tables(self) -> list[Table]:
        """Return the tables of the checks and of the audit."""
        rows = []
        for each in self.results:
            error, bound = _error(each) + FAILED[each.passed], f"{each.bound:.1e} {each.unit}".strip()
            rows.append((each.name, each.by, error, bound, each.reason))
        columns = "check", "by", "error", "at most", "what dominates the error"
        return [Table("Validation against exact theory", columns, rows, left=(0, 1, 4)), audit(self.audit)]

    def json(self) -> str:
        """Return the results as JSON, with the versions of the packages that were used."""
        listed = {
            name: [vars(result) | {"passed": result.passed} for result in results]
            for name, results in (("checks", self.results), ("audit", self.audit))
        }
        content = {"versions": machine()["versions"], "passed": self.passed, **listed}
        return to_json(content, indent=2)


def checks() -> list[Check]:
    """Return all checks of the validation, in the order of its table."""
    motions = motion_checks.checks, motion_checks.damped, motion_checks.orders
    return [check for chapter in (*motions, standing_checks.checks, track_checks.checks) for check in chapter()]


def validate(console: Console | None) -> Validation:
    """Measure every check and every claim, and return the results; `console` shows a progress bar."""
    listed, claims = checks(), paper.claims()
    results, audited = [], []
    with progress_bar(console, len(listed) + len(claims)) as begin:
        for check in listed:
            begin(f"{check.name} ({check.by})")
            results.append(check.result())
        for claim in claims:
            begin(f"{claim.equation} {claim.quantity}")
            audited.append(claim.measure())
    return Validation(results, audited)


def audit(results: list[Result]) -> Table:
    """Return the table of the audit, with the verdicts, the witnesses, and what dominates each error."""
    lines = []
    for each in results:
        printed, right = each.values.get("printed"), _error(each)
        errors = (right, "") if printed is None else (f"{printed:.2g}", right)
        bound = f"{each.bound:.1e}" + FAILED[each.passed]
        lines.append((each.group, each.name, each.values["verdict"], each.by, *errors, bound, each.reason))
    columns = "equation", "quantity", "verdict", "witness", "error, printed", "error, right"
    title = "The paper, equation by equation"
    return Table(title, (*columns, "at most", "what dominates"), lines, left=(0, 1, 2, 3, 7))


def _error(result: Result) -> str:
    return "-" if result.error is None else f"{result.error:.1e}"
