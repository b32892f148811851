"""Checks of arguments: each returns the valid value, or raises an error that names the value and what is allowed."""

import math
import numbers
import os
import pathlib
import warnings
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from decimal import Decimal
from typing import Any, TypeVar

import numpy as np

from mjbeer.exceptions import AngleWarning, ParameterError
from mjbeer.messages import in_unit, shown, spelled_alike

T = TypeVar("T")
Name = TypeVar("Name", bound=str)

SMALLEST, LARGEST = 1e-50, 1e50
"""Smallest and largest magnitude of a number that is not 0. Nothing that rolls comes near them, and a product or
quotient of six such numbers is between 1e-300 and 1e300, which a double can hold."""
_FARTHEST = 1e10
"""Largest magnitude of a start angle [rad]: there doubles are 2e-6 rad apart. MuJoCo has the same limit (mjMAXVAL)."""


def number(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a finite float.

    Python's and NumPy's real numbers, fractions, decimals and arrays without dimensions are numbers.

    Raises:
      ParameterError: if `value` is not a number, is NaN, or is infinite.
    """
    result = _float(value)
    if not math.isfinite(result):
        raise ParameterError(f"{name} must be a finite number{in_unit(unit)}, got {shown(value)}")
    return result


def positive(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a float greater than zero.

    Raises:
      ParameterError: if `value` is not greater than zero, or not between `SMALLEST` and `LARGEST`.
    """
    result = number(name, value, unit)
    if result <= 0:
        raise ParameterError(f"{name} must be greater than 0{in_unit(unit)}, got {shown(value)}")
    if not SMALLEST <= result <= LARGEST:
        raise ParameterError(f"{name} must be between {SMALLEST:g} and {LARGEST:g}{in_unit(unit)}, got {shown(value)}")
    return result


def non_negative(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a float of zero or more.

    Raises:
      ParameterError: if `value` is negative, or neither zero nor between `SMALLEST` and `LARGEST`.
    """
    result = number(name, value, unit)
    if result < 0:
        raise ParameterError(f"{name} must be 0 or greater{in_unit(unit)}, got {shown(value)}")
    if result != 0 and not SMALLEST <= result <= LARGEST:
        raise ParameterError(
            f"{name} must be 0, or between {SMALLEST:g} and {LARGEST:g}{in_unit(unit)}, got {shown(value)}"
        )
    return result


def friction(value: float) -> float:
    """Return a coefficient of friction as a float of zero or more, or infinity.

    Raises:
      ParameterError: if `value` is neither.
    """
    result = _float(value)
    if not result >= 0:
        raise ParameterError(f"friction must be 0 or greater (infinity is allowed), got {shown(value)}")
    return result if result == math.inf else non_negative("friction", result)


def start(phi0: float, phi_dot0: float) -> tuple[float, float]:
    """Return the start angle [rad] and rate [rad/s] as floats.

    Raises:
      ParameterError: if either is not finite, or is beyond `_FARTHEST` or `LARGEST`.
    """
    values = []
    for name, value, unit, limit in (("phi0", phi0, "rad", _FARTHEST), ("phi_dot0", phi_dot0, "rad/s", LARGEST)):
        values.append(number(name, value, unit))
        if abs(values[-1]) > limit:
            raise ParameterError(f"{name} must be between {-limit:g} and {limit:g} [{unit}], got {shown(value)}")
    return values[0], values[1]


def samples(name: str, value: Any, unit: str = "") -> np.ndarray:
    """Return at least one finite number as an array of shape (samples,).

    `value` is a list, a tuple, a range or a one-dimensional array; an array of doubles is returned as it is.

    Raises:
      ParameterError: if `value` is none of these, is empty, or has an entry that is no finite number; the message names
        the entry.
    """
    entries = _entries(value)
    if entries is None or not len(entries):
        raise ParameterError(
            f"{name} must be a list or a one-dimensional array of one or more numbers{in_unit(unit)}, "
            f"got {shown(value)}"
        )
    if isinstance(entries, np.ndarray) and entries.dtype != object and not np.ma.is_masked(entries):
        with np.errstate(over="ignore"):  # a long double may become infinite
            array = entries.astype(float, copy=False)
        if np.isfinite(array).all():
            return array
    return np.array([number(f"{name}[{index}]", each, unit) for index, each in enumerate(entries)])


def times(name: str, value: Any, increasing: bool = False) -> np.ndarray:
    """Return times [s] as a new array of shape (samples,).

    `value` is what `samples` takes, with no time before 0. Unless the times have to be `increasing`, a single number
    will do as well.

    Raises:
      ParameterError: if `value` is nothing of that; the message names the first entry that is wrong.
    """
    single = not increasing and _is_number(value)
    array = np.array([number(name, value, "s")]) if single else samples(name, value, "s").copy()
    for index in np.flatnonzero(~((array == 0) | ((array >= SMALLEST) & (array <= LARGEST)))):
        non_negative(name if single else f"{name}[{index}]", array[index], "s")
    back = np.flatnonzero(np.diff(array) <= 0) + 1
    if increasing and len(back):
        earlier, later = (shown(array[index]) for index in (back[0] - 1, back[0]))
        raise ParameterError(f"{name} must increase, but {name}[{back[0]}] is {later} s after {earlier} s")
    return array


def choice(name: str, value: str, allowed: Iterable[Name]) -> Name:
    """Return `value` if it is one of the `allowed` names.

    Raises:
      ParameterError: if it is none of them; the message lists the names, and asks after one that is spelled alike.
    """
    names = {str(name): name for name in allowed}
    if not isinstance(value, str) or value not in names:
        listed = ", ".join(repr(name) for name in names)
        alike = " or ".join(repr(name) for name in spelled_alike(value, names)) if isinstance(value, str) else ""
        question = f": did you mean {alike}?" if alike else ""
        raise ParameterError(f"{name} must be one of {listed}; got {shown(value)}{question}")
    return names[value]


def path(value: str | os.PathLike[str]) -> pathlib.Path:
    """Return the path of a file to be written.

    Raises:
      ParameterError: if `value` is no text and no path, or has a null character, which no system allows.
    """
    name = os.fspath(value) if isinstance(value, os.PathLike) else value
    if not isinstance(name, str) or not name or "\0" in name:
        raise ParameterError(f"path must be the name of a file, got {shown(value)}")
    return pathlib.Path(name)


def radians(phi0: float, many_turns: bool) -> None:
    """Warn if a start angle [rad] is beyond a whole turn, as one in degrees would be, unless `many_turns` are meant.

    The warning points to the line that called the function by which this one was called.

    Raises:
      ParameterError: if `many_turns` is neither True nor False.
    """
    if not boolean("many_turns", many_turns) and abs(phi0) > 2 * math.pi:
        warnings.warn(
            f"phi0 = {phi0:.6g} is taken as radians, {phi0 / (2 * math.pi):.4g} turns: if degrees are meant, write "
            f"math.radians({phi0:.6g}); if radians are, add many_turns=True",
            AngleWarning,
            stacklevel=3,
        )


def boolean(name: str, value: bool) -> bool:
    """Return `value` as True or False.

    Raises:
      ParameterError: if it is neither: a text such as "no" would count as true.
    """
    if not isinstance(value, (bool, np.bool_)):
        raise ParameterError(f"{name} must be True or False, got {shown(value)}")
    return bool(value)


def instance(name: str, value: T, kind: type[T]) -> T:
    """Return `value` if it is an instance of a class of mjbeer.

    Raises:
      ParameterError: if it is not; the message names the class.
    """
    if not isinstance(value, kind):
        raise ParameterError(f"{name} must be a {kind.__name__}, got {shown(value)}")
    return value


def store(instance: object, **values: object) -> None:
    """Set fields of a frozen dataclass to their checked values: single precision would spread from there."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)


@contextmanager
def from_given(**given: float) -> Generator[None]:
    """Add to an error about computed values the values that were given.

    Raises:
      ParameterError: the error from inside the `with` block, with the addition.
    """
    try:
        yield
    except ParameterError as error:
        listed = ", ".join(f"{name} = {shown(value)}" for name, value in given.items())
        raise ParameterError(f"{error}, which follows from {listed}") from None


def _float(value: Any) -> float:
    """Return a number as a float, which may be infinite, and NaN for what is no number."""
    try:
        return float(value) if _is_number(value) else math.nan
    except (ValueError, OverflowError):  # a decimal that signals, and an integer of 400 digits
        return math.nan


def _is_number(value: object) -> bool:
    """Return whether a value is a real number of Python's or NumPy's, which True, "1" and [1.0] are not."""
    if isinstance(value, np.ndarray):
        return value.ndim == 0 and value.dtype.kind in "iuf" and not np.ma.is_masked(value)
    return isinstance(value, (numbers.Real, Decimal)) and not isinstance(value, (bool, np.timedelta64))


def _entries(value: Any) -> Any:
    """Return what has numbers to be checked: a list, a tuple, a range or an array; None for anything else."""
    if isinstance(value, (list, tuple, range)):
        return value
    if isinstance(value, type) or not hasattr(value, "__array__"):
        return None
    try:
        array = value if np.ma.is_masked(value) else np.asarray(value)
    except Exception:  # whatever an object of another library raises, it is no array
        return None
    return array if array.ndim == 1 and array.dtype.kind in "iufO" else None
