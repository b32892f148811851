"""`mjbeer sweep`: ranges on the command line, in degrees, and a file of each kind."""

import pathlib
from collections.abc import Callable

import numpy as np
import pytest
import xarray

import mjbeer
from mjbeer.cli.app import main


def read_table(path: pathlib.Path) -> dict[str, np.ndarray]:
    """Return the columns of a CSV file by their headings, which keep their brackets."""
    table = np.genfromtxt(path, delimiter=",", names=True, deletechars="", replace_space=" ")
    return {heading: table[heading] for heading in table.dtype.names or ()}


def simulated_period(fill: float) -> float:
    """Return the period [s] of the sweep's frozen can with a fill on 5 degrees."""
    scene = mjbeer.frozen(np.radians(5), fill)
    return 2 * np.pi / mjbeer.simulate(scene, 0.8, np.radians(20), tolerance=1e-6).frequency()


INCLINES = np.radians([5, 60])


@pytest.fixture(scope="module")
def same() -> xarray.Dataset:
    """The sweep of the command below, as Python gives it."""
    return mjbeer.sweep(
        mjbeer.frozen, 0.8, np.radians(20), tolerance=1e-6, incline=INCLINES, fill=[0.3, 0.5]
    )


Sweep = Callable[[str], pathlib.Path]
"""What writes the file of a name, and returns its path."""


@pytest.fixture
def sweep(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> Sweep:
    """Return the command of the tests below, which also says what went well and what failed."""
    options = "--incline 5:60:2 --fill 0.3,0.5 --phi0 20 --duration 0.8 --quantity period"

    def swept(name: str) -> pathlib.Path:
        path = tmp_path / name
        assert main(["sweep", "frozen", *options.split(), "--output", str(path)]) == 0
        out, err = capsys.readouterr()
        assert out == "2: all went well; 2: a quantity has no value\n"
        assert f"wrote {path}" in err
        assert err.startswith(
            "failed: scene 2 (incline[1] = 60 degrees, fill[0] = 0.3): "
            "period: no equilibrium at an incline of 60 degrees"
        )
        return path

    return swept


@pytest.mark.slow
def test_a_table_has_what_python_gives(sweep: Sweep, same: xarray.Dataset) -> None:
    table = read_table(sweep("map.csv"))

    assert table["incline [rad]"].tolist() == np.repeat(INCLINES, 2).tolist()
    assert table["fill"].tolist() == [0.3, 0.5, 0.3, 0.5]
    assert table["phi [rad]"].tolist() == np.ravel(same["phi"]).tolist()


@pytest.mark.slow
def test_a_netcdf_file_has_what_python_gives(sweep: Sweep, same: xarray.Dataset) -> None:
    dataset = xarray.load_dataset(sweep("map.nc"))

    assert dataset["phi"].values.tolist() == same["phi"].values.tolist()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["map.png", "map.svg"])
def test_a_map_is_a_picture(name: str, sweep: Sweep) -> None:
    assert sweep(name).stat().st_size > 5000


@pytest.mark.slow
def test_the_heading_of_a_map_has_the_range_of_the_quantity(sweep: Sweep) -> None:
    periods = [simulated_period(fill) for fill in (0.3, 0.5)]

    picture = sweep("map.svg").read_text()

    heading = f">Period of the swing: {min(periods):.3g} to {max(periods):.3g} s<"
    assert heading in picture
    assert "white cells have no value" in picture


def test_a_single_scene_is_a_table_of_one_row(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "table.csv"
    run = mjbeer.simulate(mjbeer.frozen(), 0.1, np.radians(60), tolerance=1e-6, times=[0.1])

    status = main(["sweep", "frozen", "--duration", "0.1", "--output", str(path)])

    assert status == 0
    table = read_table(path)
    assert table["phi [rad]"] == run.phi[0]
    assert "fill" not in table


def test_a_file_of_another_sweep_is_refused(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--fill", "0.3,0.5", "--output", str(tmp_path / "map.nc"), "--duration"]
    assert main(["sweep", "frozen", *words, "0.1"]) == 0

    status = main(["sweep", "frozen", *words, "0.2"])

    assert status == 2
    assert "map.nc has another sweep, whose " in capsys.readouterr().err


def test_a_file_of_the_same_sweep_is_not_refused(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "map.nc"
    words = ["sweep", "frozen", "--fill", "0.3,0.5", "--duration", "0.1", "--output", str(path)]

    assert main(words) == 0
    assert main(words) == 0


HONEY = "--liquid honey --incline 5,20 --fill 0.4,0.5 --phi0 20 --duration 0.2"


def test_each_scene_of_a_sweep_has_the_damping_of_its_incline(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "map.nc"
    same = mjbeer.sweep(
        mjbeer.liquid,
        0.2,
        np.radians(20),
        incline=np.radians([5, 20]),
        name="honey",
        fill=[0.4, 0.5],
        tolerance=1e-6,
        progress=False,
    )

    status = main(["sweep", "liquid", *HONEY.split(), "--output", str(path)])

    assert status == 0
    assert xarray.load_dataset(path)["u"].values.tolist() == same["u"].values.tolist()


def test_what_speaks_against_a_liquid_is_told_once_and_not_for_each_scene(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status = main(["sweep", "liquid", *HONEY.split(), "--output", str(tmp_path / "map.nc")])

    assert status == 0
    assert capsys.readouterr().err.count("coats the can") == 1


TURNS = "--phi0 10,20 --phi-dot0 60,5000 --quantity period --duration 0.1"


def test_a_table_has_units(tmp_path: pathlib.Path) -> None:
    """They are those of the CSV of `mjbeer simulate`; the options are in degrees and degrees/s."""
    path = tmp_path / "table.csv"

    status = main(["sweep", "frozen", *TURNS.split(), "--output", str(path)])

    assert status == 0
    table = read_table(path)
    assert table["phi0 [rad]"].tolist() == np.radians([10, 10, 20, 20]).tolist()
    assert table["phi_dot0 [rad/s]"].tolist() == np.radians([60, 5000, 60, 5000]).tolist()
    assert {"u [m]", "period [s]", "lowest_normal [N]", "trusted", "status"} <= set(table)


def test_a_failure_has_degrees(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    status = main(["sweep", "frozen", *TURNS.split(), "--output", str(tmp_path / "table.csv")])

    assert status == 0
    angles = "phi0[0] = 10 degrees, phi_dot0[0] = 60 degrees/s"
    assert f"failed: scene 0 ({angles}): period: " in capsys.readouterr().err
