"""The benchmark on short ladders: orders, floors, what an interruption leaves. Nothing is asserted of times."""

import csv
import io
import itertools
import json
import math
import pathlib

import pytest
from rich.console import Console

from mjbeer.cli.app import main
from mjbeer.exceptions import ParameterError
from mjbeer.studies import study
from mjbeer.studies.benchmark import advice, overview, plots, run, tables
from mjbeer.studies.benchmark.curves import Curve, aligned, curves
from mjbeer.studies.benchmark.measure import Rung
from mjbeer.studies.benchmark.points import Benchmark, Point
from mjbeer.studies.cases import CASES, INTERVAL
from tests.support import stubs

pytestmark = pytest.mark.slow
OVERVIEW = ("overview.svg", "overview.png")

# Next orders of rungs that are not all small: the issue of every convergence test.
ORDER_MARGIN = 0.2


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    stubs.benchmark(monkeypatch)


@pytest.fixture
def shortest(monkeypatch: pytest.MonkeyPatch) -> None:
    stubs.benchmark(monkeypatch, stubs.FEW)


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Benchmark:
    with pytest.MonkeyPatch.context() as monkeypatch:
        stubs.benchmark(monkeypatch)
        return run.conduct(["frozen"], tmp_path_factory.mktemp("study"), False, quiet())


def quiet() -> Console:
    return Console(file=io.StringIO())


def known(value: float | None) -> float:
    assert value is not None
    return value


def on(points: list[Point], *curve: str) -> list[Point]:
    return [each for each in points if each.curve == Curve(*curve)]


@pytest.mark.parametrize(
    ("way", "method", "order"),
    [("reduced", "Euler", 1), ("reduced", "RK4", 4), ("equality", "RK4", 4)],
)
def test_fitted_orders_are_the_methods(measured: Benchmark, way: str, method: str, order: int) -> None:
    found = tables.convergence_of(on(measured.points, way, method, "timestep"))
    assert found.order == pytest.approx(order, abs=ORDER_MARGIN)


def test_dop853_gains_eight_orders_a_rung_before_its_floor(measured: Benchmark) -> None:
    """From 32 to 8 ms; coarser rungs have not settled, and from 8 ms on there is rounding."""
    errors = {each.value: each.error for each in on(measured.points, "reduced", "DOP853", "timestep")}
    assert math.log(errors[32e-3] / errors[8e-3], 4) == pytest.approx(8, abs=ORDER_MARGIN)


def test_every_order_of_the_stored_study_is_the_method_s_or_the_softness_s() -> None:
    """Contacts tuned to the timestep err as tau^2 = h^2 or, where friction creeps, as h, once the method errs less."""
    stored = Benchmark.load(advice.SHIPPED)
    methods = {"RK4": 4, "DOP853": 8, "GaussJackson": 13}
    fitted = 0
    for case in stored.cases:
        for curve in dict.fromkeys(each.curve for each in stored.of(case) if each.knob == "timestep"):
            found = tables.convergence_of([each for each in stored.of(case) if each.curve == curve]).order
            order = methods.get(curve.method, 1)
            soft = [1, 2] if curve.way == "contact" and order > 2 else []
            margin = 2 if curve.method == "GaussJackson" else ORDER_MARGIN  # its start is of another order
            assert found is None or min(abs(found - each) for each in (order, *soft)) <= margin, curve
            fitted += found is not None
    assert fitted > 40


@pytest.mark.parametrize("name", CASES)
def test_the_order_of_gauss_jackson_is_fitted(name: str) -> None:
    """Its order is 13, and 9 of the steps that start it, which count where a motion starts from its middle.

    The coarsest timesteps are unstable, and the ladder goes on to those that are not.
    """
    case, curve = CASES[name], Curve("reduced", "GaussJackson", "timestep")
    points = [rung.point for rung in run._climb(case, curve, curves(case.scene)[curve], None)]
    found = tables.convergence_of([point for point in points if point.failure is None])
    assert 11 < known(found.order) < 14
    assert min(point.error for point in points if point.failure is None) < 1e-13


def test_a_soft_contact_errs_as_the_square_of_its_time_constant(measured: Benchmark) -> None:
    """tau = h, and what a tuned contact lets through is tau^2 of it: the model's error, whatever integrates it."""
    points = on(measured.points, "contact", "DOP853", "timestep")
    assert tables.convergence_of(points).order == pytest.approx(2, abs=ORDER_MARGIN)
    assert known(points[-1].model_error) == pytest.approx(points[-1].error, rel=1e-2)
    assert known(points[-1].integrator_error) < 0.01 * points[-1].error


def test_a_ladder_ends_at_its_floor(measured: Benchmark) -> None:
    points = on(measured.points, "reduced", "DOP853", "timestep")
    assert min(each.error for each in points) < 1e-13
    assert known(points[0].integrator_error) == pytest.approx(points[0].error, rel=1e-3)
    assert known(points[0].model_error) < 1e-11


def test_the_usual_ways_are_far_off_and_say_why(measured: Benchmark) -> None:
    slide, hinge, contact = (
        next(each for each in measured.points if each.way == way)
        for way in ("equality, slide first", "equality, hinge first", "contact, defaults")
    )
    assert slide.error > 1 > hinge.error > 1e-3 < contact.error
    assert known(slide.effective_impedance) < 0.01
    assert slide.timeconst == slide.effective_timeconst == pytest.approx(0.02)
    assert known(slide.slip_max) > 1
    assert known(slide.slip_integral) > 1


def test_every_point_is_whole(measured: Benchmark) -> None:
    for point in measured.points:
        assert point.failure is None, point
        assert point.error >= max(point.phi_end, point.u_end)
        assert len(point.times) == 2
        assert point.setup > 0
        assert point.median_time >= point.time > 0
        assert (point.energy_drift is None) == point.way.startswith("SciPy")
    reduced = on(measured.points, "reduced", "RK4", "timestep")
    assert all(each.pressed for each in reduced)
    assert all(each.slip_max == 0 for each in reduced)


def test_a_study_reads_back(measured: Benchmark, tmp_path: pathlib.Path) -> None:
    measured.save(tmp_path / "study.json")
    again = Benchmark.load(tmp_path / "study.json")
    assert [(each.curve, each.value, each.error) for each in again.points] == [
        (each.curve, each.value, each.error) for each in measured.points
    ]
    assert again.points[0].times == pytest.approx(measured.points[0].times, abs=1e-9)
    rows = list(csv.DictReader(again.csv().splitlines()))
    assert [(each["way"], float(each["error"])) for each in rows] == [
        (each.way, each.error) for each in measured.points
    ]


def test_an_interrupted_study_goes_on(short: None, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupted between two ladders, and again in the middle of a round; what was measured stays to the bit."""
    climb, seconds = run._climb, Rung.seconds

    def stop(count: int, function):
        calls = iter(range(count))

        def stopping(*arguments):
            if next(calls, None) is None:
                raise KeyboardInterrupt
            return function(*arguments)

        return stopping

    (tmp_path / "summary.md").write_text("of another study")
    monkeypatch.setattr(run, "_climb", stop(3, climb))
    with pytest.raises(KeyboardInterrupt):
        run.conduct(["frozen"], tmp_path, False, quiet())
    monkeypatch.setattr(run, "_climb", climb)
    assert not (tmp_path / "summary.md").exists()
    first = Benchmark.load(tmp_path / "study.json").points
    assert len({each.curve for each in first}) == 3
    monkeypatch.setattr(Rung, "seconds", stop(70, seconds))
    with pytest.raises(KeyboardInterrupt):
        run.conduct(["frozen"], tmp_path, False, quiet())
    monkeypatch.setattr(Rung, "seconds", seconds)
    second = Benchmark.load(tmp_path / "study.json").points
    assert {len(each.times) for each in second} == {1}
    said = io.StringIO()
    done = run.conduct(["frozen"], tmp_path, False, Console(file=said))
    assert "going on from" in said.getvalue()
    assert {len(each.times) for each in done.points} == {2}
    assert [each.error for each in done.points][: len(first)] == [each.error for each in first]
    assert [each.times[0] for each in done.points] == [each.times[0] for each in second]


def test_another_question_starts_anew(shortest: None, tmp_path: pathlib.Path) -> None:
    Benchmark({"cases": ["sliding"]}, study.machine(), [Point("sliding", "reduced", "RK4", "timestep", 1.0)]).save(
        tmp_path / "study.json"
    )
    assert {each.case for each in run.conduct(["frozen"], tmp_path, False, quiet()).points} == {"frozen"}


def test_a_setting_that_fails_is_a_point_with_a_reason(
    short: None, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """DOP853 does at two timesteps; the peers, which would take most of the time, do not."""
    monkeypatch.setattr(run, "installed", list)
    done = run.conduct(["hoop"], tmp_path, False, quiet())
    failed = [each for each in done.points if each.failure]
    assert failed
    assert all(math.isinf(each.error) and not each.times for each in failed)
    assert tables.tables(done)
    json.loads((tmp_path / "study.json").read_text())


def test_a_tool_that_is_absent_is_in_the_summary_with_the_reason(
    shortest: None, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """When it is there again, the study begins anew, and the summary does not name it any more."""
    reason = "libfmt.so.11: cannot open shared object file: No such file or directory"
    for diagram in (plots, overview):
        monkeypatch.setattr(diagram, "draw", lambda study, path: None)
    monkeypatch.setattr(run, "absent", lambda: {"heyoka": reason})
    assert main(["benchmark", "frozen", "--output", str(tmp_path)]) == 0
    assert f"\nheyoka is absent: {reason}\n" in (tmp_path / "summary.md").read_text()
    monkeypatch.setattr(run, "absent", dict)
    assert main(["benchmark", "frozen", "--output", str(tmp_path)]) == 0
    assert "absent" not in (tmp_path / "summary.md").read_text()


def test_unknown_scenes_are_refused(tmp_path: pathlib.Path) -> None:
    with pytest.raises(ParameterError, match=r"scene must be one of 'sliding', .*; got 'bottle'"):
        run.conduct(["bottle"], tmp_path, True, quiet())
    assert not list(tmp_path.iterdir())


def test_a_file_that_is_no_study_is_refused(tmp_path: pathlib.Path) -> None:
    (tmp_path / "study.json").write_text("{}")
    with pytest.raises(ParameterError, match=r"study\.json was not written by `mjbeer benchmark`"):
        run.conduct(["frozen"], tmp_path, True, quiet())


def test_ladders_halve_from_16_ms_to_31_us_and_meet_every_sample() -> None:
    for name, case in CASES.items():
        found = curves(case.scene)
        assert {each.way for each in found} >= {"reduced"}
        assert ("equality" in {each.way for each in found}) == (name != "sliding")
        steps = found[Curve("reduced", "RK4", "timestep")]
        assert (steps[0], steps[-1]) == (16e-3, 16e-3 / 2**9)
        assert all(a == 2 * b for a, b in itertools.pairwise(steps))
        assert all(INTERVAL % each == 0 for each in steps)
        assert len(curves(case.scene, quick=True)[Curve("reduced", "RK4", "timestep")]) >= 6
    assert [aligned(each * INTERVAL) for each in (0.5, 2, 0.5**0.5, 0.75)] == [True, True, False, False]


def test_the_command_writes_everything(short: None, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["benchmark", "frozen", "--output", str(tmp_path / "new")]) == 0
    names = {each.name for each in (tmp_path / "new").iterdir()}
    assert names == {
        "study.json",
        "points.csv",
        "work_precision.svg",
        "work_precision.png",
        *OVERVIEW,
        "summary.md",
        ".lock",
    }
    summary = (tmp_path / "new" / "summary.md").read_text()
    for text in (
        "frozen: cheapest setting for an error",
        "SciPy odeint",
        "share of the force",
        "as usually written",
        "stubs",
    ):
        assert text in summary
    assert "cheapest setting" in capsys.readouterr().out
    assert main(["advise", "frozen", "--tolerance", "1e-6", "--study", str(tmp_path / "new" / "study.json")]) == 0
    assert "--rolling reduced --integrator DOP853" in capsys.readouterr().out
