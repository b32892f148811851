"""Limits and maps of stability: MuJoCo against linear theory on a sample, and that a wrong theory is seen."""

import functools
import json

import pytest

from mjbeer.model.setting import Integrator, Rolling
from mjbeer.predictions import linear_stability, soft_constraint, soft_rolling
from mjbeer.predictions.soft_constraint import SoftRow
from mjbeer.predictions.soft_rolling import System
from mjbeer.studies.study import Result, Row
from mjbeer.studies.stability import limits, stiff_runs
from mjbeer.studies.stability.stiff_maps import AGREEMENT, measure, measure_damped
from mjbeer.studies.stability.stiff_runs import (
    EXPLODED,
    SILENT,
    UNSTABLE,
    WRONG,
    DampedRuns,
    Plan,
    ShortRuns,
)
from mjbeer.theory.record import Record

pytestmark = pytest.mark.slow

COARSE, DAMPED_COARSE = (5, 5), (3, 4)
SAMPLE = [
    Plan("equality", "RK4"),
    Plan("equality", "discrete"),
    Plan("equality", "implicitfast", refsafe=True),
    Plan("equality", "Euler", refsafe=True, dampratio=0.1),
    Plan("equality", "Euler", written="slide"),
    Plan("equality", "Euler", written="hinge"),
    Plan("direct", "Euler", refsafe=True),
    Plan("contact", "RK4"),
    Plan("contact", "discrete", refsafe=True),
    Plan("gravity", "discrete"),
    Plan("spring", "discrete"),
]
DAMPED: dict[tuple[Rolling, Integrator], bool] = {
    ("reduced", "Euler"): True,
    ("reduced", "RK4"): True,
    ("equality", "implicitfast"): True,
    ("equality", "discrete"): False,
    ("contact", "Euler"): False,
}
"""Maps of damping, and whether there are runs in them that explode."""


@pytest.mark.parametrize("plan", SAMPLE, ids=lambda plan: plan.name)
def test_every_cell_of_a_map_is_as_theory_says(plan: Plan) -> None:
    found = measure(plan, COARSE)
    assert found["same"] == 1.0
    assert found["error"] <= AGREEMENT["maps"]
    cells = set("".join(found["measured"]))
    assert cells == set("012") or plan.name != "equality, RK4"
    assert ("0" in cells) == (plan.name not in ("contact, discrete, refsafe", "spring, discrete"))


@pytest.mark.parametrize(
    ("plan", "module", "name", "wrong"),
    [
        (Plan("equality", "Euler", written="slide"), stiff_runs, "diagonal_excess", lambda _: 1.0),
        (Plan("equality", "Euler", refsafe=True), soft_constraint, "refsafe_timeconst", lambda timeconst, _: timeconst),
        (Plan("equality", "discrete"), SoftRow, "at_end_of_step", lambda self, _: self),
        (
            Plan("equality", "Euler"),
            soft_constraint,
            "spring",
            lambda t, z, d: soft_constraint.direct(0.8 / t**2, 1.8 / t, d),
        ),
    ],
    ids=["diagonal", "refsafe", "discrete", "solref"],
)
def test_a_wrong_theory_does_not_agree(
    plan: Plan, module: object, name: str, wrong: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, name, wrong)
    assert measure(plan, COARSE)["error"] > AGREEMENT["maps"]


@pytest.mark.parametrize(("plan", "explode"), DAMPED.items())
def test_damped_runs_explode_where_theory_says(plan: tuple[Rolling, Integrator], explode: bool) -> None:
    found = measure_damped(*plan, DAMPED_COARSE)
    assert found["error"] <= AGREEMENT["damped"]
    assert (str(EXPLODED) in "".join(found["measured"])) == explode
    assert explode or found["boundaries"] == [(None, None)] * 4
    assert json.loads(json.dumps(found))["measured"] == found["measured"]


@pytest.mark.parametrize(
    ("plan", "name", "wrong"),
    [(("reduced", "Euler"), "by_tendon", False), (("equality", "Euler"), "by_tendon", True)],
)
def test_a_wrong_theory_of_damping_does_not_agree(
    plan: tuple[Rolling, Integrator], name: str, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Damping that is taken implicitly in place of explicitly, and the reverse."""
    step = System.step

    def mistaken(system: System, *settings: object) -> object:
        object.__setattr__(system, name, wrong)
        return step(system, *settings)

    monkeypatch.setattr(System, "step", mistaken)
    assert measure_damped(*plan, DAMPED_COARSE)["error"] > AGREEMENT["damped"]


def test_a_wrong_run_that_is_trusted_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """With an estimate of its error and a drift of nothing, a run whose load is 0.4 rad off would be silent."""
    runs = DampedRuns("reduced", "implicit", 1.0, [8e-3])
    assert runs.measure(8e-3) == WRONG
    monkeypatch.setattr(Record, "implied_error", 0.0)
    monkeypatch.setattr("mjbeer.simulation.run.Run.error_estimate", 0.0)
    assert runs.measure(8e-3) == SILENT
    row = Row("damped", "a map", lambda: measure_damped("reduced", "implicit", (2, 2)), bound=AGREEMENT["damped"])
    result = row.result()
    assert str(SILENT) in result.values["measured"][0]
    assert not result.passed


def test_friction_is_what_limits_rk4_in_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    runs = ShortRuns(Plan("contact", "RK4"), 1e-2)
    assert runs.measure(1.2e-2) != UNSTABLE
    assert runs.measure(1.3e-2) == runs.predict(1.3e-2) == UNSTABLE
    without = functools.partial(soft_rolling.by_contact, impratio=1e-12)
    monkeypatch.setattr(
        soft_rolling, "by_contact", lambda scene, depth, points, impratio: without(scene, depth, points)
    )
    assert runs.predict(1.3e-2) != UNSTABLE


@pytest.mark.parametrize(
    "way", [("frozen", "reduced", "RK4"), ("pendulum", "equality", "Euler"), ("frozen", "contact", "DOP853")]
)
def test_limits_agree(way: tuple[str, Rolling, Integrator]) -> None:
    found = limits.measure(*way)
    assert found["error"] <= limits.AGREEMENT
    if way[1] == "contact":  # softness, and not the integrator
        assert found["accurate"] < 0.25 * linear_stability.accurate_limit("DOP853")


def test_a_wrong_limit_does_not_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    right = linear_stability.stable_limit("RK4")
    monkeypatch.setattr(linear_stability, "stable_limit", lambda _: 1.06 * right)
    found = limits.measure("frozen", "reduced", "RK4")
    assert found["error"] > limits.AGREEMENT


def test_a_contact_that_is_not_settled_loses_a_stage() -> None:
    found = limits.measure("frozen", "contact", "RK4", settled=False)
    assert found["lost_a_stage"]
    assert found["stable"] < 0.5 * found["stable_predicted"]
    assert "loses the contact" in limits.table([Result("limits", "frozen", bound=1.0, values=found)]).markdown()
