"""A sweep as the user has it: an array for each quantity, what failed and why, and ways to show and keep them."""

import html
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError
from mjbeer.studies.sweep.plan import Plan
from mjbeer.studies.sweep.quantities import NAMED, NOT_YET, STATUS, STATUSES, TRUSTED, WELL, unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LISTED = 3
"""Number of failed scenes that a notebook's cell shows."""


class Failure(NamedTuple):
    """A scene that was refused, that diverged, or that lacks a quantity."""

    index: tuple[int, ...]
    """Where it is in the sweep's arrays."""
    parameters: str
    """Its parameters, in words."""
    reason: str


@dataclass(frozen=True, eq=False, repr=False)
class Sweep:
    """Many scenes, simulated in one call of `mjbeer.sweep`.

    `sweep["phi"]` is an array of shape `shape`, with the quantity's value for each scene, NaN where it has none.
    `sweep["incline"]` has the values of a parameter.
    """

    plan: Plan
    """Which scenes there are."""
    about: Mapping[str, Any]
    """What all scenes have in common: `make`, its other arguments, the setting, the end [s], and versions."""
    quantities: Mapping[str, np.ndarray]
    """An array for each quantity, by its name."""
    reasons: Mapping[int, str]
    """Why a scene's status is not 0, by its number, the last dimension first."""

    @property
    def dims(self) -> tuple[str, ...]:
        """Return the names of the dimensions: of each parameter that varies, or "scene" for a list of scenes."""
        return self.plan.dims

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the shape of every quantity's array."""
        return self.plan.shape

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names of the quantities."""
        return tuple(self.quantities)

    def __getitem__(self, name: str) -> np.ndarray:
        """Return the array of a quantity, or the values of a parameter that varies.

        Raises:
          ParameterError: if there is none of that name; the message lists the names.
        """
        arrays = {**self.plan.axes, **self.quantities}
        return arrays[require.choice("name", name, arrays)]

    @property
    def failed(self) -> list[Failure]:
        """Return the index, the parameters and the reason of each scene that was refused, diverged or has no value."""
        return [
            Failure(self.plan.index(scene), self.plan.named(scene), reason)
            for scene, reason in sorted(self.reasons.items())
        ]

    def to_xarray(self) -> Any:
        """Return the sweep as an xarray Dataset: a variable for each quantity, with its unit, over the parameters.

        Raises:
          MjbeerError: if xarray is not installed.
        """
        xarray = imported_xarray()
        axes, dims = self.plan.axes, self.dims
        coordinates = {name: (dims if self.plan.paired else (name,), axis, _units(name)) for name, axis in axes.items()}
        variables = {name: (dims, array, _units(name)) for name, array in self.quantities.items()}
        variables[STATUS][2]["meaning"] = "; ".join(f"{number}: {text}" for number, text in STATUSES.items())
        return xarray.Dataset(variables, coordinates, {name: str(value) for name, value in self.about.items()})

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the sweep to a file, whose name ends in .npz (NumPy), .nc (NetCDF, needs xarray) or .csv.

        Raises:
          ParameterError: if the name ends otherwise.
          OutputError: if the file cannot be written.
          MjbeerError: if xarray is not installed and a NetCDF file is to be written.
        """
        from mjbeer.studies.sweep import files

        files.save(self, path)

    def plot(self, name: str = "phi") -> "Axes":
        """Plot a quantity over one parameter, or as a map over two, in a new figure, and return its axes.

        Angles are in degrees. Scenes that have no value are left white.

        Raises:
          ParameterError: if there is no such quantity, or the sweep has not one or two dimensions.
        """
        from mjbeer.studies.sweep import plots

        return plots.plot(self, name)

    @property
    def counts(self) -> str:
        """Return in words how many scenes went well, failed, and are not trusted."""
        status = self.quantities[STATUS]
        doubted = np.count_nonzero((status == WELL) & ~self.quantities[TRUSTED])
        told = [f"{np.count_nonzero(status == WELL)} of {status.size} scenes went well"]
        told += [f"{doubted} of these are not trusted"] * bool(doubted)
        told += [
            f"{count}: {text}"
            for number, text in STATUSES.items()
            if number != WELL and (count := np.count_nonzero(status == number))
        ]
        return "; ".join(told)

    @property
    def over(self) -> str:
        """Return in words which parameters vary, and over how many values."""
        if self.plan.paired:
            return f"{self.shape[0]} scenes of {', '.join(self.plan.axes)}"
        return " x ".join(f"{name} ({len(axis)})" for name, axis in self.plan.axes.items()) or "one scene"

    def __repr__(self) -> str:
        """Return the sweep in one line."""
        return f"<Sweep of {self.about['make']} over {self.over} to t = {self.about['end [s]']:.6g} s: {self.counts}>"

    def _repr_html_(self) -> str:
        """Return what was swept, the ranges of its quantities, and the first failures, for a notebook."""
        rows = {
            "sweep": f"{self.about['make']} over {self.over}, to t = {self.about['end [s]']:.6g} s",
            "setting": self.about["stepped"],
            "scenes": self.counts,
        }
        for name, array in self.quantities.items():
            finite = array[np.isfinite(array)]
            if name not in (STATUS, TRUSTED) and finite.size:
                label = NAMED[name].meaning if name in NAMED else name
                rows[name] = f"{label}: {finite.min():.4g} to {finite.max():.4g} {unit(name)}"
        failed = self.failed
        if failed:
            more = f"; and {len(failed) - _LISTED} more" if len(failed) > _LISTED else ""
            rows["failed"] = "; ".join(f"{each.parameters}: {each.reason}" for each in failed[:_LISTED]) + more
        cells = "".join(
            f"<tr><th>{html.escape(name)}</th><td>{html.escape(row)}</td></tr>" for name, row in rows.items()
        )
        return f'<table style="text-align: left">{cells}</table>'


def imported_xarray() -> Any:
    """Return the module xarray.

    Raises:
      MjbeerError: if it is not installed.
    """
    try:
        import xarray
    except ImportError as error:
        raise MjbeerError("datasets and .nc files need xarray: pip install xarray") from error
    return xarray


def empty(plan: Plan, about: Mapping[str, Any], columns: tuple[str, ...]) -> Sweep:
    """Return a sweep of which nothing has been simulated yet."""
    arrays = {name: np.full(plan.shape, np.nan) for name in columns}
    arrays[TRUSTED] = np.zeros(plan.shape, np.bool_)
    arrays[STATUS] = np.full(plan.shape, NOT_YET, np.int8)
    return Sweep(plan, about, arrays, {})


def _units(name: str) -> dict[str, str]:
    attributes = {"units": unit(name)} if unit(name) else {}
    return attributes | ({"long_name": NAMED[name].meaning} if name in NAMED else {})
