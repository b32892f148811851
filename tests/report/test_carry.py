"""Cans that are carried, against linear theory, a rigid can, and what the film shows."""

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mjbeer import standing
from mjbeer.drawing.film import Film
from mjbeer.drawing.sheet import Sheet
from mjbeer.report import carry as carried_cans
from mjbeer.report.carry import MOVES, Carried, Carry, minimum_jerk
from mjbeer.theory.standing import INDICATIVE, QUANTITATIVE

CAN = standing()
TOTAL = CAN.mass + CAN.can.mass
SHAPE = {"rtol": 1e-9, "atol": 1e-12, "max_step": 0.01}
carry = cache(carried_cans.carry)


def linear(
    time: np.ndarray, distance: float, duration: float, modes: int
) -> tuple[np.ndarray, np.ndarray]:
    """Force and rise by linear theory.

    Each mode has y'' + 2 gamma omega y' + omega^2 y = -a, and F = m a + sum(m_n y'').
    """
    _, acceleration = minimum_jerk(time, distance, duration)
    force = TOTAL * acceleration
    rise = np.zeros_like(time)
    for mode in range(modes):
        omega = CAN.frequencies(modes)[mode]
        damping = 2 * CAN.damping_ratios(modes)[mode] * omega

        def y_ddot(
            now: float, y: float, y_dot: float, omega: float = omega, damping: float = damping
        ) -> float:
            _, a = minimum_jerk(np.array(now), distance, duration)
            return -float(a) - damping * y_dot - omega**2 * y

        def rates(
            now: float, state: np.ndarray, y_ddot: Callable[..., float] = y_ddot
        ) -> list[float]:
            return [state[1], y_ddot(now, *state)]

        y, y_dot = solve_ivp(rates, (0, time[-1]), [0, 0], t_eval=time, **SHAPE).y
        # The damper is inside the can: what the pendulum's weight gives is all that the can feels.
        force += CAN.slosh_masses(modes)[mode] * np.array(list(map(y_ddot, time, y, y_dot)))
        rise += CAN.elevations(modes)[mode] * y * omega**2 / CAN.gravity
    return force, rise


@pytest.mark.slow
def test_a_gentle_move_is_linear_theory_s() -> None:
    """At 5 cm in a second the surface rises by 0.05 R.

    The pendulum's own nonlinearity is its square.
    """
    run = carry(standing(modes=3), 0.05, 1.0)
    force, rise = linear(run.time, 0.05, 1.0, 3)
    assert np.abs(run.force - force).max() < 5e-3 * np.abs(force).max()
    assert np.abs(run.rise - rise).max() < 5e-3 * np.abs(rise).max()


def test_a_rigid_can_takes_its_mass_times_the_acceleration() -> None:
    run = carry(standing(modes=0), 0.4, 1.0, 0.1)
    assert run.force == pytest.approx(TOTAL * run.acceleration, abs=1e-12)
    assert not run.rise.any()
    assert run.place[-1] == pytest.approx(0.4)
    assert np.abs(run.acceleration).max() == pytest.approx(0.4 * 10 / math.sqrt(3), rel=1e-5)


def test_of_the_two_moves_one_is_where_linear_theory_gives_numbers() -> None:
    """As the film and its caption say: less than 0.1 R, and 0.28 R, in mm.

    A tenth more force, a tenth of ringing.
    """
    quick, gentle = (carry(CAN, duration=move.duration) for move in MOVES)
    high = np.abs(quick.rise).max()
    assert np.abs(gentle.rise).max() < QUANTITATIVE < high < INDICATIVE
    solid = TOTAL * np.abs(quick.acceleration).max()
    for rise in (QUANTITATIVE, np.abs(gentle.rise).max(), high):
        assert f" {1e3 * CAN.can.radius * rise:.1f} mm" in Carry().caption
    for force in (solid, largest_force(quick)):
        assert f" {force:.2f} N" in Carry().caption
    after_quick, after_gentle = (move.duration for move in MOVES)
    assert largest_force(gentle, after_gentle) < 0.02 * largest_force(gentle)
    ringing = largest_force(quick, after_quick) / largest_force(quick)
    assert ringing == pytest.approx(0.1, abs=0.02)
    assert largest_force(quick) / solid == pytest.approx(1.1, abs=0.02)


def largest_force(run: Carried, after: float = 0.0) -> float:
    return np.abs(run.force[run.time > after]).max()


def test_the_surface_is_drawn_where_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plane, at rest level, that rises behind a can that accelerates.

    The eye looks 32 degrees down at it, so that a height is seen as 0.84 of itself; in the close-up
    it looks 8 degrees down.
    """
    areas: list[np.ndarray] = []
    monkeypatch.setattr(Sheet, "area", lambda sheet, places, *_, **__: areas.append(places))
    film: Film = Carry()
    tilts = []
    for _ in film.plan().draw(np.array([0.0, 0.25]), 960, 540):
        _, near, close_up, _ = (area for area in areas if len(area) == 49)
        tilts.append([tilt(near), tilt(close_up)])
        areas.clear()
    run = carry(CAN)
    rise = np.interp(0.25, run.time, run.rise)
    rest, tilted = np.array(tilts)
    assert tilted - rest == pytest.approx(np.array([0.84, 0.99]) * rise, abs=0.01)
    assert np.abs(rest).max() < 0.1
    assert tilted.max() < -0.15


def tilt(surface: np.ndarray) -> float:
    """Return how much higher the right end of a surface is seen than the left, of its width."""
    return float((surface[24] - surface[0])[1] / np.ptp(surface[:, 0]))
