"""The validation table passes row by row, and each kind of row fails on a wrong model or a misprint."""

import dataclasses
import math

import numpy as np
import pytest

from mjbeer import exact, frozen, hoop, simulate, sliding
from mjbeer.model import looks
from mjbeer.paper.frozen import equilibrium_53, frequency_55
from mjbeer.paper.sliding import frequency_10
from mjbeer.studies import convergence
from mjbeer.studies.check import Check, Result
from mjbeer.studies.validation import models, motions
from mjbeer.theory import exact as theory
from mjbeer.theory import trajectory

CHECKS = motions.checks()


@pytest.mark.slow
@pytest.mark.parametrize("check", CHECKS, ids=[f"{check.quantity} - {check.by}" for check in CHECKS])
def test_check(check: Check) -> None:
    result = check.measure()
    assert result.passed, f"{result.error} > {result.bound} {result.unit}"


def test_what_is_not_a_number_does_not_pass() -> None:
    assert not Result("", "", math.nan, 1.0, "", "").passed
    assert Result("", "", 1.0, 1.0, "", "").passed


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


def test_an_order_is_the_slope() -> None:
    steps = np.array([0.4, 0.2, 0.1])
    assert convergence.observed_order(steps, 3 * steps**4) == pytest.approx(4, rel=1e-12)


def test_takeoff_is_the_first_sample_in_the_air() -> None:
    fall = exact(hoop(), np.linspace(0, 0.3, 4), 3.0)
    lifted = dataclasses.replace(fall, lift=np.array([-1e-9, 0.0, 1e-6, 2e-6]))
    assert fall.takeoff() is None
    assert lifted.takeoff() == pytest.approx(math.pi - fall.phi[2])


@pytest.mark.parametrize("fill", models.FILLS)
def test_meshes_converge_as_the_square_of_their_resolution(fill: float) -> None:
    """Halving the edges quarters the error; the next order is within 5 % of it from 64 edges on."""
    coarse, fine = (np.array(models.mesh_errors(fill, resolution)) for resolution in (64, 128))
    assert coarse / fine == pytest.approx(4, rel=0.05)


def test_a_mesh_of_another_fill_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    right = looks.beer
    monkeypatch.setattr(looks, "beer", lambda fill, *rest: right(fill * 1.01, *rest))
    assert min(models.mesh_errors(0.5)) > 1e-3
