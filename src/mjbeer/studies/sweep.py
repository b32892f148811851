"""`mjbeer.sweep`: many scenes in one call, on all cores or on a cluster, as an `xarray.Dataset`."""

import math
import os
import pathlib
import re
import time
import warnings
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import closing, contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, ParameterError
from mjbeer.model.setting import FRICTION, MJBEER_INTEGRATORS, Integrator, Rolling, Setting
from mjbeer.output import files
from mjbeer.output.terminal import STDERR, progress_bar
from mjbeer.simulation.run import Run
from mjbeer.studies.sweep_runs import (
    ALWAYS,
    NOT_YET,
    PERIOD,
    STATUSES,
    Quantity,
    Work,
    collect_liquid_warnings,
    measure,
    run_all,
)
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    import xarray

_MOST_SCENES = 10_000_000
"""Largest number of scenes, which take a gigabyte."""
_SAVED_EVERY = 2.0
"""Time between two savings [s]: a process that is killed loses the scenes of this time."""
_UNITS = {
    "incline": "rad",
    "phi0": "rad",
    "phi_dot0": "rad/s",
    "density": "kg/m^3",
    "gravity": "m/s^2",
    "damping": "N m s",
    "drag": "kg/m",
    "viscosity": "m^2/s",
    "radius": "m",
    "length": "m",
    "offset": "m",
    "wheel_mass": "kg",
    "load_mass": "kg",
    "hoop_mass": "kg",
}
"""Units of the parameters of mjbeer's own scenes; a fill has no unit."""
_ROUNDING_OF_STEPS = 1e-10
"""Share of a timestep by which a duration may exceed a whole number of timesteps."""

Asked = str | Callable[[Run], float]
"""A quantity that the caller asks for: its name, or a function of a trajectory."""


@dataclass(frozen=True)
class Grid:
    """All combinations of the values of the parameters that vary.

    Each combination is a scene, and has a number. Scenes that differ in the last parameter alone
    are neighbours.
    """

    axes: Mapping[str, np.ndarray]
    """The values of each parameter that varies."""

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of values of each parameter."""
        return tuple(len(values) for values in self.axes.values())

    @property
    def size(self) -> int:
        """The number of scenes."""
        return math.prod(self.shape)

    def places(self, scene: int) -> list[int]:
        """Return the index of the value that each parameter has in a scene."""
        return [int(place) for place in np.unravel_index(scene, self.shape)]

    def parameters(self, scenes: np.ndarray | list[int]) -> list[dict[str, float]]:
        """Return the values of the parameters that vary, for each of the given scenes."""
        if not self.axes:
            return [{}]  # the only scene
        columns = []
        for values, places in zip(
            self.axes.values(), np.unravel_index(scenes, self.shape), strict=True
        ):
            columns.append(values[places].tolist())
        return [dict(zip(self.axes, row, strict=True)) for row in zip(*columns, strict=True)]

    def name(self, scene: int) -> str:
        """Return the values that a scene has, such as "incline[3] = 0.1, fill[0] = 0.5"."""
        values = self.parameters([scene])[0]
        parts = []
        for name, place in zip(values, self.places(scene), strict=True):
            parts.append(f"{name}[{place}] = {values[name]:.6g}")
        return ", ".join(parts)

    def groups(self) -> Iterator[tuple[str, list[int]]]:
        """Yield for each value a prefix, such as "fill[3]: ", and the scenes that have it."""
        if not self.axes:
            yield "", [0]
            return
        scenes = np.arange(self.size).reshape(self.shape)
        for dimension, name in enumerate(self.axes):
            for place, with_value in enumerate(np.moveaxis(scenes, dimension, 0)):
                yield f"{name}[{place}]: ", with_value.ravel().tolist()


def sweep(
    make: Callable[..., Scene],
    duration: float,
    phi0: ArrayLike,
    phi_dot0: ArrayLike = 0.0,
    *,
    tolerance: float | None = None,
    integrator: Integrator | None = None,
    timestep: float = 1e-3,
    rolling: Rolling = "reduced",
    friction: float = FRICTION,
    quantity: Asked | Sequence[Asked] = (),
    executor: Executor | None = None,
    output: str | os.PathLike[str] | None = None,
    progress: bool = True,
    **parameters: object,
) -> "xarray.Dataset":
    """Simulate many scenes over a `duration` [s] each, and return their results as a Dataset.

    The Dataset's attributes say how it was made, and those of its variables have their units.

    `make` returns a scene for its parameters, as `mjbeer.sliding` does. Those of the `parameters`
    that are lists or one-dimensional arrays are the dimensions of the sweep, in the order given,
    and all combinations of their entries are simulated; `phi0` [rad] and `phi_dot0` [rad/s] may be
    arrays, too, and come last. The other arguments are those of `simulate`. Every result is, to the
    last bit, the one that `simulate` gives for the scene with a sample at the end.

    Every sweep has the quantities "phi", "u", "phi_dot" and "u_dot" at the end, "error" (the
    estimate), "lowest_normal", "friction_needed", "parting_time" (from which N < 0; infinity if
    never), "energy_drift", "trusted" and "status" (0 where all went well). `quantity` asks for
    more, one or a list: "period", or a function that returns a number for a `Trajectory`. They need
    samples at every timestep, so that the sweep takes longer. Without a tolerance "error" needs a
    second run of each scene, which takes twice the time of the first.

    The scenes are simulated by an `executor` of `concurrent.futures`, by default by a thread for
    each core; the result does not depend on it. With an `output`, whose name ends in .nc, the
    results are saved as NetCDF every two seconds, and after an interruption the same call continues
    from that file. A file with other coordinates or attributes is refused, and so is one whose
    first scene has other results than now.

    A value that is not allowed is refused before anything runs. A scene that fails later has NaN
    for its quantities, and a status that says so; a scene that leaves the range of its model keeps
    its quantities and has a status, too. The attribute "failed" has a line for each kind of reason,
    with the first scene that failed for it. Warnings about liquids are issued before the first
    scene runs, once for each kind.

    Raises:
      ParameterError: if an argument is not allowed; for an entry of an array the message has its
        index.
      OutputError: if the output cannot be written.
      OSError: if the system ends one of the executor's processes.
    """
    require.choice("progress", progress, (True, False))
    if executor is not None and not isinstance(executor, Executor):
        raise ParameterError(
            f"executor must be a concurrent.futures.Executor, got {require.format_value(executor)}"
        )
    path = None if output is None else require.path(output)
    if path is not None and path.suffix != ".nc":
        raise ParameterError(
            f"the file's name must end in .nc, got {require.format_value(str(path))}"
        )
    if not callable(make):
        raise ParameterError(
            f"make must be a function that returns a scene, got {require.format_value(make)}"
        )
    grid, fixed = _grid_and_constants({**parameters, "phi0": phi0, "phi_dot0": phi_dot0})
    angles = grid.axes["phi0"] if "phi0" in grid.axes else fixed["phi0"]
    require.warn_of_degrees(float(np.abs(angles).max()))
    setting = Setting.of(
        integrator, tolerance, rolling=rolling, timestep=timestep, friction=friction
    )
    asked = _quantities(quantity, grid)
    times = _sample_times(
        require.positive("duration", duration, "s"), setting, every_step=bool(asked)
    )
    work = Work(make, fixed, setting, times, asked)
    for message in _check_values(work, grid):
        warnings.warn(message, LiquidWarning, stacklevel=2)
    dataset = _empty_dataset(work, grid)
    if path is not None:
        if path.exists():
            dataset = _load_unfinished(path, dataset, work, grid)
        _save(dataset, path)  # a file that cannot be written is an error before the first scene
    _simulate_missing(dataset, work, grid, executor, path, progress)
    return dataset


def _grid_and_constants(parameters: Mapping[str, Any]) -> tuple[Grid, dict[str, Any]]:
    """Return the parameters that vary, lists or arrays, as a grid, and those that do not."""
    axes: dict[str, np.ndarray] = {}
    fixed: dict[str, Any] = {}
    for name, value in parameters.items():
        if isinstance(value, (list, tuple, range)) or getattr(value, "ndim", 0) > 0:
            axes[name] = require.samples(name, value)
        elif name in ("phi0", "phi_dot0"):
            fixed[name] = require.number(name, value)
        else:
            fixed[name] = value
    grid = Grid(axes)
    if grid.size > _MOST_SCENES:
        raise ParameterError(
            f"a sweep has at most {_MOST_SCENES:,} scenes, got {grid.size:,}: cut it into several"
        )
    return grid, fixed


def _quantities(asked: Asked | Sequence[Asked], grid: Grid) -> tuple[Quantity, ...]:
    """Return the quantities that the caller asks for besides those of every sweep."""
    names = [quantity.name for quantity in ALWAYS]
    names += [PERIOD.name, "trusted", "status", *grid.axes]
    quantities: list[Quantity] = []
    listed = asked if isinstance(asked, (list, tuple)) else [asked]
    for wanted in listed:
        if callable(wanted):
            name = getattr(wanted, "__name__", type(wanted).__name__)
            names.append(name)
            quantities.append(Quantity(name, wanted))
        elif require.choice("quantity", wanted, names) == PERIOD.name and PERIOD not in quantities:
            quantities.append(PERIOD)
    for name in names:
        if names.count(name) > 1:
            raise ParameterError(
                f"there are two quantities or parameters of the name {name!r}: "
                "give one another name"
            )
    return tuple(quantities)


def _sample_times(duration: float, setting: Setting, every_step: bool) -> np.ndarray:
    """Return the times of the samples of each run [s]: its end alone, or all timesteps.

    MuJoCo's integrators end at a timestep, the first one at or after the duration.
    """
    timestep = setting.timestep
    if setting.tolerance is not None or setting.integrator in MJBEER_INTEGRATORS:
        end = duration
    else:
        end = timestep * math.ceil(duration / timestep * (1 - _ROUNDING_OF_STEPS))
    if not every_step:
        return np.array([end])
    times = timestep * np.arange(1 + math.floor(end / timestep * (1 + 1e-12)))
    if times[-1] < end * (1 - 1e-12):
        times = np.append(times, end)
    return times


def _check_values(work: Work, grid: Grid) -> list[str]:
    """Refuse a value that is allowed in no scene; return the warnings about liquids, one a kind.

    Two values may be allowed although their combination is not. The scene of such a combination
    fails later, as does a scene for which `make` raises an error of its own.

    Raises:
      ParameterError: if a value is allowed in no scene.
    """
    messages: dict[str, str] = {}

    def refusal(scene: int) -> Exception | None:
        """Return why a scene is refused; collect the warnings of one that is not."""
        with collect_liquid_warnings() as warned:
            try:
                work.scene(*grid.parameters([scene]))
            except ParameterError as error:
                return error
            except TypeError as error:  # `make` has no such parameter
                return error
            except Exception:
                pass
        for message in warned:
            messages.setdefault(_without_numbers(message), message)
        return None

    for name, scenes in grid.groups():
        error = refusal(scenes[0])
        if error is not None and all(refusal(scene) is not None for scene in scenes):
            raise ParameterError(f"{name}{error}") from error
    return list(messages.values())


def _empty_dataset(work: Work, grid: Grid) -> "xarray.Dataset":
    """Return the Dataset of a sweep before its first scene is simulated."""
    import xarray  # pandas comes with it: together they take half a second to import

    dims = tuple(grid.axes)
    variables: dict[str, Any] = {}
    for quantity in (*ALWAYS, *work.asked):
        about = {}
        if quantity.unit is not None:
            about = {"units": quantity.unit, "long_name": quantity.long_name}
        variables[quantity.name] = dims, np.full(grid.shape, np.nan), about
    trusted = np.zeros(grid.shape, np.bool_)
    variables["trusted"] = dims, trusted, {"long_name": "whether the run is trusted"}
    status = np.full(grid.shape, NOT_YET, np.int8)
    meaning = "; ".join(f"{number}: {text}" for number, text in STATUSES.items())
    variables["status"] = dims, status, {"long_name": meaning}
    coordinates = {}
    for name, values in grid.axes.items():
        about = {"units": _UNITS[name]} if name in _UNITS else {}
        coordinates[name] = name, values, about
    return xarray.Dataset(variables, coordinates, {**_call_attributes(work), "failed": ""})


def _call_attributes(work: Work) -> dict[str, Any]:
    """Return the arguments of the call, as attributes of a Dataset."""
    call: dict[str, Any] = {"make": _label(work.make), "duration": float(work.times[-1])}
    for name, value in vars(work.setting).items():
        if name != "folder":
            call[name] = "none" if value is None else value
    if work.setting.tolerance is not None:
        del call["integrator"]
    for name, value in work.fixed.items():
        call[name] = value if isinstance(value, float) else _describe(value)
    for package in ("mjbeer", "mujoco"):
        call[f"version of {package}"] = version(package)
    return call


def _describe(thing: Any) -> str:
    """Return the text of an object without its address, which differs between processes."""
    return re.sub(r" at 0x[0-9a-f]+", "", repr(thing))


def _without_numbers(text: str) -> str:
    """Return a text without its numbers: texts of one kind differ in their numbers alone."""
    return re.sub(r"\d[\d.e+-]*", "", text)


def _label(function: Any) -> str:
    """Return the name of a function with that of its module, or a text for a nameless object."""
    if hasattr(function, "__qualname__"):
        return f"{function.__module__}.{function.__qualname__}"
    return _describe(function)


def _save(dataset: "xarray.Dataset", path: pathlib.Path) -> None:
    """Write a sweep as NetCDF, whole or not at all."""
    with files.atomic_write(path) as temporary:
        dataset.to_netcdf(temporary, engine="scipy")


def _load_unfinished(
    path: pathlib.Path, new: "xarray.Dataset", work: Work, grid: Grid
) -> "xarray.Dataset":
    """Return the sweep in a file, which must be the same as the `new` one.

    Its coordinates, its attributes and the results of its first scene show whether it is.

    Raises:
      ParameterError: if it is another sweep, or the file has no sweep.
    """
    import xarray

    try:
        stored = xarray.load_dataset(path, engine="scipy")
        differences = _differences(stored, new)
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise ParameterError(f"{path} was not written by `mjbeer.sweep`: {error}") from error
    advice = "give another name, or remove it"
    if differences:
        raise ParameterError(
            f"{path} has another sweep, whose {', '.join(differences)} differ: {advice}"
        )
    simulated = np.flatnonzero(stored["status"].values != NOT_YET)
    if len(simulated) > 0:
        scene = int(simulated[0])
        now = measure(work, grid.parameters([scene])).values[0]
        before = [variable.values.flat[scene] for variable in stored.values()]
        if not np.array_equal(now, before, equal_nan=True):
            raise ParameterError(
                f"{path} has other results than this call, at {grid.name(scene)}: "
                f"another function, or another machine, made them: {advice}"
            )
    return stored


def _differences(stored: "xarray.Dataset", new: "xarray.Dataset") -> list[str]:
    """Return the names of attributes and coordinates that are not the same."""
    names = []
    for name, value in new.attrs.items():
        if name != "failed" and stored.attrs.get(name) != value:
            names.append(name)
    for name, values in new.coords.items():
        if not values.equals(stored.coords.get(name)):
            names.append(str(name))
    if list(stored) != list(new) or stored.sizes != new.sizes:
        names.append("quantities")
    return names


def _simulate_missing(
    dataset: "xarray.Dataset",
    work: Work,
    grid: Grid,
    executor: Executor | None,
    path: pathlib.Path | None,
    progress: bool,
) -> None:
    """Simulate the scenes that a sweep lacks, write them into its arrays, and save it to a path."""
    scenes = np.flatnonzero(dataset["status"].values == NOT_YET)
    arrays = [variable.values for variable in dataset.values()]  # in the order of measurement
    failures = _Failures(grid, dataset.attrs["failed"])
    saved = time.monotonic()
    done = 0
    try:
        with (
            progress_bar(STDERR if progress else None, 100) as advance,
            _executor(executor) as pool,
            closing(run_all(work, scenes, grid.parameters, pool)) as pieces,
        ):
            for piece, measured in pieces:
                for array, column in zip(arrays, measured.values.T, strict=True):
                    array.flat[piece] = column
                for scene, reason in zip(piece.tolist(), measured.reasons, strict=True):
                    if reason:
                        failures.add(scene, reason)
                dataset.attrs["failed"] = failures.text
                before = done
                done += len(piece)
                # The bar has a hundred steps: one for each per cent that this piece completes.
                for _ in range(100 * before // len(scenes), 100 * done // len(scenes)):
                    advance(f"{len(scenes)} scenes [%]")
                if path is not None and time.monotonic() - saved > _SAVED_EVERY:
                    _save(dataset, path)
                    saved = time.monotonic()
    finally:
        if path is not None:
            _save(dataset, path)


@contextmanager
def _executor(given: Executor | None) -> Generator[Executor]:
    """Yield the executor that was given, which stays open, or one with a thread for each core."""
    if given is not None:
        yield given
    else:
        with ThreadPoolExecutor(os.cpu_count()) as threads:
            yield threads


class _Failures:
    """Why scenes have failed: for each kind of reason, the first scene that failed for it."""

    def __init__(self, grid: Grid, text: str) -> None:
        self._grid = grid
        self._lines = {_without_numbers(line): line for line in text.splitlines()}

    def add(self, scene: int, reason: str) -> None:
        """Note the reason of a scene."""
        line = f"scene {scene} ({self._grid.name(scene)}): {reason}"
        kind = _without_numbers(line)
        known = self._lines.get(kind)
        if known is None or scene < _scene_number(known):
            self._lines[kind] = line

    @property
    def text(self) -> str:
        """A line for each kind, in the order of the scenes."""
        return "\n".join(sorted(self._lines.values(), key=_scene_number))


def _scene_number(line: str) -> int:
    """Return the number of the scene with which a line begins."""
    return int(line.split()[1])
