"""The command sweep: one scene with ranges of its options, as a map, a table or a file."""

import contextlib
import functools
import pathlib
import re
from argparse import Namespace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from mjbeer.cli.arguments import SCENES, Option, asked, command, make, run_options, several, start, steps
from mjbeer.exceptions import ParameterError
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PLOTS = (".png", ".svg")
ENDINGS = (*PLOTS, ".csv", ".npz", ".nc")
_OF_A_RUN = "phi u phi_dot u_dot error lowest_normal friction_needed parting_time energy_drift"
QUANTITIES = (*_OF_A_RUN.split(), "trusted", "status", "period")
_QUANTITY = (
    "quantity of the plot; files have all of them. phi, u, phi_dot and u_dot are those at the end, error is the "
    "estimate, and parting_time the time from which N < 0. period is measured only if it is asked for"
)
_OUTPUT = (
    "file to write: a plot (.png or .svg) over one or two options, a table (.csv), or all arrays (.npz for NumPy, .nc "
    "for xarray). An interrupted sweep to .npz goes on where it was"
)


@command(
    *run_options(several),
    Option("quantity", _QUANTITY, "phi", QUANTITIES),
    Option("output", _OUTPUT, pathlib.Path("sweep.png"), pathlib.Path),
    Option("overwrite", "replace a .npz of another sweep, and begin the same one anew", kind=bool),
    numbers=several,
)
def sweep(given: Namespace) -> int:
    """Simulate a scene for ranges of its options, as --incline 1:20:39, which is 39 numbers from 1 to 20.

    NUMBERS are one number, several as 1,2,5, or such a range. Without a tolerance and an integrator, the tolerance is
    1e-6 rad.
    """
    from mjbeer.studies.sweep.measure import BEYOND
    from mjbeer.studies.sweep.result import checked, shown
    from mjbeer.studies.sweep.run import sweep

    checked(given.output, ENDINGS)
    options = {**asked(given), **start(given)}
    varied = [each for each in options.values() if isinstance(each, np.ndarray)]
    if given.output.suffix in PLOTS and len(varied) not in (1, 2):
        raise ParameterError(
            f"a plot needs one or two options with several values, got {len(varied)}: write .csv, .npz or .nc instead"
        )
    if given.tolerance is None and given.integrator is None:
        given.tolerance = 1e-6
    maker = functools.partial(make, SCENES[given.scene])
    cast("Any", maker).__name__ = given.scene
    resumed = given.output if given.output.suffix == ".npz" else None
    with files.whole(given.output) if resumed is None else contextlib.nullcontext() as temporary:
        options |= {"quantity": given.quantity, "output": resumed, "overwrite": given.overwrite, **steps(given)}
        result = sweep(maker, given.duration, **options)
        if temporary and given.output.suffix in PLOTS:
            cast("Figure", result.plot(given.quantity).figure).savefig(temporary, facecolor="white", dpi=150)
        elif temporary:
            result.save(temporary)
    alike: dict[str, list[Any]] = {}
    for failure in result.failed:  # reasons that differ in nothing but numbers are one
        alike.setdefault(re.sub(r"\d[\d.e+-]*", "", failure.reason), []).append(failure)
    for first, *others in sorted(alike.values(), key=len, reverse=True):
        named = zip(result.dims, first.index, strict=True)
        place = ", ".join(f"{name} = {shown(name, result[name])[index]:.6g}" for name, index in named)
        what = "beyond the model" if result["status"][first.index] == BEYOND else "failed"
        say(f"{what}: {1 + len(others)} scene{'s' * bool(others)}, the first at {place}: {first.reason}", "yellow")
    say(f"wrote {given.output}")
    terminal.write(f"{result.counts}\n")
    return 0
