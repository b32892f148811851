"""Cans that are carried: against the modes' equations of linear theory, the rigid can's, and what the film shows."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mjbeer import standing
from mjbeer.drawing.film import Film
from mjbeer.report.carry import GENTLE, QUICK, Carry, carry, minimum_jerk
from mjbeer.theory.standing import INDICATIVE, QUANTITATIVE


def linear(time: np.ndarray, distance: float, duration: float, modes: int) -> tuple[np.ndarray, np.ndarray]:
    """Force and rise: y'' + 2 gamma omega y' + omega^2 y = -a for each mode, and F = m a + sum(m_n y'')."""
    can = standing()
    force = (can.mass + can.can.mass) * minimum_jerk(time, distance, duration)[1]
    rise = np.zeros_like(time)
    parts = can.frequencies(modes), can.damping_ratios(modes), can.slosh_masses(modes), can.elevations(modes)
    for omega, ratio, mass, elevation in zip(*parts, strict=True):

        def rates(now: float, state: np.ndarray, omega: float = omega, ratio: float = ratio) -> list[float]:
            _, pushed = minimum_jerk(np.array(now), distance, duration)
            return [state[1], -float(pushed) - 2 * ratio * omega * state[1] - omega**2 * state[0]]

        way = solve_ivp(rates, (0, time[-1]), [0, 0], t_eval=time, rtol=1e-9, atol=1e-12, max_step=0.01).y
        # The damper is inside the can: what the pendulum's weight gives is all that the can feels.
        force += mass * np.array([rates(now, state)[1] for now, state in zip(time, way.T, strict=True)])
        rise += elevation * way[0] * omega**2 / can.gravity
    return force, rise


@pytest.mark.slow
def test_a_gentle_move_is_linear_theory_s() -> None:
    """At 5 cm in a second the surface rises by 0.05 R: the pendulum's own nonlinearity is its square."""
    run = carry(standing(modes=3), 0.05, 1.0)
    force, rise = linear(run.time, 0.05, 1.0, 3)
    assert np.abs(run.force - force).max() < 5e-3 * np.abs(force).max()
    assert np.abs(run.rise - rise).max() < 5e-3 * np.abs(rise).max()


def test_a_rigid_can_takes_its_mass_times_the_acceleration() -> None:
    can = standing(modes=0)
    run = carry(can, 0.4, 1.0, 0.1)
    assert run.force == pytest.approx((can.mass + can.can.mass) * run.acceleration, abs=1e-12)
    assert not run.rise.any()
    assert run.place[-1] == pytest.approx(0.4)
    assert np.abs(run.acceleration).max() == pytest.approx(0.4 * 10 / math.sqrt(3), rel=1e-5)


def test_of_the_two_moves_one_is_where_linear_theory_gives_numbers() -> None:
    """As the film and its caption say: less than 0.1 R, and 0.28 R; a tenth more force, a tenth of ringing."""
    runs = {move: carry(standing(), duration=move.duration) for move in (QUICK, GENTLE)}
    highest = {move: np.abs(run.rise).max() for move, run in runs.items()}
    ringing = {move: np.abs(run.force[run.time > move.duration]).max() for move, run in runs.items()}
    assert highest[GENTLE] < QUANTITATIVE < highest[QUICK] < INDICATIVE
    assert f"{highest[QUICK]:.2f} R" in Carry().caption
    assert ringing[GENTLE] < 0.02 * np.abs(runs[GENTLE].force).max()
    most, solid = np.abs(runs[QUICK].force).max(), np.abs(runs[QUICK].acceleration).max() * total()
    assert ringing[QUICK] / most == pytest.approx(0.1, abs=0.02)
    assert most / solid == pytest.approx(1.1, abs=0.02)


def total() -> float:
    """Mass of can and beer."""
    return standing().mass + standing().can.mass


@pytest.mark.draws
def test_the_surface_rises_behind_an_accelerating_can() -> None:
    film: Film = Carry()
    plan = film.plan()
    first, pushed = plan.draw(np.array([0.0, 0.25]), 960, 540)
    rest, tilted = (highest(picture) for picture in (first, pushed))
    assert abs(rest[0] - rest[1]) <= 1
    assert tilted[0] < tilted[1] - 2


def highest(picture: np.ndarray) -> tuple[int, int]:
    """Highest rows with beer of the near can, in the left and in the right third of its width."""
    amber = (picture[..., 0] > 1.3 * picture[..., 1].astype(int)) & (picture[..., 1] > 2 * picture[..., 2].astype(int))
    rows, columns = np.nonzero(amber)
    there = np.unique(rows)
    near = rows > there[np.diff(there).argmax()]  # below the gap between the two cans
    third = np.ptp(columns[near]) / 3
    left, right = columns < columns[near].min() + third, columns > columns[near].max() - third
    return int(rows[near & left].min()), int(rows[near & right].min())
