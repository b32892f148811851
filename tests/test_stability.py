"""Limits and maps of stability: MuJoCo against linear theory on a sample, and that a wrong theory is seen."""

import functools
import json
import math
import pathlib

import mujoco
import numpy as np
import pytest

from mjbeer import (
    frozen,
    linear_stability,
    small_motions,
    soft_rows,
    stability_bench,
    stability_limits,
    stability_maps,
    stability_plots,
)
from mjbeer.linear_stability import accurate_limit
from mjbeer.model import specify
from mjbeer.soft_rows import MAX_IMPEDANCE, Row
from mjbeer.stability_bench import Bench, Plan

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
def maps() -> list[dict]:
    return [stability_maps.measure(plan, COARSE) for plan in SAMPLE]


def test_every_cell_of_the_maps_is_as_theory_says(maps: list[dict]) -> None:
    assert [(each["name"], each["same"]) for each in maps] == [(plan.name, 1.0) for plan in SAMPLE]
    assert [each["agrees"] for each in maps] == [True] * len(SAMPLE)


def test_maps_have_something_to_tell(maps: list[dict]) -> None:
    kinds = {each["name"]: {cell for row in each["measured"] for cell in row} for each in maps}
    assert kinds["equality, RK4"] == {0, 1, 2}
    assert 0 not in kinds["spring, discrete"]
    assert 0 in kinds["gravity, discrete"]


@pytest.mark.parametrize(
    ("plan", "module", "name", "wrong"),
    [
        (Plan("equality", "Euler", written="slide"), stability_bench, "diagonal_excess", lambda _: 1.0),
        (Plan("equality", "Euler", refsafe=True), soft_rows, "safe", lambda timeconst, _: timeconst),
        (Plan("equality", "discrete"), Row, "at_end_of_step", lambda self, _: self),
        (Plan("equality", "Euler"), soft_rows, "spring", lambda t, z, d: soft_rows.direct(0.8 / t**2, 1.8 / t, d)),
    ],
    ids=["diagonal", "refsafe", "discrete", "solref"],
)
def test_a_wrong_theory_does_not_agree(
    plan: Plan, module: object, name: str, wrong: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, name, wrong)
    assert not stability_maps.measure(plan, COARSE)["agrees"]


def test_friction_is_what_limits_rk4_in_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(Plan("contact", "RK4"), 1e-2)
    assert bench.measure(1.2e-2) != stability_bench.UNSTABLE
    assert bench.measure(1.3e-2) == bench.predict(1.3e-2) == stability_bench.UNSTABLE
    without = functools.partial(small_motions.by_contact, impratio=1e-12)
    monkeypatch.setattr(
        small_motions, "by_contact", lambda scene, depth, points, impratio: without(scene, depth, points)
    )
    assert bench.predict(1.3e-2) != stability_bench.UNSTABLE


@pytest.mark.parametrize("timeconst", [1e-2, 1e-4, 1e-5])
@pytest.mark.parametrize("integrator", ["Euler", "discrete", "RK4"])
def test_rows_are_those_that_mujoco_solves(integrator: str, timeconst: float) -> None:
    """Reference acceleration and regularizer, in motion."""
    timestep, impedance = 1e-3, 0.9
    scene = frozen(incline=0.0)
    spec = specify(scene, "equality", integrator=integrator, timestep=timestep)
    rolling = spec.equality("rolling")
    rolling.solref, rolling.solimp = [timeconst, 0.7], [impedance, impedance, 0.001, 0.5, 2]
    model = spec.compile()
    data = mujoco.MjData(model)
    data.joint("slide").qpos, data.joint("slide").qvel = 1e-5, -2e-3
    mujoco.mj_forward(model, data)
    jacobian, mass = np.array(data.efc_J).reshape(-1, model.nv), np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    diagonal = float((jacobian @ np.linalg.solve(mass, jacobian.T))[0, 0])
    row = soft_rows.spring(timeconst, 0.7, impedance)
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
    spec = specify(frozen(incline=0.0), "contact", integrator="discrete", timestep=timestep)
    rolling = spec.pair("rolling")
    rolling.solref, rolling.solimp = [timeconst, dampratio], [impedance, impedance, 0.001, 0.5, 2]
    spec.option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.joint("lift").qpos = -1e-6
    mujoco.mj_forward(model, data)
    row = soft_rows.spring(soft_rows.resolved(timeconst, dampratio, impedance, timestep), dampratio, impedance)
    stiffness, damping, share_let_through, _ = data.efc_KBIP[0]
    assert (stiffness * share_let_through, damping) == pytest.approx((row.stiffness, row.damping), rel=ROUNDING)
    assert row.stiffness * timestep**2 <= 1 + ROUNDING


def test_limits_agree() -> None:
    found = [
        stability_limits.measure("frozen", "reduced", "RK4"),
        stability_limits.measure("pendulum", "equality", "Euler"),
        stability_limits.measure("frozen", "contact", "DOP853"),
    ]
    assert [each["agrees"] for each in found] == [True] * 3
    assert found[2]["accurate"] < 0.25 * accurate_limit("DOP853")  # softness, and not the integrator
    assert json.loads(json.dumps(found)) == found
    assert "NO" not in stability_limits.grid(found).markdown()


def test_a_wrong_limit_does_not_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    right = linear_stability.stable_limit("RK4")
    monkeypatch.setattr(linear_stability, "stable_limit", lambda _: 1.06 * right)
    found = stability_limits.measure("frozen", "reduced", "RK4")
    assert not found["agrees"]
    assert "NO" in stability_limits.grid([found]).markdown()


def test_a_contact_that_is_not_settled_loses_a_stage() -> None:
    found = stability_limits.measure("frozen", "contact", "RK4", settled=False)
    assert found["lost_a_stage"]
    assert found["stable_ratio"] < 0.5


def test_tasks_are_told_apart() -> None:
    for module in (stability_limits, stability_maps):
        for quick in (False, True):
            names = [each.name for each in module.tasks(quick)]
            assert len(set(names)) == len(names)
        assert {each.name for each in module.tasks(True)} <= {each.name for each in module.tasks()}
    assert len(stability_limits.tasks()) == 6 * (1 + 4 * 3) + 4


def test_plots_are_drawn(maps: list[dict], tmp_path: pathlib.Path) -> None:
    limits = [stability_limits.measure("sliding", "reduced", "Euler")]
    names = [line.partition(":")[0] for line in stability_plots.draw(limits, maps[:1] + maps[-1:], tmp_path)]
    assert sorted(each.name for each in tmp_path.iterdir()) == sorted(
        f"{name}{kind}" for name in names for kind in (".png", ".svg")
    )
    assert stability_plots.LIMITS in names
    assert len(names) == 3
    assert "100.0%" in stability_maps.grid(maps).markdown()


def test_the_table_of_the_document_is_that_of_theory() -> None:
    text = (pathlib.Path(__file__).parents[1] / "docs" / "stability.md").read_text()
    methods = ("Euler", "discrete", "RK4", "DOP853")

    def spring(method: str) -> float:
        return math.inf if method == "discrete" else linear_stability.stable_limit(method)

    def directly(method: str) -> float:
        return soft_rows.stable_timestep(method, soft_rows.direct(1.0, 2.0, 0.9))

    wanted = {
        "swing by gravity: ωh below": linear_stability.stable_limit,
        "swing by a joint's spring: ωh below": spring,
        "equality, ζ = 1: h/τ below": soft_rows.stable_ratio,
        "equality, ζ = 0.1: h/τ below": lambda method: soft_rows.stable_ratio(method, 0.1),
        "friction of a contact: h/τ below": soft_rows.stable_slip,
        "direct `solref`, B = 2√K: h√K below": directly,
        "error of a swing below 1 % for ten periods: ωh below": linear_stability.accurate_limit,
    }
    for head, limit in wanted.items():
        line = next(line for line in text.splitlines() if line.startswith(f"| {head} |"))
        told = [math.inf if each == "no limit" else float(each) for each in line.strip("| ").split(" | ")[1:]]
        assert told == pytest.approx([limit(method) for method in methods], rel=2e-2), head  # two digits or three
