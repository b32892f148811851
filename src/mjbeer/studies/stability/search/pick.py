"""Random choices out of a seed."""

import math
from typing import TypeVar

import numpy as np

T = TypeVar("T")


class Pick:
    """Makes random choices; the same seed makes the same ones."""

    def __init__(self, seed: int) -> None:
        self._generator = np.random.default_rng(seed)

    def between(self, low: float, high: float) -> float:
        """Return a number between two others, from an even distribution."""
        return float(self._generator.uniform(low, high))

    def decades(self, low: float, high: float) -> float:
        """Return a number between two positive others whose logarithm is evenly distributed."""
        return 10 ** self.between(math.log10(low), math.log10(high))

    def one(self, *options: T) -> T:
        """Return one of the options; all are equally likely."""
        return options[int(self._generator.integers(len(options)))]

    def sign(self) -> int:
        """Return 1 or -1."""
        return self.one(1, -1)

    def chance(self, probability: float) -> bool:
        """Return True with a probability."""
        return bool(self._generator.random() < probability)
