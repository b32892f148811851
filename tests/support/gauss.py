"""Gauss-Legendre quadrature with as many digits as its context has, with a fixed number of nodes.

mpmath's own `quad` doubles its nodes until two sums agree; for pieces that are cut to fit, the last sum is the only one
that counts, and those before it are half the work.
"""

import itertools
from collections.abc import Callable, Sequence
from typing import Any

from mpmath import MPContext
from mpmath.calculus.quadrature import GaussLegendre

_DEGREE = 4
"""24 nodes in each piece."""


def integral(context: MPContext, rate: Callable[[Any], Any], pieces: Sequence[Any]) -> Any:
    """Return the integral of a rate from the first of the ends of pieces to the last."""
    rule, total = GaussLegendre(context), context.mpf(0)
    for low, high in itertools.pairwise(pieces):
        nodes = rule.get_nodes(low, high, _DEGREE, context.prec)
        total += context.fdot((weight, rate(node)) for node, weight in nodes)
    return total
