"""Maps of timestep and damping: theory knows where runs explode, wrong runs say so, and a wrong theory is seen."""

import json
import pathlib

import pytest

from mjbeer.model.setting import Integrator, Rolling
from mjbeer.predictions.soft_rolling import System
from mjbeer.studies.stability import damped_maps, damped_plots
from mjbeer.studies.stability.damped_runs import EXPLODED, INACCURATE, SILENT, TRUSTED, WARNED, DampedRuns
from mjbeer.theory.record import Record
from tests.support import figures

pytestmark = pytest.mark.slow

COARSE = (3, 4)
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


def test_an_accurate_run_that_warns_is_kept() -> None:
    """First-order integrators drift in energy by more than their error."""
    result = damped_maps.measure("reduced", "discrete", (2, 2))
    assert result["measured"][0][0] == WARNED
    worst = result["warned"]
    assert worst["error"] <= 0.01 < worst["implied"]


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
