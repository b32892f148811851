"""A specification is that of the model that is built, and what it loses in another world is what the README says."""

import math
import pathlib
import re
import runpy
import warnings
from typing import Any

import mujoco
import numpy as np
import pytest

from mjbeer import Scene, build, exact, frozen, specify
from mjbeer.exceptions import UnsupportedError
from mjbeer.model.setting import ROLLINGS
from mjbeer.model.state import start
from tests.model.test_mjcf_readme import TEXT, table
from tests.support.scenes import METAL, SCENES

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "attach.py"
OPTIONS = (
    "timestep", "integrator", "cone", "impratio", "tolerance", "enableflags", "disableflags", "gravity", "solver",
    "iterations", "jacobian", "noslip_iterations", "density", "viscosity", "wind", "disableactuator",
)  # fmt: skip
SCENE = frozen(math.radians(8), can=METAL)
WEAK = frozen(math.radians(8), can=METAL, gravity=1.6)
# Errors in the README have two digits.
WRITTEN = 0.05


def attached(can: mujoco.MjSpec, parent: mujoco.MjSpec) -> mujoco.MjSpec:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the options that are lost
        parent.worldbody.add_frame(name="slope").attach_body(can.body("can"), "own-", "")
    return parent


def compiled(spec: mujoco.MjSpec) -> mujoco.MjModel:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return spec.compile()


@pytest.mark.parametrize("visuals", [False, True])
@pytest.mark.parametrize("rolling", ROLLINGS)
def test_a_specification_is_that_of_the_built_model(rolling: str, visuals: bool) -> None:
    for scene in SCENES.values():
        try:
            built = build(scene, rolling, visuals, "Euler", 2e-3, 0.7)
        except UnsupportedError:
            continue
        made = specify(scene, rolling, visuals, "Euler", 2e-3, 0.7).compile()
        assert made.nkey == 0  # a parent would get it
        for name in ("body_mass", "body_ipos", "body_inertia", "jnt_axis", "eq_data", "pair_friction", "pair_solref",
                     "geom_pos", "dof_armature", "tendon_armature", "actuator_biasprm"):  # fmt: skip
            assert np.array_equal(getattr(made, name), getattr(built, name)), name
        for name in ("timestep", "integrator", "gravity", "cone", "impratio", "disableflags"):
            assert np.array_equal(getattr(made.opt, name), getattr(built.opt, name)), name


@pytest.mark.parametrize("rolling", ["equality", "contact"])
def test_the_options_that_are_lost_are_those_of_the_readme(rolling: str) -> None:
    """A new parent keeps its own values of all of them, and nothing is lost that the README does not name."""
    told = {row[0].strip("`"): row for row in table("Into another world")}
    needed = specify(WEAK, rolling, visuals=True).compile().opt
    kept, fresh = compiled(attached(specify(WEAK, rolling, visuals=True), mujoco.MjSpec())).opt, mujoco.MjSpec().option
    lost = {name for name in OPTIONS if not np.array_equal(getattr(needed, name), getattr(kept, name))}
    assert all(np.array_equal(getattr(kept, name), getattr(fresh, name)) for name in OPTIONS)
    if rolling == "contact":
        assert lost == set(told)
    assert lost <= set(told)
    assert needed.enableflags == mujoco.mjtEnableBit.mjENBL_DIAGEXACT
    assert needed.disableflags == mujoco.mjtDisableBit.mjDSBL_REFSAFE
    assert (told["timestep"][1], told["impratio"][1:3]) == (str(fresh.timestep), [f"{fresh.impratio:g}", "100"])


def test_a_parent_that_merges_adopts_all_options() -> None:
    parent = mujoco.MjSpec()
    parent.compiler.conflict = mujoco.mjtConflict.mjCONFLICT_MERGE
    needed = specify(WEAK, "contact", visuals=True).compile().opt
    found = compiled(attached(specify(WEAK, "contact", visuals=True), parent)).opt
    assert all(np.array_equal(getattr(needed, name), getattr(found, name)) for name in OPTIONS)


def test_without_visuals_a_parent_that_merges_loses_stages() -> None:
    """Why the README wants visuals: gravity would be tilted, and sensors and limits of the other world not computed."""
    parent = mujoco.MjSpec()
    parent.compiler.conflict = mujoco.mjtConflict.mjCONFLICT_MERGE
    found = compiled(attached(specify(SCENE, "contact"), parent)).opt
    assert found.gravity[0] > 1
    assert found.disableflags & mujoco.mjtDisableBit.mjDSBL_SENSOR
    assert found.disableflags & mujoco.mjtDisableBit.mjDSBL_LIMIT


@pytest.mark.parametrize("rolling", ["equality", "contact"])
def test_an_attached_can_keeps_what_is_in_its_body(rolling: str) -> None:
    alone = specify(SCENE, rolling, visuals=True).compile()
    model = compiled(attached(specify(SCENE, rolling, visuals=True), mujoco.MjSpec()))
    joints = [alone.joint(i).name for i in range(alone.njnt)]
    assert [model.joint(i).name for i in range(model.njnt)] == [f"own-{name}" for name in joints]
    for body in ("can", "load"):
        assert np.array_equal(model.body(f"own-{body}").mass, alone.body(body).mass)
        assert np.array_equal(model.body(f"own-{body}").inertia, alone.body(body).inertia)
    geoms = {alone.geom(i).name for i in range(alone.ngeom)} - {"wall", "board", "surface"}
    assert {model.geom(i).name for i in range(model.ngeom)} == {f"own-{name}" for name in geoms}
    assert (model.neq, model.npair) == ((1, 0) if rolling == "equality" else (0, 0))
    assert not model.geom_contype.any()


@pytest.fixture(scope="module")
def example() -> dict[str, Any]:
    return runpy.run_path(str(EXAMPLE))


def error_without(example: dict[str, Any], *options: str) -> float:
    """Return the error of the frozen can in the example without some options."""
    names = example["errors"].__globals__
    wanted, names["OPTIONS"] = names["OPTIONS"], tuple(each for each in names["OPTIONS"] if each not in options)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return example["errors"]()["frozen"]
    finally:
        names["OPTIONS"] = wanted


@pytest.mark.slow
@pytest.mark.parametrize("option", [row[0].strip("`") for row in table("Into another world") if row[3]])
def test_without_an_option_the_error_is_that_of_the_readme(option: str, example: dict[str, Any]) -> None:
    (told,) = (row[3] for row in table("Into another world") if row[0] == f"`{option}`")
    found = error_without(example, option)
    if told == "unstable":
        assert found > 1
    else:
        assert found == pytest.approx(float(told), rel=WRITTEN)


def by_equality(scene: Scene, *without: str) -> float:
    """Return the error of phi of an attached can that rolls by a joint equality, without some options."""
    can, parent = specify(scene, "equality", visuals=True), mujoco.MjSpec()
    for name in {"timestep", "integrator", "enableflags", "disableflags"} - set(without):
        setattr(parent.option, name, getattr(can.option, name))
    attached(can, parent).frame("slope").quat = [math.cos(scene.incline / 2), 0, math.sin(scene.incline / 2), 0]
    model = compiled(parent)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = np.split(start(build(scene, "equality"), scene, 2.0, 0.0), 2)
    found = []
    for _ in range(2000):
        found.append(float(data.joint("own-roll").qpos[0]))
        mujoco.mj_step(model, data)
    truth = exact(scene, model.opt.timestep * np.arange(len(found)), 2.0)
    return float(np.abs(found - truth.phi).max())


@pytest.mark.slow
def test_the_errors_in_the_text_of_the_readme_are_those_found(example: dict[str, Any]) -> None:
    section = " ".join(TEXT.split("\n## Into another world\n")[1].split("\n## ")[0].split())
    told = [float(each) for each in re.findall(r"([\d.]+(?:e-\d+)?) rad(?! off)", section)]
    (equality,) = re.findall(r"([\d.]+e-\d+) rad off", section)
    everything = example["errors"].__globals__["OPTIONS"]
    found = error_without(example), error_without(example, *everything), by_equality(SCENE, "enableflags")
    assert told == pytest.approx(found, rel=WRITTEN)
    assert float(equality) == pytest.approx(by_equality(SCENE), rel=WRITTEN)
