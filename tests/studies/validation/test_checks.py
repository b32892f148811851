"""The validation table passes row by row, and each kind of row fails on a wrong model or a misprint."""

import dataclasses
import math

import numpy as np
import pytest

from mjbeer import Can, Scene, exact, frozen, hoop, pendulum, simulate, sliding
from mjbeer.model import looks
from mjbeer.paper.frozen import equilibrium_53, frequency_55
from mjbeer.paper.sliding import frequency_10
from mjbeer.studies.rows import Row
from mjbeer.studies.validation import models, motions
from mjbeer.studies.validation.run import rows
from mjbeer.theory import exact as theory
from mjbeer.theory import trajectory

ROWS = {f"{row.name} - {row.by}": row for row in rows()}


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_row(row: Row) -> None:
    result = row.result()
    assert result.passed, f"{result.error} > {result.bound} {result.unit}"


def test_rows_are_told_apart() -> None:
    assert len(ROWS) == len(rows())


def test_the_paper_s_frequencies_and_equilibrium_are_theory() -> None:
    """Three roots of a product of a few numbers each."""
    assert frequency_10(sliding()) == pytest.approx(sliding().frequency(), rel=1e-15)
    assert frequency_55(frozen()) == pytest.approx(frozen().frequency(), rel=1e-15)
    assert equilibrium_53(frozen()) == pytest.approx(frozen().equilibrium(), rel=1e-15)


def test_the_misprinted_frequency_is_found_out() -> None:
    assert abs(frequency_55(frozen(), factor=1) / frozen().frequency() - 1) > 0.2


def test_a_wrong_motion_is_found_out() -> None:
    """A gravity 1e-7 too strong shows in phi, in the period and in the acceleration."""
    run = simulate(sliding(gravity=9.81 * (1 + 1e-6)), 4, 1.0)
    wrong = dataclasses.replace(run, scene=sliding())
    assert theory.phi_error(wrong) > 1e-7
    assert abs(2 * math.pi / wrong.frequency() / sliding().period(1.0) - 1) > 1e-9
    steady = simulate(sliding(gravity=9.81 * (1 + 1e-6)), 2, 0.0)
    assert abs(trajectory.mean_acceleration(steady) / sliding().acceleration() - 1) > 1e-10


def test_takeoff_is_the_first_sample_in_the_air() -> None:
    fall = exact(hoop(), np.linspace(0, 0.3, 4), 3.0)
    lifted = dataclasses.replace(fall, lift=np.array([-1e-9, 0.0, 1e-6, 2e-6]))
    assert fall.takeoff() is None
    assert lifted.takeoff() == pytest.approx(math.pi - fall.phi[2])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("quantity", "name", "factor"),
    [("energy that a swing", "energy_per_swing", 1.01), ("rolling down for", "euler_motion", 1.01)],
)
def test_a_wrong_prediction_is_found_out(
    quantity: str, name: str, factor: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = getattr(motions, name)
    monkeypatch.setattr(motions, name, lambda *words: factor * right(*words))
    assert not next(row for told, row in ROWS.items() if told.startswith(quantity)).result().passed


def test_energy_that_obeys_the_other_law_is_found_out() -> None:
    """It drifts in proportion to the number of swings in place of staying within bounds, and the reverse."""
    free = sliding(0.0, can=Can.hoop(mass=1e5))
    assert (motions._drift(free, "RK4", 10)[1] - 1).max() > 0.05
    assert abs(motions._drift_exponent(free, "Euler", 32)) > 0.02


def test_the_fold_has_no_other_exponent() -> None:
    """omega^2, not omega, goes with the root of the distance: the bound is far below the difference."""
    row = ROWS["frequency over distance from the fold: exponent less 1/4 - frozen, reduced, DOP853"]
    assert abs(motions._fold_exponent() - 0.5) > 100 * row.bound


@pytest.mark.parametrize("scene", [sliding(), frozen(), frozen(0.0), pendulum()])
def test_a_fall_takes_longer_by_its_slope(scene: Scene) -> None:
    """Exact periods have two falls and two rises, from one end of the swing or from both."""
    top, rest = scene.separatrix()[1], scene.equilibrium()
    near, far = (scene.period(top - beside - rest) for beside in (1e-7, 1e-5))
    ends = 2 if scene.oscillator.slope == 0 else 1
    assert (near - far) / math.log(1e-2) == pytest.approx(2 * ends * motions.fall_slope(scene), rel=1e-5)


@pytest.mark.parametrize("fill", models.FILLS)
def test_meshes_converge_as_the_square_of_their_resolution(fill: float) -> None:
    """Halving the edges quarters the error; the next order is within 5 % of it from 64 edges on."""
    coarse, fine = (np.array(models.mesh_errors(fill, resolution)) for resolution in (64, 128))
    assert coarse / fine == pytest.approx(4, rel=0.05)


def test_a_mesh_of_another_fill_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    right = looks.beer
    monkeypatch.setattr(looks, "beer", lambda fill, *rest: right(fill * 1.01, *rest))
    assert min(models.mesh_errors(0.5)) > 1e-3
