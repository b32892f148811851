"""Settings: models are as soft as a setting says, and as usually written they have MuJoCo's defaults."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from mjbeer import build, frozen
from mjbeer.exceptions import ParameterError
from mjbeer.model.build import compile_spec, compose
from mjbeer.model.setting import Softness
from mjbeer.model.state import start
from mjbeer.studies.benchmark.measure import applied_share
from mjbeer.studies.benchmark.points import USUAL

SLIDE_FIRST = USUAL["equality, slide first"]


@pytest.mark.parametrize("written", USUAL)
def test_constraints_are_mujoco_s_defaults(written: str) -> None:
    model, stock = compile_spec(compose(frozen(), USUAL[written])), mujoco.MjSpec().option
    kind = "eq" if model.neq else "pair"
    assert getattr(model, f"{kind}_solref")[0].tolist() == [0.02, 1]
    assert getattr(model, f"{kind}_solimp")[0].tolist() == [0.9, 0.95, 0.001, 0.5, 2]
    for name in ("cone", "impratio", "solver", "iterations", "enableflags"):
        assert getattr(model.opt, name) == getattr(stock, name), name
    assert not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_REFSAFE
    assert (model.opt.timestep, model.opt.integrator) == (2e-3, mujoco.mjtIntegrator.mjINT_EULER)
    assert np.array_equal(model.body_mass, build(frozen(), USUAL[written].rolling).body_mass)


def started(model: mujoco.MjModel) -> tuple[mujoco.MjData, float]:
    """The frozen can on its way, as MuJoCo sees it, and the share of a hard constraint's force that it has there."""
    data, at = mujoco.MjData(model), start(model, frozen(), 0.3, 1.0)
    data.qpos[:], data.qvel[:] = np.split(at, 2)
    mujoco.mj_forward(model, data)
    share = applied_share(model, at)
    assert share is not None
    return data, share


def test_the_share_is_what_the_solver_lets_through() -> None:
    """Measured on the acceleration itself: the row's, over what it was to be, past what it would be unconstrained."""
    model = compile_spec(compose(frozen(), replace(SLIDE_FIRST, integrator="RK4", timestep=1e-3)))
    data, share = started(model)
    row = np.array(data.efc_J).reshape(-1, model.nv)[0]
    free, held, wanted = row @ data.qacc_smooth, row @ data.qacc, data.efc_aref[0]
    assert (held - free) / (wanted - free) == pytest.approx(share, rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"solref": (0, 1)}, r"solref must be a time constant \[s\] and a damping ratio, both greater than 0, or "),
        ({"solref": (-1e4, 5)}, r"got \(-10000\.0, 5\.0\)$"),
        ({"solref": 0.02}, r"solref must be two numbers, got 0\.02"),
        ({"solref": (0.02, "1")}, r"solref\[1\] must be a finite number, got '1'"),
        ({"impedance": (0.9, 1.0)}, r"impedance\[1\] must be between 0\.0001 and 0\.9999, got 1\.0"),
        ({"impratio": 0}, "impratio must be greater than 0, got 0"),
        ({"elliptic": 1}, "elliptic must be True or False, got 1"),
        ({"first": "roll"}, "first must be one of 'slide', 'hinge'; got 'roll'"),
    ],
)
def test_a_softness_refuses_what_mujoco_would_replace_in_silence(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        Softness(**arguments)


def test_the_limits_are_mujoco_s() -> None:
    """In the constraint that MuJoCo computes, what is at its limit is used as it is."""
    for share in (1e-4, 0.9999):
        data, _ = started(build(frozen(), "equality", softness=Softness(impedance=(share, share))))
        assert data.efc_KBIP[0, 2] == share
    model = build(frozen(), "contact", friction=1e-5)
    assert started(model)[0].contact[0].friction[0] == 1e-5
    model.pair_friction[0, :2] = 9e-6
    assert started(model)[0].contact[0].friction[0] == 1e-5


def test_what_is_given_is_used_and_the_rest_stays_tuned() -> None:
    """In the air there is no softness."""
    model = build(frozen(), "contact", friction=0.3, softness=Softness(impratio=7.0))
    assert (model.opt.impratio, model.pair_friction[0, 0]) == (7.0, 0.3)
    assert model.pair_solref[0].tolist() == [1e-3, 1]
    assert model.pair_solimp[0, :2].tolist() == [0.9999, 0.9999]
    _, share = started(model)
    assert model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_REFSAFE
    assert share == pytest.approx(0.9999, abs=1e-12)
    at = start(model, frozen(), 0.3, 0.0)
    at[model.joint("lift").qposadr[0]] = 1.0
    assert applied_share(model, at) is None
    model = build(frozen(), "equality", softness=Softness(solref=(-1e6, -2e3)))
    assert model.eq_solref[0].tolist() == [-1e6, -2e3]
