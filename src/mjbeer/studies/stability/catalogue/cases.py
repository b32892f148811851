"""The catalogue of stiff and extreme cases, and what came of them as tables."""

from mjbeer.studies.stability.catalogue import extreme, found, stiff
from mjbeer.studies.stability.catalogue.case import Extreme
from mjbeer.studies.study import Task


def cases() -> list[Extreme]:
    """All of them."""
    return [*stiff.cases(), *extreme.cases(), *found.cases()]


def tasks(quick: bool) -> list[Task]:
    """One a case; quickly, with fewer ways to try it."""
    return [each.task(quick) for each in cases()]
