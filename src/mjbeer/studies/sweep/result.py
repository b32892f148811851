"""A sweep as the user has it: an array for each quantity, what failed and why, and ways to show and keep them."""

import json
import math
import os
import pathlib
import zipfile
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.output import files
from mjbeer.studies.sweep.measure import NAMED, STATUS, STATUSES, TRUSTED, WELL

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SCENE = "scene"
"""The one dimension of a sweep over a list of scenes."""
_HEADER = "sweep.json"
"""What a NumPy file has beside the arrays, whose names there all end in .npy."""
_UNITS = {name: quantity.unit for name, quantity in NAMED.items()}
_UNITS |= {"incline": "rad", "phi0": "rad", "phi_dot0": "rad/s", "density": "kg/m^3", "gravity": "m/s^2"}
_UNITS |= {"damping": "N m s", "drag": "kg/m", "viscosity": "m^2/s", "radius": "m", "length": "m", "offset": "m"}
_UNITS |= {"wheel_mass": "kg", "load_mass": "kg", "hoop_mass": "kg"}
"""Units of quantities, and of the parameters of mjbeer's own scenes; a fill has none."""


class Failure(NamedTuple):
    """A scene that was refused, that diverged, that lacks a quantity, or that left the range of its model."""

    index: tuple[int, ...]
    """Where it is in the sweep's arrays."""
    parameters: str
    reason: str


@dataclass(frozen=True, eq=False, repr=False)
class Sweep:
    """Many scenes, simulated in one call of `mjbeer.sweep`, numbered with the last dimension first.

    `sweep["phi"]` is an array of shape `shape`, with the quantity's value for each scene, NaN where it has none.
    `sweep["incline"]` has the values of a parameter.
    """

    axes: dict[str, np.ndarray]
    """The values of each parameter that varies, in the order given."""
    paired: bool
    """Whether the entries of all of these belong together, one scene for each, instead of being combined."""
    about: dict[str, Any]
    """What all scenes have in common: `make`, its other arguments, the setting, the end [s], versions, and notes: what
    liquids have warned of."""
    quantities: dict[str, np.ndarray]
    """An array for each quantity."""
    reasons: dict[int, str]
    """Why a scene's status is not 0, by its number."""

    @property
    def dims(self) -> tuple[str, ...]:
        """Return the names of the dimensions: of each parameter that varies, or "scene" for a list of scenes."""
        return (SCENE,) if self.paired else tuple(self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the shape of every quantity's array."""
        return tuple(len(values) for values in self.axes.values())[: 1 if self.paired else None]

    def __getitem__(self, name: str) -> np.ndarray:
        """Return the array of a quantity, or the values of a parameter that varies.

        Raises:
          ParameterError: if there is none of that name; the message lists the names.
        """
        arrays = self.axes | self.quantities
        return arrays[require.choice("name", name, arrays)]

    @property
    def failed(self) -> list[Failure]:
        """Return each scene that was refused, diverged, lacks a quantity or left the range of its model, and why."""
        return [
            Failure(tuple(map(int, self._places(number)))[: len(self.dims)], self.named(number), reason)
            for number, reason in sorted(self.reasons.items())
        ]

    def rows(self, scenes: np.ndarray) -> np.ndarray:
        """Return the parameters of the scenes with these numbers, shape (scenes, parameters)."""
        places = zip(self.axes.values(), self._places(scenes), strict=True)
        return np.array([values[place] for values, place in places]).T.reshape(len(scenes), len(self.axes))

    def named(self, scene: Any) -> str:
        """Return the parameters of a scene in words, as "incline[3] = 0.1, fill[0] = 0.5"."""
        places = zip(self.axes.items(), self._places(scene), strict=True)
        return ", ".join(f"{name}[{place}] = {values[place]:.6g}" for (name, values), place in places)

    def _places(self, scenes: Any) -> tuple[Any, ...]:
        """Return the index in the values of each parameter that some scenes have."""
        return (scenes,) * len(self.axes) if self.paired or not self.axes else np.unravel_index(scenes, self.shape)

    @property
    def counts(self) -> str:
        """Return in words how many scenes went well, failed, and are not trusted."""
        status = self.quantities[STATUS]
        of_each = {text: np.count_nonzero(status == number) for number, text in STATUSES.items()}
        doubted = np.count_nonzero((status == WELL) & ~self.quantities[TRUSTED])
        told = [f"{of_each.pop(STATUSES[WELL])} of {status.size} scenes went well"]
        told += [f"{doubted} of these are not trusted"] * bool(doubted)
        return "; ".join(told + [f"{count}: {text}" for text, count in of_each.items() if count])

    def __repr__(self) -> str:
        """Return the sweep in one line."""
        over = " x ".join(f"{name} ({len(axis)})" for name, axis in self.axes.items()) or "one scene"
        over = f"{self.shape[0]} scenes of {', '.join(self.axes)}" if self.paired else over
        return f"<Sweep of {self.about['make']} over {over} to t = {self.about['end [s]']:.6g} s: {self.counts}>"

    def to_xarray(self) -> Any:
        """Return the sweep as an xarray Dataset: a variable for each quantity, with its unit, over the parameters.

        Raises:
          MjbeerError: if xarray is not installed.
        """
        told = {name: {"units": unit} if unit else {} for name, unit in _UNITS.items()}
        for name, quantity in NAMED.items():
            told[name]["long_name"] = quantity.meaning
        told[STATUS] = {"meaning": "; ".join(f"{number}: {text}" for number, text in STATUSES.items())}
        axes, dims = self.axes.items(), self.dims
        return _xarray().Dataset(
            {name: (dims, array, told.get(name, {})) for name, array in self.quantities.items()},
            {name: (dims if self.paired else (name,), values, told.get(name, {})) for name, values in axes},
            {name: str(value) for name, value in self.about.items()},
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the sweep to a file, whose name ends in .npz (NumPy), .nc (NetCDF, needs xarray) or .csv.

        Raises:
          ParameterError: if the name ends otherwise.
          OutputError: if the file cannot be written.
          MjbeerError: if xarray is not installed and a NetCDF file is to be written.
        """
        target = checked(path, (".npz", ".nc", ".csv"))
        with files.whole(target) as temporary:
            if target.suffix == ".nc":
                self.to_xarray().to_netcdf(temporary, engine="scipy")
            elif target.suffix == ".csv":  # a line for each scene; 17 digits are all that a double has
                rows = self.rows(np.arange(math.prod(self.shape)))
                columns = [*rows.T, *(array.ravel() for array in self.quantities.values())]
                names = [f"{name} [{_UNITS.get(name, '')}]".removesuffix(" []") for name in self.axes | self.quantities]
                np.savetxt(temporary, np.transpose(columns), "%.17g", ",", header=",".join(names), comments="")
            else:
                self._write(temporary)

    def _write(self, path: pathlib.Path) -> None:
        """Write NumPy's .npz. Its own `savez` takes names as arguments, of which "file" has another meaning."""
        header = {"axes": list(self.axes), "paired": self.paired, "about": self.about, "reasons": self.reasons}
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr(_HEADER, json.dumps(header))
            for name, array in {**self.axes, **self.quantities}.items():
                with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                    np.lib.format.write_array(member, array, allow_pickle=False)

    def plot(self, name: str = "phi") -> "Axes":
        """Plot a quantity over one parameter, or as a map over two, in a new figure, and return its axes.

        Angles are in degrees. Scenes that have no value are left white.

        Raises:
          ParameterError: if there is no such quantity, or the sweep has not one or two dimensions.
        """
        require.choice("name", name, self.quantities)
        if self.paired or len(self.shape) not in (1, 2):
            raise ParameterError(f"a plot needs a sweep over one or two parameters, got {self!r}")
        import matplotlib as mpl
        from matplotlib import pyplot as plt

        from mjbeer.output.plots import STYLE

        # A notebook makes matplotlib interactive with the first figure, which the context would undo at its end.
        figure = plt.figure(figsize=(7, 4.5), layout="constrained")
        values = shown(name, np.where(np.isfinite(self[name]), self[name], np.nan))
        edges, scales = zip(*(_edges(shown(each, self[each])) for each in self.dims), strict=True)
        with mpl.rc_context(STYLE):
            axes = figure.subplots()
            axes.set(xlabel=_label(self.dims[0]), xscale=scales[0], ylabel=_label([*self.dims, name][1]))
            if len(edges) == 1:
                axes.plot(shown(self.dims[0], self[self.dims[0]]), values, marker="." if len(values) < 100 else "")
            else:  # a colour map that colour-blind readers see as others do, and which is even in print
                mesh = axes.pcolormesh(*edges, values.T, cmap="cividis", rasterized=True)
                axes.set_yscale(scales[1])
                figure.colorbar(mesh, ax=axes, label=_label(name))
                axes.grid(visible=False)
            figure.suptitle(f"{self.about['make']}, {self.about['end [s]']:.6g} s", fontsize=STYLE["axes.titlesize"])
        return axes


def load(path: pathlib.Path) -> Sweep:
    """Return the sweep in a NumPy file.

    Raises:
      ParameterError: if the file has none, or not all of it.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            header = json.loads(archive.read(_HEADER))
            names = [name.removesuffix(".npy") for name in archive.namelist() if name != _HEADER]
            arrays = {name: np.lib.format.read_array(archive.open(f"{name}.npy")) for name in names}
        axes = {name: arrays.pop(name) for name in header["axes"]}
        reasons = {int(scene): reason for scene, reason in header["reasons"].items()}
        sweep = Sweep(axes, header["paired"], header["about"], arrays, reasons)
        kinds = dict.fromkeys(sweep.about["quantities"], "f") | {TRUSTED: "b", STATUS: "i"}
        found = {name: (array.shape, array.dtype.kind) for name, array in arrays.items()}
        if found != {name: (sweep.shape, kind) for name, kind in kinds.items()}:
            raise ValueError(f"its arrays are not those of {' x '.join(map(str, sweep.shape))} scenes")
    except (OSError, ValueError, KeyError, TypeError, AttributeError, zipfile.BadZipFile) as error:
        raise ParameterError(f"{path} was not written by `mjbeer.sweep`: {error}") from error
    return sweep


def checked(path: str | os.PathLike[str], endings: tuple[str, ...]) -> pathlib.Path:
    """Return the path of a file whose name has one of some endings, and for which nothing is missing.

    Raises:
      ParameterError: if it has another one.
      MjbeerError: if it is a NetCDF file's, and xarray is not installed.
    """
    target = require.path(path)
    if target.suffix not in endings:
        raise ParameterError(f"the file's name must end in {' or '.join(endings)}, got {require.shown(str(target))}")
    if target.suffix == ".nc":
        _xarray()
    return target


def shown(name: str, values: np.ndarray) -> np.ndarray:
    """Return the values of a quantity or parameter as plots have them: angles and their rates in degrees."""
    return np.degrees(values) if "°" in _label(name) else values


def _label(name: str) -> str:
    """Return a quantity or a parameter with its unit, as an axis has it."""
    unit = _UNITS.get(name, "")
    unit = unit if name == "error" else unit.replace("rad", "°")
    meaning = NAMED[name].meaning if name in NAMED else name.replace("_", " ")
    return f"{meaning} [{unit}]" if unit else meaning


def _edges(values: np.ndarray) -> tuple[np.ndarray, str]:
    """Return the borders of a map's cells, half-way between some values, and the scale of their axis.

    It is logarithmic if each value is the one before times the same factor, over a decade or more.
    """
    steps = np.diff(np.log10(values)) if len(values) > 2 and (values > 0).all() else np.zeros(1)
    by_factor = abs(steps.sum()) >= 1 and np.ptp(steps) < 1e-6 * abs(steps[0])  # values may come from a text
    values = np.log(values) if by_factor else values
    half = np.diff(values) / 2 if len(values) > 1 else np.array([0.5])
    edges = np.append(values[0] - half[0], values + np.append(half, half[-1])[: len(values)])
    return (np.exp(edges), "log") if by_factor else (edges, "linear")


def _xarray() -> Any:
    try:
        import xarray
    except ImportError as error:
        raise MjbeerError("datasets and .nc files need xarray: pip install xarray") from error
    return xarray
