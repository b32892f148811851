"""The catalogue of stiff and extreme cases, and of what the search found."""

from mjbeer.studies.stability.catalogue import extreme, found, stiff
from mjbeer.studies.stability.catalogue.case import CatalogueCase
from mjbeer.studies.study import Task


def cases() -> list[CatalogueCase]:
    """Return all cases of the catalogue."""
    return [*stiff.cases(), *extreme.cases(), *found.cases()]


def tasks(quick: bool) -> list[Task]:
    """Return one task a case; quickly, with fewer ways to try it."""
    return [case.task(quick) for case in cases()]
