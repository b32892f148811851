"""A can that is carried: against the modes' equations of linear theory, and the rigid can's."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mjbeer import LiquidWarning, standing
from mjbeer.exceptions import ParameterError
from mjbeer.simulation.carry import carry, minimum_jerk


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


def test_a_surface_that_rises_too_high_warns() -> None:
    with pytest.warns(LiquidWarning, match=r"the surface rises by 0\.8\d radii at the wall: beyond 0\.3"):
        carry(standing(), 0.4, 0.5)


@pytest.mark.parametrize("arguments", [{"distance": 0.0}, {"duration": -1.0}, {"after": math.nan}])
def test_what_is_no_move_is_refused(arguments: dict[str, float]) -> None:
    with pytest.raises(ParameterError, match=next(iter(arguments))):
        carry(standing(), **arguments)


def test_a_move_without_end_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"a move has 1e\+06 timesteps at most, got 2e\+12"):
        carry(standing(), duration=1e9)
