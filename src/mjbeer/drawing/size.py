"""The size of a picture: its pixels, and the units that all sizes in it are multiples of."""

from mjbeer import require
from mjbeer.exceptions import ParameterError

UNITS = 36
"""Height of a picture in units."""
_LARGEST = 4096
"""Largest width and height [pixels] that H.264 encoders support."""


def whole(name: str, pixels: float) -> int:
    """Return a number of pixels as an integer.

    Raises:
      ParameterError: if it is not a whole number, not positive, or larger than encoders support.
    """
    number = require.positive(name, pixels)
    if number % 1 != 0 or number > _LARGEST:
        raise ParameterError(f"{name} must be a whole number of pixels up to {_LARGEST}, got {require.shown(pixels)}")
    return int(number)
