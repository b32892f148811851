"""Maps of timestep and damping: theory knows where runs explode, wrong runs say so, and a wrong theory is seen."""

import json
import pathlib
from collections.abc import Collection

import pytest

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, Integrator, Rolling
from mjbeer.predictions.soft_rolling import System
from mjbeer.studies.stability import damped_maps, damped_plots, stored
from mjbeer.studies.stability.damped_runs import EXPLODED, INACCURATE, SILENT, TRUSTED, WARNED, DampedRuns
from mjbeer.theory.record import Record
from tests.support import figures

pytestmark = pytest.mark.slow

COARSE = (3, 4)
DOCUMENT = (pathlib.Path(__file__).parents[3] / "docs" / "stability.md").read_text()
SAMPLE: list[tuple[Rolling, Integrator]] = [
    ("reduced", "Euler"),
    ("reduced", "RK4"),
    ("equality", "implicitfast"),
    ("equality", "discrete"),
    ("contact", "Euler"),
]


@pytest.fixture(scope="module")
def measured() -> list[dict]:
    return [damped_maps.measure(*plan, COARSE) for plan in SAMPLE]


def test_runs_explode_where_theory_says(measured: list[dict]) -> None:
    assert [(each["name"], each["agrees"]) for each in measured] == [(damped_maps.name(*plan), True) for plan in SAMPLE]
    explode = {each["name"] for each in measured if any(EXPLODED in row for row in each["measured"])}
    assert explode == {"reduced, Euler", "reduced, RK4", "equality, implicitfast"}
    assert all(edge["measured"] is None for edge in measured[3]["boundaries"] + measured[4]["boundaries"])
    assert json.loads(json.dumps(measured)) == measured


@pytest.mark.parametrize(
    ("plan", "name", "wrong"),
    [
        (("reduced", "Euler"), "by_tendon", False),
        (("equality", "Euler"), "by_tendon", True),
    ],
)
def test_a_wrong_theory_does_not_agree(
    plan: tuple[Rolling, Integrator], name: str, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Damping that is taken implicitly in place of explicitly, and the reverse."""
    step = System.step

    def mistaken(system: System, *settings: object) -> object:
        object.__setattr__(system, name, wrong)
        return step(system, *settings)

    monkeypatch.setattr(System, "step", mistaken)
    assert not damped_maps.measure(*plan, COARSE)["agrees"]


def test_a_wrong_run_that_is_trusted_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """With an estimate of its error and a drift of nothing, a run whose load is 0.4 rad off would be silent."""
    runs = DampedRuns("reduced", "implicit", 1.0, [8e-3])
    assert runs.measure(8e-3).outcome == INACCURATE
    monkeypatch.setattr(Record, "implied_error", 0.0)
    monkeypatch.setattr("mjbeer.simulation.run.Run.error_estimate", 0.0)
    assert runs.measure(8e-3).outcome == SILENT
    result = damped_maps.measure("reduced", "implicit", (2, 2))
    assert SILENT in result["measured"][0]
    assert not result["agrees"]


def test_plot_and_table_are_drawn(
    measured: list[dict], tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = figures.saved(monkeypatch)
    assert damped_plots.draw(measured, tmp_path).partition(":")[0] == damped_plots.NAME
    assert sorted(each.name for each in tmp_path.iterdir()) == [
        f"{damped_plots.NAME}{kind}" for kind in (".png", ".svg")
    ]
    assert [figures.faults(figure) for figure in seen] == [[]]
    text = damped_maps.table(measured).markdown()
    assert "NO" not in text
    assert "reduced, RK4" in text
    assert TRUSTED in {cell for row in measured[1]["measured"] for cell in row}


def test_tasks_are_told_apart() -> None:
    names = [task.name for task in damped_maps.tasks()]
    assert len(set(names)) == len(names) == 18
    assert {task.name for task in damped_maps.tasks(quick=True)} < set(names)


def test_the_errors_of_the_document_are_measured_now() -> None:
    text = DOCUMENT.partition("errors of φ and u/a at h = 1 ms")[2]
    for integrator in (*INTEGRATORS, DOP853):
        line = next(line for line in text.splitlines() if line.startswith(f"| {integrator} |"))
        for rolling, cell in zip(ROLLINGS, line.strip("| ").split(" | ")[1:], strict=True):
            runs = [DampedRuns(rolling, integrator, damping, [1e-3]).measure(1e-3) for damping in (0.01, 0.1, 1.0)]
            for run, told in zip(runs, cell.split(", "), strict=True):
                if told == "explodes":
                    assert run.outcome == EXPLODED
                elif float(told) > 1e-10:  # below is rounding, which differs from machine to machine
                    assert run.error == pytest.approx(float(told), rel=0.05)


def test_the_counts_of_the_document_are_those_of_the_stored_maps() -> None:
    kept = stored.load()["damped"]

    def count(outcomes: Collection[int]) -> int:
        cells = "".join(row for result in kept for row in result["measured"])
        return sum(cells.count(str(outcome)) for outcome in outcomes)

    words = " ".join(DOCUMENT.split())
    assert f"Of the {count(range(5)):,} runs in the maps {count([EXPLODED])} explode." in words
    assert f"{count([INACCURATE]):,} are inaccurate, and say it." in words
    assert f"Of {count((WARNED, TRUSTED)):,} accurate runs {count([WARNED])} warn all the same." in words
    worst = {result["name"]: f"{100 * result['worst']:.1f} %" for result in kept}
    borders = {number for name, number in worst.items() if not name.startswith("contact")}
    assert f"agree within {max(borders)}, in contact within {worst['contact, RK4']} under RK4" in words
    assert f"and {worst['contact, DOP853']} under DOP853" in words
