"""Limits and maps of stability: MuJoCo against linear theory on a sample, and that a wrong theory is seen."""

import functools
import json
import math
import pathlib

import mujoco
import numpy as np
import pytest

from mjbeer import frozen
from mjbeer.model.build import compose
from mjbeer.model.setting import Setting
from mjbeer.predictions import linear_stability, soft_constraint, soft_rolling
from mjbeer.predictions.linear_stability import accurate_limit
from mjbeer.predictions.soft_constraint import MAX_IMPEDANCE, SoftRow
from mjbeer.studies.stability import limits, maps, plots, short_runs
from mjbeer.studies.stability.short_runs import Plan, ShortRuns
from tests.support import figures, rows

pytestmark = pytest.mark.slow

COARSE = 5
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
ROUNDING = 1e-9


@pytest.fixture(scope="module")
def measured_maps() -> list[dict]:
    return [maps.measure(plan, COARSE) for plan in SAMPLE]


def test_every_cell_of_the_maps_is_as_theory_says(measured_maps: list[dict]) -> None:
    assert [(each["name"], each["same"]) for each in measured_maps] == [(plan.name, 1.0) for plan in SAMPLE]
    assert [each["agrees"] for each in measured_maps] == [True] * len(SAMPLE)


def test_maps_have_something_to_tell(measured_maps: list[dict]) -> None:
    kinds = {each["name"]: {cell for row in each["measured"] for cell in row} for each in measured_maps}
    assert kinds["equality, RK4"] == {0, 1, 2}
    assert 0 not in kinds["spring, discrete"]
    assert 0 in kinds["gravity, discrete"]


@pytest.mark.parametrize(
    ("plan", "module", "name", "wrong"),
    [
        (Plan("equality", "Euler", written="slide"), short_runs, "diagonal_excess", lambda _: 1.0),
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
    assert not maps.measure(plan, COARSE)["agrees"]


def test_friction_is_what_limits_rk4_in_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    runs = ShortRuns(Plan("contact", "RK4"), 1e-2)
    assert runs.measure(1.2e-2) != short_runs.UNSTABLE
    assert runs.measure(1.3e-2) == runs.predict(1.3e-2) == short_runs.UNSTABLE
    without = functools.partial(soft_rolling.by_contact, impratio=1e-12)
    monkeypatch.setattr(
        soft_rolling, "by_contact", lambda scene, depth, points, impratio: without(scene, depth, points)
    )
    assert runs.predict(1.3e-2) != short_runs.UNSTABLE


@pytest.mark.parametrize("timeconst", [1e-2, 1e-4, 1e-5])
@pytest.mark.parametrize("integrator", ["Euler", "discrete", "RK4"])
def test_rows_are_those_that_mujoco_solves(integrator: str, timeconst: float) -> None:
    """Reference acceleration and regularizer, in motion."""
    timestep, impedance = 1e-3, 0.9
    scene = frozen(incline=0.0)
    spec = compose(scene, Setting("equality", integrator, timestep))
    rolling = spec.equality("rolling")
    rolling.solref, rolling.solimp = [timeconst, 0.7], [impedance, impedance, 0.001, 0.5, 2]
    model = spec.compile()
    data = mujoco.MjData(model)
    data.joint("slide").qpos, data.joint("slide").qvel = 1e-5, -2e-3
    mujoco.mj_forward(model, data)
    jacobian, mass = np.array(data.efc_J).reshape(-1, model.nv), np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    diagonal = float((jacobian @ np.linalg.solve(mass, jacobian.T))[0, 0])
    row = soft_constraint.spring(timeconst, 0.7, impedance)
    row = row.at_end_of_step(timestep) if integrator == "discrete" else row
    assert float(data.efc_aref[0]) == pytest.approx(2e-3 * row.damping - 1e-5 * row.stiffness, rel=ROUNDING)
    assert diagonal / (diagonal + float(data.efc_R[0])) == pytest.approx(row.impedance, rel=ROUNDING)
    assert row.impedance <= MAX_IMPEDANCE


@pytest.mark.parametrize("impedance", [0.9, 0.5])
@pytest.mark.parametrize("dampratio", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("share", [0.1, 0.99, 1.01, 3.0])
def test_refsafe_resolves_contacts_under_discrete(impedance: float, dampratio: float, share: float) -> None:
    """On either side of its threshold."""
    timestep = 1e-3
    timeconst = share * timestep / (dampratio * math.sqrt(impedance))
    spec = compose(frozen(incline=0.0), Setting("contact", "discrete", timestep))
    rolling = spec.pair("rolling")
    rolling.solref, rolling.solimp = [timeconst, dampratio], [impedance, impedance, 0.001, 0.5, 2]
    spec.option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.joint("lift").qpos = -1e-6
    mujoco.mj_forward(model, data)
    row = soft_constraint.spring(
        soft_constraint.discrete_refsafe_timeconst(timeconst, dampratio, impedance, timestep), dampratio, impedance
    )
    stiffness, damping, share_let_through, _ = data.efc_KBIP[0]
    assert (stiffness * share_let_through, damping) == pytest.approx((row.stiffness, row.damping), rel=ROUNDING)
    assert row.stiffness * timestep**2 <= 1 + ROUNDING


def test_limits_agree() -> None:
    found = [
        limits.measure("frozen", "reduced", "RK4"),
        limits.measure("pendulum", "equality", "Euler"),
        limits.measure("frozen", "contact", "DOP853"),
    ]
    assert [each["agrees"] for each in found] == [True] * 3
    assert found[2]["accurate"] < 0.25 * accurate_limit("DOP853")  # softness, and not the integrator
    assert json.loads(json.dumps(found)) == found
    assert "NO" not in limits.table(found).markdown()


def test_a_wrong_limit_does_not_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    right = linear_stability.stable_limit("RK4")
    monkeypatch.setattr(linear_stability, "stable_limit", lambda _: 1.06 * right)
    found = limits.measure("frozen", "reduced", "RK4")
    assert not found["agrees"]
    assert "NO" in limits.table([found]).markdown()


def test_a_contact_that_is_not_settled_loses_a_stage() -> None:
    found = limits.measure("frozen", "contact", "RK4", settled=False)
    assert found["lost_a_stage"]
    assert found["stable_ratio"] < 0.5


def test_tasks_are_told_apart() -> None:
    for module in (limits, maps):
        for quick in (False, True):
            names = [each.name for each in module.tasks(quick)]
            assert len(set(names)) == len(names)
        assert {each.name for each in module.tasks(True)} <= {each.name for each in module.tasks()}
    assert len(limits.tasks()) == 6 * (1 + 4 * 3) + 4


def test_plots_are_drawn(measured_maps: list[dict], tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = figures.saved(monkeypatch)
    found = [limits.measure("sliding", "reduced", "Euler")]
    names = [line.partition(":")[0] for line in plots.draw(found, measured_maps[:1] + measured_maps[-1:], tmp_path)]
    assert sorted(each.name for each in tmp_path.iterdir()) == sorted(
        f"{name}{kind}" for name in names for kind in (".png", ".svg")
    )
    assert plots.LIMITS in names
    assert len(names) == 3
    assert [figures.faults(figure) for figure in seen] == [[], [], []]
    assert "100.0%" in maps.table(measured_maps).markdown()


def test_the_table_of_the_document_is_that_of_theory() -> None:
    text = (pathlib.Path(__file__).parents[3] / "docs" / "stability.md").read_text()
    methods = ("Euler", "discrete", "RK4", "DOP853")

    def spring(method: str) -> float:
        return math.inf if method == "discrete" else linear_stability.stable_limit(method)

    def directly(method: str) -> float:
        return rows.stable_timestep(method, soft_constraint.direct(1.0, 2.0, 0.9))

    wanted = {
        "swing by gravity: ωh below": linear_stability.stable_limit,
        "swing by a joint's spring: ωh below": spring,
        "equality, ζ = 1: h/τ below": rows.stable_ratio,
        "equality, ζ = 0.1: h/τ below": lambda method: rows.stable_ratio(method, 0.1),
        "friction of a contact: h/τ below": rows.stable_slip,
        "direct `solref`, B = 2√K: h√K below": directly,
        "error of a swing below 1 % for ten periods: ωh below": linear_stability.accurate_limit,
    }
    for head, limit in wanted.items():
        line = next(line for line in text.splitlines() if line.startswith(f"| {head} |"))
        told = [math.inf if each == "no limit" else float(each) for each in line.strip("| ").split(" | ")[1:]]
        assert told == pytest.approx([limit(method) for method in methods], rel=2e-2), head  # two digits or three
