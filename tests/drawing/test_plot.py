"""A plot of a motion: what it shows, beside exact theory, and where rolling would be impossible."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from matplotlib import pyplot as plt

from mjbeer import exact, frozen, simulate, sliding
from mjbeer.exceptions import ParameterError


@pytest.fixture(autouse=True)
def _closed_figures() -> Iterator[None]:
    """Close all figures at the end of a test."""
    yield
    plt.close("all")


def test_a_plot_shows_phi_and_u_on_top_of_exact_theory() -> None:
    run = simulate(frozen(), 1.0, 1.0)

    above, below = run.plot(theory=True)

    theory, simulated = above.get_lines()
    expected = exact(run.scene, theory.get_xdata(), 1.0)
    assert np.array_equal(simulated.get_ydata(), np.degrees(run.phi))
    assert np.array_equal(theory.get_ydata(), np.degrees(expected.phi))
    assert np.array_equal(below.get_lines()[1].get_ydata(), run.u)

    legend = above.get_legend()
    assert legend
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["exact theory", "MuJoCo"]
    assert above.get_ylabel() == "φ [°]"
    assert below.get_ylabel() == "u [m]"
    assert below.get_xlabel() == "time [s]"
    assert above.figure.get_suptitle() == "half-full massless can, beer frozen, incline 10°"


def test_a_plot_shows_what_is_asked_for() -> None:
    run = simulate(frozen(), 0.2, 1.0)

    rate, energy = run.plot("phi_dot", "energy", theory=True)

    assert np.array_equal(rate.get_lines()[1].get_ydata(), np.degrees(run.phi_dot))
    assert np.array_equal(energy.get_lines()[1].get_ydata(), run.energy)


def test_an_energy_that_is_conserved_looks_constant() -> None:
    """One that damping takes does not."""
    run = exact(sliding(), np.linspace(0, 1, 101), 1.0)
    drifted = replace(run, phi_dot=run.phi_dot * (1 + 1e-6 * run.time))
    change = np.ptp(drifted.energy)
    damped = exact(sliding(damping=1e-3), np.linspace(0, 1, 101), 1.0)

    (constant,) = drifted.plot("energy")
    (falling,) = damped.plot("energy")

    assert np.ptp(constant.get_ylim()) > 1000 * change
    assert [text.get_text() for text in constant.texts] == [f"constant within {change:.0e} J"]
    assert np.ptp(falling.get_ylim()) < 1.2 * np.ptp(damped.energy)
    assert not falling.texts


@pytest.mark.parametrize("name", ["ph", True])
def test_a_quantity_that_does_not_exist_is_refused(name: str) -> None:
    run = exact(frozen(), [0.0, 0.1], 1.0)

    with pytest.raises(ParameterError, match=r"quantity must be one of 'phi', 'u', .*'energy'; "):
        run.plot(name)


def test_what_would_need_the_incline_to_pull_is_dotted() -> None:
    """From the top, rolling is possible until N = 0, after 0.834 s."""
    rolling = exact(frozen(), np.linspace(0, 1, 1001), math.pi)

    panels = rolling.plot()

    for axes in panels:
        rolls, pulled = axes.get_lines()
        last_of_rolls = np.asarray(rolls.get_xdata())[-1]
        first_of_pulled = np.asarray(pulled.get_xdata())[0]
        assert last_of_rolls < 0.8339 < first_of_pulled < 0.836
        assert rolls.get_linestyle() == "-"
        assert pulled.get_linestyle() == ":"
    legend = panels[0].get_legend()
    assert legend
    assert len(legend.get_texts()) == 2


def test_a_can_in_contact_leaves_the_incline_by_itself_and_is_not_dotted() -> None:
    hops = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=1e-3)

    above, _ = hops.plot()

    (line,) = above.get_lines()
    assert line.get_linestyle() == "-"
