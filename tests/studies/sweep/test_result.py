"""A sweep is shown, kept and read back as it is."""

import csv
import pathlib
import sys
import zipfile

import numpy as np
import pytest

import mjbeer
from mjbeer import frozen, sliding
from mjbeer.exceptions import MjbeerError, OutputError, ParameterError
from mjbeer.studies.sweep.result import Sweep, checked, load

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
    with pytest.raises(ParameterError, match=r"name must be one of 'incline', .*; got 'perod'$"):
        _ = swept["perod"]
    assert repr(swept) == (
        "<Sweep of frozen over incline (2) x fill (3) to t = 1.5 s: 3 of 6 scenes went well; "
        "3: a quantity has no value>"
    )


def test_a_run_that_is_not_trusted_is_counted() -> None:
    """The timestep is too long for the wider swing: by the second run it is 0.02 rad off, and the other 0.006."""
    swept = mjbeer.sweep(frozen, 0.5, [0.1, 1.0], integrator="Euler", timestep=4e-3)
    assert swept["trusted"].tolist() == [True, False]
    assert "2 of 2 scenes went well; 1 of these are not trusted" in repr(swept)


@pytest.mark.parametrize("which", ["swept", "listed"])
def test_a_numpy_file_has_all_of_it(which: str, tmp_path: pathlib.Path, request: pytest.FixtureRequest) -> None:
    sweep: Sweep = request.getfixturevalue(which)
    sweep.save(tmp_path / "map.npz")
    read = load(tmp_path / "map.npz")
    assert (read.dims, read.about, read.reasons) == (sweep.dims, sweep.about, sweep.reasons)
    for name in (*sweep.axes, *sweep.quantities):
        assert np.array_equal(read[name], sweep[name], equal_nan=sweep[name].dtype.kind == "f")
        assert read[name].dtype == sweep[name].dtype


def test_a_file_whose_arrays_differ_in_length_is_refused(listed: Sweep, tmp_path: pathlib.Path) -> None:
    listed.save(tmp_path / "whole.npz")
    with zipfile.ZipFile(tmp_path / "whole.npz") as whole, zipfile.ZipFile(tmp_path / "cut.npz", "w") as cut:
        for name in whole.namelist():
            if name != "u.npy":
                cut.writestr(name, whole.read(name))
        with cut.open("u.npy", "w") as member:
            np.save(member, listed["u"][:1])
    with pytest.raises(
        ParameterError, match=r"cut.npz was not written by `mjbeer.sweep`: its arrays are not those of 2"
    ):
        load(tmp_path / "cut.npz")


def test_a_csv_file_has_a_line_for_each_scene(swept: Sweep, tmp_path: pathlib.Path) -> None:
    swept.save(tmp_path / "map.csv")
    lines = list(csv.DictReader((tmp_path / "map.csv").read_text().splitlines()))
    assert [float(line["phi [rad]"]) for line in lines] == swept["phi"].ravel().tolist()
    assert [float(line["incline [rad]"]) for line in lines] == INCLINES.repeat(3).tolist()
    assert [int(line["status"]) for line in lines] == swept["status"].ravel().tolist()
    assert "fill" in lines[0]


@pytest.mark.slow
def test_an_xarray_dataset_has_all_of_it_with_units(swept: Sweep, listed: Sweep, tmp_path: pathlib.Path) -> None:
    xarray = pytest.importorskip("xarray")
    dataset = swept.to_xarray()
    assert dataset.phi.dims == ("incline", "fill")
    assert (dataset.phi.attrs["units"], dataset.incline.attrs["units"]) == ("rad", "rad")
    assert dataset.phi.sel(fill=0.5).values.tolist() == swept["phi"][:, 1].tolist()
    assert listed.to_xarray().phi.dims == ("scene",)
    assert listed.to_xarray().fill.values.tolist() == [0.3, 0.5]
    swept.save(tmp_path / "map.nc")
    with xarray.open_dataset(tmp_path / "map.nc", engine="scipy") as read:
        assert read.identical(dataset)


def test_without_xarray_an_error_says_what_brings_it(swept: Sweep, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    for failing in (swept.to_xarray, lambda: checked("map.nc", (".nc",))):
        with pytest.raises(MjbeerError, match=r"need xarray: pip install xarray"):
            failing()


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
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("phi0 [°]", "rate of φ at the end [°/s]")
    with pytest.raises(ParameterError, match=r"a sweep over one or two parameters, got <Sweep of .* fill, "):
        listed.plot()


@pytest.mark.parametrize("turned", [False, True])
def test_a_map_over_decades_is_logarithmic(turned: bool) -> None:
    """Its cells are around their values, and a parameter in even steps stays as it is."""
    parameters = [("damping", np.geomspace(1e-4, 1e-2, 3)), ("incline", np.radians([5.0, 10.0, 15.0]))]
    axes = mjbeer.sweep(sliding, 0.01, 1.0, tolerance=1e-6, **dict(parameters[::-1] if turned else parameters)).plot()
    limits, scales = [axes.get_xlim(), axes.get_ylim()], [axes.get_xscale(), axes.get_yscale()]
    assert scales[:: -1 if turned else 1] == ["log", "linear"]
    assert limits[turned] == pytest.approx((10**-4.5, 10**-1.5))
    assert limits[not turned] == pytest.approx((2.5, 17.5))
    line = mjbeer.sweep(sliding, 0.01, 1.0, tolerance=1e-6, damping=[1e-4, 2e-3, 1e-2]).plot("u")
    assert (line.get_xlabel(), line.get_xscale()) == ("damping [N m s]", "linear")
