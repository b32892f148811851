"""Maps of stability: MuJoCo against linear theory on a sample, a wrong theory is seen; and the
study as a whole."""

import datetime
import json
import math
import os
import pathlib
import re
from dataclasses import replace
from functools import partial

import pytest

from mjbeer.checks.check import Check
from mjbeer.cli.app import main
from mjbeer.model.setting import Integrator
from mjbeer.output.plots import Picture
from mjbeer.studies import predictions
from mjbeer.studies.predictions import SoftRow
from mjbeer.studies.stability import map_plots, stability_maps, stability_study
from mjbeer.studies.stability.stability_maps import PLANS, measure
from mjbeer.studies.study import Study
from mjbeer.theory.paper_scenes import frozen

pytestmark = pytest.mark.slow

SAMPLE: list[tuple[str, Integrator]] = [
    ("solref", "RK4"),
    ("solref", "discrete"),
    ("direct", "Euler"),
    ("gravity", "discrete"),
    ("damping", "Euler"),
    ("damping", "implicitfast"),
    ("damping", "discrete"),
    ("damping", "RK4"),
]
BOUND = stability_maps.checks()[0].bound


@pytest.mark.parametrize(("family", "integrator"), SAMPLE)
def test_every_cell_of_a_map_is_as_theory_says(family: str, integrator: Integrator) -> None:
    found = measure(family, integrator, 5)

    assert found.same == 1.0
    assert found.worst <= BOUND
    explodes = "0" in "".join(found.measured)
    takes_damping_implicitly = family == "damping" and integrator in ("discrete", "implicitfast")
    assert explodes is not takes_damping_implicitly


def wrong_spring(timeconst: float, _: float, impedance: float) -> SoftRow:
    """Return a row that is a tenth too soft."""
    return predictions.direct(0.8 / timeconst**2, 1.8 / timeconst, impedance)


def wrong_polynomial(_: str) -> list[float]:
    """Return that of RK4 with a wrong last coefficient."""
    return [1, 1, 1 / 2, 1 / 6, 1 / 30]


@pytest.mark.parametrize(
    ("plan", "module", "name", "wrong"),
    [
        (("solref", "discrete"), SoftRow, "at_end_of_step", lambda self, _: self),
        (("solref", "Euler"), stability_maps, "spring", wrong_spring),
        (("gravity", "RK4"), predictions, "polynomial", wrong_polynomial),
        (("damping", "RK4"), predictions, "polynomial", wrong_polynomial),
        (("damping", "discrete"), predictions, "IMPLICIT", ()),
    ],
)
def test_a_wrong_theory_does_not_agree(
    plan: tuple[str, Integrator],
    module: object,
    name: str,
    wrong: object,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, name, wrong)

    assert measure(*plan, 5).worst > BOUND


@pytest.mark.parametrize("quick", [True, False])
def test_checks_have_names_of_their_own(quick: bool) -> None:
    names = [(check.group, check.name) for check in stability_study.plan(quick, 0)]

    assert len(set(names)) == len(names)
    assert {group for group, _ in names} == {"maps", "cases", "search"}


@pytest.fixture
def small_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    """One check of each group, in this process; the map is small, and the runs are few."""
    first: dict[str, Check] = {}
    for check in stability_study.plan(True, 0):
        first.setdefault(check.group, check)
    small_map = partial(stability_maps.measured_map, *PLANS[0], 4)
    first["maps"] = replace(first["maps"], measure=small_map)
    few_runs = partial(stability_study.measured_batch, 0, 4)
    first["search"] = replace(first["search"], measure=few_runs)
    monkeypatch.setattr(stability_study, "plan", lambda quick, number: list(first.values()))
    monkeypatch.setattr(os, "cpu_count", lambda: 1)


@pytest.mark.usefixtures("small_plan")
def test_the_study_is_written(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stability", "--quick", "--output", str(tmp_path)]) == 0

    assert "not as it must be" not in capsys.readouterr().err
    counts = json.loads((tmp_path / "totals.json").read_text())["kinds"]["all"]
    assert sum(counts.get(verdict, 0) for verdict in ("right", "refused", "doubted")) == 4
    assert not (tmp_path / stability_study.UNFINISHED).exists()
    study = Study.load(tmp_path / "stability.jsonl", "mjbeer stability")
    assert {result.group for result in study.results} == {"maps", "cases", "search"}
    assert "All came out as they must." in (tmp_path / "summary.md").read_text()
    assert [path.stem for path in tmp_path.glob("*.svg")] == ["stability-solref"]
    (written,) = stability_maps.load(tmp_path / "maps.json").maps
    assert written.name == "solref, Euler"

    # The same with a map that does not agree.
    failed = replace(study.results[0], error=0.1)
    study.results[0] = failed
    stability_study.write(study, tmp_path)

    assert "**1 did not come out as they must.**" in (tmp_path / "summary.md").read_text()
    (written,) = stability_maps.load(tmp_path / "maps.json").maps
    assert written.worst == 0.1


def test_the_stored_maps_are_all_that_the_study_makes_and_agree_with_theory() -> None:
    stored = stability_maps.load()

    assert [stored_map.name for stored_map in stored.maps] == [", ".join(plan) for plan in PLANS]
    assert set(stored.settings) == {"quick", stability_study.FIRST}
    assert stored.settings["quick"] is False
    assert datetime.date.fromisoformat(stored.date) >= datetime.date(2026, 11, 21)
    for stored_map in stored.maps:
        assert stored_map.worst <= BOUND
        assert stored_map.same == 1
        widths = [len(row) for row in stored_map.measured]
        assert widths == [len(stored_map.timesteps)] * len(stored_map.values)


@pytest.mark.parametrize("plan", [("gravity", "RK4"), ("damping", "RK4")], ids=str)
def test_stored_maps_are_what_is_measured_now(plan: tuple[str, Integrator]) -> None:
    """The corners of a stored map are cells of a coarser one over the same ranges."""
    by_name = {stored_map.name: stored_map for stored_map in stability_maps.load().maps}
    stored = by_name[", ".join(plan)]

    now = measure(*plan, 2)

    for place in (0, -1):
        row = stored.measured[place]
        assert now.measured[place] == row[0] + row[-1]
        for before, after in zip(stored.boundaries[place], now.boundaries[place], strict=True):
            assert (before or math.inf) == pytest.approx(after or math.inf, rel=0.05)


@pytest.mark.parametrize(
    ("name", "limit"),
    [
        # h < 2 (sqrt(2) - 1) tau is where semi-implicit Euler's bound meets zeta = 1.
        ("solref, Euler", f"stable below h = {2 * (math.sqrt(2) - 1):.2g} τ"),
        ("direct, Euler", f"stable below h = {2 * (math.sqrt(2) - 1):.2g}/√K"),
        # A swing of omega is stable up to h = 2/omega under semi-implicit Euler.
        (
            "gravity, Euler",
            f"stable below h = {2 / frozen(0.0, gravity=1.0).frequency():.2g} √(1 m/g)",
        ),
        ("damping, implicit", "stable with every timestep"),
    ],
)
def test_a_panel_says_which_timesteps_are_stable(name: str, limit: str) -> None:
    (shown,) = (one_map for one_map in stability_maps.load().maps if one_map.name == name)

    assert map_plots._limit(shown) == limit


def test_integrators_whose_runs_end_alike_share_a_panel() -> None:
    maps = [one_map for one_map in stability_maps.load().maps if one_map.family == "gravity"]
    picture = Picture("gravity")

    map_plots.draw(picture, maps)

    titles = re.findall(r"<text[^>]*>([^<]*)</text>", picture.svg)
    assert "RK4" in titles
    assert "implicitfast, discrete" in titles
    assert "implicit" not in titles
