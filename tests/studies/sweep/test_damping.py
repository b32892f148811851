"""Sweeps over damping, drag and liquids: what `simulate` gives to the bit, and reasons where there is no swing."""

import math
import warnings
from functools import partial

import numpy as np
import pytest
from matplotlib import pyplot as plt

import mjbeer
from mjbeer import Can, LiquidWarning, liquid, simulate, sliding
from mjbeer.exceptions import ParameterError
from mjbeer.studies.sweep.plots import label
from mjbeer.studies.sweep.quantities import NO_VALUE, WELL

METAL = Can.sheet_metal()
sweep = partial(mjbeer.sweep, progress=False)


@pytest.mark.parametrize(
    "setting",
    [{"tolerance": 1e-6}, {"integrator": "discrete", "timestep": 2e-3}, {"rolling": "equality", "tolerance": 1e-6}],
)
def test_each_scene_is_that_of_simulate_to_the_bit(setting: dict) -> None:
    """Also where the damping is so stiff that an implicit method takes over."""
    damping = np.geomspace(1e-6, 10, 4)
    swept = sweep(sliding, 0.1, 1.0, can=METAL, damping=damping, drag=[0.0, 1e-3], **setting)
    for index, c in enumerate(damping):
        for place, drag in enumerate((0.0, 1e-3)):
            run = simulate(sliding(can=METAL, damping=c, drag=drag), 0.1, 1.0, times=[0.1], **setting)
            values = [run.phi[-1], run.u[-1], run.error_estimate, run.energy_drift]
            names = ("phi", "u", "error", "energy_drift")
            assert [swept[name][index, place] for name in names] == values


def test_a_liquid_is_swept_over_fill_and_viscosity() -> None:
    swept = sweep(liquid, 0.2, 1.0, tolerance=1e-6, name="olive oil", fill=[0.5, 0.8], viscosity=[1e-6, 1e-5])
    run = simulate(liquid("olive oil", fill=0.8, viscosity=1e-6), 0.2, 1.0, tolerance=1e-6, times=[0.2])
    assert swept["u"][1, 0] == run.u[-1]
    assert [label(name) for name in ("damping", "drag", "viscosity")] == [
        "damping [N m s]",
        "drag [kg/m]",
        "viscosity [m^2/s]",
    ]


def test_a_period_needs_a_swing_and_says_so() -> None:
    """Without steady rolling there is nothing to swing about."""
    swept = sweep(
        sliding, 2.0, 0.1, tolerance=1e-6, quantity="period", damping=[1e-6, 1e-4], incline=np.radians([5, 60])
    )
    assert swept["status"].tolist() == [[WELL, NO_VALUE]] * 2
    assert np.isnan(swept["period"][:, 1]).all()
    assert np.isfinite(swept["phi"]).all()
    assert [failure.reason.split(":")[1] for failure in swept.failed] == [
        " no steady rolling at an incline of 60 degrees"
    ] * 2
    # While the can gains speed, its load swings about a tilt between that without damping and that of steady rolling.
    free, steady = (2 * math.pi / sliding(math.radians(5), damping=c).frequency() for c in (0.0, 1e-4))
    assert free < swept["period"][1, 0] < steady


def test_a_load_that_creeps_back_has_no_period() -> None:
    heavy = Can.hoop(0.033, 0.12, 100.0)
    creeping = sliding(can=heavy, damping=0.02, incline=0.0)
    with pytest.raises(mjbeer.MjbeerError, match="creeps back"):
        creeping.frequency()
    swept = sweep(sliding, 0.5, 1.0, tolerance=1e-6, quantity="period", can=heavy, damping=[0.02], incline=0.0)
    assert swept["status"].tolist() == [NO_VALUE]
    assert np.isfinite(swept["phi"]).all()
    assert "no frequency: the load creeps back without a swing" in swept.failed[0].reason


def test_damping_that_is_not_allowed_is_refused_with_its_index() -> None:
    with pytest.raises(ParameterError, match=r"damping\[1\]: damping must be 0 or greater \[N m s\], got -1.0"):
        sweep(sliding, 0.1, 1.0, tolerance=1e-6, damping=[0.0, -1.0])


def test_thick_liquids_warn_once() -> None:
    with pytest.warns(LiquidWarning, match="honey as one lump .* it coats the can") as told:
        sweep(liquid, 0.01, 1.0, tolerance=1e-6, name="honey", fill=[0.4, 0.5, 0.6])
    assert len(told) == 1
    show = warnings.showwarning
    with warnings.catch_warnings(action="error", category=LiquidWarning), pytest.raises(LiquidWarning):
        sweep(liquid, 0.01, 1.0, tolerance=1e-6, name="honey", fill=[0.4, 0.5])
    assert warnings.showwarning is show


def test_a_map_over_decades_is_logarithmic() -> None:
    """Its cells are around their values, and a parameter in even steps stays as it is."""
    damping, inclines = np.geomspace(1e-4, 1e-2, 3), np.radians([5.0, 10.0, 15.0])
    axes = sweep(sliding, 0.01, 1.0, tolerance=1e-6, damping=damping, incline=inclines).plot("u")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")
    assert axes.get_xlim() == pytest.approx((10**-4.5, 10**-1.5))
    assert axes.get_ylim() == pytest.approx((2.5, 17.5))
    assert axes.get_xlabel() == "damping [N m s]"
    axes = sweep(sliding, 0.01, 1.0, tolerance=1e-6, damping=[1e-4, 2e-3, 1e-2]).plot("u")
    assert axes.get_xscale() == "linear"
    plt.close("all")
