"""Random choices: a quantity says as data what a number is chosen from.

It is a number, a `Uniform` or `LogUniform` range, or `OneOf` several of these.
"""

import math
from typing import NamedTuple, TypeVar

import numpy as np

T = TypeVar("T")


class Uniform(NamedTuple):
    """A number between two others, with a uniform distribution."""

    low: float
    high: float


class LogUniform(NamedTuple):
    """A number between two positive ones, whose logarithm has a uniform distribution."""

    low: float
    high: float


class OneOf:
    """One of several quantities, each of which is equally likely."""

    def __init__(self, *options: "Quantity") -> None:
        self.options = options


class Minus(NamedTuple):
    """A number minus a quantity."""

    number: float
    by: "Quantity"


Quantity = float | Uniform | LogUniform | OneOf | Minus
"""What a number is chosen from; a float stands for itself."""


def signed(quantity: Quantity) -> OneOf:
    """Return a quantity with either sign."""
    return OneOf(quantity, Minus(0, quantity))


class RandomPicker:
    """Makes random choices; the same seed makes the same ones."""

    def __init__(self, seed: int) -> None:
        self._generator = np.random.default_rng(seed)

    def number(self, quantity: Quantity) -> float:
        """Return a value of a quantity."""
        match quantity:
            case Uniform(low, high):
                return float(self._generator.uniform(low, high))
            case LogUniform(low, high):
                return 10 ** self.number(Uniform(math.log10(low), math.log10(high)))
            case Minus(number, by):
                return number - self.number(by)
            case OneOf():
                return self.number(self.one(*quantity.options))
        return float(quantity)

    def one(self, *options: T) -> T:
        """Return one of the options, each of which is equally likely."""
        if len(options) == 1:
            return options[0]
        return options[int(self._generator.integers(len(options)))]
