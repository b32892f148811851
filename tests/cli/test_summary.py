"""The key figures of a run: as text and as JSON, and the friction that a real can would need."""

import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mjbeer import Scene, exact, frozen, hoop, liquid, simulate, sliding
from mjbeer.cli.motions import Summary
from mjbeer.simulation.run import Run

START = math.pi
"""The beer is on top. The can hops at 0.834 s, and before that needs ever more friction to roll."""
SHORT = 0.8
"""A duration [s] without the hop; the largest friction coefficient needed in it is 1.839."""
LONG = 0.9
"""A duration [s] with the hop."""


def lines(trajectory: Run, friction: float = 1.0) -> dict[str, str]:
    """Return the text of the summary, by the names at the beginning of its lines."""
    text = Summary(trajectory, friction).text()
    return {line[:31].strip(): line[32:] for line in text.splitlines()}


def content(trajectory: Run, friction: float = 1.0) -> dict[str, Any]:
    """Return the JSON of the summary."""
    return json.loads(Summary(trajectory, friction).json(), parse_constant=pytest.fail)


def test_text_and_json_have_what_a_run_says_about_itself() -> None:
    run = simulate(hoop(), 0.1, 1.0, rolling="contact", friction=0.05)
    slip = run.slip / run.scene.can.radius
    lift = run.lift / run.scene.can.radius
    expected = {
        "phi at the end [degrees]": math.degrees(run.phi[-1]),
        "u at the end [m]": run.u[-1],
        "largest slip [radii]": np.abs(slip).max(),
        "final slip [radii]": slip[-1],
        "lowest lift [radii]": lift.min(),
        "highest lift [radii]": lift.max(),
        "least normal force needed [N]": run.forces.normal.min(),
        "largest normal force needed [N]": run.forces.normal.max(),
        "can roll without slipping until [s]": run.rolls_until(0.05),
        "warnings": list(run.warnings),
        # In contact the can simply slips, and a warning says so.
        "notes": [],
    }

    figures = content(run, 0.05)

    assert {name: figures[name] for name in expected} == expected
    text = lines(run, 0.05)
    assert text["phi at the end"] == f"{math.degrees(run.phi[-1]):.9g} degrees"
    error = figures["estimated error of phi and u/a [rad]"]
    assert text["estimated error of phi and u/a"] == f"{error:.2e} rad"


@pytest.mark.parametrize(
    ("scene", "takes"), [(frozen(), False), (liquid(), True), (sliding(drag=1e-3), True)]
)
def test_what_damping_and_drag_take_is_no_drift(scene: Scene, takes: bool) -> None:
    run = simulate(scene, 0.5, 1.0, tolerance=1e-6)

    assert ("energy drift" not in lines(run)) is takes
    assert (content(run)["energy drift"] is None) is takes


@pytest.mark.parametrize(
    ("make", "friction", "solved", "holds"),
    [
        (lambda: simulate(frozen(), 0.5, 1.0), 1.0, True, True),
        (lambda: simulate(frozen(), 0.5, 1.0, integrator="Euler", timestep=4e-3), 1.0, False, True),
        (lambda: simulate(frozen(), SHORT, START), 1.8, True, False),  # it would slip
        (lambda: simulate(frozen(), SHORT, START), 2.0, True, True),
        (lambda: simulate(frozen(), LONG, START), 2.0, True, False),  # it would leave the incline
        (lambda: simulate(frozen(), 0.5, 1.0, rolling="contact", friction=0.05), 0.05, True, False),
        (lambda: simulate(liquid(), 1.0, 0.5, tolerance=1e-6), 1.0, True, False),  # it is no lump
    ],
)
def test_how_well_equations_are_solved_is_one_thing_and_whether_they_hold_another(
    make: Callable[[], Run], friction: float, solved: bool, holds: bool
) -> None:
    run = make()

    figures = content(run, friction)
    text = lines(run, friction)

    assert figures["equations solved"] == solved
    assert figures["model holds"] == holds
    assert text["equations solved"] == ("yes" if solved else "no")
    assert text["model holds"] == ("yes" if holds else "no")


def test_a_damped_run_has_its_steady_rolling_and_its_modes() -> None:
    scene = sliding(damping=1e-3)
    run = simulate(scene, 0.1, 1.0)
    modes = "modes, real and imaginary parts"

    figures = content(run)

    assert lines(run)[modes] == "-4.76, -2.2-17.96j, -2.2+17.96j 1/s"
    assert [complex(*root) for root in figures[f"{modes} [1/s]"]] == scene.modes().tolist()
    assert figures["terminal speed [m/s]"] == scene.terminal_speed()
    assert figures["terminal tilt [degrees]"] == math.degrees(scene.terminal_tilt())


def test_a_damped_run_says_why_it_has_no_steady_rolling() -> None:
    full = simulate(sliding(fill=1.0, damping=1e-3), 0.1, 1.0)

    assert lines(full)["terminal speed"].startswith("nothing restores")


@pytest.fixture(scope="module")
def precise() -> Run:
    """A run without the hop; its motion is right if the can rolls."""
    run = simulate(frozen(), SHORT, START, tolerance=1e-10)
    assert run.trusted
    return run


@pytest.mark.parametrize("friction", [0.6, 1.8])
def test_until_when_a_can_rolls_with_a_friction(friction: float, precise: Run) -> None:
    """At that time the exact motion needs the coefficient that was given.

    The time is interpolated linearly between steps: near the largest coefficient this makes an
    error of up to 0.0013.
    """
    summary = Summary(precise, friction)

    until = summary.rolls_until
    (note,) = summary.notes
    assert f"until t = {until:.6g} s with friction {friction:g}\n" in summary.text()
    assert f"from t = {until:.6g} s with a friction coefficient of {friction:g}" in note
    (needed,) = exact(frozen(), [until], START).forces.needed_friction
    assert needed == pytest.approx(friction, rel=2e-3)


def test_a_can_rolls_to_the_end_with_more_friction_than_it_needs(precise: Run) -> None:
    summary = Summary(precise, 2.0)

    assert summary.rolls_until == math.inf
    assert content(precise, 2.0)["can roll without slipping until [s]"] is None
    assert "until the end with friction 2\n" in summary.text()


def test_where_the_incline_would_have_to_pull_no_friction_is_enough() -> None:
    run = simulate(frozen(), LONG, START, tolerance=1e-10)

    words = f"none is enough: N < 0 from t = {run.rolls_until():.6g} s"
    assert lines(run)["friction coefficient needed"] == words
    assert content(run)["friction coefficient needed"] is None


def test_where_nothing_presses_the_can_no_friction_is_enough() -> None:
    weightless = simulate(frozen(gravity=0.0), 0.1, 1.0)

    assert lines(weightless)["friction coefficient needed"].endswith("(N = 0)")
