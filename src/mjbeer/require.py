"""The domain of mjbeer, and checks of arguments: each returns the valid value, or raises a `ParameterError`."""

import math
import numbers
import os
import pathlib
import reprlib
import warnings
from collections.abc import Iterable
from typing import Any, TypeVar

import numpy as np

from mjbeer.exceptions import AngleWarning, ParameterError

T = TypeVar("T")

# The domain: the smallest and the largest value.
SIZE = 1e-3, 1e2  # of radius and length of a can [m]
MASS = 1e-9, 1e4  # that is not 0 [kg]
RATIO = 1e4  # of two masses, or of inertias compared with masses at the radius, either way
INCLINE = -math.nextafter(math.pi / 2, 0), math.nextafter(math.pi / 2, 0)  # [rad]
FILL = 1e-12, 1.0  # filling height of beer, over the diameter
GRAVITY = 1e-3, 1e3  # that is not 0 [m/s^2]
ANGLE = 1e4  # at the start, either way [rad]
RATE = 1e6  # at the start, either way [rad/s]
TIMESTEP = 1e-7, 10.0  # [s]

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = 80


def number(name: str, value: Any, unit: str = "") -> float:
    """Return a real number of Python's or NumPy's as a finite float."""
    if not math.isfinite(result := _float(value)):
        raise _refused(f"{name} must be a finite number", unit, value)
    return result


def within(name: str, value: Any, lowest: float, highest: float, unit: str = "", zero: bool = False) -> float:
    """Return `value` as a float from `lowest` to `highest`, or 0 if `zero` is allowed as well."""
    if not (lowest <= (result := number(name, value, unit)) <= highest or (zero and result == 0)):
        either = "0, or " if zero and lowest > 0 else ""
        raise _refused(f"{name} must be {either}between {lowest:.6g} and {highest:.6g}", unit, value)
    return result


def fill(value: Any) -> float:
    """Return the height of a load over the can's diameter as a float; half is 0.5, and not 50."""
    lowest, highest = FILL
    if not lowest <= (result := number("fill", value)) <= highest:
        allowed = f"a fraction between {lowest:g} and {highest:g} (50 % is 0.5)"
        raise _refused(f"fill must be {allowed}", "", value)
    return result


def positive(name: str, value: Any, unit: str = "") -> float:
    """Return `value` as a finite float greater than 0."""
    if not (result := number(name, value, unit)) > 0:
        raise _refused(f"{name} must be greater than 0", unit, value)
    return result


def non_negative(name: str, value: Any, unit: str = "", finite: bool = True) -> float:
    """Return `value` as a float of 0 or more, which is finite unless infinity is allowed."""
    if not (result := number(name, value, unit) if finite else _float(value)) >= 0:
        raise _refused(f"{name} must be 0 or greater{'' if finite else ' (infinity is allowed)'}", unit, value)
    return result


def start(phi0: Any, phi_dot0: Any) -> tuple[float, float]:
    """Return the start angle [rad] and rate [rad/s] as floats."""
    return within("phi0", phi0, -ANGLE, ANGLE, "rad"), within("phi_dot0", phi_dot0, -RATE, RATE, "rad/s")


def warn_of_degrees(phi0: float) -> None:
    """Warn, where the calling function is called, of a start angle [rad] beyond a whole turn, as one in degrees is."""
    if abs(phi0) > 2 * math.pi:
        meant = f"phi0 = {phi0:.6g} is taken as radians: if degrees are meant, write math.radians({phi0:.6g})"
        warnings.warn(meant, AngleWarning, stacklevel=3)


def samples(name: str, value: Any, unit: str = "") -> np.ndarray:
    """Return a list, a tuple, a range or a one-dimensional array of finite numbers as doubles, of shape (samples,)."""
    array = np.asarray(value)
    if array.ndim != 1 or not len(array) or array.dtype.kind not in "iuf":
        raise _refused(f"{name} must be a list or a one-dimensional array of one or more numbers", unit, value)
    for index in np.flatnonzero(~np.isfinite(array)):
        number(f"{name}[{index}]", array[index], unit)
    return array.astype(float, copy=False)


def times(name: str, value: Any, increasing: bool = False) -> np.ndarray:
    """Return times [s], none before 0, or a single one, as a new array of shape (samples,)."""
    array = samples(name, np.atleast_1d(value), "s").copy()
    if array.min() < 0:
        non_negative(f"{name}[{array.argmin()}]", array.min(), "s")
    if increasing and ((steps := array[1:] - array[:-1]) <= 0).any():
        at = steps.argmin() + 1
        raise ParameterError(f"{name} must increase, but {name}[{at}] is {array[at]} s after {array[at - 1]} s")
    return array


def choice(name: str, value: Any, allowed: Iterable[T]) -> T:
    """Return `value` if it is one of the `allowed` names, or of True and False if those are."""
    for each in (names := tuple(allowed)):
        if isinstance(value, (str, bool, np.bool_)) and value == each:
            return each
    raise ParameterError(f"{name} must be one of {', '.join(map(repr, names))}; got {format_value(value)}")


def path(value: Any) -> pathlib.Path:
    """Return the path of a file to be written."""
    if not isinstance(value, (str, os.PathLike)) or not str(value):
        raise ParameterError(f"path must be the name of a file, got {format_value(value)}")
    return pathlib.Path(value)


def instance(name: str, value: Any, kind: type[T]) -> T:
    """Return `value` if it is an instance of a class of mjbeer."""
    if not isinstance(value, kind):
        raise ParameterError(f"{name} must be a {kind.__name__}, got {format_value(value)}")
    return value


def format_value(value: object) -> str:
    """Return a value as messages show it: in one short line, NumPy's numbers as plain ones."""
    text = _SHORT.repr(value.tolist() if isinstance(value, (np.generic, np.ndarray)) else value)
    return " ".join(text.splitlines())


def _refused(what: str, unit: str, value: object) -> ParameterError:
    return ParameterError(f"{what}{f' [{unit}]' if unit else ''}, got {format_value(value)}")


def _float(value: Any) -> float:
    """Return a number as a float, which may be infinite, and NaN for what is none, as True, "1" and [1.0] are not."""
    value = value[()] if isinstance(value, np.ndarray) else value  # a number, if the array has no dimensions
    return float(value) if isinstance(value, numbers.Real) and not isinstance(value, bool) else math.nan
