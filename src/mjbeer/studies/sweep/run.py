"""`mjbeer.sweep`: many scenes in one call, on all cores, or on a cluster."""

import dataclasses
import hashlib
import inspect
import math
import os
import pathlib
import pickle
import re
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import closing, nullcontext
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, ParameterError, liquid_notes
from mjbeer.model.setting import FRICTION, OWN, Integrator, Rolling, Setting
from mjbeer.output.terminal import STDERR, progress_bar
from mjbeer.simulation.run import Run
from mjbeer.studies.sweep import measure
from mjbeer.studies.sweep.result import SCENE, Sweep, checked, load
from mjbeer.theory.scene import Scene

_MOST_STEPS = 1_000_000_000
"""Largest number of timesteps of each run: they take some minutes."""
_MOST_SCENES = 10_000_000
"""Largest number of scenes: they take a gigabyte."""
_SAVE_EVERY, _SAVING = 5.0, 20.0
"""Time between two savings of what is there so far [s], and its smallest ratio to the time that saving takes."""
_LARGEST_PIECE = 1000
"""Largest number of scenes that are handed out in one piece."""
_UNKNOWN_WORKERS, _SMALLEST_PIECE = 128, 100
"""Number of workers that an executor is taken to have that does not tell, a cluster's, and the smallest piece that it
is given: to hand one out takes as long as some ten scenes there."""

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
) -> Sweep:
    """Return many scenes, simulated over a `duration` [s] each.

    `make` returns a scene for its parameters, as `mjbeer.sliding` does. Those of the `parameters` that are lists or
    one-dimensional arrays are the dimensions of the sweep, in the order given, and all combinations of their entries
    are simulated; `phi0` [rad] and `phi_dot0` [rad/s] may be arrays, too, and come last. If `paired`, the arrays have
    one length, and their entries belong together: one scene for each. The other arguments are those of `simulate`, and
    each scene is what `simulate` gives for it with a sample at the end, to the last bit.

    Every sweep has the quantities "phi", "u", "phi_dot" and "u_dot" at the end, "error" (the estimate),
    "lowest_normal", "friction_needed", "parting_time" (from which N < 0; infinity if never), "energy_drift", "trusted"
    and "status" (0 where all went well). `quantity` asks for more, one or a list: "period", or a function of a
    `Trajectory` that returns a number, which has samples at every timestep and so takes longer. Without a tolerance
    "error" needs a second run of each scene, of twice the time.

    The scenes are simulated by an `executor` of `concurrent.futures`, by default by a thread for each core. The result
    does not depend on it. With an `output`, whose name ends in .npz, what is there is saved every few seconds; the same
    sweep goes on from there after an interruption. Two sweeps are the same if parameters and their values, start,
    setting, end and quantities are; if `make` gives the same scenes, for which it is asked once for each value; and if
    the source of `make` and of functions of a trajectory is, but not of what these call. Versions do not count;
    `Sweep.about` has all that were at work. A file of another sweep is refused, unless `overwrite`, which begins anew
    whatever the file has.

    A value that is not allowed is refused before anything runs. A scene that fails is listed in `Sweep.failed`. What
    liquids warn of is said beforehand, once for each kind of reason, and kept in `Sweep.about`.

    Raises:
      ParameterError: if an argument is not allowed; for an entry of an array the message has its index.
      OutputError: if the output cannot be written.
      OSError: if the system ends one of the executor's processes.
    """
    for name, value in (("paired", paired), ("overwrite", overwrite), ("progress", progress)):
        require.boolean(name, value)
    if executor is not None and not isinstance(executor, Executor):
        raise ParameterError(f"executor must be a concurrent.futures.Executor, got {require.shown(executor)}")
    path = None if output is None else checked(output, (".npz",))
    if not callable(make):
        raise ParameterError(f"make must be a function that returns a scene, got {require.shown(make)}")
    try:
        inspect.signature(make).bind(**parameters)
    except TypeError as error:
        raise ParameterError(f"make is {require.shown(make)}: {error}") from error
    except ValueError:  # a function in C without a signature
        pass
    axes, fixed = _arranged({**parameters, "phi0": phi0, "phi_dot0": phi_dot0}, paired)
    require.radians(float(np.abs(axes.get("phi0", fixed.get("phi0"))).max()))
    setting = Setting.of(integrator, tolerance, rolling=rolling, timestep=timestep, friction=friction)
    measures = _asked(quantity, axes)
    end = _end(require.positive("duration", duration, "s"), setting, bool(set(measures) - {measure.PERIOD}))
    work = measure.Work(make, fixed, tuple(axes), setting, end, measures)
    result = Sweep(axes, paired, {}, {}, {})
    for name in (*measure.ALWAYS, *measures):
        result.quantities[name] = np.full(result.shape, np.nan)
    result.quantities[measure.TRUSTED] = np.zeros(result.shape, np.bool_)
    result.quantities[measure.STATUS] = np.full(result.shape, measure.NOT_YET, np.int8)
    functions = [_source(function) for function in (make, *measures.values())]
    if path is not None and not all(functions):
        raise ParameterError(
            "a sweep that is saved is known again by the source of its functions: they must be defined in a file, got "
            + require.shown([make, *measures.values()][functions.index("")])
        )
    digest, notes = _check_scenes(work, result)
    result.about.update(
        {
            "make": _label(make),
            "arguments": {name: _shown(value) for name, value in fixed.items()},
            "setting": repr(setting),
            "end [s]": end,
            "quantities": [*measure.ALWAYS, *measures],
            "scenes": digest,
            "functions": functions,
            "versions": [f"{package} {version(package)}" for package in ("mjbeer", "mujoco")],
            "notes": notes,
        }
    )
    for note in notes:
        warnings.warn(note, LiquidWarning, stacklevel=2)
    if path is not None and os.path.exists(path) and not overwrite:
        result = _continued(path, result)
    _fill(result, work, executor, path, progress)
    return result


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
    there = (*measure.NAMED, measure.TRUSTED, measure.STATUS)
    if clash := {*there, SCENE} & set(axes):
        raise ParameterError(f"a quantity has the name of the parameter {clash.pop()!r}: give that another name")
    found: dict[str, Callable[[Run], Any]] = {}
    for each in quantity if isinstance(quantity, (list, tuple)) else (quantity,):
        if callable(each) and not isinstance(each, type):
            if (name := _label(each)) in (*there, SCENE, *axes, *found):
                raise ParameterError(f"quantity {name!r} is there already: give the function another name")
            found[name] = each
        elif not isinstance(each, str):
            raise ParameterError(f"quantity must be a name or a function of a trajectory, got {require.shown(each)}")
        elif require.choice("quantity", each, there) == measure.PERIOD:
            found = {measure.PERIOD: measure.NAMED[measure.PERIOD].of} | found
    return found


def _end(duration: float, setting: Setting, every_step: bool) -> float:
    """Return the time at which the runs end [s]: MuJoCo's integrators end at a timestep, the first one after it."""
    steps, most = duration / setting.timestep, measure.MOST_SAMPLES if every_step else _MOST_STEPS
    if steps > most and (every_step or setting.tolerance is None):
        raise ParameterError(
            f"a duration of {duration!r} s has too many timesteps of {setting.timestep!r} s for a sweep: at most "
            f"{most:,}{', at each of which a function of a trajectory has a sample' * every_step}"
        )
    if setting.tolerance is not None or setting.integrator in OWN:
        return duration
    return setting.timestep * math.ceil(steps * (1 - 1e-10))  # which allows for rounding


def _check_scenes(work: measure.Work, plan: Sweep) -> tuple[str, list[str]]:
    """Check that every value is allowed in some scene; where they are paired, that every scene is.

    Two values may be allowed, and their combination not: such a scene is left to fail by itself, as is one for which
    `make` raises an error of its own. Return a digest of the scenes that are made here, and what liquids have warned
    of, once where only the numbers differ.
    """
    digest, notes = hashlib.sha256(), dict[str, str]()

    def problem(number: Any) -> ParameterError | None:
        try:
            with liquid_notes() as told:
                scene, *_ = work.scene(plan.rows(np.array([number]))[0])
            made = [getattr(scene, each.name) for each in dataclasses.fields(scene) if each.compare]
        except ParameterError as error:
            return error
        except Exception as error:
            made = [type(error)]
        digest.update(_shown(made).encode())
        for note in told:
            notes.setdefault(re.sub(r"\d[\d.e+-]*", "", note), note)
        return None

    numbers = np.arange(math.prod(plan.shape)).reshape(plan.shape)
    groups: Iterable[tuple[str, Any]] = ((plan.named(number), [number]) for number in numbers.flat)
    if plan.axes and not plan.paired:
        groups = (
            (f"{name}[{index}]", of_value.flat)
            for dimension, name in enumerate(plan.axes)
            for index, of_value in enumerate(np.moveaxis(numbers, dimension, 0))
        )
    for place, group in groups:
        if (first := problem(group[0])) and all(problem(number) for number in group):
            raise ParameterError(f"{place}: {first}".removeprefix(": ")) from first
    return digest.hexdigest(), list(notes.values())


def _shown(thing: Any) -> str:
    """Return what an object is, without what is another in each process."""
    return re.sub(r" at 0x[0-9a-f]+", "", repr(thing))


def _source(function: Any) -> str:
    """Return what a function is, its text, and the values that it has from around it; empty if there is no text."""
    inner = inspect.unwrap(getattr(function, "func", function))
    if str(inner.__module__).startswith("mjbeer."):  # versions do not count
        return _shown(function)
    cells = [cell.cell_contents for cell in getattr(inner, "__closure__", None) or ()]
    try:
        text = inspect.getsource(inner if inspect.isroutine(inner) else type(inner))
    except (OSError, TypeError):  # typed at a prompt, or in C
        return ""
    return _shown((function, getattr(inner, "__defaults__", None), cells)) + text


def _label(function: Any) -> str:
    """Return the name of a function; a partial one that has been given none has that of its function."""
    function = function if hasattr(function, "__name__") else getattr(function, "func", type(function))
    return getattr(function, "__name__", type(function).__name__)


def _continued(path: pathlib.Path, new: Sweep) -> Sweep:
    """Return the sweep in a file, if it is the same as the new one in the sense of `sweep`."""
    stored, asked = load(path), ("arguments", "setting", "end [s]", "quantities", "scenes", "functions")
    same = stored.paired == new.paired and list(stored.axes) == list(new.axes)
    same = same and all(map(np.array_equal, stored.axes.values(), new.axes.values()))
    if differ := ["parameters"] * (not same) + [name for name in asked if stored.about.get(name) != new.about[name]]:
        raise ParameterError(
            f"{path} has another sweep, whose {', '.join(differ)} differ: give another name, or overwrite=True to "
            "replace it"
        )
    if measure.NOT_YET in stored[measure.STATUS]:
        stored.about["versions"] = list(dict.fromkeys([*stored.about["versions"], *new.about["versions"]]))
    return stored


def _fill(
    result: Sweep, work: measure.Work, executor: Executor | None, path: pathlib.Path | None, progress: bool
) -> None:
    """Simulate the scenes that a sweep lacks, and write them into its arrays; save them if there is a path."""
    scenes = np.flatnonzero(result[measure.STATUS].ravel() == measure.NOT_YET)
    saved, pause, done = time.monotonic(), _SAVE_EVERY, 0
    if path is not None:
        result.save(path)  # a file that cannot be written is an error before the first scene
    try:
        with (
            progress_bar(STDERR if progress else None, 100) as advance,
            nullcontext(executor) if executor else ThreadPoolExecutor(os.cpu_count()) as pool,
            closing(_carried_out(work, result, scenes, pool)) as pieces,
        ):
            for piece, values, reasons in pieces:
                result.reasons.update({int(piece[place]): reason for place, reason in reasons.items()})
                for array, column in zip(result.quantities.values(), values.T, strict=True):  # the status is the last
                    array.flat[piece] = column
                before, done = done, done + len(piece)
                for _ in range(100 * before // len(scenes), 100 * done // len(scenes)):
                    advance(f"{len(scenes)} scenes [%]")
                if path is not None and time.monotonic() - saved > pause:
                    began = time.monotonic()
                    result.save(path)
                    saved = time.monotonic()
                    pause = max(_SAVE_EVERY, _SAVING * (saved - began))
    finally:
        if path is not None:
            result.save(path)


def _carried_out(
    work: measure.Work, plan: Sweep, scenes: np.ndarray, executor: Executor
) -> Generator[tuple[np.ndarray, np.ndarray, dict[int, str]]]:
    """Yield the numbers of some scenes and what was measured on them, piece by piece, as the pieces come back.

    A piece is a share of what is left, and what is left of it after a second is handed out again. What is measured on a
    scene does not depend on that. If the generator is closed, pieces that have not begun are cancelled.
    """
    if isinstance(executor, ProcessPoolExecutor):  # which may hang at its end if it cannot send what it was given
        try:
            pickle.dumps(work)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise ParameterError(
                "what makes the scenes, and functions of their runs, must be defined at the top of a module to be sent "
                f"to processes: {' '.join(str(error).split())}"
            ) from error
    known = getattr(executor, "_max_workers", None)
    workers, least = (known, 1) if known else (_UNKNOWN_WORKERS, _SMALLEST_PIECE)
    waiting, left, out = [scenes], len(scenes), dict[Future[Any], np.ndarray]()
    try:
        while left or out:
            while left and len(out) < 2 * workers:
                size = min(max(math.ceil(left / (4 * workers)), least), _LARGEST_PIECE)
                piece, rest = np.split(waiting.pop(), [size])
                waiting += [rest] * bool(len(rest))
                left -= len(piece)
                out[executor.submit(measure.measure, work, plan.rows(piece))] = piece
            for future in wait(out, return_when=FIRST_COMPLETED).done:
                piece = out.pop(future)
                found, reasons = future.result()
                piece, rest = np.split(piece, [len(found)])
                waiting += [rest] * bool(len(rest))
                left += len(rest)
                yield piece, np.array(found), reasons
    except BrokenExecutor as error:
        raise OSError("a process of the sweep was ended from outside: is memory short?") from error
    finally:
        for future in out:
            future.cancel()
