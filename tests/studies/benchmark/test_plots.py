"""The diagram of a stored study has what its legend says, and the ablation what its table says."""

import pathlib
import re

import pytest

from mjbeer.studies.benchmark import ablation, advice, overview, plots
from mjbeer.studies.benchmark.points import Benchmark
from mjbeer.studies.cases import CASES
from mjbeer.theory.named import in_words
from tests.support import figures

pytestmark = pytest.mark.slow


def test_the_diagram_names_everything_that_it_shows(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stored, seen = Benchmark.load(advice.SHIPPED), figures.saved(monkeypatch)
    plots.draw(stored, tmp_path / "diagram")
    overview.draw(stored, tmp_path / "overview")
    assert [figures.faults(figure) for figure in seen] == [[], []]
    assert max(file.stat().st_size for file in tmp_path.glob("*.svg")) < 160_000
    texts = re.findall(r"<text[^>]*>([^<]*)</text>", (tmp_path / "diagram.svg").read_text())
    for case in stored.cases:
        assert any(text.startswith(f"{case}: {in_words(CASES[case].scene)}") for text in texts)
    for label in ("RK4, contact", "mjbeer to a tolerance, reduced", "the best of mjbeer", "heyoka", "SciPy LSODA"):
        assert label in texts
    assert any(text.startswith("DOP853 ") and text.endswith(" ms") for text in texts)


def test_every_stage_has_a_ratio(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ablation, "_STEPS", 10)
    rows = ablation.ablate()
    assert {(row["case"], row["integrator"]) for row in rows} == {
        (case, integrator) for case in ("sliding", "frozen", "pendulum") for integrator in ("Euler", "RK4")
    }
    for row in rows:
        assert {"contact", "constraint", "sensor", "clock", "visuals", "everything"} <= set(row)
        assert ("actuation" in row) == (row["case"] != "frozen")  # whose constant torque is an actuator


@pytest.mark.parametrize("stage", ["nothing", "visuals", "everything", "contact"])
def test_stages_change_no_motion(stage: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is timed is the same motion."""
    monkeypatch.setattr(ablation, "_STEPS", 200)
    loops = ablation._loops("pendulum", "RK4")
    states = [loops[each]()[0][0, -1, 1:5] for each in ("nothing", stage)]
    assert states[0] == pytest.approx(states[1], rel=1e-9)
