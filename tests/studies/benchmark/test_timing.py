"""The benchmark on short ladders: points, failures, files. Nothing is asserted of times."""

import math
import pathlib
from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from mjbeer.cli.app import main
from mjbeer.exceptions import DivergenceError
from mjbeer.studies.benchmark import benchmark_tables, ladders, other_tools, timing, work_precision
from mjbeer.studies.benchmark.ladders import Ladders
from mjbeer.studies.benchmark.other_tools import (
    HEYOKA,
    ODEINT,
    WHOLE_CALL,
    OtherTool,
    Samples,
    Solver,
)
from mjbeer.studies.benchmark.points import (
    CASES,
    INTERVAL,
    TOLERANCE,
    Benchmark,
    Case,
    Curve,
    Point,
)
from mjbeer.studies.benchmark.timing import measure
from mjbeer.theory.trajectory import exact

pytestmark = pytest.mark.slow

END = float(CASES["frozen"].times[-1])
STEPS = tuple(16e-3 / 2**k for k in range(6))
LARGE = tuple(64e-3 / 2**k for k in range(7))
SHORT: Ladders = {
    Curve("reduced", "RK4"): STEPS,
    Curve("reduced", "DOP853"): LARGE,
    Curve("reduced", "mjbeer", TOLERANCE): (1e-6,),
    Curve("contact", "DOP853"): LARGE[:2],
    Curve("contact, defaults", "Euler"): (2e-3,),
    Curve(ODEINT, "", TOLERANCE): (1e-3, 1e-6),
    Curve(WHOLE_CALL, "", TOLERANCE): (1e-6,),
}


def shorten(
    monkeypatch: pytest.MonkeyPatch, tried: Mapping[Curve, tuple[float, ...]] = SHORT
) -> None:
    """Make the benchmark one of short ladders, timed twice, with all tools there."""
    monkeypatch.setattr(ladders, "ladders", lambda *_: dict(tried))
    monkeypatch.setattr(other_tools, "absent", dict)
    monkeypatch.setattr(timing, "REPEATS", 2)


@pytest.fixture(scope="module")
def measured() -> Benchmark:
    with pytest.MonkeyPatch.context() as monkeypatch:
        shorten(monkeypatch)
        return timing.run(["frozen"], False, None)


def points_on(study: Benchmark, *curve: str) -> list[Point]:
    return [point for point in study.points if point.curve == Curve(*curve)]


def test_every_setting_is_a_point(measured: Benchmark) -> None:
    counted = Counter(point.curve for point in measured.points)
    assert counted == {curve: len(values) for curve, values in SHORT.items()}


def test_every_point_is_whole(measured: Benchmark) -> None:
    for point in measured.points:
        assert point.failure is None, point
        assert point.error < math.inf
        assert len(point.times) == 2
        assert point.time > 0
        assert point.setup is not None
        assert point.energy_drift is not None
        is_counted = point.parameter == "timestep" or point.model == ODEINT
        assert (point.evaluations is not None) == is_counted


def test_evaluations_are_those_of_the_method(measured: Benchmark) -> None:
    """RK4 has four a step, and DOP853 twelve; more where it reads samples off."""
    rk4 = points_on(measured, "reduced", "RK4")
    assert [point.evaluations for point in rk4] == [4 * round(END / timestep) for timestep in STEPS]
    dop853 = [point.evaluations or 0 for point in points_on(measured, "reduced", "DOP853")]
    assert 12 * END / LARGE[0] <= dop853[0] < dop853[-1]


def test_energy_drifts_less_with_a_shorter_timestep(measured: Benchmark) -> None:
    drifts = [point.energy_drift or 0.0 for point in points_on(measured, "reduced", "RK4")]
    assert 1e-14 < drifts[-1] < drifts[0] / 100


def test_what_is_written_is_read(measured: Benchmark, tmp_path: pathlib.Path) -> None:
    path = tmp_path / "study.json"
    path.write_text(measured.json())
    read = Benchmark.load(path)
    assert read.json() == measured.json()
    assert read.cases == measured.cases == ["frozen"]


def test_a_setting_that_fails_is_a_point_with_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    """A second is too long for a timestep, and the ladder goes on."""
    shorten(monkeypatch, {Curve("reduced", "DOP853"): (1.0, 8e-3)})
    failed, other = timing.run(["frozen"], False, None).points
    assert failed.failure is not None
    assert math.isinf(failed.error)
    assert not failed.times
    assert other.error < 1e-10


@pytest.mark.parametrize("name", ["phi", "u"])
def test_a_tool_that_does_not_say_that_it_failed_is_found_out(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = CASES["frozen"]
    motion = exact(case.scene, case.times, case.phi0)
    getattr(motion, name)[-1] = np.nan
    careless = Solver(lambda: None, lambda _: Samples(motion, 1))
    monkeypatch.setitem(other_tools.OTHER_TOOLS, HEYOKA, OtherTool((1e-3,), lambda *_: careless))
    point = Point(case.name, HEYOKA, "", TOLERANCE, 1e-3)
    with pytest.raises(DivergenceError, match="heyoka: the motion did not stay finite"):
        measure(case, point, case.truth())


SHORT_CASES = [case for case in CASES.values() if not case.is_long]


@pytest.mark.parametrize("case", SHORT_CASES, ids=[case.name for case in SHORT_CASES])
def test_ladders_halve_from_16_ms_to_31_us_and_meet_every_sample(case: Case) -> None:
    found = ladders.ladders(case)
    models = {curve.model for curve in found}
    assert models >= {"reduced", *other_tools.OTHER_TOOLS}
    assert ("equality" in models) == (case.name != "sliding")
    steps = found[Curve("reduced", "RK4")]
    assert steps == tuple(16e-3 / 2**k for k in range(10))
    assert all(INTERVAL % timestep == 0 for timestep in steps)


def test_a_tool_that_is_missing_has_no_ladder() -> None:
    for case in CASES.values():
        assert HEYOKA in {curve.model for curve in ladders.ladders(case)}
        assert HEYOKA not in {curve.model for curve in ladders.ladders(case, missing=[HEYOKA])}


def test_a_long_motion_has_few_settings_that_meet_every_sample() -> None:
    (case,) = (case for case in CASES.values() if case.is_long)
    assert case.times[-1] == pytest.approx(1000, abs=1)
    found = ladders.ladders(case)
    assert sum(map(len, found.values())) < 20
    for curve, values in found.items():
        if curve.parameter == "timestep":
            assert all(case.times[1] % timestep == 0 for timestep in values)


def test_the_command_writes_everything(
    measured: Benchmark,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    asked = []

    def run_no_more(*arguments: Any) -> Benchmark:
        asked.append(arguments[:2])
        return measured

    monkeypatch.setattr(timing, "run", run_no_more)
    folder = tmp_path / "new"
    assert main(["benchmark", "frozen", "--quick", "--output", str(folder)]) == 0
    assert asked == [(["frozen"], True)]
    names = {path.name for path in folder.iterdir()}
    assert names == {"study.json", "summary.md", ".lock", ".mjbeer", "work_precision.svg"}
    summary = (folder / "summary.md").read_text()
    for text in ("fastest setting for an error", ODEINT, "Whole calls"):
        assert text in summary
    assert "fastest setting" in capsys.readouterr().out


def test_the_summary_says_what_was_absent(
    monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path
) -> None:
    reason = "libfmt.so.11: cannot open shared object file: No such file or directory"
    shorten(monkeypatch, {Curve("reduced", "RK4"): (16e-3,)})
    monkeypatch.setattr(other_tools, "absent", lambda: {HEYOKA: reason})
    monkeypatch.setattr(work_precision, "draw", lambda *_: None)
    benchmark_tables.write(timing.run(["frozen"], True, None), tmp_path)
    assert f"\nheyoka is absent: {reason}\n" in (tmp_path / "summary.md").read_text()
