"""The domain of mjbeer, and checks of arguments: each returns the valid value, or raises an error.

The error is a `ParameterError`, which says what came and what is allowed.
"""

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

# The domain is that of cans: the smallest and the largest value of each quantity.
SIZE = (1e-3, 1e2)  # radius and length of a can [m]
MASS = (1e-9, 1e4)  # [kg]; a can may also have none
RATIO = (
    1e-3 * (1 - 1e-12),
    1e3 * (1 + 1e-12),
)  # mass of a can divided by that of its load; 1e-12 is for rounding
LARGEST_INERTIA = RATIO[1]  # of a can or a load, divided by its mass and the radius squared
INCLINE = (-math.radians(85), math.radians(85))  # [rad]
FILL = (0.01, 1.0)  # depth of beer divided by the can's diameter
GRAVITY = (1e-3, 1e3)  # [m/s^2]; there may also be none
ANGLE = 1e4  # largest initial angle, either way [rad]
RATE = 1e6  # largest initial rate, either way [rad/s]
TIMESTEP = (1e-7, 10.0)  # [s]

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = 80


def number(name: str, value: Any, unit: str = "") -> float:
    """Return a real number of Python's or NumPy's as a finite float."""
    # It is nearly always a float, and `_float` takes ten times as long to find out.
    result = value if type(value) is float else _float(value)
    if not math.isfinite(result):
        raise _refused(f"{name} must be a finite number", unit, value)
    return result


def within(
    name: str, value: Any, lowest: float, highest: float, unit: str = "", zero: bool = False
) -> float:
    """Return `value` as a float from `lowest` to `highest`, or 0 if `zero` is allowed as well."""
    result = number(name, value, unit)
    if lowest <= result <= highest or (zero and result == 0):
        return result
    allowed = f"between {lowest:.6g} and {highest:.6g}"
    if zero and lowest > 0:
        allowed = f"0, or {allowed}"
    raise _refused(f"{name} must be {allowed}", unit, value)


def fill(value: Any) -> float:
    """Return the depth of a load divided by the can's diameter as a float: half is 0.5, not 50."""
    lowest, highest = FILL
    result = number("fill", value)
    if lowest <= result <= highest:
        return result
    allowed = f"a fraction between {lowest:g} and {highest:g} (50 % is 0.5)"
    raise _refused(f"fill must be {allowed}", "", value)


def positive(name: str, value: Any, unit: str = "") -> float:
    """Return `value` as a finite float greater than 0."""
    result = number(name, value, unit)
    if result > 0:
        return result
    raise _refused(f"{name} must be greater than 0", unit, value)


def non_negative(name: str, value: Any, unit: str = "", finite: bool = True) -> float:
    """Return `value` as a float of 0 or more, which is finite unless infinity is allowed."""
    result = number(name, value, unit) if finite else _float(value)
    if result >= 0:
        return result
    infinity = "" if finite else " (infinity is allowed)"
    raise _refused(f"{name} must be 0 or greater{infinity}", unit, value)


def start(phi0: Any, phi_dot0: Any) -> tuple[float, float]:
    """Return the initial angle [rad] and its rate [rad/s] as floats."""
    angle = within("phi0", phi0, -ANGLE, ANGLE, "rad")
    rate = within("phi_dot0", phi_dot0, -RATE, RATE, "rad/s")
    return angle, rate


def warn_of_degrees(phi0: float) -> None:
    """Warn if an initial angle [rad] is more than a whole turn, as an angle in degrees would be.

    The warning points at the line that called the caller of this function.
    """
    if abs(phi0) > 2 * math.pi:
        meant = f"if degrees are meant, write math.radians({phi0:.6g})"
        message = f"phi0 = {phi0:.6g} is taken as radians: {meant}"
        warnings.warn(message, AngleWarning, stacklevel=3)


def samples(name: str, value: Any, unit: str = "") -> np.ndarray:
    """Return finite numbers as doubles, shape (samples,).

    They may come as a list, a tuple, a range or a one-dimensional array.
    """
    array = np.asarray(value)
    if array.ndim != 1 or not len(array) or array.dtype.kind not in "iuf":
        allowed = "a list or a one-dimensional array of one or more numbers"
        raise _refused(f"{name} must be {allowed}", unit, value)
    for index in np.flatnonzero(~np.isfinite(array)):
        number(f"{name}[{index}]", array[index], unit)
    return array.astype(float, copy=False)


def times(name: str, value: Any, increasing: bool = False) -> np.ndarray:
    """Return times [s], none of them before 0, as a new array of shape (samples,).

    A single number is one time.
    """
    array = samples(name, np.atleast_1d(value), "s").copy()
    if array.min() < 0:
        non_negative(f"{name}[{array.argmin()}]", array.min(), "s")
    steps = np.diff(array)
    if increasing and (steps <= 0).any():
        index = steps.argmin() + 1
        found = f"{name}[{index}] is {array[index]} s after {array[index - 1]} s"
        raise ParameterError(f"{name} must increase, but {found}")
    return array


def choice(name: str, value: Any, allowed: Iterable[T]) -> T:
    """Return `value` if it is one of the `allowed` names, or of True and False if those are."""
    options = tuple(allowed)
    if isinstance(value, (str, bool, np.bool_)):
        for option in options:
            if value == option:
                return option
    listed = ", ".join(map(repr, options))
    raise ParameterError(f"{name} must be one of {listed}; got {format_value(value)}")


def path(value: Any) -> pathlib.Path:
    """Return the path of a file to be written."""
    if not isinstance(value, (str, os.PathLike)) or not str(value):
        raise ParameterError(f"path must be the name of a file, got {format_value(value)}")
    return pathlib.Path(value)


def instance(name: str, value: Any, kind: type[T]) -> T:
    """Return `value` if it is an instance of `kind`."""
    if not isinstance(value, kind):
        raise ParameterError(f"{name} must be a {kind.__name__}, got {format_value(value)}")
    return value


def set_fields(instance: object, **values: Any) -> None:
    """Set fields of a frozen dataclass; only for those who make it, as its `__post_init__`."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)


def format_value(value: object) -> str:
    """Return a value as messages show it: in one short line, NumPy's numbers as plain ones."""
    plain = value.tolist() if isinstance(value, (np.generic, np.ndarray)) else value
    return " ".join(_SHORT.repr(plain).splitlines())


def _refused(what: str, unit: str, value: object) -> ParameterError:
    in_unit = f" [{unit}]" if unit else ""
    return ParameterError(f"{what}{in_unit}, got {format_value(value)}")


def _float(value: Any) -> float:
    """Return a real number as a float, which may be infinite; NaN for True, "1" and [1.0]."""
    if isinstance(value, np.ndarray):
        value = value[()]  # a number, if the array has no dimensions
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return float(value)
    return math.nan
