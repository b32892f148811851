"""Models as usually written have MuJoCo's defaults, the scene's masses, and are as soft as they are said to be."""

import mujoco
import numpy as np
import pytest

from mjbeer import build, frozen, sliding
from mjbeer.exceptions import UnsupportedError
from mjbeer.model.build import specify
from mjbeer.model.softness import softness
from mjbeer.model.state import start
from mjbeer.model.usual import USUAL, build_usual


@pytest.mark.parametrize("written", USUAL)
def test_constraints_are_mujoco_s_defaults(written: str) -> None:
    model, stock = build_usual(frozen(), written), mujoco.MjSpec().option
    solref, solimp = (
        (model.eq_solref, model.eq_solimp) if model.neq else (model.pair_solref, model.pair_solimp)
    )  # fmt: skip
    assert solref[0].tolist() == [0.02, 1]
    assert solimp[0].tolist() == [0.9, 0.95, 0.001, 0.5, 2]
    for name in ("cone", "impratio", "solver", "iterations", "tolerance", "enableflags"):
        assert getattr(model.opt, name) == getattr(stock, name), name
    assert not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_REFSAFE
    assert (model.opt.timestep, model.opt.integrator) == (2e-3, mujoco.mjtIntegrator.mjINT_EULER)
    assert np.array_equal(model.body_mass, build(frozen(), USUAL[written]).body_mass)


def test_either_joint_may_be_named_first() -> None:
    slide, hinge = (build_usual(frozen(), f"equality, {each} first") for each in ("slide", "hinge"))
    names = [
        [model.joint(int(each)).name for each in (model.eq_obj1id[0], model.eq_obj2id[0])] for model in (slide, hinge)
    ]
    assert names == [["slide", "roll"], ["roll", "slide"]]
    radius = frozen().can.radius
    assert (slide.eq_data[0, 1], hinge.eq_data[0, 1]) == (radius, 1 / radius)


def test_a_massless_can_around_a_sliding_load_is_refused() -> None:
    with pytest.raises(UnsupportedError, match="massless"):
        build_usual(sliding(), "contact, defaults")


def test_refsafe_raises_a_time_constant_under_two_timesteps() -> None:
    at = start(build_usual(frozen(), "equality, slide first"), frozen(), 0.3, 1.0)
    for timestep, expected in ((2e-3, 0.02), (16e-3, 0.032)):
        soft = softness(build_usual(frozen(), "equality, slide first", timestep=timestep), at)
        assert soft is not None
        assert soft.effective_timeconst == pytest.approx(expected, rel=1e-12)
        assert soft.changed == (expected != 0.02)


def test_the_share_is_what_the_solver_lets_through() -> None:
    """Measured on the acceleration itself: the row's, over what it was to be, past what it would be unconstrained."""
    scene = frozen()
    model = build_usual(scene, "equality, slide first", "RK4", 1e-3)
    at = start(model, scene, 0.3, 1.0)
    soft = softness(model, at)
    assert soft is not None
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = np.split(at, 2)
    mujoco.mj_forward(model, data)
    row = np.array(data.efc_J).reshape(-1, model.nv)[0]
    free, held, wanted = row @ data.qacc_smooth, row @ data.qacc, data.efc_aref[0]
    assert (held - free) / (wanted - free) == pytest.approx(soft.effective_impedance, rel=1e-9)


def test_tuned_models_get_what_they_ask_for() -> None:
    scene = frozen()
    for rolling, share in (("equality", 1.0), ("contact", 0.9999)):
        model = build(scene, rolling)
        soft = softness(model, start(model, scene, 0.3, 0.0))
        assert soft is not None
        assert not soft.changed
        assert soft.effective_impedance == pytest.approx(share, abs=1e-12)
    assert softness(build(scene), np.zeros(2)) is None


def test_in_the_air_there_is_no_softness() -> None:
    model = specify(frozen(), "contact").compile()
    at = start(model, frozen(), 0.3, 0.0)
    at[model.joint("lift").qposadr[0]] = 1.0
    assert softness(model, at) is None
