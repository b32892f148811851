"""The catalogue of stiff and extreme cases, and what came of them as tables."""

from mjbeer import catalogue_extreme, catalogue_found, catalogue_stiff
from mjbeer.extreme import Extreme
from mjbeer.task import Task


def cases() -> list[Extreme]:
    """All of them."""
    return [*catalogue_stiff.cases(), *catalogue_extreme.cases(), *catalogue_found.cases()]


def tasks(quick: bool) -> list[Task]:
    """One a case; quickly, with fewer ways to try it."""
    return [each.task(quick) for each in cases()]
