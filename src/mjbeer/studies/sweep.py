"""`mjbeer.sweep`: many scenes in one call, on all cores or on a cluster, as an `xarray.Dataset`."""

import inspect
import math
import os
import pathlib
import pickle
import re
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ThreadPoolExecutor, wait
from contextlib import closing, nullcontext
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import (
    DivergenceError,
    LiquidWarning,
    MjbeerError,
    ParameterError,
    ToleranceError,
    collect_liquid_warnings,
)
from mjbeer.model.setting import FRICTION, OWN, Integrator, Rolling, Setting
from mjbeer.output import files
from mjbeer.output.terminal import STDERR, progress_bar
from mjbeer.simulation.run import Run, integrate
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    import xarray

_MOST_STEPS, _MOST_SAMPLES = 1_000_000_000, 1_000_000
"""Largest number of timesteps of a run, which take some minutes, and of samples, a hundred megabytes in each thread."""
_MOST_SCENES = 10_000_000
"""Largest number of scenes: they take a gigabyte."""
_PIECE, _LARGEST_PIECE = 0.5, 256
"""Time after which a piece of work ends [s], and the most scenes in one: little enough to be lost with a process."""
_SAVING, _LONGEST = 10.0, 2.0
"""Time between two savings over the time that one takes, and the longest [s]: what is done in it may be lost."""
_WORKERS = 64
"""Number of workers that an executor is taken to have that does not tell, such as a cluster's."""
_UNITS = {"incline": "rad", "phi0": "rad", "phi_dot0": "rad/s", "density": "kg/m^3", "gravity": "m/s^2"}
_UNITS |= {"damping": "N m s", "drag": "kg/m", "viscosity": "m^2/s", "radius": "m", "length": "m", "offset": "m"}
_UNITS |= {"wheel_mass": "kg", "load_mass": "kg", "hoop_mass": "kg"}
"""Units of the parameters of mjbeer's own scenes; a fill has none."""


class Quantity(NamedTuple):
    """A number of a run, with its unit, and what it is in words."""

    of: Callable[[Run], Any]
    unit: str
    meaning: str


ALWAYS: Mapping[str, Quantity] = {
    "phi": Quantity(lambda run: run.phi[-1], "rad", "φ at the end"),
    "u": Quantity(lambda run: run.u[-1], "m", "u at the end"),
    "phi_dot": Quantity(lambda run: run.phi_dot[-1], "rad/s", "rate of φ at the end"),
    "u_dot": Quantity(lambda run: run.u_dot[-1], "m/s", "velocity at the end"),
    "error": Quantity(lambda run: run.error_estimate, "rad", "estimated error of φ and u/a"),
    "lowest_normal": Quantity(lambda run: run.record.lowest_normal, "N", "lowest normal force"),
    "friction_needed": Quantity(lambda run: run.record.needed_friction, "", "friction coefficient that rolling needs"),
    "parting_time": Quantity(lambda run: run.record.rolling_ends_at, "s", "time from which N < 0"),
    "energy_drift": Quantity(lambda run: run.energy_drift, "", "energy drift over the swing's kinetic energy"),
}
"""The quantities that every sweep has, besides "trusted" and "status"."""
PERIOD, TRUSTED, STATUS, SCENE = "period", "trusted", "status", "scene"
_PERIOD = Quantity(lambda run: 2 * math.pi / run.frequency(), "s", "period of the swing")
WELL, REFUSED, DIVERGED, NOT_REACHED, NO_VALUE, BEYOND, NOT_YET = 0, 1, 2, 3, 4, 5, -1
STATUSES = {
    WELL: "all went well",
    REFUSED: "the scene is not possible",
    DIVERGED: "the motion diverged",
    NOT_REACHED: "the tolerance was not reached",
    NO_VALUE: "a quantity has no value",
    BEYOND: "the model left its range",
    NOT_YET: "not yet simulated",
}

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
    paired: bool = False,
    executor: Executor | None = None,
    output: str | os.PathLike[str] | None = None,
    overwrite: bool = False,
    progress: bool = True,
    **parameters: Any,
) -> "xarray.Dataset":
    """Return many scenes, simulated over a `duration` [s] each, as a Dataset with units and this call as attributes.

    `make` returns a scene for its parameters, as `mjbeer.sliding` does. Those of the `parameters` that are lists or
    one-dimensional arrays are the dimensions of the sweep, in the order given, and all combinations of their entries
    are simulated; `phi0` [rad] and `phi_dot0` [rad/s] may be arrays, too, and come last. If `paired`, the arrays have
    one length, and their entries belong together: one scene for each, along the dimension "scene". The other arguments
    are those of `simulate`, and each scene is what `simulate` gives for it with a sample at the end, to the last bit.

    Every sweep has the quantities "phi", "u", "phi_dot" and "u_dot" at the end, "error" (the estimate),
    "lowest_normal", "friction_needed", "parting_time" (from which N < 0; infinity if never), "energy_drift", "trusted"
    and "status" (0 where all went well). `quantity` asks for more, one or a list: "period", or a function of a
    `Trajectory` that returns a number, which has samples at every timestep and so takes longer. Without a tolerance
    "error" needs a second run of each scene, of twice the time.

    The scenes are simulated by an `executor` of `concurrent.futures`, by default by a thread for each core; the result
    does not depend on it. With an `output`, whose name ends in .nc, what is there is saved as NetCDF every two seconds
    or sooner, and the same call goes on from there after an interruption. A file with other coordinates or attributes
    is refused, and so is one whose first scene has other results than now; `overwrite` replaces it.

    A value that is not allowed is refused before anything runs. A scene that fails later has NaN and a status, one that
    leaves the range of its model a status, and the attribute "failed" has a line for each kind of reason, with the
    first scene of it. What liquids warn of is said
    beforehand, once for each kind.

    Raises:
      ParameterError: if an argument is not allowed; for an entry of an array the message has its index.
      OutputError: if the output cannot be written.
      OSError: if the system ends one of the executor's processes.
    """
    for name, value in (("paired", paired), ("overwrite", overwrite), ("progress", progress)):
        require.boolean(name, value)
    if executor is not None and not isinstance(executor, Executor):
        raise ParameterError(f"executor must be a concurrent.futures.Executor, got {require.format_value(executor)}")
    path = None if output is None else _netcdf(output)
    if not callable(make):
        raise ParameterError(f"make must be a function that returns a scene, got {require.format_value(make)}")
    try:
        inspect.signature(make).bind(**parameters)
    except TypeError as error:
        raise ParameterError(f"make is {require.format_value(make)}: {error}") from error
    except ValueError:  # a function in C without a signature
        pass
    axes, fixed = _arranged({**parameters, "phi0": phi0, "phi_dot0": phi_dot0}, paired)
    require.warn_of_degrees(float(np.abs(axes.get("phi0", fixed.get("phi0"))).max()))
    setting = Setting.of(integrator, tolerance, rolling=rolling, timestep=timestep, friction=friction)
    measures = _asked(quantity, axes)
    times = _times(require.positive("duration", duration, "s"), setting, bool(measures))
    work, grid = Work(make, fixed, tuple(axes), setting, times, measures), Grid(axes, paired)
    for note in _checked(work, grid):
        warnings.warn(note, LiquidWarning, stacklevel=2)
    found = _empty(work, grid)
    if path is not None:
        if path.exists() and not overwrite:
            found = _continued(path, found, work, grid)
        _save(found, path)  # a file that cannot be written is an error before the first scene
    _fill(found, work, grid, executor, path, progress)
    return found


@dataclass(frozen=True)
class Grid:
    """The scenes of a sweep by their numbers, of which those of the last dimension are neighbours."""

    axes: Mapping[str, np.ndarray]
    """The values of each parameter that varies."""
    paired: bool

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of every quantity's array."""
        return tuple(len(values) for values in self.axes.values())[: 1 if self.paired else None]

    def _places(self, scenes: Any) -> tuple[Any, ...]:
        return (scenes,) * len(self.axes) if self.paired or not self.axes else np.unravel_index(scenes, self.shape)

    def rows(self, scenes: np.ndarray) -> np.ndarray:
        """Return the parameters of the scenes with these numbers, shape (scenes, parameters)."""
        places = zip(self.axes.values(), self._places(scenes), strict=True)
        return np.array([values[place] for values, place in places]).T.reshape(len(scenes), len(self.axes))

    def named(self, scene: Any) -> str:
        """Return the parameters of a scene in words, as "incline[3] = 0.1, fill[0] = 0.5"."""
        places = zip(self.axes.items(), self._places(scene), strict=True)
        return ", ".join(f"{name}[{place}] = {values[place]:.6g}" for (name, values), place in places)


@dataclass(frozen=True)
class Work:
    """What all scenes of a sweep have in common; it is sent to where they are simulated."""

    make: Callable[..., Scene]
    fixed: Mapping[str, Any]
    """Arguments of `make`, phi0 [rad] and phi_dot0 [rad/s] included, that are the same in all scenes."""
    varied: tuple[str, ...]
    """The others, in the order of the columns of the scenes' rows."""
    setting: Setting
    times: np.ndarray
    """Times of the samples of every run [s]."""
    measures: Mapping[str, Callable[[Run], Any]]
    """What is measured besides the quantities of every sweep."""

    def scene(self, row: np.ndarray) -> tuple[Scene, float, float]:
        """Return the scene of a row of parameters, with its phi0 [rad] and phi_dot0 [rad/s].

        Raises:
          ParameterError: if a parameter is not allowed, or `make` does not return a scene.
        """
        values = {**self.fixed, **dict(zip(self.varied, row.tolist(), strict=True))}
        start = require.start(values.pop("phi0"), values.pop("phi_dot0"))
        if not isinstance(made := self.make(**values), Scene):
            called = require.format_value(self.make)
            raise ParameterError(f"make must return a scene, got {called}, which returns {require.format_value(made)}")
        return made, *start


def measure(work: Work, rows: np.ndarray) -> tuple[list[list[float]], list[str]]:
    """Simulate the scenes of some rows of parameters, at least one and as many as half a second has time for.

    Return for each its quantities, NaN where there is none, whether it is trusted and its status; and why the status is
    not 0.
    """
    found, reasons, began = [], [], time.perf_counter()
    with collect_liquid_warnings():  # the sweep has said them
        for row in rows:
            values = [math.nan] * (len(ALWAYS) + len(work.measures))
            trusted, status, reason = _outcome(work, row, values)
            found.append([*values, trusted, status])
            reasons.append(reason)
            if time.perf_counter() - began > _PIECE:
                break
    return found, reasons


def _outcome(work: Work, row: np.ndarray, values: list[float]) -> tuple[bool, int, str]:
    """Fill in the quantities of a scene; return whether its run is trusted, its status, and a reason unless that is 0.

    Whatever a function of the user's raises, or is wrong with a scene, the others go on.
    """
    try:
        scene, *start = work.scene(row)
        run = integrate(scene, *start, work.setting, work.times)
        values[: len(ALWAYS)] = [float(quantity.of(run)) for quantity in ALWAYS.values()]
        trusted = run.trusted
    except Exception as error:
        kinds = {DivergenceError: DIVERGED, ToleranceError: NOT_REACHED}
        return False, kinds.get(type(error), REFUSED), _in_a_line(error)
    status, reason = WELL, ""
    for place, (name, of) in enumerate(work.measures.items(), len(ALWAYS)):
        try:
            values[place] = float(of(run))
        except Exception as error:
            status, reason = NO_VALUE, f"{name}: {_in_a_line(error)}"
    if status == WELL and (beyond := (*run.rolling_warnings, *run.liquid_warnings)):
        status, reason = BEYOND, "; ".join(beyond)
    return trusted, status, reason


def _in_a_line(error: Exception) -> str:
    """Return an error in one line, with its kind if it is none of mjbeer's."""
    kind = "" if isinstance(error, MjbeerError) else f"{type(error).__name__}: "
    return kind + " ".join(str(error).split())


def _arranged(parameters: Mapping[str, Any], paired: bool) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Return the parameters that are lists or arrays, and the others."""
    listed = list, tuple, range
    several = [name for name, value in parameters.items() if isinstance(value, listed) or getattr(value, "ndim", 0) > 0]
    axes = {name: require.samples(name, value) for name, value in parameters.items() if name in several}
    fixed = {name: value for name, value in parameters.items() if name not in several}
    fixed |= {name: require.number(name, fixed[name]) for name in ("phi0", "phi_dot0") if name in fixed}
    lengths = [len(values) for values in axes.values()]
    told = ", ".join(f"{name} has {len(values)}" for name, values in axes.items()) or "no parameter is an array"
    if paired and len(set(lengths)) != 1:
        raise ParameterError(f"paired=True needs arrays of one length: {told}")
    if (count := lengths[0] if paired else math.prod(lengths)) > _MOST_SCENES:
        raise ParameterError(
            f"a sweep has at most {_MOST_SCENES:,} scenes, got {count:,} ({told}): cut it into several, each with an "
            "output of its own"
        )
    return axes, fixed


def _asked(quantity: Asked | Sequence[Asked], axes: Mapping[str, Any]) -> dict[str, Callable[[Run], Any]]:
    """Return what measures the quantities that are asked for besides those of every sweep, by their names."""
    there = (*ALWAYS, PERIOD, TRUSTED, STATUS)
    if clash := {*there, SCENE} & set(axes):
        raise ParameterError(f"a quantity has the name of the parameter {clash.pop()!r}: give that another name")
    found: dict[str, Callable[[Run], Any]] = {}
    for each in quantity if isinstance(quantity, (list, tuple)) else (quantity,):
        if callable(each) and not isinstance(each, type):
            name = getattr(each, "__name__", type(each).__name__)
            if name in (*there, SCENE, *axes, *found):
                raise ParameterError(f"quantity {name!r} is there already: give the function another name")
            found[name] = each
        elif not isinstance(each, str):
            raise ParameterError(
                f"quantity must be a name or a function of a trajectory, got {require.format_value(each)}"
            )
        elif require.choice("quantity", each, there) == PERIOD:
            found = {PERIOD: _PERIOD.of} | found
    return found


def _times(duration: float, setting: Setting, every_step: bool) -> np.ndarray:
    """Return the times of the samples of each run [s]: its end, or all timesteps if that is asked for.

    MuJoCo's integrators end at a timestep, the first one at or after the duration.
    """
    steps, most = duration / setting.timestep, _MOST_SAMPLES if every_step else _MOST_STEPS
    if steps > most and (every_step or setting.tolerance is None):
        raise ParameterError(
            f"a duration of {duration!r} s has too many timesteps of {setting.timestep!r} s for a sweep: at most "
            f"{most:,}{', at each of which a measured quantity has a sample' * every_step}"
        )
    whole = setting.timestep * math.ceil(steps * (1 - 1e-10))  # which allows for rounding
    end = duration if setting.tolerance is not None or setting.integrator in OWN else whole
    if not every_step:
        return np.array([end])
    times = setting.timestep * np.arange(1 + math.floor(end / setting.timestep * (1 + 1e-12)))
    return times if times[-1] >= end * (1 - 1e-12) else np.append(times, end)


def _checked(work: Work, grid: Grid) -> list[str]:
    """Check that every value is allowed in some scene; where they are paired, that every scene is.

    Two values may be allowed, and their combination not: such a scene is left to fail by itself, as is one for which
    `make` raises an error of its own. Return what liquids have warned of, once where only the numbers differ.
    """
    notes: dict[str, str] = {}

    def problem(number: int) -> ParameterError | None:
        with collect_liquid_warnings() as told:
            try:
                work.scene(grid.rows(np.array([number]))[0])
            except ParameterError as error:
                return error
            except Exception:
                pass
        for note in told:
            notes.setdefault(_numberless(note), note)
        return None

    numbers = np.arange(math.prod(grid.shape)).reshape(grid.shape)
    groups: Iterable[tuple[str, Any]] = ((grid.named(number), [number]) for number in numbers.flat)
    if grid.axes and not grid.paired:
        groups = (
            (f"{name}[{index}]", of_value.flat)
            for dimension, name in enumerate(grid.axes)
            for index, of_value in enumerate(np.moveaxis(numbers, dimension, 0))
        )
    for place, group in groups:
        if (first := problem(int(group[0]))) and all(problem(int(number)) for number in group):
            raise ParameterError(f"{place}: {first}".removeprefix(": ")) from first
    return list(notes.values())


def _empty(work: Work, grid: Grid) -> "xarray.Dataset":
    """Return the Dataset of a sweep of which nothing is simulated yet."""
    import xarray  # pandas comes with it: together they take half a second to import

    dims = (SCENE,) if grid.paired else tuple(grid.axes)
    variables: dict[str, Any] = {}
    for name in (*ALWAYS, *work.measures):
        quantity = _PERIOD if name == PERIOD else ALWAYS.get(name)
        about = {"units": quantity.unit, "long_name": quantity.meaning} if quantity else {}
        variables[name] = dims, np.full(grid.shape, np.nan), about
    variables[TRUSTED] = dims, np.zeros(grid.shape, np.bool_), {"long_name": "whether the run is trusted"}
    told = "; ".join(f"{number}: {text}" for number, text in STATUSES.items())
    variables[STATUS] = dims, np.full(grid.shape, NOT_YET, np.int8), {"long_name": told}
    coordinates = {
        name: (dims if grid.paired else (name,), values, {"units": _UNITS[name]} if name in _UNITS else {})
        for name, values in grid.axes.items()
    }
    given = {"make": _label(work.make), "duration": float(work.times[-1]), "paired": str(grid.paired)}
    given |= {
        name: "none" if value is None else value for name, value in vars(work.setting).items() if name != "folder"
    }
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
    names = getattr(function, "__module__", None), getattr(function, "__qualname__", None)
    return ".".join(map(str, names)) if None not in names else _shown(function)


def _netcdf(path: str | os.PathLike[str]) -> pathlib.Path:
    target = require.path(path)
    if target.suffix != ".nc":
        raise ParameterError(f"the file's name must end in .nc, got {require.format_value(str(target))}")
    return target


def _save(found: "xarray.Dataset", path: pathlib.Path) -> None:
    """Write a sweep as NetCDF, whole or not at all."""
    with files.atomic_write(path) as temporary:
        found.to_netcdf(temporary, engine="scipy")


def _continued(path: pathlib.Path, new: "xarray.Dataset", work: Work, grid: Grid) -> "xarray.Dataset":
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
    advice = "give another name, or overwrite=True to replace it"
    if differ:
        raise ParameterError(f"{path} has another sweep, whose {', '.join(differ)} differ: {advice}")
    for number in np.flatnonzero(stored[STATUS].values != NOT_YET)[:1]:
        (now,), _ = measure(work, grid.rows(np.array([number])))
        if not np.array_equal(now, [float(values.values.flat[number]) for values in stored.values()], equal_nan=True):
            raise ParameterError(
                f"{path} has other results than this call, at {grid.named(number)}: another function, or another "
                f"machine, made them: {advice}"
            )
    return stored


def _fill(
    found: "xarray.Dataset",
    work: Work,
    grid: Grid,
    executor: Executor | None,
    path: pathlib.Path | None,
    progress: bool,
) -> None:
    """Simulate the scenes that a sweep lacks, and write them into its arrays; save them if there is a path."""
    scenes = np.flatnonzero(found[STATUS].values == NOT_YET)
    arrays = [variable.values for variable in found.values()]  # the status is the last
    failed = {_numberless(line): (int(line.split()[1]), line) for line in found.attrs["failed"].splitlines()}
    saved, pause, done = 0.0, 0.0, 0
    try:
        with (
            progress_bar(STDERR if progress else None, 100) as advance,
            nullcontext(executor) if executor else ThreadPoolExecutor(os.cpu_count()) as pool,
            closing(_pieces(work, grid, scenes, pool)) as pieces,
        ):
            for piece, values, reasons in pieces:
                for array, column in zip(arrays, values.T, strict=True):
                    array.flat[piece] = column
                for number, reason in zip(piece.tolist(), reasons, strict=True):
                    line = f"scene {number} ({grid.named(number)}): {reason}"
                    if reason and number < failed.get(kind := _numberless(line), (math.inf,))[0]:
                        failed[kind] = number, line
                before, done = done, done + len(piece)
                for _ in range(100 * before // len(scenes), 100 * done // len(scenes)):
                    advance(f"{len(scenes)} scenes [%]")
                found.attrs["failed"] = "\n".join(line for _, line in sorted(failed.values()))
                if path is not None and time.monotonic() - saved > pause:
                    began = time.monotonic()
                    _save(found, path)
                    saved = time.monotonic()
                    pause = min(_LONGEST, _SAVING * (saved - began))
    finally:
        if path is not None:
            _save(found, path)


def _pieces(
    work: Work, grid: Grid, scenes: np.ndarray, executor: Executor
) -> Generator[tuple[np.ndarray, np.ndarray, list[str]]]:
    """Yield the numbers of some scenes and what was measured on them, piece by piece, as the pieces come back.

    What is left of a piece after half a second is handed out again; what is measured on a scene does not depend on
    that. If the generator is closed, pieces that have not begun are cancelled.
    """
    if not isinstance(
        executor, ThreadPoolExecutor
    ):  # processes may hang at their end if what they are given cannot be sent
        try:
            pickle.dumps(work)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise ParameterError(
                "what makes the scenes, and functions of their runs, must be defined at the top of a module to be sent "
                f"to processes: {' '.join(str(error).split())}"
            ) from error
    workers = getattr(executor, "_max_workers", None) or _WORKERS
    size = min(_LARGEST_PIECE, max(1, len(scenes) // (4 * workers)))
    waiting, out = [scenes] * bool(len(scenes)), dict[Future[Any], np.ndarray]()
    try:
        while waiting or out:
            while waiting and len(out) < 2 * workers:
                piece, rest = np.split(waiting.pop(), [size])
                waiting += [rest] * bool(len(rest))
                out[executor.submit(measure, work, grid.rows(piece))] = piece
            for future in wait(out, return_when=FIRST_COMPLETED).done:
                piece = out.pop(future)
                values, reasons = future.result()
                piece, rest = np.split(piece, [len(values)])
                waiting += [rest] * bool(len(rest))
                yield piece, np.array(values), reasons
    except BrokenExecutor as error:
        raise OSError("a process of the sweep was ended from outside: is memory short?") from error
    finally:
        for future in out:
            future.cancel()
