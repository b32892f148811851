"""Which scenes a sweep has: every combination of its parameters' values, or one scene for each entry of all of them."""

import functools
import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.studies.sweep.work import Work
from mjbeer.theory.scene import Scene

SCENE = "scene"
"""The one dimension of a sweep over a list of scenes."""


@dataclass(frozen=True)
class Plan:
    """The scenes of a sweep, which are numbered as the entries of its arrays are, the last dimension first."""

    axes: Mapping[str, np.ndarray]
    """The values of each parameter that varies, in the order given."""
    paired: bool
    """Whether the entries of all parameters belong together, one scene for each, instead of being combined."""

    @property
    def dims(self) -> tuple[str, ...]:
        """Return the names of the dimensions of the sweep's arrays."""
        return (SCENE,) if self.paired else tuple(self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the shape of the sweep's arrays."""
        lengths = tuple(len(values) for values in self.axes.values())
        return lengths[:1] if self.paired else lengths

    def rows(self, scenes: np.ndarray) -> np.ndarray:
        """Return the parameters of the scenes with these numbers, shape (scenes, parameters)."""
        places = self._places(scenes)
        rows = np.empty((len(scenes), len(self.axes)))
        for column, (values, place) in enumerate(zip(self.axes.values(), places, strict=True)):
            rows[:, column] = values[place]
        return rows

    def index(self, scene: int) -> tuple[int, ...]:
        """Return where a scene is in the sweep's arrays."""
        return (scene,) if self.paired else tuple(int(place) for place in self._places(scene))

    def named(self, scene: int) -> str:
        """Return the parameters of a scene in words, as "incline[3] = 0.1, fill[0] = 0.5"."""
        places = self._places(scene)
        return ", ".join(
            f"{name}[{place}] = {values[place]:.6g}"
            for (name, values), place in zip(self.axes.items(), places, strict=True)
        )

    def check(self, work: Work) -> None:
        """Check that every value is allowed in some scene; where the scenes are paired, that all scenes are.

        Two values may be allowed, and their combination not: such a scene is left to fail by itself.

        Raises:
          ParameterError: for the first value that is not allowed; the message has its index.
        """
        if self.paired or not self.axes:
            for scene in range(math.prod(self.shape)):
                if error := self._problem(work, scene):
                    raise ParameterError(f"{self.named(scene)}: {error}" if self.axes else str(error)) from error
            return
        numbers = np.arange(math.prod(self.shape)).reshape(self.shape)
        for dimension, name in enumerate(self.axes):
            for index, of_value in enumerate(np.moveaxis(numbers, dimension, 0)):
                problems = (self._problem(work, int(scene)) for scene in of_value.flat)
                error = first = next(problems)
                while error is not None:
                    error = next(problems, first)
                    if error is first:
                        raise ParameterError(f"{name}[{index}]: {first}") from first

    def _places(self, scenes: Any) -> Sequence[Any]:
        """Return the index in the values of each parameter that some scenes have."""
        if self.paired or not self.axes:
            return [scenes] * len(self.axes)
        return np.unravel_index(scenes, self.shape)

    def _problem(self, work: Work, scene: int) -> ParameterError | None:
        """Return why a scene cannot be made, or None if it can.

        Raises:
          ParameterError: if what makes the scenes does not return one, or takes other parameters.
        """
        (row,) = self.rows(np.array([scene]))
        try:
            made, phi0, phi_dot0 = work.scene(row)
            require.start(phi0, phi_dot0)
        except ParameterError as error:
            return error
        except TypeError as error:
            raise ParameterError(
                f"make must be a function that returns a scene, got {require.shown(work.make)}: {error}"
            ) from error
        if not isinstance(made, Scene):
            raise ParameterError(
                f"make must be a function that returns a scene, got {require.shown(work.make)}, which returns "
                f"{require.shown(made)}"
            )
        return None


def arrange(parameters: Mapping[str, Any], paired: bool) -> tuple[Plan, dict[str, Any]]:
    """Return the plan of the parameters that are lists or arrays, and the other parameters.

    Raises:
      ParameterError: if an array is empty, has more than one dimension or an entry that is no finite number; or if the
        arrays of paired scenes differ in length.
    """
    axes = {name: require.samples(name, value) for name, value in parameters.items() if _several(value)}
    lengths = {name: len(values) for name, values in axes.items()}
    if paired and len(set(lengths.values())) != 1:
        told = ", ".join(f"{name} has {length}" for name, length in lengths.items()) or "no parameter is an array"
        raise ParameterError(f"paired=True needs arrays of one length: {told}")
    return Plan(axes, paired), {name: value for name, value in parameters.items() if name not in axes}


def check_names(make: Callable[..., Scene], parameters: Mapping[str, Any]) -> None:
    """Check that what makes the scenes has these parameters, and that it needs no others.

    Raises:
      ParameterError: if it has no such parameter, or is no function.
    """
    if not callable(make):
        raise ParameterError(f"make must be a function that returns a scene, got {require.shown(make)}")
    try:
        known = inspect.signature(make).parameters
    except (ValueError, TypeError):  # some functions in C have no signature; they are seen to fail when they are called
        return
    if any(each.kind is inspect.Parameter.VAR_KEYWORD for each in known.values()):
        return
    for name, value in parameters.items():
        if name not in known:
            alike = " or ".join(repr(each) for each in require.spelled_alike(name, known))
            raise ParameterError(
                f"{label(make)} has no parameter {name!r}, which got {require.shown(value)}"
                + (f": did you mean {alike}?" if alike else f"; it has {', '.join(known)}")
            )


def label(function: Callable[..., Any]) -> str:
    """Return the name of a function; that of a partial one has its arguments, too."""
    if isinstance(function, functools.partial):
        named = [f"{name}={value!r}" for name, value in function.keywords.items()]
        return f"{label(function.func)}({', '.join([*map(repr, function.args), *named])})"
    return getattr(function, "__name__", type(function).__name__)


def _several(value: Any) -> bool:
    """Return whether a parameter is a list of values, and not one value."""
    return isinstance(value, (list, tuple, range)) or getattr(value, "ndim", 0) > 0
