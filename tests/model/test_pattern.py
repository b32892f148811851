"""A model into which a scene is written has every number of a model that is compiled for the scene, to the bit."""

import pathlib
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mjbeer import Can, Load, Scene, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import TemplateError, UnsupportedError
from mjbeer.model import pattern
from mjbeer.model.build import compile_model
from mjbeer.model.pattern import Editable, Plan
from mjbeer.model.setting import INTEGRATORS, ROLLINGS, USUAL, Rolling, Setting, supported
from mjbeer.theory.liquid import Damping
from tests.support.scenes import METAL, SCENES, scenes

OTHERS = [
    *SCENES.values(),
    sliding(incline=0.3, fill=0.2, gravity=1e-3),
    frozen(incline=0.0, fill=0.9, can=METAL),
    pendulum(wheel_mass=3.0, load_mass=1e-12),
    hoop(incline=0.3, hoop_mass=1e-9, gravity=0.0),
    Scene(Can(0.03, 0.1, 0.1, 9e-5), Load(0.2, 0.0, 1e-4), 0.2, "sliding"),
    Scene(Can(0.03, 0.1, 0.1, 9e-5), Load(0.2, 1e-9, 1e-4), 0.2, "frozen"),
    Scene(Can(0.03, 0.1, 1e4, 9.0), Load(0.2, 0.01, 1e-4), 0.2, "sliding"),
    *(sliding(can=can, damping=1e-3) for can in (None, METAL)),
    sliding(incline=0.3, can=Can.sheet_metal(0.05, 0.1), damping=Damping(1.0, 1e-9, 3.0)),
    replace(pendulum(wheel_mass=1e-12, load_mass=1e-12), damping=1e-14),
    sliding(can=METAL, drag=1e-3),
    replace(pendulum(), drag=2.0),
    sliding(fill=0.1, can=METAL, drag=0.1, damping=1e-5),
    replace(pendulum(), drag=2.0, damping=Damping(cubic=1.0)),
]


def numbers(model: mujoco.MjModel) -> Iterator[tuple[str, Any]]:
    """Yield the name and the value of every field of a model, its options and its statistics."""
    for part, prefix in ((model, ""), (model.opt, "option "), (model.stat, "statistic "), (model.vis, "visual ")):
        for name in dir(part):
            value = None if name.startswith("_") else getattr(part, name)
            if isinstance(value, (int, float, bytes, np.ndarray)):
                yield prefix + name, value


def assert_same(written: mujoco.MjModel, compiled: mujoco.MjModel) -> None:
    fields, wanted = dict(numbers(written)), dict(numbers(compiled))
    assert len(wanted) > 400
    differing = [name for name in wanted if np.asarray(fields[name]).tobytes() != np.asarray(wanted[name]).tobytes()]
    assert not differing


def written(scene: Scene, setting: Setting) -> mujoco.MjModel:
    """Return a model into which a scene is written that had another scene of its kind before."""
    plan = Plan.of(scene, setting)
    for other in OTHERS:
        if supported(other, setting.rolling):
            before = Plan.of(other, Setting(setting.rolling, "Euler", 3e-3, None, 0.2, setting.softness))
            if before.kind == plan.kind and other != scene:
                editable = Editable(before)
                editable.write(plan)
                return editable.model
    return Editable(plan).model


@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize("place", range(len(OTHERS)))
def test_every_number_is_that_of_the_compiler(rolling: Rolling, place: int) -> None:
    scene, setting = OTHERS[place], Setting(rolling, "implicit", 2e-4, friction=0.7)
    if supported(scene, rolling):
        assert_same(written(scene, setting), compile_model(scene, setting))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(scenes(), st.sampled_from(ROLLINGS), st.sampled_from(INTEGRATORS), st.floats(1e-6, 0.1), st.floats(1e-4, 10))
def test_every_number_is_that_of_the_compiler_for_any_scene(
    scene: Scene, rolling: Rolling, integrator: Any, timestep: float, friction: float
) -> None:
    setting = Setting(rolling, integrator, timestep, friction=friction)
    assume(
        supported(scene, rolling) and (rolling == "reduced" or scene.can.inertia > 0 or scene.attachment == "frozen")
    )
    assert_same(written(scene, setting), compile_model(scene, setting))


@pytest.mark.parametrize("name", USUAL)
def test_softness_as_people_write_it_is_written(name: str) -> None:
    for scene in (frozen(incline=0.1, can=METAL), sliding(fill=0.3, can=METAL)):
        assert_same(written(scene, USUAL[name]), compile_model(scene, USUAL[name]))


def test_a_model_without_dampers_is_of_another_kind() -> None:
    """Its flag says that there are none: a scene that is written into it would not be damped."""
    scenes = sliding(can=METAL), sliding(can=METAL, damping=1e-3), sliding(can=METAL, drag=1e-3)
    for rolling in ROLLINGS:
        assert len({Plan.of(scene, Setting(rolling)).kind for scene in scenes}) == 3
    assert Plan.of(sliding(damping=1e-3), Setting()).kind == Plan.of(sliding(damping=Damping(cubic=9)), Setting()).kind


def test_nothing_is_compiled_for_the_next_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    editable = Editable(Plan.of(sliding(), Setting()))

    def fail(*_: object) -> None:
        pytest.fail("a model is compiled")

    monkeypatch.setattr(pattern, "compile_model", fail)
    monkeypatch.setattr(pattern, "compose", fail)
    editable.write(Plan.of(sliding(fill=0.3), Setting()))
    Editable(Plan.of(sliding(fill=0.7), Setting()))


def test_a_scene_whose_inertia_is_lost_is_refused_in_the_compiler_s_words() -> None:
    setting = Setting("equality")
    assert_refused(Scene(Can(2e-10, 1, 3e3, 1.5e-16), Load(1.2e4, 3e-12, 9e9)), setting, r".* too close to singular")


def test_a_mass_below_the_smallest_is_refused_in_the_compiler_s_words(monkeypatch: pytest.MonkeyPatch) -> None:
    """No scene is known in which the unit of mass leaves one that small; here the inertias are not small."""
    scene = Scene(Can(100, 1, 1e3, 1e7), Load(1, 50, 1e3), 0.1)
    editable = Editable(Plan.of(scene, Setting()))
    monkeypatch.setattr("mjbeer.model.build.mass_unit", lambda _: 1e-16)
    with pytest.raises(UnsupportedError, match=r"MuJoCo cannot represent this scene: .*mass and inertia"):
        editable.write(Plan.of(scene, Setting()))


def assert_refused(scene: Scene, setting: Setting, reason: str) -> None:
    """Check that a scene is refused as the compiler refuses it, and that the next one is written as ever."""
    with pytest.raises(UnsupportedError, match=f"MuJoCo cannot represent this scene: {reason}") as compiled:
        compile_model(scene, setting)
    editable = Editable(Plan.of(pendulum(), setting))
    with pytest.raises(UnsupportedError) as refused:
        editable.write(Plan.of(scene, setting))
    assert str(refused.value) == str(compiled.value)
    assert_same_after(editable, pendulum(incline=0.3), setting)


def test_the_data_are_those_of_a_new_model() -> None:
    for rolling in ROLLINGS:
        editable = Editable(Plan.of(frozen(0.2), Setting(rolling)))
        editable.data.qvel[:] = 3.0
        for _ in range(3):
            mujoco.mj_step(editable.model, editable.data)
        editable.write(Plan.of(frozen(0.3), Setting(rolling)))
        fresh = mujoco.MjData(editable.model)
        for name in ("time", "qpos", "qvel", "qacc", "qacc_warmstart", "xpos", "qM", "qfrc_bias", "ncon"):
            if hasattr(fresh, name):
                assert np.array_equal(getattr(editable.data, name), getattr(fresh, name)), name


def assert_same_after(editable: Editable, scene: Scene, setting: Setting) -> None:
    editable.write(Plan.of(scene, setting))
    assert_same(editable.model, compile_model(scene, setting))


def test_an_edited_template_takes_effect_at_once(copy: pathlib.Path) -> None:
    """In the template or in a file that it includes."""
    for file in ("hoop.xml", "shared.xml"):
        before, text = Plan.of(hoop(), Setting("contact")), (copy / file).read_text()
        assert Plan.of(hoop(), Setting("contact")).kind == before.kind
        start, end, outermost = text.rpartition("</")
        (copy / file).write_text(f'{start}<visual><map zfar="9"/></visual>{end}{outermost}')
        assert Plan.of(hoop(), Setting("contact")).kind != before.kind
        assert written(hoop(), Setting("contact")).vis.map.zfar == 9
        (copy / file).write_text(text)
    (copy / "hoop.xml").unlink()
    with pytest.raises(TemplateError, match=r"hoop\.xml is not readable MJCF"):
        written(hoop(), Setting("contact"))


def test_a_template_may_leave_its_extent_to_the_compiler(copy: pathlib.Path) -> None:
    text = (copy / "shared.xml").read_text()
    assert 'extent="0.3"' in text
    (copy / "shared.xml").write_text(text.replace('extent="0.3"', ""))
    for rolling in ROLLINGS:
        scene = frozen(can=Can.hoop(1.0, 3.0, 0.1))
        assert_same(written(scene, Setting(rolling)), compile_model(scene, Setting(rolling)))
