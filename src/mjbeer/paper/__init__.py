"""McDonald's paper: its statements as measured claims, its scenarios as plots and films."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mjbeer.paper.claim import Claim


def claims() -> "list[Claim]":
    """Return all claims in the order of the paper's sections; nothing is simulated yet."""
    from mjbeer.paper import frozen, hopping, massive_can, oscillation, segment, sliding

    can = *sliding.CLAIMS, *oscillation.CLAIMS, *segment.CLAIMS, *massive_can.CLAIMS
    return [*can, *frozen.CLAIMS, *hopping.CLAIMS, *massive_can.OF_THE_WHEEL]
