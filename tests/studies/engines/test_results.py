"""The results of the can test are those of the stored motions, and their judge can tell motions
apart."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mjbeer.output.numbers import number
from mjbeer.studies.can_test import CASES, ROCK
from mjbeer.studies.engines import engine_plot, engine_tables, findings
from mjbeer.studies.engines.results import (
    FRICTION,
    TIMESTEPS,
    Motion,
    Results,
    Row,
    judge,
    order_of,
)

RESULTS = Results.load()
# Another processor computes the exact motion with other last digits, which are 1e-12 of 66 rad.
RELATIVE = 1e-6
ABSOLUTE = 1e-9


def exact_motion(case_name: str) -> Motion:
    """The exact motion, as an engine would give it."""
    case = CASES[case_name]
    time = np.linspace(0, 2, 51)
    truth = case.truth(time, 0.0)
    columns = (time, truth.phi, truth.u, truth.phi_dot, truth.u_dot, np.zeros_like(time))
    return Motion(*(column.tolist() for column in columns))


def row(timestep: float, error: float) -> Row:
    return Row("rock", "an engine", "circle", "default", False, timestep, error, error / 2)


def test_every_row_is_what_its_stored_motion_says() -> None:
    judged = 0
    for stored in RESULTS.rows:
        if stored.motion is None:
            assert stored.failure, stored.key
            continue
        found = judge(CASES[stored.case], stored.motion)
        judged_anew = (*found.position, found.energy, found.slip, found.lateral)
        written = (
            stored.phi_error,
            stored.u_error,
            stored.energy_error,
            stored.slip,
            stored.lateral,
        )
        assert written == pytest.approx(judged_anew, rel=RELATIVE, abs=ABSOLUTE), stored.key
        judged += 1
    assert judged >= 0.9 * len(RESULTS.rows)


def test_every_motion_begins_as_its_case_does() -> None:
    """An engine that was set up otherwise would have an error that is not its own.

    Single precision has seven digits.
    """
    for stored in RESULTS.rows:
        if stored.motion is None:
            continue
        case = CASES[stored.case]
        motion = stored.motion
        assert motion.time == pytest.approx(np.linspace(0, 2, 51))
        began = motion.phi[0], motion.u[0], motion.phi_dot[0], motion.u_dot[0], motion.lateral[0]
        radius = case.scene.can.radius
        start = case.phi0, radius * case.phi0, case.phi_dot0, radius * case.phi_dot0, 0.0
        assert began == pytest.approx(start, rel=1e-6, abs=1e-7), stored.key


def test_every_engine_has_every_case_and_timestep() -> None:
    contacts = {engine.name for engine in RESULTS.engines} - {"SciPy"}
    assert len(contacts) >= 9
    for engine in RESULTS.engines:
        for setting in engine.settings:
            for case in CASES:
                found = [
                    stored.timestep
                    for stored in RESULTS.rows
                    if stored.key == (case, engine.name, setting["shape"], setting["name"])
                ]
                assert found == list(TIMESTEPS)


def test_neither_case_needs_the_friction_that_it_has_or_parts_from_the_incline() -> None:
    for case in CASES.values():
        forces = case.truth(np.linspace(0, 2, 2001), 0.0).forces
        assert forces.normal.min() > 0
        assert forces.needed_friction.max() < 0.39 < FRICTION


@pytest.mark.parametrize("name", CASES)
def test_the_exact_motion_has_no_error(name: str) -> None:
    """But that of rounding: 66 rad, 100 rad/s, and J of energy."""
    errors = judge(CASES[name], exact_motion(name))
    assert errors.position.largest == 0
    assert errors.energy < 1e-10
    assert errors.slip < 1e-15


def test_the_judge_tells_an_angle_a_slide_a_drift_and_a_speed() -> None:
    motion = exact_motion("rock")
    radius = ROCK.scene.can.radius
    turned = replace(motion, phi=[*motion.phi[:-1], motion.phi[-1] - 0.01])
    assert judge(ROCK, turned).position.phi == pytest.approx(0.01)
    slid = judge(ROCK, replace(motion, u=[*motion.u[:-1], motion.u[-1] + 0.01 * radius]))
    assert (slid.position.u, slid.slip) == pytest.approx((0.01, 0.01 * radius))
    assert judge(ROCK, replace(motion, lateral=[*motion.lateral[:-1], -2e-3])).lateral == 2e-3
    fast = [*motion.phi_dot[:-1], 2 * motion.phi_dot[-1]]
    faster = judge(ROCK, replace(motion, phi_dot=fast))
    assert faster.energy > 0.01
    assert faster.position.largest == 0


def test_what_is_no_motion_is_infinitely_far_and_is_not_stored() -> None:
    motion = exact_motion("rock")
    exploded = replace(motion, u=[math.nan] * 51)
    assert judge(ROCK, exploded).position.largest == math.inf
    found = row(1e-3, math.inf)
    found.judged(exploded, motion)
    assert found.motion is None
    assert found.failure == "the motion explodes"


def test_a_row_that_a_start_aside_changes_says_so() -> None:
    """The second motion is judged from its own start, so that the exact one is exact."""
    motion = exact_motion("rock")
    found = row(1e-3, math.inf)
    late = replace(motion, phi=[phi + 1e-3 for phi in motion.phi])
    found.judged(late, replace(motion, phi=[phi + 1.04e-3 for phi in motion.phi]))
    assert not found.is_sensitive
    found.judged(late, replace(motion, phi=[phi + 1.06e-3 for phi in motion.phi]))
    assert found.is_sensitive


def curve(errors: list[float]) -> list[Row]:
    """Rows of an engine with these errors, one for each timestep."""
    return [row(timestep, error) for timestep, error in zip(TIMESTEPS, errors, strict=True)]


@pytest.mark.parametrize("power", [0.1, 0.3, 1.0, 2.0])
def test_an_order_is_the_power_of_the_timestep(power: float) -> None:
    """A fourth of the timestep takes a quarter off the error if the power is 0.21."""
    order = order_of(curve([timestep**power for timestep in TIMESTEPS]))
    assert order is not None
    assert order.order == pytest.approx(power)
    assert order.converges == (power > 0.21)
    assert order.floor == pytest.approx(1e-4**power)


def test_there_is_a_floor_where_the_last_timestep_does_not_help() -> None:
    """Whatever the power of the timesteps before."""
    rises = order_of(curve([0.4, 0.2, 0.1, 0.01, 0.02]))
    assert rises is not None
    assert not rises.converges
    assert rises.floor == 0.01
    after_an_explosion = order_of(curve([math.inf, math.inf, 80.0, 0.015, 0.014]))
    assert after_an_explosion is not None
    assert not after_an_explosion.converges


def test_the_fall_from_an_explosion_is_no_order() -> None:
    assert order_of(curve([math.inf, math.inf, 80.0, 0.1, 0.01])) is None
    assert order_of(curve([80.0, 40.0, 20.0, 8.0, 2.0])) is not None
    assert order_of([row(1e-3, 1.0), row(1e-4, math.inf)]) is None


def test_labels_that_would_overlap_stand_around_their_mean() -> None:
    assert engine_plot.spread([0.0, 1.0, 1.0, 3.0], 0.5) == [0.0, 0.75, 1.25, 3.0]
    crowded = engine_plot.spread([0.0, 0.01, 0.02, 0.4], 0.3)
    assert np.diff(crowded) == pytest.approx([0.3, 0.3, 0.3])
    assert engine_plot.spread([], 0.1) == []


def test_the_table_marks_what_is_sensitive_and_names_orders_and_floors() -> None:
    found = row(1e-3, 0.0123)
    found.aside_error = 0.0123
    assert engine_tables.error_cell(found) == "0.012"
    found.aside_error = 0.02
    assert engine_tables.error_cell(found) == "0.012*"
    assert engine_tables.error_cell(row(1e-3, math.inf)) == "none"
    falling = order_of([row(timestep, timestep) for timestep in TIMESTEPS])
    assert engine_tables.order_cell(falling) == "h^1.0"
    floored = order_of([row(timestep, 0.3) for timestep in TIMESTEPS])
    assert engine_tables.order_cell(floored) == "floor 0.30"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (3.44e-5, "3.4e-5"),
        (2.4e-4, "0.00024"),
        (0.0996, "0.10"),
        (0.4, "0.40"),
        (7.23, "7.2"),
        (22.4, "22"),
        (1983.0, "2,000"),
        (math.inf, "none"),
    ],
)
def test_a_number_has_two_digits(value: float, text: str) -> None:
    assert number(value) == text


def test_an_engine_has_its_first_default_and_its_closest_setting_in_the_main_table() -> None:
    """And what chooses its own steps, which no timestep is compared with."""
    shown = engine_tables.main_ways(RESULTS)
    names = [engine.name for engine in RESULTS.engines]
    assert list(dict.fromkeys(way.engine for way in shown)) == names
    for name in names:
        of_engine = [way for way in engine_tables.ways(RESULTS) if way.engine == name]
        errors = {
            way: engine_tables.worst_error(RESULTS, way)
            for way in of_engine
            if way.engine != "SciPy" and "error control" not in way.setting
        }
        expected = {way for way in of_engine if way not in errors} | {of_engine[0]}
        if errors:
            expected.add(min(errors, key=errors.__getitem__))
        assert {way for way in shown if way.engine == name} == expected


def test_at_the_defaults_an_engine_has_its_closest_shape() -> None:
    least: dict[str, float] = {}
    for way in engine_tables.ways(RESULTS):
        if way.setting == "default" and way.engine != "SciPy":
            error = engine_tables.worst_error(RESULTS, way)
            least[way.engine] = min(error, least.get(way.engine, math.inf))
    found = engine_tables.closest_defaults(RESULTS)
    assert {
        engine: engine_tables.worst_error(RESULTS, way) for engine, way in found.items()
    } == least
    assert found["PhysX (SAPIEN)"].shape == "capsule"


def test_without_an_engine_there_are_tables_but_no_findings() -> None:
    rows = [stored for stored in RESULTS.rows if stored.engine != "Drake"]
    known = [engine for engine in RESULTS.engines if engine.name != "Drake"]
    without = Results(known, {"drake_can": "pip cannot install drake_can: no wheel"}, rows)
    assert findings.findings(without) == []
    assert findings.answer(without) == (
        "There is no answer without drake_can, which could not be had."
    )
    assert {row[0] for row in engine_tables.errors(without).rows} == {
        engine.name for engine in known
    }
    assert "Left out: drake_can, as pip cannot" in engine_tables.measured(without)


def test_the_answer_is_not_given_for_other_results() -> None:
    """Its sentences name the engines that are closest."""
    close = [
        replace(stored, phi_error=1e-9, u_error=1e-9) if stored.engine == "Pymunk" else stored
        for stored in RESULTS.rows
    ]
    with pytest.raises(ValueError, match="the results are others"):
        findings.answer(Results(RESULTS.engines, {}, close))
    far = [
        replace(stored, phi_error=1.0, u_error=1.0) if stored.engine == "Pymunk" else stored
        for stored in RESULTS.rows
    ]
    with pytest.raises(ValueError, match="the results are others"):
        findings.answer(Results(RESULTS.engines, {}, far))


def test_results_come_back_from_their_file() -> None:
    assert Results(**vars(RESULTS)).json() == RESULTS.json()
