"""Numbers as people write them."""

import math

_PLAIN = 1e-4
"""The least number that is written without a power of ten."""


def number(value: float) -> str:
    """Return a number with two digits as people write it: 0.087, 22, 3.4e-5; "none" if infinite."""
    if value == 0:
        return "0"
    if not math.isfinite(value):
        return "none"
    if value < _PLAIN:
        digits, power = f"{value:.1e}".split("e")
        return f"{digits}e{int(power)}"
    rounded = float(f"{value:.1e}")
    decimals = max(0, 1 - math.floor(math.log10(rounded)))
    return f"{rounded:,.{decimals}f}"
