"""Constraints as usually written have the defaults of MuJoCo."""

import mujoco
import numpy as np
import pytest

from mjbeer import build, frozen
from mjbeer.studies.benchmark.points import STOCK
from mjbeer.studies.benchmark.timing import usual_model


@pytest.mark.parametrize("written", STOCK)
def test_constraints_are_mujoco_s_defaults(written: str) -> None:
    model = usual_model(written, frozen())
    stock = mujoco.MjSpec().option
    kind = "eq" if model.neq else "pair"
    assert getattr(model, f"{kind}_solref")[0].tolist() == [0.02, 1]
    assert getattr(model, f"{kind}_solimp")[0].tolist() == [0.9, 0.95, 0.001, 0.5, 2]
    for name in ("cone", "impratio", "solver", "iterations", "enableflags"):
        assert getattr(model.opt, name) == getattr(stock, name), name
    assert not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_REFSAFE
    assert (model.opt.timestep, model.opt.integrator) == (2e-3, mujoco.mjtIntegrator.mjINT_EULER)
    assert np.array_equal(model.body_mass, build(frozen(), STOCK[written]).body_mass)
