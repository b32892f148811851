"""The key figures of a run: as text and as JSON, and the friction that a real can would need."""

import json
import math

import numpy as np
import pytest

from mjbeer import Damping, Trajectory, exact, frozen, hoop, simulate, sliding
from mjbeer.cli.figures import Figures
from mjbeer.simulation.run import Run
from mjbeer.theory.scene import Scene

# Let go with the beer on top, the can hops at 0.834 s; before, rolling needs ever more friction, 1.839 within 0.8 s.
START, SHORT, LONG = math.pi, 0.8, 0.9


def lines(trajectory: Trajectory, friction: float = 1.0) -> dict[str, str]:
    rows = [line.split("  ", 1) for line in Figures(trajectory, friction).text().splitlines()]
    return {name: value.strip() for name, value in rows}


def test_the_text_says_what_a_run_says_about_itself() -> None:
    run = simulate(frozen(), 0.5, 1.0, rolling="contact")
    text = lines(run)
    assert text["rolling, integrator"] == "contact, RK4"
    assert text["samples"] == "501 to t = 0.5 s"
    assert text["phi at the end"] == f"{math.degrees(run.phi[-1]):.9g} degrees"
    assert text["u at the end"] == f"{run.u[-1]:.9g} m"
    assert text["energy drift"].startswith(f"{run.energy_drift:.2e} of ")
    assert text["lift, lowest and highest"] == f"{run.lift.min() / 0.033:.2e}, {run.lift.max() / 0.033:.2e} radii"
    assert text["normal force needed"] == f"{run.forces.normal.min():.4g} to {run.forces.normal.max():.4g} N"
    assert text["estimated error of phi and u/a"] == f"{run.error_estimate:.2e} rad"
    assert text["trusted"] == "yes"
    assert lines(simulate(frozen(), SHORT, START, timestep=0.02))["trusted"] == "no"


def test_the_drift_of_a_full_can_is_a_share_of_what_gravity_gives() -> None:
    """Its load neither swings nor turns. From rest m g u sin(alpha) is all the kinetic energy that it has."""
    run = simulate(sliding(fill=1.0), 2.0, 1.0)
    gained = run.scene.mass * run.scene.gravity * np.sin(run.scene.incline) * (run.u - run.u[0]).max()
    drift = run.energy_drift
    # 2,000 steps add up as many roundings, in the velocity and so twice in its square.
    assert drift == pytest.approx(np.abs(run.energy - run.energy[0]).max() / gained, rel=1e-9)
    assert drift < 2 * 2000 * np.finfo(float).eps
    assert lines(run)["energy drift"] == f"{drift:.2e} of the largest kinetic energy"


def test_the_text_fits_in_80_columns() -> None:
    for run in (
        simulate(frozen(), SHORT, START, timestep=0.02),
        exact(hoop(), np.linspace(0, 0.5, 1001), 3.0),
        simulate(sliding(damping=Damping(1.2345e-5, 1.2345e-5), drag=1.2345e-5), 0.1, 1.0),
    ):
        assert max(len(line) for line in Figures(run, 0.123456).text().splitlines()) <= 80


def test_the_text_has_the_estimated_error_of_a_tolerance() -> None:
    run = simulate(frozen(), 0.5, 1.0, tolerance=1e-9)
    assert lines(run)["estimated error of phi and u/a"] == f"{run.error_estimate:.2e} rad"


def test_a_damped_run_has_its_steady_rolling_and_its_modes() -> None:
    scene = sliding(damping=1e-3)
    run = simulate(scene, 0.1, 1.0)
    text, content = lines(run), json.loads(Figures(run).json())
    assert text["damping torque over slip rate"] == "0.001 N m s"
    tilt = math.degrees(scene.terminal_tilt())
    assert text["steady rolling"] == f"{scene.terminal_speed():.6g} m/s, the load at phi = {tilt:.6g} degrees"
    assert text["its modes exp(s t), s"] == "-4.76, -2.2 +- 17.96i 1/s"
    assert content["terminal speed [m/s]"] == scene.terminal_speed()
    assert content["terminal tilt [degrees]"] == tilt
    assert [complex(*root) for root in content["modes, real and imaginary parts [1/s]"]] == scene.modes().tolist()


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (sliding(incline=0.7, damping=1e-3, drag=1e-3), "no steady rolling at an incline of 40.11 degrees"),
        (sliding(fill=1.0, damping=1e-3), "nothing restores the load"),
        (sliding(gravity=0.0, drag=1e-3), "nothing restores the load"),
    ],
)
def test_a_damped_run_without_steady_rolling_says_why(scene: Scene, reason: str) -> None:
    run = simulate(scene, 0.1, 1.0)
    text, content = lines(run), json.loads(Figures(run).json())
    assert text["steady rolling"].startswith(reason)
    assert "its modes exp(s t), s" not in text
    assert content["terminal speed [m/s]"] is content["modes, real and imaginary parts [1/s]"] is None
    assert len(text["steady rolling"]) <= 80 - 32


def test_a_run_without_damping_has_no_such_figures() -> None:
    run = simulate(sliding(), 0.1, 1.0)
    assert "steady rolling" not in lines(run)
    assert "terminal speed [m/s]" not in json.loads(Figures(run).json())


def test_a_motion_of_theory_has_no_estimated_error() -> None:
    motion = exact(frozen(), np.linspace(0, 0.5, 51), 1.0)
    assert "estimated error of phi and u/a" not in lines(motion)
    assert json.loads(Figures(motion).json())["estimated error of phi and u/a [rad]"] is None


def test_the_friction_needed_is_that_of_all_steps_and_not_of_the_samples() -> None:
    run = simulate(frozen(), SHORT, START, times=np.array([0.0, SHORT]), integrator="DOP853")
    assert run.record.needed > run.forces.needed.max()
    assert lines(run)["friction coefficient needed"] == f"{run.record.needed:.4g} to roll to the end without slipping"


@pytest.mark.parametrize("friction", [0.6, 1.0, 1.8, 2.0])
def test_until_when_a_can_rolls_with_a_friction(friction: float) -> None:
    """Beside the exact motion: at that time it needs the coefficient that was given. It needs 1.839 at most."""
    run = simulate(frozen(), SHORT, START, tolerance=1e-10)
    until = Figures(run, friction).rolls_until[friction]
    said = lines(run, friction)[f"with a coefficient of {friction:g}"]
    if friction == 2.0:
        assert until == math.inf
        assert said == "can roll to the end"
        return
    assert said == f"can roll until t = {until:.6g} s"
    # The time is interpolated between steps on a straight line: the coefficient is off by up to a thousandth.
    assert exact(frozen(), [until], START).forces.needed[0] == pytest.approx(friction, rel=1e-3)


def test_the_friction_of_1_is_always_there_and_once() -> None:
    run = simulate(frozen(), SHORT, START, tolerance=1e-6)
    assert list(Figures(run, 0.5).rolls_until) == [0.5, 1.0]
    assert list(Figures(run, 1.0).rolls_until) == [1.0]


def test_a_can_that_needs_no_more_is_not_simulated_again(monkeypatch: pytest.MonkeyPatch) -> None:
    run = simulate(frozen(), 0.5, 1.0)
    monkeypatch.setattr(Run, "rolls_until", lambda *_: pytest.fail("it was simulated again"))
    assert run.record.needed < 0.5
    assert Figures(run, 0.5).rolls_until == {0.5: math.inf, 1.0: math.inf}


def test_where_the_incline_would_have_to_pull_no_friction_is_enough() -> None:
    run = simulate(frozen(), LONG, START, tolerance=1e-10)
    assert lines(run)["friction coefficient needed"] == f"none is enough: N < 0 from t = {run.rolls_until():.6g} s"
    content = json.loads(Figures(run).json(), parse_constant=pytest.fail)
    assert content["friction coefficient needed"] is None


def test_without_weight_nothing_presses_the_can_on_the_incline() -> None:
    run = simulate(frozen(gravity=0.0), 0.1, 1.0)
    assert lines(run)["friction coefficient needed"].endswith("(N = 0)")


def test_a_note_says_when_a_real_can_would_slip() -> None:
    run = simulate(frozen(), SHORT, START, tolerance=1e-10)
    weak, usual = Figures(run, 0.6).rolls_until.values()
    assert Figures(run, 0.6).notes == (
        f"a real can would slip from t = {weak:.6g} s with a friction coefficient of 0.6, "
        f"from t = {usual:.6g} s with a friction coefficient of 1",
    )
    assert run.trusted  # the motion is right, if the can rolls


def test_there_is_no_note_without_reason() -> None:
    assert Figures(simulate(frozen(), 0.5, 1.0)).notes == ()
    assert Figures(simulate(sliding(), 0.5, 1.0), 0.01).notes == ()  # a massless can needs no friction
    contact = simulate(hoop(), 0.1, 1.0, rolling="contact", friction=0.05)
    assert Figures(contact, 0.05).notes == ()  # it slips of itself
    assert any("slips" in warning for warning in contact.warnings)


def test_json_has_the_figures_with_their_units() -> None:
    run = simulate(hoop(), 0.1, 1.0, rolling="contact", friction=0.05)
    content = json.loads(Figures(run, 0.05).json(), parse_constant=pytest.fail)
    slip, lift, radius = run.slip, run.lift, run.scene.can.radius
    until = Figures(run, 0.05).rolls_until
    assert content == {
        "rolling": "contact",
        "integrator": "RK4",
        "timestep [s]": 1e-3,
        "samples": 101,
        "end [s]": run.time[-1],
        "phi at the end [degrees]": math.degrees(run.phi[-1]),
        "u at the end [m]": run.u[-1],
        "energy drift": run.energy_drift,
        "largest slip [radii]": np.abs(slip / radius).max(),
        "final slip [radii]": slip[-1] / radius,
        "lowest lift [radii]": lift.min() / radius,
        "highest lift [radii]": lift.max() / radius,
        "least normal force needed [N]": run.forces.normal.min(),
        "largest normal force needed [N]": run.forces.normal.max(),
        "friction coefficient needed": run.record.needed,
        "estimated error of phi and u/a [rad]": run.error_estimate,
        "can roll without slipping": [
            {"friction coefficient": friction, "to the end": end, "until [s]": None if end else until[friction]}
            for friction, end in ((0.05, False), (1.0, until[1.0] == math.inf))
        ],
        "trusted": False,
        "warnings": list(run.warnings),
        "notes": [],
    }
