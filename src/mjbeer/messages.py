"""What messages say: values in one short line, units, and the names that are spelled most like a wrong one."""

import difflib
import math
import reprlib
from collections.abc import Iterable
from typing import Any

import numpy as np

_SHOWN_ENTRIES = 4
"""Number of entries of an array that a message shows."""
_SHOWN_CHARACTERS = 80
"""Length at which a message abbreviates a value."""


def shown(value: object) -> str:
    """Return a value as messages show it: in one short line, and NumPy's numbers as plain ones."""
    try:
        text = _PLAIN.repr(value)
    except Exception:  # whatever the __repr__ of an unknown object raises, its type can be named
        text = f"<{type(value).__name__}>"
    return " ".join(text.splitlines())


class _Plain(reprlib.Repr):
    """Abbreviates long values, also within lists."""

    def __init__(self) -> None:
        super().__init__()
        self.maxstring = self.maxother = _SHOWN_CHARACTERS

    def repr_int(self, x: int, level: int) -> str:
        digits = math.ceil(x.bit_length() * math.log10(2))
        return repr(x) if digits < _SHOWN_CHARACTERS else f"an integer of about {digits} digits"

    def repr1(self, x: Any, level: int) -> str:
        if x is np.ma.masked:
            return "masked"
        if isinstance(x, np.generic) or (isinstance(x, np.ndarray) and x.ndim == 0):
            plain = x.item()
            return str(x) if isinstance(plain, (np.generic, np.ndarray)) else super().repr1(plain, level)
        if isinstance(x, np.ndarray):
            entries = [super(_Plain, self).repr1(each, level) for each in x.ravel()[:_SHOWN_ENTRIES].tolist()]
            entries += ["..."] if x.size > _SHOWN_ENTRIES else []
            return f"{type(x).__name__} of shape {x.shape} and type {x.dtype}: [{', '.join(entries)}]"
        return super().repr1(x, level)


_PLAIN = _Plain()


def in_unit(unit: str) -> str:
    """Return how a unit stands behind a number, as in "a finite number [kg]"; empty if there is no unit."""
    return f" [{unit}]" if unit else ""


def spelled_alike(word: str, allowed: Iterable[str]) -> list[str]:
    """Return the one or two allowed words that are spelled most like this one, in capitals or not; empty if none is."""
    folded = {each.casefold(): each for each in allowed}
    return [folded[each] for each in difflib.get_close_matches(word.casefold(), folded, n=2)]
