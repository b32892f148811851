"""Maps of stability: MuJoCo against linear theory on a sample, a wrong theory is seen; and the study as a whole."""

import datetime
import json
import math
import os
import pathlib
from dataclasses import replace
from functools import partial

import pytest

from mjbeer.checks.check import Check, Result
from mjbeer.cli.app import main
from mjbeer.model.setting import Integrator
from mjbeer.studies import predictions
from mjbeer.studies.predictions import SoftRow
from mjbeer.studies.stability import stability_maps, stability_study
from mjbeer.studies.stability.stability_maps import PLANS, measure
from mjbeer.studies.study import Study

pytestmark = pytest.mark.slow

SAMPLE: list[tuple[str, Integrator]] = [
    *(("solref", "RK4"), ("solref", "discrete"), ("direct", "Euler"), ("gravity", "discrete")),
    *(("damping", "Euler"), ("damping", "implicitfast"), ("damping", "discrete"), ("damping", "RK4")),
]
BOUND = stability_maps.checks()[0].bound


@pytest.mark.parametrize(("family", "integrator"), SAMPLE)
def test_every_cell_of_a_map_is_as_theory_says(family: str, integrator: Integrator) -> None:
    found, damped = measure(family, integrator, 5), family == "damping" and integrator in ("discrete", "implicitfast")
    assert found["same"] == 1.0
    assert found["error"] <= BOUND
    assert ("0" in "".join(found["measured"])) == (not damped)


@pytest.mark.parametrize(
    ("plan", "module", "name", "wrong"),
    [
        (("solref", "discrete"), SoftRow, "at_end_of_step", lambda self, _: self),
        (("solref", "Euler"), stability_maps, "spring", lambda t, z, d: predictions.direct(0.8 / t**2, 1.8 / t, d)),
        (("gravity", "RK4"), predictions, "polynomial", lambda _: [1, 1, 1 / 2, 1 / 6, 1 / 30]),
        (("damping", "RK4"), predictions, "polynomial", lambda _: [1, 1, 1 / 2, 1 / 6, 1 / 30]),
        (("damping", "discrete"), predictions, "IMPLICIT", ()),
    ],
)
def test_a_wrong_theory_does_not_agree(
    plan: tuple[str, Integrator], module: object, name: str, wrong: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, name, wrong)
    assert measure(*plan, 5)["error"] > BOUND


@pytest.mark.parametrize("quick", [True, False])
def test_checks_have_names_of_their_own(quick: bool) -> None:
    names = [(check.group, check.name) for check in stability_study.plan(quick, 0)]
    assert len(set(names)) == len(names)
    assert {group for group, _ in names} == {"maps", "cases", "search"}


def test_the_study_is_written(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One check of each group, for real and in this process; the map is small, and the runs are few."""
    first: dict[str, Check] = {}
    for check in stability_study.plan(True, 0):
        first.setdefault(check.group, check)
    small = {"maps": partial(measure, *PLANS[0], 4), "search": partial(stability_study.batch, 0, 4)}
    first |= {group: replace(first[group], measure=few) for group, few in small.items()}
    monkeypatch.setattr(stability_study, "plan", lambda quick, number: list(first.values()))
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    assert main(["stability", "--quick", "--json", "--output", str(tmp_path)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["failed"] == []
    assert sum(told["totals"]["kinds"]["all"].get(verdict, 0) for verdict in ("right", "refused", "doubted")) == 4
    assert not (tmp_path / stability_study.UNFINISHED).exists()
    found = Study.load(tmp_path / "stability.jsonl", "mjbeer stability")
    assert {result.group for result in found.results} == {"maps", "cases", "search"}
    assert "All came out as they must." in (tmp_path / "summary.md").read_text()
    assert [each.stem for each in tmp_path.glob("*.svg")] == ["stability-solref"]
    assert [each["name"] for each in stability_maps.load(tmp_path / "maps.json")["maps"]] == ["solref, Euler"]
    found.results[0] = Result("maps", "a map", bound=0.05, error=0.1, values=found.results[0].values)
    stability_study.write(found, tmp_path)
    assert "**1 did not come out as they must.**" in (tmp_path / "summary.md").read_text()


def test_the_stored_maps_are_all_that_the_study_makes_and_agree_with_theory() -> None:
    kept = stability_maps.load()
    assert [each["name"] for each in kept["maps"]] == [", ".join(plan) for plan in PLANS]
    assert all(each["worst"] <= BOUND and each["same"] == 1 for each in kept["maps"])
    assert set(kept["settings"]) == {"quick", stability_study.FIRST}
    assert kept["settings"]["quick"] is False
    assert datetime.date.fromisoformat(kept["date"]) >= datetime.date(2026, 11, 21)
    for each in kept["maps"]:
        assert [len(row) for row in each["measured"]] == [len(each["timesteps"])] * len(each["values"])


@pytest.mark.parametrize("name", ["gravity, RK4", "damping, RK4"])
def test_stored_maps_are_what_is_measured_now(name: str) -> None:
    """The corners of a stored map are cells of a coarser one over the same ranges."""
    (kept,) = (each for each in stability_maps.load()["maps"] if each["name"] == name)
    now = measure(*next(plan for plan in PLANS if ", ".join(plan) == name), 2)
    for place in (0, -1):
        assert now["measured"][place] == kept["measured"][place][0] + kept["measured"][place][-1]
        stretches = ([edge or math.inf for edge in of["boundaries"][place]] for of in (kept, now))
        assert next(stretches) == pytest.approx(next(stretches), rel=0.05)
