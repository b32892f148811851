"""The results of the can test are those of the stored motions, and their judge can tell motions
apart."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mjbeer.studies.engines import engine_plot, engine_tables
from mjbeer.studies.engines.results import (
    CASES,
    FRICTION,
    TIMESTEPS,
    Motion,
    Results,
    Row,
    judge,
    order_of,
)

RESULTS = Results.load()
ROCK = CASES["rock"]
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
        errors = judge(CASES[stored.case], stored.motion)
        written = (
            stored.phi_error,
            stored.u_error,
            stored.energy_error,
            stored.slip,
            stored.lateral,
        )
        assert written == pytest.approx(errors, rel=RELATIVE, abs=ABSOLUTE), stored.key
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
    assert errors.largest == 0
    assert errors.energy < 1e-10
    assert errors.slip < 1e-15


def test_the_judge_tells_an_angle_a_slide_a_drift_and_a_speed() -> None:
    motion = exact_motion("rock")
    radius = ROCK.scene.can.radius
    turned = replace(motion, phi=[*motion.phi[:-1], motion.phi[-1] - 0.01])
    assert judge(ROCK, turned).phi == pytest.approx(0.01)
    slid = judge(ROCK, replace(motion, u=[*motion.u[:-1], motion.u[-1] + 0.01 * radius]))
    assert (slid.u, slid.slip) == pytest.approx((0.01, 0.01 * radius))
    assert judge(ROCK, replace(motion, lateral=[*motion.lateral[:-1], -2e-3])).lateral == 2e-3
    fast = [*motion.phi_dot[:-1], 2 * motion.phi_dot[-1]]
    faster = judge(ROCK, replace(motion, phi_dot=fast))
    assert faster.energy > 0.01
    assert faster.largest == 0


def test_what_is_no_motion_is_infinitely_far_and_is_not_stored() -> None:
    motion = exact_motion("rock")
    exploded = replace(motion, u=[math.nan] * 51)
    assert judge(ROCK, exploded).largest == math.inf
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


@pytest.mark.parametrize("power", [0.3, 1.0, 2.0])
def test_an_order_is_the_power_of_the_timestep(power: float) -> None:
    order = order_of([row(timestep, timestep**power) for timestep in TIMESTEPS])
    assert order is not None
    assert order.order == pytest.approx(power)
    assert order.converges == (power > 0.5)
    assert order.floor == pytest.approx(1e-4**power)
    assert order_of([row(1e-3, 1.0), row(1e-4, math.inf)]) is None


def test_labels_that_would_overlap_stand_around_their_mean() -> None:
    assert engine_plot.spread([0.0, 1.0, 1.0, 3.0], 0.5) == [0.0, 0.75, 1.25, 3.0]
    crowded = engine_plot.spread([0.0, 0.01, 0.02, 0.4], 0.3)
    assert np.diff(crowded) == pytest.approx([0.3, 0.3, 0.3])
    assert engine_plot.spread([], 0.1) == []


def test_the_table_marks_what_is_sensitive_and_names_orders_and_floors() -> None:
    found = row(1e-3, 0.0123)
    found.aside_error = 0.0123
    assert engine_tables.error_cell(found) == "1.2e-02"
    found.aside_error = 0.02
    assert engine_tables.error_cell(found) == "1.2e-02*"
    falling = order_of([row(timestep, timestep) for timestep in TIMESTEPS])
    assert engine_tables.order_cell(falling) == "h^1.0"
    floored = order_of([row(timestep, 0.3) for timestep in TIMESTEPS])
    assert engine_tables.order_cell(floored) == "floor 3.0e-01"


def test_results_come_back_from_their_file() -> None:
    assert Results(**vars(RESULTS)).json() == RESULTS.json()
