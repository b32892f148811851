"""A sweep is shown, kept and read back as it is."""

import csv
import math
import pathlib
import sys

import numpy as np
import pytest

import mjbeer
from mjbeer import frozen
from mjbeer.exceptions import MjbeerError, OutputError, ParameterError
from mjbeer.studies.sweep import files
from mjbeer.studies.sweep.arrays import Sweep

INCLINES, FILLS = np.radians([5.0, 60.0]), [0.3, 0.5, 0.7]


@pytest.fixture(scope="module")
def swept() -> Sweep:
    """Six scenes; on the steep incline none has a period."""
    return mjbeer.sweep(frozen, 1.5, 0.6, tolerance=1e-6, incline=INCLINES, fill=FILLS, quantity="period")


@pytest.fixture(scope="module")
def listed() -> Sweep:
    return mjbeer.sweep(frozen, 0.1, [0.6, 0.7], paired=True, tolerance=1e-6, fill=[0.3, 0.5])


def test_parameters_and_quantities_are_found_by_name(swept: Sweep) -> None:
    assert swept["incline"].tolist() == INCLINES.tolist()
    assert swept["phi"].shape == swept.shape == (2, 3)
    with pytest.raises(ParameterError, match=r"name must be one of 'incline', .*; got 'perod': did you mean 'period'"):
        _ = swept["perod"]


def test_it_is_described_in_a_line_and_in_a_table(swept: Sweep) -> None:
    assert repr(swept) == (
        "<Sweep of frozen over incline (2) x fill (3) to t = 1.5 s: 3 of 6 scenes went well; "
        "3: a quantity has no value>"
    )
    table = swept._repr_html_()
    assert "period of the swing: 0.3" in table
    assert "reduced, to a tolerance of 1e-06 rad" in table
    assert "incline[1] = 1.0472, fill[0] = 0.3: period: no equilibrium" in table


def test_a_run_that_is_not_trusted_is_counted() -> None:
    """The frozen can that is released upside down leaves the incline."""
    swept = mjbeer.sweep(frozen, 2.0, [0.1, math.pi - 0.1], tolerance=1e-6)
    assert swept["trusted"].tolist() == [True, False]
    assert "2 of 2 scenes went well; 1 of these are not trusted" in repr(swept)


@pytest.mark.parametrize("which", ["swept", "listed"])
def test_a_numpy_file_has_all_of_it(which: str, tmp_path: pathlib.Path, request: pytest.FixtureRequest) -> None:
    sweep: Sweep = request.getfixturevalue(which)
    sweep.save(tmp_path / "map.npz")
    read = files.load(tmp_path / "map.npz")
    assert (read.dims, read.about, read.reasons) == (sweep.dims, sweep.about, sweep.reasons)
    for name in (*sweep.plan.axes, *sweep.names):
        assert np.array_equal(read[name], sweep[name], equal_nan=sweep[name].dtype.kind == "f")
        assert read[name].dtype == sweep[name].dtype


def test_a_csv_file_has_a_line_for_each_scene(swept: Sweep, tmp_path: pathlib.Path) -> None:
    swept.save(tmp_path / "map.csv")
    lines = list(csv.DictReader((tmp_path / "map.csv").read_text().splitlines()))
    assert [float(line["phi [rad]"]) for line in lines] == swept["phi"].ravel().tolist()
    assert [float(line["incline [rad]"]) for line in lines] == INCLINES.repeat(3).tolist()
    assert [int(line["status"]) for line in lines] == swept["status"].ravel().tolist()
    assert "fill" in lines[0]


def test_an_xarray_dataset_has_all_of_it_with_units(swept: Sweep, listed: Sweep, tmp_path: pathlib.Path) -> None:
    xarray = pytest.importorskip("xarray")
    dataset = swept.to_xarray()
    assert dataset.phi.dims == ("incline", "fill")
    assert dataset.phi.attrs["units"] == "rad"
    assert dataset.phi.sel(fill=0.5).values.tolist() == swept["phi"][:, 1].tolist()
    assert listed.to_xarray().phi.dims == ("scene",)
    assert listed.to_xarray().fill.values.tolist() == [0.3, 0.5]
    swept.save(tmp_path / "map.nc")
    with xarray.open_dataset(tmp_path / "map.nc", engine="scipy") as read:
        assert read.identical(dataset)


def test_without_xarray_an_error_says_what_brings_it(swept: Sweep, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(MjbeerError, match=r"need xarray: pip install xarray"):
        swept.to_xarray()
    with pytest.raises(MjbeerError, match=r"\.nc files need xarray"):
        files.checked("map.nc", (files.NETCDF,))


def test_a_file_that_cannot_be_written_is_refused(swept: Sweep, tmp_path: pathlib.Path) -> None:
    with pytest.raises(ParameterError, match=r"name must end in .npz or .nc or .csv, got 'map.xls'"):
        swept.save("map.xls")
    (tmp_path / "map.csv").mkdir()
    with pytest.raises(OutputError, match="it is a folder"):
        swept.save(tmp_path / "map.csv")


def test_a_map_has_its_parameters_in_degrees_and_no_colour_without_a_value(swept: Sweep) -> None:
    axes = swept.plot("period")
    (mesh,) = axes.collections
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("incline [°]", "fill")
    colours = np.ma.masked_invalid(np.ma.asarray(mesh.get_array()))
    assert np.ma.getmaskarray(colours).tolist() == [[False, True]] * 3
    assert colours[:, 0].tolist() == swept["period"][0].tolist()
    assert np.ptp(axes.get_xlim()) == pytest.approx(2 * 55)
    assert axes.figure.axes[1].get_ylabel() == "period of the swing [s]"


def test_one_parameter_gives_a_line(listed: Sweep) -> None:
    axes = mjbeer.sweep(frozen, 0.1, [0.6, 0.7], tolerance=1e-6).plot("phi_dot")
    assert np.asarray(axes.get_lines()[0].get_xdata()).tolist() == pytest.approx(np.degrees([0.6, 0.7]))
    assert axes.get_ylabel() == "rate of φ at the end [°/s]"
    with pytest.raises(ParameterError, match="a plot needs a sweep over one or two parameters, got 2 scenes of fill, "):
        listed.plot()
