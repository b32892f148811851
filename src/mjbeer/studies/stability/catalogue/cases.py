"""All cases of the catalogue: stiff ones, extreme ones, and those that the random search found."""

from mjbeer.studies.stability.catalogue import extreme, found, found_in_regions, stiff
from mjbeer.studies.stability.catalogue.case import CatalogueCase
from mjbeer.studies.study import Task


def cases() -> list[CatalogueCase]:
    """Return all cases of the catalogue."""
    return [*stiff.cases(), *extreme.cases(), *found.cases(), *found_in_regions.cases()]


def tasks(quick: bool) -> list[Task]:
    """Return one task a case; a `quick` study tries each in fewer ways."""
    return [case.task(quick) for case in cases()]
