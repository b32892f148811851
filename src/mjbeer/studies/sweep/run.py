"""`mjbeer.sweep`: many scenes in one call, on all cores, or on a cluster."""

import json
import os
import pathlib
import time
import warnings
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import closing, contextmanager
from importlib.metadata import version
from inspect import isfunction
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, ParameterError
from mjbeer.model.setting import FRICTION, OWN, Integrator, Rolling, Setting
from mjbeer.output.terminal import STDERR, progress_bar
from mjbeer.simulation.run import Run
from mjbeer.studies.sweep import files
from mjbeer.studies.sweep.arrays import Sweep, empty
from mjbeer.studies.sweep.chunks import carry_out
from mjbeer.studies.sweep.plan import Plan, arrange, check_names, label
from mjbeer.studies.sweep.quantities import ALWAYS, ASKED, NOT_YET, STATUS, TRUSTED
from mjbeer.studies.sweep.work import MOST_SAMPLES, Work
from mjbeer.theory.scene import Scene

_MOST_STEPS = 1e9
"""Largest number of timesteps of each run: they take some minutes."""
_SAVE_EVERY = 5.0
"""Time between two savings of what is there so far [s]."""
_SAVING = 20.0
"""Smallest ratio of that time to the time that saving takes."""
_PERCENT = 100

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
    call goes on from there after an interruption.

    A value that is not allowed is refused before anything runs. A scene that fails is listed in `Sweep.failed`.

    Raises:
      ParameterError: if an argument is not allowed; for an entry of an array the message has its index.
      OutputError: if the output cannot be written.
      OSError: if the system ends one of the executor's processes.
    """
    paired, progress = require.boolean("paired", paired), require.boolean("progress", progress)
    if executor is not None and not isinstance(executor, Executor):
        raise ParameterError(f"executor must be a concurrent.futures.Executor, got {require.shown(executor)}")
    path = None if output is None else files.checked(output, (files.NUMPY,))
    check_names(make, parameters)
    plan, fixed = arrange({**parameters, "phi0": phi0, "phi_dot0": phi_dot0}, paired)
    start = {name: require.number(name, fixed.pop(name)) for name in ("phi0", "phi_dot0") if name in fixed}
    require.radians(float(np.abs(plan.axes.get("phi0", start.get("phi0", 0.0))).max()))
    setting = Setting.of(integrator, tolerance, rolling=rolling, timestep=timestep, friction=friction)
    asked, functions = _asked(quantity)
    end = _end(require.positive("duration", duration, "s"), setting)
    if functions and end / setting.timestep > MOST_SAMPLES:
        raise ParameterError(
            f"a function of a trajectory has samples at every timestep, at most {MOST_SAMPLES}: a duration of "
            f"{duration!r} s has too many of {setting.timestep!r} s"
        )
    work = Work(make, fixed, start, tuple(plan.axes), setting, end, asked, functions)
    with _one_warning_of_liquids():
        return _swept(work, plan, executor, path, progress)


def _swept(work: Work, plan: Plan, executor: Executor | None, path: pathlib.Path | None, progress: bool) -> Sweep:
    """Check the scenes, go on from what is there already, and simulate the others."""
    plan.check(work)
    about = _about(work)
    result = empty(plan, about, work.columns)
    if path is not None:
        _nameable(work.make, *work.functions.values())
        result = _continued(path, result)
    _fill(result, work, executor, path, progress)
    return result


def _fill(result: Sweep, work: Work, executor: Executor | None, path: pathlib.Path | None, progress: bool) -> None:
    """Simulate the scenes that a sweep lacks, and write them into its arrays; save them if there is a path."""
    scenes = np.flatnonzero(result[STATUS].ravel() == NOT_YET)
    assert isinstance(result.reasons, dict)
    saved, interval = time.monotonic(), _SAVE_EVERY
    done, shown = 0, 0
    console = STDERR if progress else None
    if path is not None:
        files.save(result, path)  # a file that cannot be written is an error before the first scene
    try:
        with (
            progress_bar(console, _PERCENT) as advance,
            _running(executor) as pool,
            closing(carry_out(work, result.plan, scenes, pool)) as chunks,
        ):
            for chunk, measured in chunks:
                for column, name in enumerate(work.columns):
                    result.quantities[name].flat[chunk] = measured.values[:, column]
                result.quantities[TRUSTED].flat[chunk] = measured.trusted
                result.reasons.update((int(chunk[index]), reason) for index, reason in measured.reasons.items())
                result.quantities[STATUS].flat[chunk] = (
                    measured.status
                )  # the last, as it says that the others are there
                done += len(chunk)
                while shown < _PERCENT * done // len(scenes):
                    advance(f"{len(scenes)} scenes [%]")
                    shown += 1
                if path is not None and time.monotonic() - saved > interval:
                    began = time.monotonic()
                    files.save(result, path)
                    saved = time.monotonic()
                    interval = max(_SAVE_EVERY, _SAVING * (saved - began))
    finally:
        if path is not None:
            files.save(result, path)


@contextmanager
def _one_warning_of_liquids() -> Generator[None]:
    """Have what liquids warn of shown for the first such scene only: each would say it with other numbers."""
    show, shown = warnings.showwarning, set[type[Warning]]()

    def show_once(message: Warning | str, category: type[Warning], *place: Any) -> None:
        if category not in shown:
            show(message, category, *place)
        shown.update({category} & {LiquidWarning})

    cast("Any", warnings).showwarning = show_once
    try:
        yield
    finally:
        warnings.showwarning = show


@contextmanager
def _running(executor: Executor | None) -> Generator[Executor]:
    """Yield the user's executor, which is left as it is, or one with a thread for each core."""
    if executor is not None:
        yield executor
        return
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        yield threads


def _end(duration: float, setting: Setting) -> float:
    """Return the time at which the runs end [s]: MuJoCo's integrators end at a timestep, the first one after it.

    Raises:
      ParameterError: if there are too many timesteps.
    """
    if setting.tolerance is not None:
        return duration
    steps = duration / setting.timestep
    if steps > _MOST_STEPS:
        raise ParameterError(
            f"a duration of {duration!r} s has too many timesteps of {setting.timestep!r} s for a sweep: at most "
            f"{_MOST_STEPS:g}"
        )
    if setting.integrator in OWN:
        return duration
    nearest = round(steps)
    on_a_step = nearest > 0 and abs(steps - nearest) <= 1e-10 * steps
    return setting.timestep * (nearest if on_a_step else int(np.ceil(steps)))


def _asked(quantity: Asked | Sequence[Asked]) -> tuple[tuple[str, ...], dict[str, Callable[[Run], float]]]:
    """Return the names of the quantities that are asked for, and the functions by their names.

    Raises:
      ParameterError: if a name is unknown, or something is neither a name nor a function, or a name is there twice.
    """
    several: Sequence[Any] = quantity if isinstance(quantity, (list, tuple)) else (quantity,)
    names: list[str] = []
    functions: dict[str, Any] = {}
    for each in several:
        if callable(each) and not isinstance(each, type):
            if (name := label(each)) in (*ALWAYS, *ASKED, *functions, STATUS, TRUSTED):
                raise ParameterError(f"quantity {name!r} is there already: give the function another name")
            functions[name] = each
        elif isinstance(each, str):
            name = require.choice("quantity", each, (*ALWAYS, *ASKED, STATUS, TRUSTED))
            names += [name] if name in ASKED and name not in names else []
        else:
            raise ParameterError(f"quantity must be a name or a function of a trajectory, got {require.shown(each)}")
    return tuple(names), functions


def _about(work: Work) -> dict[str, Any]:
    """Return what all scenes of a sweep have in common, as it is saved: a sweep that differs in it is another one."""
    setting = work.setting
    stepped = f"{setting.integrator} at {setting.timestep:g} s"
    if setting.tolerance is not None:
        stepped = f"to a tolerance of {setting.tolerance:g} rad"
    return {
        "make": label(work.make),
        "defined in": getattr(work.make, "__module__", ""),
        "with": "" if isfunction(work.make) else repr(work.make),
        "arguments": {name: repr(value) for name, value in {**work.fixed, **work.start}.items()},
        "stepped": f"{setting.rolling}, {stepped}",
        "setting": repr(setting),
        "end [s]": work.end,
        "quantities": list(work.columns),
        "functions of": [getattr(function, "__module__", "") for function in work.functions.values()],
        "versions": {package: version(package) for package in ("mjbeer", "mujoco")},
    }


def _nameable(*functions: Callable[..., Any]) -> None:
    """Check that functions have names by which a saved sweep can be known again.

    Raises:
      ParameterError: if one is a lambda or defined within another function.
    """
    for function in functions:
        if "<" in label(function) or "<locals>" in getattr(function, "__qualname__", ""):
            raise ParameterError(
                "a sweep that is saved must be known again when it goes on: its functions must be defined at the top "
                f"of a module, got {require.shown(function)}"
            )


def _continued(path: pathlib.Path, new: Sweep) -> Sweep:
    """Return the sweep in a file if it is the same one, or else the new one.

    Raises:
      ParameterError: if the file is there but is no sweep's.
    """
    if not path.exists():
        return new
    stored = files.load(path)
    same = json.dumps(stored.about) == json.dumps(new.about) and stored.plan.paired == new.plan.paired
    same = same and list(stored.plan.axes) == list(new.plan.axes)
    same = same and all(np.array_equal(stored[name], axis) for name, axis in new.plan.axes.items())
    return stored if same else new
