"""All claims of K. T. McDonald's paper that the audit measures, equation by equation."""

from mjbeer.paper.audit import frozen, hopping, massive_can, oscillation, pendulum, roll_down, segment, sliding
from mjbeer.paper.audit.claim import Claim

_CHAPTERS = (
    sliding,
    oscillation,
    segment,
    massive_can,
    frozen,
    roll_down,
    hopping,
    pendulum,
)


def claims() -> list[Claim]:
    """Return all claims of the audit in the order of the paper's sections; each becomes a row of the audit's table."""
    return [claim for chapter in _CHAPTERS for claim in chapter.claims()]
