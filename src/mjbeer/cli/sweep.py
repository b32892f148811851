"""The command sweep: one scene with ranges of its options, as a map, a table or a file."""

import contextlib
import functools
import pathlib
from argparse import Namespace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from mjbeer.cli.arguments import SCENES, Option, asked, command, make, run_options, several, start, steps
from mjbeer.exceptions import ParameterError
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say

if TYPE_CHECKING:
    import xarray

PLOTS = (".png", ".svg")
ENDINGS = (*PLOTS, ".csv", ".nc")
_OF_A_RUN = "phi u phi_dot u_dot error lowest_normal friction_needed parting_time energy_drift"
QUANTITIES = (*_OF_A_RUN.split(), "trusted", "status", "period")
_QUANTITY = (
    "quantity of the plot; files have all of them. phi, u, phi_dot and u_dot are those at the end, error is the "
    "estimate, and parting_time the time from which N < 0. period is measured only if it is asked for"
)
_OUTPUT = (
    "file to write: a plot (.png or .svg) over one or two options, a table (.csv), or NetCDF (.nc), with all arrays; "
    "an interrupted sweep to .nc goes on where it was"
)


@command(
    *run_options(several),
    Option("quantity", _QUANTITY, "phi", QUANTITIES),
    Option("output", _OUTPUT, pathlib.Path("sweep.png"), pathlib.Path),
    Option("overwrite", "replace a .nc of another sweep, and begin the same one anew", kind=bool),
    numbers=several,
)
def sweep(given: Namespace) -> int:
    """Simulate a scene for ranges of its options, as --incline 1:20:39, which is 39 numbers from 1 to 20.

    NUMBERS are one number, several as 1,2,5, or such a range. Without a tolerance and an integrator, the tolerance is
    1e-6 rad.
    """
    from mjbeer.studies.sweep import STATUSES, WELL, sweep

    if given.output.suffix not in ENDINGS:
        raise ParameterError(f"the file's name must end in {' or '.join(ENDINGS)}, got {str(given.output)!r}")
    options = {**asked(given), **start(given)}
    varied = [each for each in options.values() if isinstance(each, np.ndarray)]
    if given.output.suffix in PLOTS and len(varied) not in (1, 2):
        raise ParameterError(
            f"a plot needs one or two options with several values, got {len(varied)}: write .csv or .nc instead"
        )
    if given.tolerance is None and given.integrator is None:
        given.tolerance = 1e-6
    maker = functools.partial(make, SCENES[given.scene])
    cast("Any", maker).__qualname__ = given.scene
    resumed = given.output if given.output.suffix == ".nc" else None
    with files.whole(given.output) if resumed is None else contextlib.nullcontext() as temporary:
        options |= {"quantity": given.quantity, "output": resumed, "overwrite": given.overwrite, **steps(given)}
        result = sweep(maker, given.duration, **options)
        if temporary and given.output.suffix in PLOTS:
            _plot(result, given.quantity, temporary)
        elif temporary:
            result.to_dataframe().to_csv(temporary, float_format="%.17g", index=bool(result.dims))
    for line in result.attrs["failed"].splitlines():
        say(f"failed: {line}", "yellow")  # one of each kind
    say(f"wrote {given.output}")
    status = result["status"].values
    counts = [f"{np.count_nonzero(status == number)}: {text}" for number, text in STATUSES.items() if number in status]
    doubted = np.count_nonzero((status == WELL) & ~result["trusted"].values)
    terminal.write("; ".join(counts + [f"{doubted}: not trusted"] * bool(doubted)) + "\n")
    return 0


def _plot(result: "xarray.Dataset", quantity: str, path: pathlib.Path) -> None:
    """Plot a quantity over one parameter, or as a map over two, with angles in degrees."""
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    from mjbeer.output.plots import STYLE

    shown = result.copy()
    for name in (*shown.coords, quantity):
        unit = shown[name].attrs.get("units", "")
        if "rad" in unit and name != "error":
            values = np.degrees(shown[name].values)
            shown[name] = shown[name].dims, values, shown[name].attrs | {"units": unit.replace("rad", "°")}
    with mpl.rc_context(STYLE):
        figure = plt.figure(figsize=(7, 4.5), layout="constrained")
        axes = figure.add_subplot()
        values = shown[quantity].where(np.isfinite(shown[quantity]))
        if values.ndim == 1:
            values.plot.line(ax=axes, marker="." if values.size < 100 else "")
        else:
            values.plot.pcolormesh(ax=axes, x=values.dims[0], cmap="cividis", rasterized=True)
            axes.grid(visible=False)
        axes.set_title(f"{result.attrs['make']}, {result.attrs['duration']:.6g} s")
        figure.savefig(path, facecolor="white", dpi=150)
        plt.close(figure)
