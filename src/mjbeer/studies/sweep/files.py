"""Files of a sweep: NumPy's, from which an interrupted sweep goes on, NetCDF, and CSV."""

import json
import os
import pathlib
import zipfile
from typing import IO

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.output import files
from mjbeer.studies.sweep.arrays import Sweep, imported_xarray
from mjbeer.studies.sweep.plan import Plan
from mjbeer.studies.sweep.quantities import unit

NUMPY, NETCDF, CSV = ".npz", ".nc", ".csv"
_ABOUT, _REASONS, _PAIRED = "about", "reasons", "paired"
"""Entries of a NumPy file beside the parameters and the quantities."""
_PARAMETER = "parameter "
"""What precedes the name of a parameter in a NumPy file."""


def save(sweep: Sweep, path: str | os.PathLike[str]) -> None:
    """Write a sweep to a file, in the way that its name's ending says, whole or not at all.

    Raises:
      ParameterError: if the name has another ending.
      OutputError: if the file cannot be written.
      MjbeerError: if xarray is not installed and a NetCDF file is to be written.
    """
    target = checked(path, (NUMPY, NETCDF, CSV))
    dataset = sweep.to_xarray() if target.suffix == NETCDF else None
    with files.whole(target) as temporary:
        if dataset is not None:
            dataset.to_netcdf(temporary, engine="scipy")
        elif target.suffix == NUMPY:
            with temporary.open("wb") as file:
                _write_numpy(sweep, file)
        else:
            temporary.write_text(csv(sweep), encoding="utf-8")


def load(path: pathlib.Path) -> Sweep:
    """Return the sweep in a NumPy file that `save` wrote.

    Raises:
      ParameterError: if the file is none.
    """
    try:
        with np.load(path) as stored:
            axes = {name.removeprefix(_PARAMETER): stored[name] for name in stored if name.startswith(_PARAMETER)}
            plan = Plan(axes, bool(stored[_PAIRED]))
            about = json.loads(str(stored[_ABOUT]))
            reasons = {int(scene): reason for scene, reason in json.loads(str(stored[_REASONS])).items()}
            skipped = {_ABOUT, _REASONS, _PAIRED}
            arrays = {name: stored[name] for name in stored if name not in skipped and not name.startswith(_PARAMETER)}
            return Sweep(plan, about, arrays, reasons)
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise ParameterError(f"{path} was not written by `mjbeer.sweep`: {error}") from error


def csv(sweep: Sweep) -> str:
    """Return a sweep as CSV: one line for each scene, units in the header, numbers with all their digits."""
    scenes = np.arange(int(np.prod(sweep.shape)))
    columns = [*sweep.plan.rows(scenes).T, *(array.ravel() for array in sweep.quantities.values())]
    header = ",".join(f"{name} [{unit(name)}]" if unit(name) else name for name in (*sweep.plan.axes, *sweep.names))
    whole = [array.dtype.kind in "bi" for array in columns]
    lines = (
        ",".join(f"{value:d}" if plain else f"{value:.17g}" for value, plain in zip(row, whole, strict=True))
        for row in zip(*(array.tolist() for array in columns), strict=True)
    )
    return "\n".join((header, *lines)) + "\n"


def checked(path: str | os.PathLike[str], endings: tuple[str, ...]) -> pathlib.Path:
    """Return the path of a file whose name has one of some endings.

    Raises:
      ParameterError: if it has another one.
      MjbeerError: if it is a NetCDF file's, and xarray is not installed.
    """
    target = require.path(path)
    if target.suffix == NETCDF:
        imported_xarray()  # before a long run, not after it
    if target.suffix not in endings:
        raise ParameterError(f"the file's name must end in {' or '.join(endings)}, got {require.shown(str(target))}")
    return target


def _write_numpy(sweep: Sweep, file: IO[bytes]) -> None:
    parameters = {_PARAMETER + name: axis for name, axis in sweep.plan.axes.items()}
    texts = {_ABOUT: json.dumps(sweep.about), _REASONS: json.dumps(sweep.reasons)}
    np.savez(file, allow_pickle=False, **parameters, **sweep.quantities, **texts, **{_PAIRED: sweep.plan.paired})
