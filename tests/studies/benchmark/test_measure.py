"""The benchmark on short ladders: orders, floors, what an interruption leaves. Nothing is asserted of times."""

import io
import itertools
import math
import pathlib
from collections.abc import Sequence

import numpy as np
import pytest
from rich.console import Console

from mjbeer.cli.app import main
from mjbeer.exceptions import ParameterError
from mjbeer.studies.benchmark import diagrams, measure, peers
from mjbeer.studies.benchmark.measure import Rung, conduct, ladders
from mjbeer.studies.benchmark.points import Benchmark, Curve, Point
from mjbeer.studies.cases import CASES, INTERVAL
from tests.support import stubs

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Benchmark:
    with pytest.MonkeyPatch.context() as monkeypatch:
        stubs.benchmark(monkeypatch)
        return conduct(["frozen"], tmp_path_factory.mktemp("study"), False, quiet())


def quiet() -> Console:
    return Console(file=io.StringIO())


def on(found: Benchmark, *curve: str) -> list[Point]:
    return [each for each in found.points if each.curve == Curve(*curve)]


@pytest.mark.parametrize(
    ("errors", "floored"),
    [
        (1e-2 * 16.0 ** -np.arange(8), False),
        (np.maximum(1e-2 * 16.0 ** -np.arange(8), 6e-9), True),
        ([2.0, 1.9, 2.1, 2.0, 1.8, 1.0, 0.1], False),  # motions that lost their phase
        ([1e-2, 1e-9, 1e-9, 1e-9], False),  # too few
    ],
)
def test_a_floor_is_where_errors_stop_falling(errors: Sequence[float], floored: bool) -> None:
    rungs = [Point("frozen", "reduced", "RK4", "timestep", 16e-3 / 2**k, error) for k, error in enumerate(errors)]
    for rung in rungs:
        rung.u_max = rung.phi_max
    assert measure._floored(rungs) is floored


def test_a_ladder_ends_at_its_floor() -> None:
    ended = measure._climb(CASES["frozen"], Curve("reduced", "DOP853"), [16e-3 / 2**k for k in range(10)])
    assert len(ended["points"]) < 10


def test_every_point_is_whole(measured: Benchmark) -> None:
    assert {each.curve: len(on(measured, *vars(each.curve).values())) for each in measured.points} == {
        curve: len(values) for curve, values in stubs.LADDERS.items()
    }
    for point in measured.points:
        assert point.failure is None, point
        assert math.inf > point.error >= max(point.phi_end, point.u_end)
        assert len(point.times) == 2
        assert point.time > 0
        assert point.setup is not None
        assert (point.energy_drift is None) == (point.method == "")
    assert all(each.slip_max == 0 for each in on(measured, "reduced", "RK4"))


def test_an_interrupted_study_goes_on(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupted in the second round of timing; what was measured stays to the bit."""
    stubs.benchmark(monkeypatch)
    seconds, calls = Rung.seconds, itertools.count()

    def stopping(rung: Rung) -> float:
        if next(calls) == 70:
            raise KeyboardInterrupt
        return seconds(rung)

    (tmp_path / "summary.md").write_text("of another study")
    monkeypatch.setattr(Rung, "seconds", stopping)
    with pytest.raises(KeyboardInterrupt):
        conduct(["frozen"], tmp_path, False, quiet())
    assert not (tmp_path / "summary.md").exists()
    first = Benchmark.load(tmp_path / "study.jsonl").points
    assert {len(each.times) for each in first} == {1}
    said = io.StringIO()
    done = conduct(["frozen"], tmp_path, False, Console(file=said)).points
    assert "going on from" in said.getvalue()
    assert {len(each.times) for each in done} == {2}
    assert [(each.error, each.times[0]) for each in done] == [(each.error, each.time) for each in first]


def test_a_setting_that_fails_is_a_point_with_a_reason(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the timesteps of DOP853 the coarsest ones diverge, and the ladder goes on to those that do not."""
    curve = Curve("reduced", "DOP853")
    stubs.benchmark(monkeypatch, {curve: ladders(CASES["hoop"].scene)[curve]})
    done = conduct(["hoop"], tmp_path, False, quiet())
    failed = [each for each in done.points if each.failure]
    assert failed
    assert all(math.isinf(each.error) and not each.times for each in failed)
    assert min(each.error for each in done.of("hoop")) < 1e-10


def test_a_peer_that_does_not_say_that_it_failed_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    case, lost = CASES["frozen"], np.where(CASES["frozen"].times > 1, np.nan, 0)
    for result in ((lost, 0 * case.times), (0 * case.times, lost)):
        careless = peers.Peer("heyoka", (1e-3,), lambda *_, result=result: lambda: result)
        monkeypatch.setitem(peers.PEERS, "heyoka", careless)
        (point,) = measure._climb(case, Curve("heyoka", "", "tolerance"), [1e-3])["points"]
        assert point["failure"] == "heyoka: the motion did not stay finite"


def test_a_tool_that_is_absent_is_in_the_summary_with_the_reason(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """When it is there again, the study begins anew, and the summary does not name it any more."""
    assert "heyoka" not in {curve.way for curve in ladders(CASES["frozen"].scene, missing=["heyoka"])}
    stubs.benchmark(monkeypatch, stubs.FEW)
    reason = "libfmt.so.11: cannot open shared object file: No such file or directory"
    monkeypatch.setattr(diagrams, "draw", lambda study, path: None)
    monkeypatch.setattr(peers, "absent", lambda: {"heyoka": reason})
    assert main(["benchmark", "frozen", "--output", str(tmp_path)]) == 0
    assert f"\nheyoka is absent: {reason}\n" in (tmp_path / "summary.md").read_text()
    monkeypatch.setattr(peers, "absent", dict)
    assert main(["benchmark", "frozen", "--output", str(tmp_path)]) == 0
    assert "absent" not in (tmp_path / "summary.md").read_text()


def test_what_is_no_benchmark_is_refused(tmp_path: pathlib.Path) -> None:
    with pytest.raises(ParameterError, match=r"scene must be one of 'sliding', .*; got 'bottle'"):
        conduct(["bottle"], tmp_path, True, quiet())
    (tmp_path / "study.jsonl").write_text("{}\n")
    with pytest.raises(ParameterError, match=r"study\.jsonl was not written by `mjbeer benchmark`"):
        conduct(["frozen"], tmp_path, True, quiet())


def test_ladders_halve_from_16_ms_to_31_us_and_meet_every_sample() -> None:
    for name, case in CASES.items():
        found = ladders(case.scene)
        assert {each.way for each in found} >= {"reduced", *peers.PEERS}
        assert ("equality" in {each.way for each in found}) == (name != "sliding")
        steps = found[Curve("reduced", "RK4")]
        assert (steps[0], steps[-1]) == (16e-3, 16e-3 / 2**9)
        assert all(a == 2 * b for a, b in itertools.pairwise(steps))
        assert all(INTERVAL % each == 0 for each in steps)
        assert len(ladders(case.scene, quick=True)[Curve("reduced", "RK4")]) >= 6
    labels = [curve.label for curve in ladders(CASES["frozen"].scene)]
    assert len(set(labels)) == len(labels)  # by which rounds find their curves


def test_the_command_writes_everything(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.benchmark(monkeypatch)
    assert main(["benchmark", "frozen", "--output", str(tmp_path / "new")]) == 0
    names = {each.name for each in (tmp_path / "new").iterdir()}
    assert names == {"study.jsonl", "points.csv", "summary.md", ".lock", "work_precision.svg"}
    summary = (tmp_path / "new" / "summary.md").read_text()
    for text in ("cheapest setting for an error", "SciPy odeint", "share of the force", "a sweep of stubs"):
        assert text in summary
    assert "cheapest setting" in capsys.readouterr().out
