"""A sweep is what its scenes are one by one: to the last bit, in any executor, and near exact
theory."""

import math
import pathlib
import signal
import warnings
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from typing import Any

import numpy as np
import pytest
import xarray

import mjbeer
from mjbeer import (
    Can,
    LiquidWarning,
    Scene,
    Trajectory,
    frozen,
    liquid,
    pendulum,
    simulate,
    sliding,
)
from mjbeer.exceptions import OutputError, ParameterError
from mjbeer.output import jobs
from mjbeer.studies import sweep_runs
from mjbeer.studies.sweep_runs import (
    BEYOND,
    DIVERGED,
    NO_VALUE,
    NOT_REACHED,
    NOT_YET,
    REFUSED,
    WELL,
)
from tests.support.processes import hear, highest, interrupt, start

INCLINES = np.radians([3.0, 11.0, 20.0])
FILLS = np.array([0.2, 0.5, 0.7, 0.95])


def sweep_of_sliding(
    make: Callable[..., Scene] = sliding, duration: float = 1.0, **others: Any
) -> xarray.Dataset:
    return mjbeer.sweep(
        make, duration, 1.0, **({"tolerance": 1e-6, "incline": INCLINES, "fill": FILLS} | others)
    )


def missing(trajectory: Trajectory) -> float:
    return math.nan


def endless(trajectory: Trajectory) -> float:
    return math.inf


def broken(trajectory: Trajectory) -> float:
    raise ZeroDivisionError(f"no {trajectory.scene.attachment} can do that")


@pytest.mark.slow
@pytest.mark.parametrize(
    "setting",
    [
        {"tolerance": 1e-6},
        {"integrator": "RK4", "timestep": 3e-3},
        {"integrator": "Euler", "rolling": "contact", "friction": 0.4},
        {"tolerance": 1e-8, "rolling": "equality"},
        {"tolerance": 1e-6, "damping": 10.0, "drag": 1e-3},  # so stiff that other methods take over
    ],
)
def test_each_scene_is_what_simulate_gives_to_the_last_bit(setting: dict[str, Any]) -> None:
    setting = dict(setting)
    lost = {name: setting.pop(name) for name in ("damping", "drag") if name in setting}
    make = partial(sliding, can=Can.sheet_metal(), **lost)

    swept = mjbeer.sweep(
        make, 0.3, 0.7, phi_dot0=[0.0, 2.0], incline=INCLINES[:2], fill=[0.3], **setting
    )

    assert tuple(swept.dims) == ("incline", "fill", "phi_dot0")
    assert swept["phi"].shape == (2, 1, 2)
    for (row, _, column), status in np.ndenumerate(swept["status"].values):
        scene = make(INCLINES[row], 0.3)
        phi_dot0 = float(swept["phi_dot0"][column])
        run = simulate(scene, 0.3, 0.7, phi_dot0, times=[0.3], **setting)
        values = {name: array.values[row, 0, column] for name, array in swept.items()}
        beyond = bool(run.rolling_warnings or run.liquid_warnings)
        assert status == (BEYOND if beyond else WELL)
        assert values["phi"] == run.phi[-1]
        assert values["u"] == run.u[-1]
        assert values["phi_dot"] == run.phi_dot[-1]
        assert values["u_dot"] == run.u_dot[-1]
        assert values["error"] == run.error_estimate
        assert values["trusted"] == run.trusted
        assert values["energy_drift"] == run.energy_drift
        assert values["friction_needed"] == run.record.needed_friction
        assert values["lowest_normal"] == run.record.lowest_normal
        assert values["parting_time"] == run.record.rolling_ends_at


def test_the_result_is_the_same_with_any_number_of_threads_and_in_any_pieces(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    alone = sweep_of_sliding(executor=ThreadPoolExecutor(1))
    assert alone.identical(sweep_of_sliding(executor=ThreadPoolExecutor(5)))
    monkeypatch.setattr(sweep_runs, "_PIECE", 0.0)  # then each piece has one scene
    assert alone.identical(sweep_of_sliding())


@pytest.mark.slow
def test_the_result_is_the_same_in_another_process() -> None:
    """That of a quantity with a name and of a function, too."""
    asked = {"fill": FILLS[:2], "quantity": ["period", highest]}
    here = sweep_of_sliding(**asked)

    with jobs.pool(1) as processes:
        there = sweep_of_sliding(**asked, executor=processes)

    assert there.identical(here)


def test_what_cannot_be_sent_to_processes_is_refused() -> None:
    with (
        ProcessPoolExecutor(1) as processes,
        pytest.raises(ParameterError, match="must be defined at the top of a module to be sent"),
    ):
        mjbeer.sweep(
            lambda incline: sliding(incline, 0.4), 0.1, 1.0, incline=INCLINES, executor=processes
        )


@pytest.mark.costly
def test_the_result_is_the_same_on_a_dask_cluster(monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    here = sweep_of_sliding()
    monkeypatch.setattr(sweep_runs, "integrate", lambda *_: pytest.fail("it ran in this process"))
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=":0"
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        assert len(client.ncores()) == 2
        assert here.identical(sweep_of_sliding(executor=client.get_executor()))


def test_a_period_is_that_of_exact_theory() -> None:
    """A turning point is off by 1.5e-8 rad of phase, and by the tolerance over the swing."""
    starts = [-2.0, -0.3, 0.8]
    swept = mjbeer.sweep(sliding, 2.0, starts, tolerance=1e-6, quantity="period", fill=[0.1, 0.75])
    for (row, column), period in np.ndenumerate(swept["period"].values):
        scene = sliding(fill=float(swept["fill"][row]))
        phi0 = starts[column]
        truth = scene.period(phi0 - scene.equilibrium())
        assert period == pytest.approx(truth, rel=1e-5 / min(1, abs(phi0)))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"fill": [0.5, 1.5]},
            r"fill\[1\]: fill must be a fraction between 0.01 and 1 .*, got 1.5",
        ),
        ({"fil": [0.5]}, r"fil\[0\]: sliding\(\) got an unexpected keyword argument 'fil'"),
        ({"phi0": [0.1, 1e11]}, r"phi0\[1\]: phi0 must be between"),
        ({"quantity": "perod"}, "quantity must be one of 'phi', .*'period', .*; got 'perod'"),
        ({"quantity": [highest, highest]}, "two quantities or parameters of the name 'highest'"),
        ({"output": "map.txt"}, "name must end in .nc, got 'map.txt'"),
        ({"make": dict}, "make must return a scene, got <class 'dict'>, which returns {}"),
        (
            {"fill": np.linspace(0.1, 0.9, 10**5), "incline": np.linspace(0, 1, 10**5)},
            "at most 10,000,000 scenes, got 10,000,000,000: cut it into several",
        ),
    ],
)
def test_what_is_not_allowed_is_refused_before_anything_runs(
    arguments: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sweep_runs, "integrate", lambda *_: pytest.fail("something ran"))
    with pytest.raises(ParameterError, match=message):
        mjbeer.sweep(**({"make": sliding, "duration": 0.1, "phi0": 1.0} | arguments))


def test_units_and_the_call_are_attributes_and_a_run_ends_with_a_whole_timestep() -> None:
    swept = mjbeer.sweep(frozen, 0.1, 0.7, phi_dot0=0.5, timestep=3e-3, fill=[0.5])
    assert (swept.phi.attrs["units"], swept.fill.attrs, swept.phi0, swept.phi_dot0) == (
        "rad",
        {},
        0.7,
        0.5,
    )
    assert (swept.make, swept.timestep, swept.duration) == (
        "mjbeer.theory.paper_scenes.frozen",
        3e-3,
        34 * 3e-3,
    )
    assert swept["phi"][0] == simulate(frozen(), 0.1, 0.7, 0.5, timestep=3e-3).phi[-1]


def test_a_combination_that_is_not_possible_is_told_and_the_others_are_there() -> None:
    swept = mjbeer.sweep(
        pendulum, 0.1, 1.0, tolerance=1e-6, offset=[0.01, 0.05], radius=[0.03, 0.06]
    )
    assert swept["status"].values.tolist() == [[WELL, WELL], [REFUSED, WELL]]
    assert swept.failed.startswith(
        "scene 2 (offset[1] = 0.05, radius[0] = 0.03): load offset must be 0, or between"
    )
    assert swept["phi"].isnull().values.tolist() == [[False, False], [True, False]]


def test_what_goes_wrong_inside_of_a_run_is_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    beside = mjbeer.sweep(frozen, 5.0, [1.0, math.pi], tolerance=1e-14, incline=[0.0])
    assert NOT_REACHED in beside["status"]
    assert "is not reached" in beside.failed
    wild = mjbeer.sweep(frozen, 5.0, 1.0, [0.0, 1e6], integrator="Euler", timestep=0.5, incline=0.1)
    assert wild["status"][1] == DIVERGED
    assert "diverged at t" in wild.failed
    monkeypatch.setattr(sweep_runs, "integrate", lambda *_: 1 / 0)
    assert (
        mjbeer.sweep(sliding, 0.1, 1.0).failed == "scene 0 (): ZeroDivisionError: division by zero"
    )


def test_a_quantity_without_a_value_leaves_the_others() -> None:
    tilted = {"incline": np.radians([5.0, 40.0]), "quantity": ["period", highest, broken]}
    swept = mjbeer.sweep(frozen, 1.5, 1.0, tolerance=1e-6, **tilted)
    assert swept["status"].values.tolist() == [NO_VALUE, NO_VALUE]
    assert swept["period"].notnull().values.tolist() == [True, False]
    assert np.isnan(swept["broken"]).all()
    assert np.isfinite(swept["phi"]).all()
    assert (
        swept["highest"][0] == simulate(frozen(math.radians(5)), 1.5, 1.0, tolerance=1e-6).phi.max()
    )
    assert "broken: ZeroDivisionError: no frozen can do that" in swept.failed


def test_a_quantity_that_is_not_a_number_is_told() -> None:
    """Infinity is a value: the time of what never happens has it."""
    swept = mjbeer.sweep(frozen, 0.1, 1.0, fill=[0.4, 0.5], quantity=[missing, endless])
    assert swept["status"].values.tolist() == [NO_VALUE, NO_VALUE]
    assert swept.failed == "scene 0 (fill[0] = 0.4): missing: it is not a number (NaN)"
    assert np.isinf(swept["endless"]).all()
    assert mjbeer.sweep(frozen, 0.1, 1.0, fill=[0.4], quantity=endless)[
        "status"
    ].values.tolist() == [WELL]


def test_what_liquids_warn_of_is_said_once() -> None:
    def honey(fill: float) -> Scene:
        return liquid("honey", fill=fill)

    with warnings.catch_warnings(record=True, action="always") as told:
        mjbeer.sweep(honey, 0.01, 1.0, tolerance=1e-6, fill=[0.4, 0.5, 0.6])

    (warning,) = told
    assert warning.category is LiquidWarning
    assert warning.filename == __file__
    assert "it coats the can" in str(warning.message)


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Everything that is simulated."""
    ran: list[Any] = []
    integrate = sweep_runs.integrate
    monkeypatch.setattr(
        sweep_runs,
        "integrate",
        lambda *arguments: (ran.append(arguments), integrate(*arguments))[1],
    )
    return ran


RESUMED: dict[str, Any] = {
    "duration": 1.0,
    "phi0": 1.0,
    "timestep": 2e-3,
    "quantity": "period",
    "progress": False,
    "incline": [1.4, 0.1],
    "fill": [0.1, 0.3, 0.5, 0.7, 0.9],
}
"""A sweep of ten scenes."""
SWEEP_THAT_STOPS = f"""
import sys, time
from mjbeer import frozen, sweep
from mjbeer.studies import sweep as sweeps, sweep_runs
save = sweeps._save
def save_and_stop(dataset, path):
    save(dataset, path)
    if (dataset["status"] != sweep_runs.NOT_YET).sum() >= int(sys.argv[2]):
        print("saved", flush=True)
        time.sleep(3600)
sweeps._save = save_and_stop
sweeps._SAVED_EVERY = 0.0
sweep_runs._PIECE = 0.0
sweep(frozen, **{RESUMED!r}, output=sys.argv[1])
"""
"""It stops as soon as it has saved so many scenes, of which each is a piece of work."""


def simulated(path: pathlib.Path) -> int:
    """Return how many scenes of a stored sweep are simulated."""
    status = xarray.load_dataset(path, engine="scipy")["status"]
    return int((status != NOT_YET).sum())


@pytest.mark.slow
def test_a_sweep_that_is_killed_goes_on(tmp_path: pathlib.Path, counted: list[Any]) -> None:
    """What failed before is told at the end, and the first scene is simulated again."""
    path = tmp_path / "map.nc"
    with start([str(path), "5"], SWEEP_THAT_STOPS) as process:
        hear(process, "saved")
        interrupt(process, signal.SIGKILL)
    assert simulated(path) == 5

    whole = mjbeer.sweep(frozen, **RESUMED)
    assert "period: no equilibrium" in whole.failed
    del counted[:]
    resumed = mjbeer.sweep(frozen, **RESUMED, output=path)

    assert resumed.identical(whole)
    assert len(counted) == 10 - 5 + 1
    assert xarray.load_dataset(path, engine="scipy").identical(whole)


def test_a_sweep_that_is_whole_simulates_its_first_scene_alone(
    tmp_path: pathlib.Path, counted: list[Any]
) -> None:
    path = tmp_path / "map.nc"
    whole = sweep_of_sliding(output=path)
    del counted[:]

    again = sweep_of_sliding(output=path)

    assert again.identical(whole)
    assert len(counted) == 1


def edited(incline: float, fill: float) -> Scene:
    """Make other scenes than `sliding`, as a function does that was edited."""
    return sliding(incline, fill, gravity=9.82)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("other", "differs"),
    [
        ({"duration": 0.5, "phi_dot0": 1.0}, "another sweep, whose duration, phi_dot0 differ"),
        ({"fill": FILLS[:2]}, "another sweep, whose fill, quantities differ"),
        ({"quantity": "period"}, "another sweep, whose quantities differ"),
        (
            {"make": edited},
            "other results than this call, at incline.0. = 0.0523599, fill.0. = 0.2",
        ),
    ],
)
def test_a_file_of_another_sweep_is_refused(
    other: dict[str, Any], differs: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(edited, "__module__", sliding.__module__)
    monkeypatch.setattr(edited, "__qualname__", "sliding")
    path = tmp_path / "map.nc"
    sweep_of_sliding(output=path)
    before = path.read_bytes()
    with pytest.raises(
        ParameterError, match=f"map.nc has {differs}.*: give another name, or remove it"
    ):
        sweep_of_sliding(**({"output": path} | other))
    assert path.read_bytes() == before


def test_what_is_no_sweep_is_not_overwritten(tmp_path: pathlib.Path, counted: list[Any]) -> None:
    path = tmp_path / "map.nc"
    path.write_text("my notes")
    with pytest.raises(ParameterError, match=r"was not written by `mjbeer\.sweep`"):
        sweep_of_sliding(output=path)
    assert path.read_text() == "my notes"
    with pytest.raises(OutputError):
        sweep_of_sliding(output=path / "map.nc")
    assert not counted
