"""A sweep is what its scenes are one by one: to the last bit, in any executor, and near exact theory."""

import contextlib
import math
import pathlib
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import mjbeer
from mjbeer import Can, Scene, Trajectory, exact, frozen, pendulum, simulate, sliding
from mjbeer.exceptions import AngleWarning, OutputError, ParameterError
from mjbeer.output import processes
from mjbeer.studies.sweep import chunks, run, work
from mjbeer.studies.sweep.arrays import Sweep
from mjbeer.studies.sweep.plan import Plan
from mjbeer.studies.sweep.quantities import DIVERGED, NO_VALUE, NOT_REACHED, NOT_YET, REFUSED, WELL

INCLINES = np.radians([3.0, 11.0, 20.0])
FILLS = np.array([0.2, 0.5, 0.7, 0.95])


def sweep_of_sliding(**others: Any) -> Sweep:
    return mjbeer.sweep(sliding, 1.0, 1.0, tolerance=1e-6, incline=INCLINES, fill=FILLS, **others)


def metal(incline: float, fill: float) -> Scene:
    return sliding(incline, fill, Can.sheet_metal())


def highest(trajectory: Trajectory) -> float:
    return float(trajectory.phi.max())


def broken(trajectory: Trajectory) -> float:
    raise ZeroDivisionError(f"no {trajectory.scene.attachment} can do that")


def same(one: Sweep, other: Sweep) -> bool:
    equal = all(np.array_equal(one[name], other[name], equal_nan=True) for name in one.names)
    return equal and one.names == other.names and one.reasons == other.reasons


@pytest.mark.parametrize(
    "setting",
    [
        {"tolerance": 1e-6},
        {"integrator": "DOP853", "timestep": 0.02},
        {"integrator": "RK4", "timestep": 3e-3},
        {"integrator": "Euler", "rolling": "contact", "friction": 0.4},
        {"tolerance": 1e-8, "rolling": "equality"},
    ],
)
def test_each_scene_is_what_simulate_gives_to_the_last_bit(setting: dict[str, Any]) -> None:
    swept = mjbeer.sweep(metal, 0.3, 0.7, phi_dot0=[0.0, 2.0], incline=INCLINES[:2], fill=[0.3], **setting)
    assert (swept.dims, swept.shape) == (("incline", "fill", "phi_dot0"), (2, 1, 2))
    for (row, _, rate), status in np.ndenumerate(swept["status"]):
        single = simulate(metal(INCLINES[row], 0.3), 0.3, 0.7, swept["phi_dot0"][rate], times=[0.3], **setting)
        found = {name: swept[name][row, 0, rate] for name in swept.names}
        assert status == WELL
        assert found["phi"] == single.phi[-1]
        assert found["u"] == single.u[-1]
        assert found["phi_dot"] == single.phi_dot[-1]
        assert found["u_dot"] == single.u_dot[-1]
        assert found["error"] == single.error_estimate
        assert found["trusted"] == single.trusted
        assert found["energy_drift"] == single.energy_drift
        assert found["friction_needed"] == single.record.needed


def test_a_run_ends_at_the_first_timestep_after_the_duration_as_in_simulate() -> None:
    swept = mjbeer.sweep(frozen, 0.1, 0.7, integrator="RK4", timestep=3e-3, fill=[0.5])
    assert swept["phi"][0] == simulate(frozen(), 0.1, 0.7, timestep=3e-3).phi[-1]


def test_the_result_is_the_same_with_any_number_of_threads() -> None:
    alone = sweep_of_sliding(executor=ThreadPoolExecutor(1))
    assert same(alone, sweep_of_sliding(executor=ThreadPoolExecutor(5)))
    assert same(alone, sweep_of_sliding())


@pytest.mark.slow
def test_the_result_is_the_same_in_processes() -> None:
    with processes.pool(2) as pool:
        assert same(sweep_of_sliding(quantity=highest), sweep_of_sliding(quantity=highest, executor=pool))
        with pytest.raises(ParameterError, match="must be defined at the top of a module to be sent to processes"):
            mjbeer.sweep(lambda incline: sliding(incline, 0.4), 0.1, 1.0, incline=INCLINES, executor=pool)


@pytest.mark.slow
def test_the_result_is_the_same_on_a_dask_cluster(monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    here = sweep_of_sliding()
    monkeypatch.setattr(work, "integrate", lambda *_: pytest.fail("it ran in this process"))
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        assert len(client.ncores()) == 2
        assert same(here, sweep_of_sliding(executor=client.get_executor()))


def test_every_scene_is_within_its_tolerance_of_exact_theory() -> None:
    draw = np.random.default_rng(16)
    count, tolerance = 24, 1e-6
    inclines, fills, starts = draw.uniform(0.02, 0.5, count), draw.uniform(0.1, 0.9, count), draw.uniform(-2, 2, count)
    swept = mjbeer.sweep(
        sliding, 2.0, starts, paired=True, tolerance=tolerance, incline=inclines, fill=fills, quantity="period"
    )
    assert (swept.dims, swept.shape) == (("scene",), (count,))
    for index in range(count):
        scene = sliding(inclines[index], fills[index])
        truth = exact(scene, [2.0], starts[index])
        off = max(abs(swept["phi"][index] - truth.phi[0]), abs(swept["u"][index] - truth.u[0]) / scene.can.radius)
        turned = max(1.0, abs(swept["u"][index]) / scene.can.radius)
        assert off <= tolerance * turned
        assert swept["error"][index] <= tolerance
        # A turning point is off by 1.5e-8 rad of phase, and by the tolerance over the swing.
        period = scene.period(starts[index] - scene.equilibrium())
        assert swept["period"][index] == pytest.approx(period, rel=10 * tolerance / min(1, abs(starts[index])))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"fill": [0.5, 1.5]}, r"fill\[1\]: fill \(height of .*\) must be in \(0, 1\], got 1.5"),
        ({"fill": [0.5, math.nan]}, r"fill\[1\] must be a finite number, got nan"),
        ({"fill": []}, r"fill must be a list or a one-dimensional array of one or more numbers, got \[\]"),
        ({"fill": np.ones((2, 2))}, "fill must be a list or a one-dimensional array"),
        ({"fill": "0.5"}, "fill must be a finite number, got '0.5'"),
        ({"fill": [0.5], "incline": 7.0}, r"incline must be between -pi/2 and pi/2 .*, got 7.0"),
        ({"fil": [0.5]}, r"sliding has no parameter 'fil', which got \[0.5\]: did you mean 'fill'"),
        ({"phi0": [0.1, 1e11]}, r"phi0\[1\]: phi0 must be between"),
        ({"tolerance": 1e-6, "integrator": "RK4"}, "give a tolerance or an integrator"),
        ({"duration": 1e9}, "too many timesteps of 0.001 s for a sweep: at most 1e.09"),
        ({"quantity": "perod"}, "quantity must be one of .*did you mean 'period'"),
        ({"quantity": [3]}, "quantity must be a name or a function of a trajectory, got 3"),
        ({"quantity": highest, "duration": 2e3}, "samples at every timestep, at most 1000000: a duration of 2000.0 s"),
        ({"executor": 4}, "executor must be a concurrent.futures.Executor, got 4"),
        ({"output": "map.txt"}, "name must end in .npz, got 'map.txt'"),
        ({"make": 3}, "make must be a function that returns a scene, got 3"),
        ({"make": dict}, "make must be a function that returns a scene, got <class 'dict'>, which returns {}"),
        ({"paired": True, "fill": [0.5], "incline": [0.1, 0.2]}, "one length: fill has 1, incline has 2"),
        ({"paired": True, "fill": [0.5, 2.0], "incline": [0.1, 0.2]}, r"fill\[1\] = 2, incline\[1\] = 0.2: fill"),
        ({"paired": True}, "one length: no parameter is an array"),
    ],
)
def test_what_is_not_allowed_is_refused_before_anything_runs(
    arguments: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(work, "integrate", lambda *_: pytest.fail("something ran"))
    with pytest.raises(ParameterError, match=message):
        mjbeer.sweep(**({"make": sliding, "duration": 0.1, "phi0": 1.0} | arguments))


def test_degrees_for_radians_give_a_warning() -> None:
    with pytest.warns(AngleWarning, match="phi0 = 60 is taken as radians"):
        mjbeer.sweep(sliding, 0.01, [1.0, 60.0], tolerance=1e-3)


def test_a_combination_that_is_not_possible_is_listed_and_the_others_are_there() -> None:
    swept = mjbeer.sweep(pendulum, 0.1, 1.0, tolerance=1e-6, offset=[0.01, 0.05], radius=[0.03, 0.06])
    assert swept["status"].tolist() == [[WELL, WELL], [REFUSED, WELL]]
    assert [failure.index for failure in swept.failed] == [(1, 0)]
    assert "load offset must be 0, or between" in swept.failed[0].reason
    assert swept.failed[0].parameters == "offset[1] = 0.05, radius[0] = 0.03"
    assert np.isnan(swept["phi"]).tolist() == [[False, False], [True, False]]
    assert "3 of 4 scenes went well; 1: the scene is not possible" in repr(swept)


def test_a_tolerance_that_is_not_reached_and_a_run_that_diverges_are_listed() -> None:
    beside = mjbeer.sweep(frozen, 5.0, [1.0, math.pi], tolerance=1e-14, incline=[0.0])
    assert NOT_REACHED in beside["status"]
    assert "is not reached" in beside.failed[-1].reason
    wild = mjbeer.sweep(frozen, 5.0, 1.0, [0.0, 1e6], integrator="Euler", timestep=0.5, incline=0.1)
    assert wild["status"][1] == DIVERGED
    assert "diverged at t" in wild.failed[-1].reason


def test_a_quantity_without_a_value_leaves_the_others() -> None:
    swept = mjbeer.sweep(
        frozen, 1.5, 1.0, tolerance=1e-6, incline=np.radians([5.0, 40.0]), quantity=["period", highest, broken]
    )
    assert swept["status"].tolist() == [NO_VALUE, NO_VALUE]
    assert np.isfinite(swept["period"]).tolist() == [True, False]
    assert np.isnan(swept["broken"]).all()
    assert np.isfinite(swept["phi"]).all()
    whole = simulate(frozen(math.radians(5)), 1.5, 1.0, tolerance=1e-6)
    assert swept["highest"][0] == whole.phi.max()
    assert swept.failed[0].reason == "broken: ZeroDivisionError: no frozen can do that"


def test_the_time_of_parting_and_the_lowest_force_are_those_of_theory() -> None:
    swept = mjbeer.sweep(frozen, 2.0, [0.5, math.pi - 0.5], tolerance=1e-9, incline=math.radians(10))
    times = np.linspace(0, 2.0, 20001)
    assert np.isinf(swept["parting_time"]).tolist() == [True, False]
    for index, phi0 in enumerate(swept["phi0"]):
        truth = exact(frozen(math.radians(10)), times, phi0)
        # The run looks between its steps on polynomials of fifth degree, theory at 20,001 times.
        assert swept["lowest_normal"][index] == pytest.approx(truth.forces.normal.min(), rel=1e-3)
        assert swept["parting_time"][index] == pytest.approx(truth.rolls_until(), rel=1e-3)


class Interrupting(Executor):
    """Does the work at once, and is interrupted when it is to do some chunk."""

    _max_workers = 2

    def __init__(self, at: int) -> None:
        self.left = at

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        self.left -= 1
        if self.left < 0:
            raise KeyboardInterrupt
        done: Future[Any] = Future()
        done.set_result(function(*arguments, **named))
        return done


def test_an_interrupted_sweep_goes_on_where_it_was(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, whole, counted = tmp_path / "map.npz", sweep_of_sliding(), []
    monkeypatch.setattr(chunks, "_FIRST", 2)
    with pytest.raises(KeyboardInterrupt):
        sweep_of_sliding(executor=Interrupting(2), output=path)
    kept = np.load(path)["status"]
    done = int((kept != NOT_YET).sum())
    assert 0 < done < kept.size

    def counting(*arguments: Any) -> Any:
        counted.append(arguments)
        return integrate(*arguments)

    integrate = work.integrate
    monkeypatch.setattr(work, "integrate", counting)
    assert same(sweep_of_sliding(output=path), whole)
    assert len(counted) == kept.size - done
    assert same(sweep_of_sliding(output=path), whole)
    assert len(counted) == kept.size - done
    other = sweep_of_sliding(output=path, phi_dot0=1.0)  # another sweep begins anew
    assert not same(other, whole)
    assert len(counted) == 2 * kept.size - done


def test_an_output_that_cannot_be_written_is_refused_before_anything_runs(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran: list[object] = []
    monkeypatch.setattr(work, "integrate", lambda *arguments: ran.append(arguments))
    (tmp_path / "file").touch()
    with pytest.raises(OutputError):
        sweep_of_sliding(output=tmp_path / "file" / "map.npz")
    assert not ran


class Busy(Interrupting):
    """Does some chunks at once; those after them wait for a worker."""

    def __init__(self, free: int) -> None:
        super().__init__(free)
        self.waiting: list[Future[Any]] = []

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        if self.left:
            return super().submit(function, *arguments, **named)
        self.waiting.append(Future())
        return self.waiting[-1]


def test_an_interruption_between_two_chunks_leaves_no_work_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    """Chunks that wait for a worker are given up."""
    monkeypatch.setattr(chunks, "_FIRST", 2)
    monkeypatch.setattr(chunks, "_CHUNK", 1e-9)  # then of one scene each, all of which are handed out
    executor, percent = Busy(10), iter(range(100))

    def interrupt(_: str) -> None:
        if next(percent) == 5:
            raise KeyboardInterrupt

    monkeypatch.setattr(run, "progress_bar", lambda *_: contextlib.nullcontext(interrupt))
    with pytest.raises(KeyboardInterrupt):
        mjbeer.sweep(sliding, 0.5, 1.0, tolerance=1e-6, fill=np.linspace(0.1, 0.9, 90), executor=executor)
    assert len(executor.waiting) > 50
    assert all(each.cancelled() for each in executor.waiting)


def test_what_goes_wrong_inside_of_a_run_is_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(work, "integrate", lambda *_: 1 / 0)
    swept = mjbeer.sweep(sliding, 0.1, 1.0, fill=[0.5])
    assert swept.failed[0].reason == "ZeroDivisionError: division by zero"


def test_functions_that_cannot_be_known_again_are_not_saved(tmp_path: pathlib.Path) -> None:
    with pytest.raises(ParameterError, match="must be defined at the top of a module"):
        mjbeer.sweep(lambda fill: sliding(fill=fill), 0.1, 1.0, fill=FILLS, output=tmp_path / "map.npz")


def test_what_is_no_sweep_is_not_overwritten(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "map.npz"
    path.write_text("my notes")
    with pytest.raises(ParameterError, match=r"was not written by `mjbeer\.sweep`"):
        sweep_of_sliding(output=path)
    assert path.read_text() == "my notes"
    with pytest.raises(OutputError):
        sweep_of_sliding(output=tmp_path / "map.npz" / "map.npz")


def test_chunks_become_as_long_as_a_second_and_share_out_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """With scenes of a millisecond each, 10,000 of them and two workers."""
    sizes = []

    def timed(_: object, rows: np.ndarray) -> work.Measured:
        sizes.append(len(rows))
        count = len(rows)
        return work.Measured(np.zeros((count, 1)), np.ones(count, bool), np.zeros(count, np.int8), {}, 1e-3)

    monkeypatch.setattr(chunks, "measure", timed)
    monkeypatch.setattr(chunks, "_WAITING", 2)
    executor = Interrupting(10_000)
    plan = Plan({"fill": np.linspace(0.1, 0.9, 10_000)}, paired=False)
    seen = [chunk for chunk, _ in chunks.carry_out(None, plan, np.arange(10_000), executor)]
    assert np.array_equal(np.sort(np.concatenate(seen)), np.arange(10_000))
    assert max(sizes) == 1000
    assert sizes[-1] <= 50
