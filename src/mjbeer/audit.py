"""The audit of K. T. McDonald's paper, equation by equation."""

from mjbeer import (
    audit_can,
    audit_frozen,
    audit_hopping,
    audit_oscillation,
    audit_pendulum,
    audit_segment,
    audit_sliding,
)
from mjbeer.claim import Claim

_CHAPTERS = (
    audit_sliding,
    audit_oscillation,
    audit_segment,
    audit_can,
    audit_frozen,
    audit_hopping,
    audit_pendulum,
)


def claims() -> list[Claim]:
    """All rows of the audit, in its order: by section of the paper, one row a claim."""
    return [claim for chapter in _CHAPTERS for claim in chapter.claims()]
