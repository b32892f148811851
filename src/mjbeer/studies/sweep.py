"""`mjbeer.sweep`: many scenes in one call, on all cores or on a cluster, as an `xarray.Dataset`."""

import math
import os
import pathlib
import re
import time
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import closing, nullcontext
from functools import partial
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
from mjbeer.studies.sweep_runs import ALWAYS, NOT_YET, PERIOD, STATUSES, Work, collect_liquid_warnings, measure, run_all
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    import xarray

_MOST_SCENES = 10_000_000
"""Largest number of scenes, which take a gigabyte."""
_SAVED_EVERY = 2.0
"""Time between two savings [s]: what is done in it may be lost."""
_UNITS = {"incline": "rad", "phi0": "rad", "phi_dot0": "rad/s", "density": "kg/m^3", "gravity": "m/s^2"}
_UNITS |= {"damping": "N m s", "drag": "kg/m", "viscosity": "m^2/s", "radius": "m", "length": "m", "offset": "m"}
_UNITS |= {"wheel_mass": "kg", "load_mass": "kg", "hoop_mass": "kg"}
"""Units of the parameters of mjbeer's own scenes; a fill has none."""

Axes = Mapping[str, np.ndarray]
"""The values of each parameter that varies; scenes are numbered with those of the last as neighbours."""
Asked = str | Callable[[Run], float]
"""A quantity that is measured if it is asked for: its name, or a function of a trajectory."""


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
    **parameters: Any,
) -> "xarray.Dataset":
    """Return many scenes, simulated over a `duration` [s] each, as a Dataset with units and this call as attributes.

    `make` returns a scene for its parameters, as `mjbeer.sliding` does. Those of the `parameters` that are lists or
    one-dimensional arrays are the dimensions of the sweep, in the order given, and all combinations of their entries
    are simulated; `phi0` [rad] and `phi_dot0` [rad/s] may be arrays, too, and come last. The other arguments are those
    of `simulate`, and each scene is what `simulate` gives for it with a sample at the end, to the last bit.

    Every sweep has the quantities "phi", "u", "phi_dot" and "u_dot" at the end, "error" (the estimate),
    "lowest_normal", "friction_needed", "parting_time" (from which N < 0; infinity if never), "energy_drift", "trusted"
    and "status" (0 where all went well). `quantity` asks for more, one or a list: "period", or a function of a
    `Trajectory` that returns a number, which has samples at every timestep and so takes longer. Without a tolerance
    "error" needs a second run of each scene, of twice the time.

    The scenes are simulated by an `executor` of `concurrent.futures`, by default by a thread for each core; the result
    does not depend on it. With an `output`, whose name ends in .nc, what is there is saved as NetCDF every two seconds,
    and the same call goes on from there after an interruption. A file with other coordinates or attributes
    is refused, and so is one whose first scene has other results than now.

    A value that is not allowed is refused before anything runs. A scene that fails later has NaN and a status, one that
    leaves the range of its model a status, and the attribute "failed" has a line for each kind of reason, with the
    first scene of it. What liquids warn of is said beforehand, once for each kind.

    Raises:
      ParameterError: if an argument is not allowed; for an entry of an array the message has its index.
      OutputError: if the output cannot be written.
      OSError: if the system ends one of the executor's processes.
    """
    require.choice("progress", progress, (True, False))
    if executor is not None and not isinstance(executor, Executor):
        raise ParameterError(f"executor must be a concurrent.futures.Executor, got {require.format_value(executor)}")
    path = None if output is None else require.path(output)
    if path is not None and path.suffix != ".nc":
        raise ParameterError(f"the file's name must end in .nc, got {require.format_value(str(path))}")
    if not callable(make):
        raise ParameterError(f"make must be a function that returns a scene, got {require.format_value(make)}")
    axes, fixed = _arranged({**parameters, "phi0": phi0, "phi_dot0": phi_dot0})
    require.warn_of_degrees(float(np.abs(axes.get("phi0", fixed.get("phi0"))).max()))
    setting = Setting.of(integrator, tolerance, rolling=rolling, timestep=timestep, friction=friction)
    measures = _asked(quantity, axes)
    times = _times(require.positive("duration", duration, "s"), setting, bool(measures))
    work = Work(make, fixed, setting, times, measures)
    for note in _checked(work, axes):
        warnings.warn(note, LiquidWarning, stacklevel=2)
    found = _empty(work, axes)
    if path is not None:
        if path.exists():
            found = _continued(path, found, work, axes)
        _save(found, path)  # a file that cannot be written is an error before the first scene
    _fill(found, work, axes, executor, path, progress)
    return found


def _arranged(parameters: Mapping[str, Any]) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Return the parameters that are lists or arrays, and the others."""
    listed = list, tuple, range
    several = [name for name, value in parameters.items() if isinstance(value, listed) or getattr(value, "ndim", 0) > 0]
    axes = {name: require.samples(name, parameters[name]) for name in several}
    fixed = {name: value for name, value in parameters.items() if name not in axes}
    fixed |= {name: require.number(name, fixed[name]) for name in ("phi0", "phi_dot0") if name in fixed}
    if (count := math.prod(_shape(axes))) > _MOST_SCENES:
        raise ParameterError(f"a sweep has at most {_MOST_SCENES:,} scenes, got {count:,}: cut it into several")
    return axes, fixed


def _shape(axes: Axes) -> tuple[int, ...]:
    return tuple(len(values) for values in axes.values())


def _varied(axes: Axes, scenes: np.ndarray | list[int]) -> list[dict[str, float]]:
    """Return what varies, as the scenes with these numbers have it."""
    if not axes:
        return [{}]  # the only one
    columns = zip(axes.values(), np.unravel_index(scenes, _shape(axes)), strict=True)
    rows = zip(*(values[places].tolist() for values, places in columns), strict=True)
    return [dict(zip(axes, row, strict=True)) for row in rows]


def _named(axes: Axes, scene: int) -> str:
    """Return what varies, as the scene with this number has it, as "incline[3] = 0.1, fill[0] = 0.5"."""
    values = zip(_varied(axes, [scene])[0].items(), np.unravel_index(scene, _shape(axes)), strict=True)
    return ", ".join(f"{name}[{place}] = {value:.6g}" for (name, value), place in values)


def _asked(quantity: Asked | Sequence[Asked], axes: Axes) -> dict[str, Callable[[Run], Any]]:
    """Return what measures the quantities that are asked for besides those of every sweep, by their names."""
    names, found = [*ALWAYS, "period", "trusted", "status", *axes], dict[str, Callable[[Run], Any]]()
    for each in quantity if isinstance(quantity, (list, tuple)) else (quantity,):
        if callable(each):
            names.append(getattr(each, "__name__", type(each).__name__))
            found[names[-1]] = each
        elif require.choice("quantity", each, names) == "period":
            found["period"] = PERIOD[0]
    if clash := [name for name in names if names.count(name) > 1]:
        raise ParameterError(f"there are two quantities or parameters of the name {clash[0]!r}: give one another name")
    return found


def _times(duration: float, setting: Setting, every_step: bool) -> np.ndarray:
    """Return the times of the samples of each run [s]: its end, or all timesteps if that is asked for.

    MuJoCo's integrators end at a timestep, the first one at or after the duration.
    """
    whole = setting.timestep * math.ceil(duration / setting.timestep * (1 - 1e-10))  # which allows for rounding
    end = duration if setting.tolerance is not None or setting.integrator in MJBEER_INTEGRATORS else whole
    if not every_step:
        return np.array([end])
    times = setting.timestep * np.arange(1 + math.floor(end / setting.timestep * (1 + 1e-12)))
    return times if times[-1] >= end * (1 - 1e-12) else np.append(times, end)


def _checked(work: Work, axes: Axes) -> list[str]:
    """Check that every value is allowed in some scene; return what liquids have warned of, once for each kind.

    Two values may be allowed, and their combination not: such a scene is left to fail by itself, as is one for which
    `make` raises an error of its own.
    """
    notes: dict[str, str] = {}

    def problem(scene: int) -> Exception | None:
        with collect_liquid_warnings() as warnings_of_liquids:
            try:
                work.scene(*_varied(axes, [scene]))
            except (ParameterError, TypeError) as error:  # the latter if `make` has no such parameter
                return error
            except Exception:
                pass
        for note in warnings_of_liquids:
            notes.setdefault(_numberless(note), note)
        return None

    scenes = np.arange(math.prod(_shape(axes))).reshape(_shape(axes))
    groups: Iterable[tuple[str, Any]] = (
        (f"{name}[{place}]: ", of_value.flat)
        for dimension, name in enumerate(axes)
        for place, of_value in enumerate(np.moveaxis(scenes, dimension, 0))
    )
    for name, group in groups if axes else [("", [0])]:
        if (error := problem(int(group[0]))) and all(problem(int(scene)) for scene in group):
            raise ParameterError(f"{name}{error}") from error
    return list(notes.values())


def _empty(work: Work, axes: Axes) -> "xarray.Dataset":
    """Return the Dataset of a sweep of which nothing is simulated yet."""
    import xarray  # pandas comes with it: together they take half a second to import

    dims, shape = tuple(axes), _shape(axes)
    variables: dict[str, Any] = {}
    for name in (*ALWAYS, *work.measures):
        _, *about = (ALWAYS | {"period": PERIOD}).get(name, (None,))
        variables[name] = dims, np.full(shape, np.nan), dict(zip(("units", "long_name"), about, strict=False))
    variables["trusted"] = dims, np.zeros(shape, np.bool_), {"long_name": "whether the run is trusted"}
    meaning = "; ".join(f"{number}: {text}" for number, text in STATUSES.items())
    variables["status"] = dims, np.full(shape, NOT_YET, np.int8), {"long_name": meaning}
    units = {name: {"units": unit} for name, unit in _UNITS.items()}
    coordinates = {name: (name, values, units.get(name, {})) for name, values in axes.items()}
    given = {"make": _label(work.make), "duration": float(work.times[-1])}
    setting = {name: value for name, value in vars(work.setting).items() if name != "folder"}
    given |= {name: "none" if value is None else value for name, value in setting.items()}
    if work.setting.tolerance is not None:
        del given["integrator"]
    given |= {name: value if isinstance(value, float) else _shown(value) for name, value in work.fixed.items()}
    given |= {f"version of {package}": version(package) for package in ("mjbeer", "mujoco")}
    return xarray.Dataset(variables, coordinates, {**given, "failed": ""})


def _shown(thing: Any) -> str:
    """Return what an object is, without what is another in each process."""
    return re.sub(r" at 0x[0-9a-f]+", "", repr(thing))


def _numberless(text: str) -> str:
    """Return a text without its numbers: texts of one kind differ in nothing else."""
    return re.sub(r"\d[\d.e+-]*", "", text)


def _label(function: Any) -> str:
    """Return the name of a function with that of its module, or what it is."""
    named = hasattr(function, "__qualname__")
    return f"{function.__module__}.{function.__qualname__}" if named else _shown(function)


def _save(found: "xarray.Dataset", path: pathlib.Path) -> None:
    """Write a sweep as NetCDF, whole or not at all."""
    with files.atomic_write(path) as temporary:
        found.to_netcdf(temporary, engine="scipy")


def _continued(path: pathlib.Path, new: "xarray.Dataset", work: Work, axes: Axes) -> "xarray.Dataset":
    """Return the sweep in a file, if it is the same: by coordinates, attributes and the results of its first scene.

    Raises:
      ParameterError: if it is not.
    """
    import xarray

    try:
        stored = xarray.load_dataset(path, engine="scipy")
        differ = [name for name, value in new.attrs.items() if stored.attrs.get(name) != value and name != "failed"]
        differ += [name for name, values in new.coords.items() if not values.equals(stored.coords.get(name))]
        differ += ["quantities"] * (list(stored) != list(new) or stored.sizes != new.sizes)
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise ParameterError(f"{path} was not written by `mjbeer.sweep`: {error}") from error
    advice = "give another name, or remove it"
    if differ:
        raise ParameterError(f"{path} has another sweep, whose {', '.join(differ)} differ: {advice}")
    for scene in np.flatnonzero(stored["status"].values != NOT_YET)[:1].tolist():
        (now,), *_ = measure(work, _varied(axes, [scene]))
        if not np.array_equal(now, [values.values.flat[scene] for values in stored.values()], equal_nan=True):
            raise ParameterError(
                f"{path} has other results than this call, at {_named(axes, scene)}: another function, or another "
                f"machine, made them: {advice}"
            )
    return stored


def _fill(
    found: "xarray.Dataset",
    work: Work,
    axes: Axes,
    executor: Executor | None,
    path: pathlib.Path | None,
    progress: bool,
) -> None:
    """Simulate the scenes that a sweep lacks, and write them into its arrays; save them if there is a path."""
    scenes = np.flatnonzero(found["status"].values == NOT_YET)
    arrays = [variable.values for variable in found.values()]  # in the order in which they are measured
    failed = {_numberless(line): line for line in found.attrs["failed"].splitlines()}
    saved, done = time.monotonic(), 0
    try:
        with (
            progress_bar(STDERR if progress else None, 100) as advance,
            nullcontext(executor) if executor else ThreadPoolExecutor(os.cpu_count()) as pool,
            closing(run_all(work, scenes, partial(_varied, axes), pool)) as pieces,
        ):
            for piece, values, reasons in pieces:
                for array, column in zip(arrays, values.T, strict=True):
                    array.flat[piece] = column
                for scene, reason in zip(piece.tolist(), reasons, strict=True):
                    if reason:
                        line = f"scene {scene} ({_named(axes, scene)}): {reason}"
                        kind = _numberless(line)
                        failed[kind] = min(failed.get(kind, line), line, key=_number)
                found.attrs["failed"] = "\n".join(sorted(failed.values(), key=_number))
                before, done = done, done + len(piece)
                for _ in range(100 * before // len(scenes), 100 * done // len(scenes)):
                    advance(f"{len(scenes)} scenes [%]")
                if path is not None and time.monotonic() - saved > _SAVED_EVERY:
                    _save(found, path)
                    saved = time.monotonic()
    finally:
        if path is not None:
            _save(found, path)


def _number(line: str) -> int:
    """Return the number of the scene that a line of what failed begins with."""
    return int(line.split()[1])
