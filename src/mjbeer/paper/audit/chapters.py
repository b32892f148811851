"""The audit of K. T. McDonald's paper, equation by equation."""

from mjbeer.paper.audit import frozen, hopping, massive_can, oscillation, pendulum, segment, sliding
from mjbeer.paper.audit.claim import Claim

_CHAPTERS = (
    sliding,
    oscillation,
    segment,
    massive_can,
    frozen,
    hopping,
    pendulum,
)


def claims() -> list[Claim]:
    """All rows of the audit, in its order: by section of the paper, one row a claim."""
    return [claim for chapter in _CHAPTERS for claim in chapter.claims()]
