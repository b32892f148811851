"""Constraints as hard as one says: what the compiled model has, read back from MuJoCo's own solver."""

import mujoco
import pytest

from mjbeer import frozen
from mjbeer.model.softness import softness
from mjbeer.model.state import start
from mjbeer.simulation.hardness import constrained

REFSAFE = int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)


@pytest.mark.parametrize("rolling", ["equality", "contact"])
@pytest.mark.parametrize(("refsafe", "effective"), [(False, 5e-4), (True, 2e-3)])
def test_time_constants(rolling: str, refsafe: bool, effective: float) -> None:
    """With refsafe, MuJoCo raises what is under two timesteps to two."""
    make = constrained(frozen(), rolling, solref=(5e-4, 1.0), impedance=0.99, refsafe=refsafe)
    model = make("RK4", 1e-3)
    soft = softness(model, start(model, frozen(), 1.0, 0.0))
    assert soft is not None
    assert (soft.timeconst, soft.impedance) == (5e-4, pytest.approx(0.99))
    assert soft.effective_timeconst == pytest.approx(effective, rel=1e-9)


def test_stiffness_is_given_directly() -> None:
    model = constrained(frozen(), "equality", solref=(-1e6, -2e3))("RK4", 1e-3)
    assert model.eq_solref[0].tolist() == [-1e6, -2e3]


def test_what_is_not_given_stays_as_it_is_tuned() -> None:
    model = constrained(frozen(), "contact", impratio=7.0, friction=0.3)("RK4", 1e-3)
    assert model.opt.impratio == 7.0
    assert model.pair_friction[0, 0] == 0.3
    assert model.pair_solref[0].tolist() == [1e-3, 1]
    assert model.pair_solimp[0, :2].tolist() == [0.9999, 0.9999]
    assert model.opt.disableflags & REFSAFE
