"""Runs anywhere in the space of scenes, starts, settings and samples: none is wrong and silent.

`make test` makes the same runs every time, `make search` as many new ones as one wants; the search of
`mjbeer stability` makes the ones with the first numbers.
"""

import math
import os
import secrets
from dataclasses import replace

import numpy as np
import pytest

import mjbeer
from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.exceptions import NoEquilibriumError, ParameterError
from mjbeer.studies.stability import outcome
from mjbeer.studies.stability.crew import crew
from mjbeer.studies.stability.outcome import ACCURATE, MISSED, REFUSED, SILENT, THEORIES, Outcome
from mjbeer.studies.stability.reference.lagrangian import reference
from mjbeer.studies.stability.search import batches, check, tables
from mjbeer.studies.stability.search.batches import SIZE, batch, tasks
from mjbeer.studies.stability.search.check import FALSE, PARTS, SENSITIVE, SMALL, WAY, Finding
from mjbeer.studies.stability.search.pick import Pick
from mjbeer.studies.stability.search.random_run import RandomRun
from mjbeer.studies.stability.search.regions import REGIONS, random_run
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load

pytestmark = pytest.mark.slow

EXAMPLES = os.environ.get("MJBEER_EXAMPLES")
"""How many new runs `make search` asks for."""
FIXED = 72
"""How many runs `make test` makes: four a region."""
RUNS = [random_run(number) for number in range(1800)]


def test_no_run_is_wrong_and_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor does one miss its tolerance, nor do two theories differ."""
    if EXAMPLES is None:
        found = [batch(0, FIXED)]
    else:
        monkeypatch.setitem(batches.RUNS, "usual", int(EXAMPLES))
        todo = tasks("usual", secrets.randbelow(10**9))
        with crew(todo) as measure:
            found = [measure(task) for task in todo]
        for table in tables.tables(found):
            print(table.markdown())
    assert not [run for each in found for run in each["never"]]


def test_a_number_makes_the_same_run_every_time() -> None:
    assert random_run(77) == RUNS[77]
    assert batch(1, 3) == batch(1, 3)


def test_a_run_can_be_pasted() -> None:
    names = {"simulate": lambda scene, **setting: (scene, setting), "np": np, "Can": Can, "Load": Load, "Scene": Scene}
    names |= {each: getattr(mjbeer, each) for each in ("Damping", "sliding", "frozen", "pendulum", "hoop")}
    for run in RUNS[:100]:
        assert "\n" not in str(run)
        scene, setting = eval(str(run), names)
        times = setting.pop("times")
        assert scene == run.scene
        assert np.array_equal(times, run.times)
        assert setting.pop("duration") == run.timestep * run.steps
        assert setting == {name: getattr(run, name) for name in setting}
        assert len(setting) == 7
    assert all(hasattr(mjbeer, name) for name in ("simulate", "Scene", "Can", "Load"))


def of(region: str) -> list[RandomRun]:
    return [run for run in RUNS if run.region == region]


def test_regions_have_names_of_their_own_and_as_many_runs() -> None:
    assert len({region.name for region in REGIONS}) == len(REGIONS)
    assert {len(of(region.name)) for region in REGIONS} == {len(RUNS) // len(REGIONS)}


def test_every_region_has_all_rollings_and_tolerances() -> None:
    for region in REGIONS:
        runs = of(region.name)
        wanted = {"contact"} if region.name == "contact friction" else {"reduced", "equality", "contact"}
        assert {run.rolling for run in runs} == wanted
        assert {run.integrator for run in runs if run.integrator} == {
            "Euler",
            "implicit",
            "implicitfast",
            "discrete",
            "RK4",
            "DOP853",
        }
        assert {run.rolling for run in runs if run.tolerance} == wanted - {"contact"}


def test_regions_reach_their_extremes() -> None:
    late = of("single late sample")
    assert all(len(run.times) <= 2 and run.times[-1] == pytest.approx(run.timestep * run.steps) for run in late)
    assert {len(run.times) for run in late} == {1, 2}
    assert all(len(run.times) <= 6 for run in of("sparse samples"))
    assert any(run.times[0] > 0 for run in of("sparse samples"))
    assert max(run.steps for run in of("few steps")) <= 5
    spins = [abs(run.phi_dot0) * run.timestep for run in of("fast rotation")]
    assert min(spins) < 0.1
    assert max(spins) > 10
    turns = [abs(run.phi_dot0) * run.timestep / (math.pi / 2) for run in of("resonance")]
    assert sum(abs(turn - round(turn)) < 1e-9 for turn in turns) > 30
    frictions = [run.friction for run in of("contact friction")]
    assert min(frictions) < 0.02
    assert max(frictions) > 5
    ratios = [run.scene.can.mass / run.scene.load.mass for run in of("mass ratios")]
    assert min(ratios) < 1e-5
    assert max(ratios) > 1e5
    assert max(run.timestep * run.steps for run in of("long")) > 150
    assert max(abs(run.phi0) for run in of("far angles")) > 5e3
    assert max(abs(run.phi_dot0) for run in of("far angles")) > 1e5
    inclines = [math.degrees(run.scene.incline) for run in of("steep")]
    assert min(inclines) < -89.99
    assert max(inclines) > 89.99
    gravities = [run.scene.gravity for run in of("weak or strong gravity")]
    assert 0 in gravities
    assert max(gravities) > 5e2
    assert min(1 - run.scene.load.fill for run in of("thin or full") if run.scene.load.fill) < 1e-7
    anything = [run.scene for run in of("anything")]
    assert min(scene.can.radius for scene in anything) < 1e-3
    assert max(scene.can.radius for scene in anything) > 10
    assert any(scene.load.offset == 0 for scene in anything)
    assert any(scene.load.inertia == 0 and scene.load.offset == scene.can.radius for scene in anything)


def unit(scene: Scene) -> float:
    """The damping that stops a can with load in the time of a fall through the radius [N m s]."""
    clock = math.sqrt(scene.can.radius / scene.gravity) if scene.gravity else 1.0
    return (scene.mass + scene.can.inertia / scene.can.radius**2) * scene.can.radius**2 / clock


def test_damping_spans_twelve_decades_in_every_way_of_rolling() -> None:
    for region in ("damped", "damped, mixed"):
        runs = of(region)
        assert all(run.scene.dissipates for run in runs)
        for rolling in ("reduced", "equality", "contact"):
            sizes = [
                run.scene.damping_law.linear / unit(run.scene)
                for run in runs
                if run.rolling == rolling and run.scene.damping_law.linear
            ]
            assert min(sizes) < 1e-4
            assert max(sizes) > 1e4
        laws = [run.scene.damping_law for run in runs]
        assert any(law.quadratic and not law.cubic for law in laws)
        assert any(law.cubic and not law.linear for law in laws)
        assert any(run.scene.drag and not law for run, law in zip(runs, laws, strict=True))
        assert any(run.scene.drag and law for run, law in zip(runs, laws, strict=True))


def test_starts_beside_the_separatrix_are_there() -> None:
    """Half of them are at rest there, the others have its energy; nearly."""
    distances = []
    for run in of("beside the separatrix"):
        form = run.scene.oscillator
        try:
            high = run.scene.separatrix()[1]
        except NoEquilibriumError:
            continue
        missing = form.drop(run.phi0, high) - form.inertia(run.phi0) * run.phi_dot0**2 / 2
        distances.append(abs(missing) / form.depth)
    assert len(distances) > 50
    assert max(distances) < 3
    assert np.median(distances) < 1e-3


def test_no_run_takes_theory_long() -> None:
    """It follows a run if that turns by some thousand radians, or swings some hundred times."""
    for run in RUNS:
        assert abs(run.phi_dot0) * run.timestep * run.steps <= 3001
        assert run.steps <= 15_000
    longest = max(of("long"), key=lambda run: run.scene.oscillator.depth * (run.timestep * run.steps) ** 2)
    reference(longest.scene, longest.times, longest.phi0, longest.phi_dot0)  # LongMotionError if it cannot


def made(scene: Scene, phi0: float = 1.0, **changes: object) -> RandomRun:
    usual = RandomRun(
        region="ordinary",
        scene=scene,
        phi0=phi0,
        phi_dot0=0.0,
        rolling="reduced",
        integrator="RK4",
        timestep=1e-3,
        tolerance=None,
        friction=1.0,
        steps=1000,
    )
    return replace(usual, **changes)


def off_by_a_bit(*_: object) -> Outcome:
    """Return what is said of a run that is right at its samples and has warned."""
    return Outcome(ACCURATE, 1e-5, 1.0, "it is off by 1 rad", 0.0, ("it is off by",))


@pytest.mark.parametrize(
    ("run", "alarm"),
    [
        (made(frozen()), FALSE),
        (made(frozen(), 0.0, rolling="contact", timestep=5e-4, steps=400, friction=0.23), PARTS),
        (made(pendulum(0.0), math.pi - 1e-12, timestep=2e-3), SENSITIVE),
        (made(frozen(), integrator="Euler", timestep=8e-3, steps=200, moments=(1.0,)), WAY),
        (made(frozen(), timestep=0.5, steps=1000, moments=(1.0,)), WAY),  # it explodes after its sample
    ],
)
def test_an_alarm_is_false_or_a_fact(run: RandomRun, alarm: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check, "judge", off_by_a_bit)
    assert check.check(run).alarm == alarm


@pytest.mark.parametrize("phi0", [1.0, math.pi])  # from there a real can would leave the incline
def test_a_pull_is_no_alarm(phi0: float) -> None:
    finding = check.check(made(frozen(), phi0))
    assert finding.outcome.verdict == ACCURATE
    assert bool(finding.outcome.says) == (phi0 > 3)
    assert not finding.alarm


def test_a_batch_counts_and_keeps_what_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = iter(
        [
            Finding(Outcome(ACCURATE, 1e-9, 1e-8, "", 0.0)),
            Finding(Outcome(ACCURATE, 1e-3, 1e-4, "", 0.0)),
            Finding(Outcome(ACCURATE, 1e-3, 1e-4, "N < 0", 0.0, alarms=("from t =",))),
            Finding(Outcome(SILENT, 1.0, 1e-4, "", 0.0)),
            Finding(Outcome(MISSED, 1.0, 1e-4, "", 0.0)),
            Finding(Outcome(THEORIES, 1.0, 1e-4, "", 0.0)),
            Finding(Outcome(ACCURATE, 1e-3, 1.0, "off", 0.0, alarms=("off by", "from t =")), FALSE, SMALL * 2),
            Finding(Outcome(ACCURATE, 1e-3, 1.0, "off", 0.0, alarms=("off by", "drifts by")), FALSE, SMALL / 2),
            Finding(Outcome(REFUSED, None, None, "tolerance 1 is not reached", alarms=("tolerance",))),
            Finding(Outcome(ACCURATE, 1e-3, 1.0, "slips", 0.0, alarms=("slips by",)), PARTS),
        ]
    )
    monkeypatch.setattr(batches, "check", lambda _: next(ends))
    found = batch(SIZE, 10)
    assert [each["number"] - SIZE for each in found["never"]] == [3, 4, 5]
    assert [each["number"] - SIZE for each in found["overconfident"]] == [1]
    assert [each["number"] - SIZE for each in found["needless"]] == [7]
    assert found["false alarms"] == {"off by": 2, "drifts by": 1}
    assert found["refusals"] == {"tolerance": 1}
    assert found["never"][0]["call"].startswith("simulate(")
    by_region = tables.by_region([found, found])
    everything = dict(zip(by_region.columns, by_region.rows[-1], strict=True))
    assert everything == {
        "region": "all", "runs": "20", "refused": "2", "unstable": "0", "accurate": "12", "inaccurate": "0",
        "silent": "2", "missed": "2", "theories": "2", "beyond": "0", "false alarms": "4", "below 0.0001": "2",
        "slip or lift": "2", "way": "0", "sensitive": "0", "one theory": "0",
    }  # fmt: skip
    assert by_region.rows[0][:2] == (RUNS[SIZE].region, "2")
    assert [len(table.rows) for table in tables.tables([found])] == [len(REGIONS) + 1, 2, 1, 1, 3]


def test_the_search_is_cut_into_tasks_without_gaps() -> None:
    for extent, least in batches.RUNS.items():
        firsts = [int(task.name.split()[2]) for task in tasks(extent)]
        assert firsts == list(range(0, SIZE * len(firsts), SIZE))
        assert 0 <= SIZE * len(firsts) - least < SIZE


def test_choices_are_between_their_limits() -> None:
    pick = Pick(0)
    numbers = [pick.decades(1e-3, 1e3) for _ in range(1000)]
    assert all(1e-3 <= number <= 1e3 for number in numbers)
    assert 400 < sum(number < 1 for number in numbers) < 600
    assert {pick.one(1, 2, 3) for _ in range(100)} == {1, 2, 3}
    assert {pick.sign() for _ in range(100)} == {-1, 1}


def test_a_scene_that_cannot_be_is_drawn_again(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []

    def draw(_: Pick) -> Scene:
        calls.append(1)
        if len(calls) < 3:
            raise ParameterError("no such scene")
        return sliding()

    monkeypatch.setattr("mjbeer.studies.stability.search.regions.REGIONS", (replace(REGIONS[0], scene=draw),))
    assert random_run(0).scene == sliding()
    assert outcome.judge(random_run(0).simulate).error is not None
