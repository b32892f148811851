"""How soft constraints are: as hard as MuJoCo takes them, and as usually written they have MuJoCo's defaults."""

import mujoco
import numpy as np
import pytest

from mjbeer import build, frozen
from mjbeer.model.joints import initial_state
from mjbeer.studies.benchmark.points import USUAL
from mjbeer.studies.benchmark.timing import usual_model
from tests.support.rows import applied_share


@pytest.mark.parametrize("written", USUAL)
def test_constraints_are_mujoco_s_defaults(written: str) -> None:
    model, stock = usual_model(written, frozen()), mujoco.MjSpec().option
    kind = "eq" if model.neq else "pair"
    assert getattr(model, f"{kind}_solref")[0].tolist() == [0.02, 1]
    assert getattr(model, f"{kind}_solimp")[0].tolist() == [0.9, 0.95, 0.001, 0.5, 2]
    for name in ("cone", "impratio", "solver", "iterations", "enableflags"):
        assert getattr(model.opt, name) == getattr(stock, name), name
    assert not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_REFSAFE
    assert (model.opt.timestep, model.opt.integrator) == (2e-3, mujoco.mjtIntegrator.mjINT_EULER)
    assert np.array_equal(model.body_mass, build(frozen(), USUAL[written]).body_mass)


def started(model: mujoco.MjModel) -> tuple[mujoco.MjData, float]:
    """The frozen can on its way, as MuJoCo sees it, and the share of a hard constraint's force that it has there."""
    data, at = mujoco.MjData(model), initial_state(model, frozen(), 0.3, 1.0)
    data.qpos[:], data.qvel[:] = np.split(at, 2)
    mujoco.mj_forward(model, data)
    share = applied_share(model, at)
    assert share is not None
    return data, share


def test_constraints_are_tuned() -> None:
    """They have the largest impedance that MuJoCo takes as it is, and the least friction is used as it is, too.

    In the air there is no softness.
    """
    model = build(frozen(), "contact", friction=1e-5)
    assert (model.opt.impratio, model.pair_friction[0, 0]) == (100.0, 1e-5)
    assert model.pair_solref[0].tolist() == [1e-3, 1]
    assert model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_REFSAFE
    data, share = started(model)
    assert (data.efc_KBIP[0, 2], data.contact[0].friction[0]) == (0.9999, 1e-5)
    assert share == pytest.approx(0.9999, abs=1e-12)
    at = initial_state(model, frozen(), 0.3, 0.0)
    at[model.joint("lift").qposadr[0]] = 1.0
    assert applied_share(model, at) is None
