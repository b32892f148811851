"""Cans that are carried: against the modes' equations of linear theory, the rigid can's, and what the film shows."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mjbeer import standing
from mjbeer.drawing.film import Film
from mjbeer.drawing.sheet import Sheet
from mjbeer.report.carry import MOVES, Carry, carry, minimum_jerk
from mjbeer.theory.standing import INDICATIVE, QUANTITATIVE

CAN = standing()
TOTAL = CAN.mass + CAN.can.mass
SHAPE = {"rtol": 1e-9, "atol": 1e-12, "max_step": 0.01}


def linear(time: np.ndarray, distance: float, duration: float, modes: int) -> tuple[np.ndarray, np.ndarray]:
    """Force and rise: y'' + 2 gamma omega y' + omega^2 y = -a for each mode, and F = m a + sum(m_n y'')."""
    force, rise = TOTAL * minimum_jerk(time, distance, duration)[1], np.zeros_like(time)
    parts = CAN.frequencies(modes), CAN.damping_ratios(modes), CAN.slosh_masses(modes), CAN.elevations(modes)
    for omega, ratio, mass, elevation in zip(*parts, strict=True):

        def rates(now: float, state: np.ndarray, omega: float = omega, ratio: float = ratio) -> list[float]:
            _, pushed = minimum_jerk(np.array(now), distance, duration)
            return [state[1], -float(pushed) - 2 * ratio * omega * state[1] - omega**2 * state[0]]

        way = solve_ivp(rates, (0, time[-1]), [0, 0], t_eval=time, **SHAPE).y
        # The damper is inside the can: what the pendulum's weight gives is all that the can feels.
        force += mass * np.array([rates(now, state)[1] for now, state in zip(time, way.T, strict=True)])
        rise += elevation * way[0] * omega**2 / CAN.gravity
    return force, rise


@pytest.mark.slow
def test_a_gentle_move_is_linear_theory_s() -> None:
    """At 5 cm in a second the surface rises by 0.05 R: the pendulum's own nonlinearity is its square."""
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
    """As the film and its caption say: less than 0.1 R, and 0.28 R; a tenth more force, a tenth of ringing."""
    quick, gentle = (carry(CAN, duration=duration) for duration in MOVES)
    highest = [np.abs(run.rise).max() for run in (gentle, quick)]
    assert highest[0] < QUANTITATIVE < highest[1] < INDICATIVE
    assert f"{highest[1]:.2f} R" in Carry().caption
    most, ringing = (
        [np.abs(run.force[run.time > start]).max() for run, start in zip((quick, gentle), starts, strict=True)]
        for starts in ((0.0, 0.0), MOVES)
    )
    assert ringing[1] < 0.02 * most[1]
    assert ringing[0] / most[0] == pytest.approx(0.1, abs=0.02)
    assert most[0] / (TOTAL * np.abs(quick.acceleration).max()) == pytest.approx(1.1, abs=0.02)


def test_the_surface_is_drawn_where_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plane that rises behind an accelerating can, whose least and highest point are about that at rest.

    The eye looks 32 degrees down at it, so that a height is seen as 0.84 of itself.
    """
    areas: list[np.ndarray] = []
    monkeypatch.setattr(Sheet, "area", lambda sheet, places, *_, **__: areas.append(places))
    film: Film = Carry()
    seen = []
    for _ in film.plan().draw(np.array([0.0, 0.25]), 960, 540):
        seen.append([area for area in areas if len(area) == 49][-1])  # that of the near can
        areas.clear()
    run = carry(CAN)
    rest, tilted = ((each[24] - each[0])[1] / np.ptp(each[:, 0]) for each in seen)  # left less right
    assert tilted - rest == pytest.approx(0.84 * np.interp(0.25, run.time, run.rise), abs=0.01)
    assert abs(rest) < 0.1
    assert tilted < -0.15
