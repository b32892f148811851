"""The benchmark on short ladders: points, failures, files. Nothing is asserted of times."""

import math
import pathlib
from collections import Counter
from collections.abc import Mapping

import numpy as np
import pytest

from mjbeer.cli.app import main
from mjbeer.exceptions import DivergenceError
from mjbeer.studies.benchmark import other_tools, timing
from mjbeer.studies.benchmark.points import CASES, INTERVAL, TIMES, Benchmark, Curve, Point
from mjbeer.studies.benchmark.timing import conduct, ladders, measure

pytestmark = pytest.mark.slow

STEPS = tuple(16e-3 / 2**k for k in range(6))
LARGE = tuple(64e-3 / 2**k for k in range(7))
LADDERS = {
    Curve("reduced", "RK4"): STEPS,
    Curve("reduced", "DOP853"): LARGE,
    Curve("reduced", "mjbeer", "tolerance"): (1e-6, 1e-9),
    Curve("contact", "DOP853"): LARGE[:5],
    Curve("contact, defaults", "Euler"): (2e-3,),
    Curve("SciPy DOP853", "", "tolerance"): (1e-3, 1e-6),
    Curve("mjbeer.simulate", "", "tolerance"): (1e-6,),
}


def short(monkeypatch: pytest.MonkeyPatch, ladders: Mapping[Curve, tuple[float, ...]] = LADDERS) -> None:
    """Make the benchmark one of short ladders, timed twice, with all tools there."""
    monkeypatch.setattr(timing, "ladders", lambda *_: dict(ladders))
    monkeypatch.setattr(other_tools, "absent", dict)
    monkeypatch.setattr(timing, "REPEATS", 2)


@pytest.fixture(scope="module")
def measured() -> Benchmark:
    with pytest.MonkeyPatch.context() as monkeypatch:
        short(monkeypatch)
        return conduct(["frozen"], False, None)


def on(found: Benchmark, *curve: str) -> list[Point]:
    return [each for each in found.points if each.curve == Curve(*curve)]


def test_every_point_is_whole(measured: Benchmark) -> None:
    """Evaluations are those of the method: RK4 has four a step."""
    assert Counter(each.curve for each in measured.points) == {curve: len(values) for curve, values in LADDERS.items()}
    for point in measured.points:
        assert point.failure is None, point
        assert point.error < math.inf
        assert len(point.times) == 2
        assert point.time > 0
        assert point.setup is not None
        known = point.parameter == "timestep" or point.model.startswith("SciPy")
        assert (point.evaluations is not None) == known
    steps = [round(TIMES[-1] / each) for each in STEPS]
    assert [each.evaluations for each in on(measured, "reduced", "RK4")] == [4 * count for count in steps]
    few, *_, many = (each.evaluations or 0 for each in on(measured, "reduced", "DOP853"))
    assert 12 * TIMES[-1] / 64e-3 * 0.9 < few < many


def test_what_is_written_is_read(measured: Benchmark, tmp_path: pathlib.Path) -> None:
    (tmp_path / "study.json").write_text(measured.json())
    read = Benchmark.load(tmp_path / "study.json")
    assert (read.json(), read.cases) == (measured.json(), measured.cases)


def test_a_setting_that_fails_is_a_point_with_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    """A second is too long for a timestep, and the ladder goes on."""
    short(monkeypatch, {Curve("reduced", "DOP853"): (1.0, 8e-3)})
    failed, other = conduct(["frozen"], False, None).points
    assert failed.failure is not None
    assert math.isinf(failed.error)
    assert not failed.times
    assert other.error < 1e-10


def test_a_tool_that_does_not_say_that_it_failed_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    case, lost = CASES["frozen"], np.where(TIMES > 1, np.nan, 0)
    for result in ((lost, 0 * TIMES, 1), (0 * TIMES, lost, 1)):
        careless = other_tools.OtherTool((1e-3,), lambda *_, result=result: lambda: result)
        monkeypatch.setitem(other_tools.OTHER_TOOLS, "heyoka", careless)
        with pytest.raises(DivergenceError, match="heyoka: the motion did not stay finite"):
            measure(case, Point(case.name, "heyoka", "", "tolerance", 1e-3), case.truth())


def test_ladders_halve_from_16_ms_to_31_us_and_meet_every_sample() -> None:
    assert "heyoka" not in {curve.model for curve in ladders(CASES["frozen"].scene, missing=["heyoka"])}
    for name, case in CASES.items():
        found = ladders(case.scene)
        assert {each.model for each in found} >= {"reduced", *other_tools.OTHER_TOOLS}
        assert ("equality" in {each.model for each in found}) == (name != "sliding")
        assert found[Curve("reduced", "RK4")] == tuple(16e-3 / 2**k for k in range(10))
        assert all(INTERVAL % each == 0 for each in found[Curve("reduced", "RK4")])


def test_the_command_writes_everything(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    reason = "libfmt.so.11: cannot open shared object file: No such file or directory"
    short(monkeypatch)
    monkeypatch.setattr(other_tools, "absent", lambda: {"heyoka": reason})
    assert main(["benchmark", "frozen", "--output", str(tmp_path / "new")]) == 0
    names = {each.name for each in (tmp_path / "new").iterdir()}
    assert names == {"study.json", "summary.md", ".lock", ".mjbeer", "work_precision.svg"}
    summary = (tmp_path / "new" / "summary.md").read_text()
    for text in ("cheapest setting for an error", "SciPy odeint", "Whole calls", f"\nheyoka is absent: {reason}\n"):
        assert text in summary
    assert "cheapest setting" in capsys.readouterr().out
