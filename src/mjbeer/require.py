"""Checks of arguments: each returns the valid value, or raises an error that names the value and what is allowed."""

import math
from collections.abc import Iterable

from mjbeer.exceptions import ParameterError

_LARGEST = 1e100
"""Largest magnitude of a start [rad, rad/s]: the square of a larger one may overflow."""


def number(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a finite float.

    Raises:
      ParameterError: if `value` is not a number, is NaN, or is infinite.
    """
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ParameterError(f"{name} must be a finite number{_in(unit)}, got {value!r}") from None
    if isinstance(value, (str, bytes, bool)) or not math.isfinite(result):
        raise ParameterError(f"{name} must be a finite number{_in(unit)}, got {value!r}")
    return result


def positive(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a finite float greater than zero.

    Raises:
      ParameterError: if `value` is not finite and greater than zero.
    """
    result = number(name, value, unit)
    if result <= 0:
        raise ParameterError(f"{name} must be greater than 0{_in(unit)}, got {value!r}")
    return result


def non_negative(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a finite float of zero or more.

    Raises:
      ParameterError: if `value` is not finite, or is negative.
    """
    result = number(name, value, unit)
    if result < 0:
        raise ParameterError(f"{name} must be 0 or greater{_in(unit)}, got {value!r}")
    return result


def store_floats(instance: object, *names: str) -> None:
    """Convert the named attributes of a frozen dataclass to doubles: single precision would spread from there."""
    for name in names:
        object.__setattr__(instance, name, float(getattr(instance, name)))


def start(phi0: float, phi_dot0: float) -> tuple[float, float]:
    """Return the start angle [rad] and rate [rad/s] as floats.

    Raises:
      ParameterError: if either is not finite, or is so large that its square may overflow.
    """
    values = number("phi0", phi0, "rad"), number("phi_dot0", phi_dot0, "rad/s")
    for name, value in zip(("phi0", "phi_dot0"), values, strict=True):
        if abs(value) > _LARGEST:
            raise ParameterError(f"{name} must be between -1e100 and 1e100, got {value!r}")
    return values


def choice(name: str, value: str, allowed: Iterable[str]) -> str:
    """Return `value` if it is one of the `allowed` names.

    Raises:
      ParameterError: if it is none of them; the message lists the names.
    """
    names = tuple(allowed)
    if not isinstance(value, str) or value not in names:
        listed = ", ".join(repr(name) for name in names)
        raise ParameterError(f"{name} must be one of {listed}; got {value!r}")
    return value


def _in(unit: str) -> str:
    return f" [{unit}]" if unit else ""
