"""Every MJCF template as a stock MuJoCo user finds it: it compiles, moves as the paper says, and repeats."""

import math
import os
import pathlib
import time
import warnings

import mujoco
import numpy as np
import pytest

from mjbeer import Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.model import templates
from mjbeer.model.build import build
from tests.support.scenes import METAL

TEMPLATES: dict[str, Scene] = {
    "sliding": sliding(can=METAL),
    "frozen": frozen(can=METAL),
    "pendulum": pendulum(),
    "hoop": hoop(),
}
KEYS = [
    *(("sliding", key) for key in ("equilibrium", "level", "swing", "loop")),
    *(("frozen", key) for key in ("equilibrium", "rocking", "swing", "roll_down")),
    *(("pendulum", key) for key in ("equilibrium", "level", "swing", "loop")),
    *(("hoop", key) for key in ("equilibrium", "rocking", "hop", "push")),
]
# The softness of the constraints, and RK4 at the template's timestep: 2e-5 rad at worst, on 89 rad of roll-down.
# The bound is the promise made to users.
PROMISE = 1e-3
# Numbers in the templates have 13 digits.
WRITTEN = 1e-12


def load(name: str) -> mujoco.MjModel:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model = mujoco.MjModel.from_xml_path(str(templates.folder() / f"{name}.xml"))
    assert not caught
    return model


def phi(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
    joints = [
        data.joint(name) for name in ("roll", "swing") if name in {model.joint(i).name for i in range(model.njnt)}
    ]
    return sum(float(each.qpos[0]) for each in joints), sum(float(each.qvel[0]) for each in joints)


def roll(model: mujoco.MjModel, key: str, duration: float) -> tuple[np.ndarray, np.ndarray, mujoco.MjData]:
    """Times and phi of plain mj_step from a keyframe."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    times, angles = [0.0], [phi(model, data)[0]]
    while data.time < duration:
        mujoco.mj_step(model, data)
        times.append(data.time)
        angles.append(phi(model, data)[0])
    return np.array(times), np.array(angles), data


@pytest.mark.slow
@pytest.mark.parametrize(("name", "key"), KEYS)
def test_keyframes_move_as_theory_says(name: str, key: str) -> None:
    """For 2 s; the hoop until it hops."""
    scene, model = TEMPLATES[name], load(name)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    start = phi(model, data)
    hops = exact(scene, np.linspace(0, 2, 20_001), *start).rolls_until() if name == "hoop" else math.inf
    times, angles, data = roll(model, key, 2.0)
    before = times <= hops
    truth = exact(scene, times[before], *start)
    assert np.abs(angles[before] - truth.phi).max() < PROMISE
    assert not any(warning.number for warning in data.warning)
    if name != "hoop":
        radius, joint = scene.can.radius, data.joint
        assert abs(joint("slide").qpos[0] / radius - joint("roll").qpos[0]) < PROMISE


def test_keyframes_are_all_tested() -> None:
    found = [(name, load(name).key(i).name) for name in TEMPLATES for i in range(load(name).nkey)]
    assert found == KEYS


@pytest.mark.parametrize(("key", "duration", "height"), [("hop", 0.43, 1e-6), ("push", 0.3, 0.02)])
def test_the_hoop_hops(key: str, duration: float, height: float) -> None:
    """By 15 um let go, by a radius of 33 mm pushed; a penetration would be negative."""
    model = load("hoop")
    *_, data = roll(model, key, duration)
    assert data.joint("lift").qpos[0] > height


def test_mujoco_s_defaults_do_not_move_as_theory_says() -> None:
    """Why the templates set solref, solimp and diagexact: without them the roll-down is wrong by radians."""
    spec = mujoco.MjSpec.from_file(str(templates.folder() / "frozen.xml"))
    rolling = spec.equality("rolling")
    rolling.solref, rolling.solimp = [0.02, 1], [0.9, 0.95, 0.001, 0.5, 2]
    spec.option.enableflags = spec.option.disableflags = 0
    times, angles, _ = roll(spec.compile(), "roll_down", 2.0)
    assert np.abs(angles - exact(TEMPLATES["frozen"], times, math.pi).phi).max() > 10


@pytest.mark.parametrize("name", TEMPLATES)
def test_numbers_are_those_of_the_scene(name: str) -> None:
    """The same model as built from the scene, but for the point loads' stand-in inertia."""
    model, scene = load(name), TEMPLATES[name]
    built = build(scene, "contact" if name == "hoop" else "equality", visuals=True)
    for body in (each.name for each in map(model.body, range(model.nbody))):
        assert np.allclose(model.body(body).pos, built.body(body).pos, rtol=WRITTEN, atol=1e-16)
    one, other = mujoco.MjData(model), mujoco.MjData(built)
    for data, each in ((one, model), (other, built)):
        data.qpos[-1] = 0.7
        mujoco.mj_forward(each, data)
    masses = [np.zeros((each.nv, each.nv)) for each in (model, built)]
    mujoco.mj_fullM(model, one, masses[0])
    mujoco.mj_fullM(built, other, masses[1])
    # 1e-12 kg m^2 stands for none: 2e-8 of the pendulum's m b^2.
    assert np.allclose(*masses, rtol=1e-7 if scene.load.fill is None else WRITTEN, atol=1e-18)
    assert np.allclose(model.body("incline").quat, built.body("incline").quat, atol=1e-15)


@pytest.mark.parametrize("name", TEMPLATES)
def test_everything_is_named_and_in_its_group(name: str) -> None:
    model = load(name)
    for kind in ("body", "joint", "geom", "camera", "light", "mesh", "material", "texture", "equality", "key"):
        count = getattr(model, {"joint": "njnt", "camera": "ncam", "texture": "ntex", "material": "nmat"}.get(
            kind, f"n{'eq' if kind == 'equality' else kind}"))  # fmt: skip
        assert all(getattr(model, kind)(i).name for i in range(count)), kind
    assert model.ncam >= 2
    for geom in map(model.geom, range(model.ngeom)):
        collides = geom.name in ("surface", "can")
        assert geom.group[0] == (3 if collides else 2), geom.name
        assert geom.contype[0] == geom.conaffinity[0] == 0


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_repeats_to_the_bit(name: str) -> None:
    model = load(name)
    key = model.key(model.nkey - 1).name
    assert np.array_equal(roll(model, key, 0.2)[1], roll(model, key, 0.2)[1])


def test_a_file_that_has_not_changed_for_long_is_read_once(copy: pathlib.Path) -> None:
    path = copy / "shared.xml"
    os.utime(path, (1e9, 1e9))
    first, again = templates.contents("hoop"), templates.contents("hoop")
    assert len(first) == 4  # the folder, the template, and what all templates include
    (shared,) = (text for text in first if text == path.read_bytes())
    assert any(text is shared for text in again)
    path.write_bytes(path.read_bytes().replace(b"0", b"1"))
    assert templates.contents("hoop") != first
    os.utime(path, (1e9, 1e9 + 1))
    assert path.read_bytes() in templates.contents("hoop")


def test_a_change_that_does_not_show_in_the_time_is_seen(copy: pathlib.Path) -> None:
    """Two changes may be so near that a file system gives them the same time."""
    path = copy / "hoop.xml"
    now = time.time_ns()
    for digit in (b"0", b"1", b"2"):
        path.write_bytes(path.read_bytes().replace(b"size", b"si" + digit + b"e"))
        os.utime(path, ns=(now, now))
        assert path.read_bytes() in templates.contents("hoop")
        path.write_bytes(path.read_bytes().replace(b"si" + digit + b"e", b"size"))
