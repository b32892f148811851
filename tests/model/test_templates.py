"""MJCF templates: as a stock MuJoCo user finds them, missing, and edited, which changes looks and never a motion."""

import functools
import math
import pathlib
import re
import warnings
import xml.etree.ElementTree as ET

import mujoco
import numpy as np
import pytest

from mjbeer import build, exact, export, frozen, hoop, pendulum, simulate, sliding, specify
from mjbeer.exceptions import TemplateError
from mjbeer.model import looks, state
from mjbeer.model.setting import ROLLINGS
from tests.support.scenes import METAL

TEMPLATES = {"sliding": sliding(can=METAL), "frozen": frozen(can=METAL), "pendulum": pendulum(), "hoop": hoop()}
KEYS = [
    (name, key.attrib["name"]) for name in TEMPLATES for key in ET.parse(looks.folder() / f"{name}.xml").iter("key")
]
# The softness of the constraints, and RK4 at the template's timestep: 2e-5 rad at worst, on 89 rad of roll-down.
# The bound is the promise made to users.
PROMISE = 1e-3
# Numbers in the templates have 13 digits.
WRITTEN = 1e-12
TEN = np.linspace(0, 10, 1001)
DRAWN, INVISIBLE = 2, 3
"""Groups of geoms."""


def load(name: str) -> mujoco.MjModel:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return mujoco.MjModel.from_xml_path(str(looks.folder() / f"{name}.xml"))


def phi(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
    joints = [data.joint(name) for name in state.places(model) if name in ("roll", "swing")]
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
    """For 2 s; the hoop until it hops. And the board does not end within ten seconds."""
    scene, model = TEMPLATES[name], load(name)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    start, u = phi(model, data), float(data.joint("slide").qpos[0])
    hops = exact(scene, np.linspace(0, 2, 20_001), *start).rolls_until() if name == "hoop" else math.inf
    times, angles, data = roll(model, key, 2.0)
    before = times <= hops
    truth = exact(scene, times[before], *start)
    assert np.abs(angles[before] - truth.phi).max() < PROMISE
    assert not any(warning.number for warning in data.warning)
    if name != "hoop":
        assert abs(data.joint("slide").qpos[0] / scene.can.radius - data.joint("roll").qpos[0]) < PROMISE
    way, board = u + exact(scene, TEN, *start).u - scene.start(*start)[0], model.geom("board")
    assert board.pos[0] - board.size[0] < way.min()
    assert way.max() < board.pos[0] + board.size[0]


@pytest.mark.parametrize(("key", "duration", "height"), [("hop", 0.43, 1e-6), ("push", 0.3, 0.02)])
def test_the_hoop_hops(key: str, duration: float, height: float) -> None:
    """By 15 um let go, by a radius of 33 mm pushed; a penetration would be negative."""
    *_, data = roll(load("hoop"), key, duration)
    assert data.joint("lift").qpos[0] > height


def test_mujoco_s_defaults_do_not_move_as_theory_says() -> None:
    """Why the templates set solref, solimp and diagexact: without them the roll-down is wrong by radians."""
    spec = mujoco.MjSpec.from_file(str(looks.folder() / "frozen.xml"))
    rolling = spec.equality("rolling")
    rolling.solref, rolling.solimp = [0.02, 1], [0.9, 0.95, 0.001, 0.5, 2]
    spec.option.enableflags = spec.option.disableflags = 0
    times, angles, _ = roll(spec.compile(), "roll_down", 2.0)
    assert np.abs(angles - exact(TEMPLATES["frozen"], times, math.pi).phi).max() > 10


@pytest.mark.parametrize("name", TEMPLATES)
def test_numbers_are_those_of_the_scene(name: str) -> None:
    """The same model as built from the scene, but for the point loads' stand-in inertia; and it repeats to the bit."""
    model, scene = load(name), TEMPLATES[name]
    built = build(scene, "contact" if name == "hoop" else "equality", visuals=True)
    for body in (each.name for each in map(model.body, range(model.nbody))):
        assert np.allclose(model.body(body).pos, built.body(body).pos, rtol=WRITTEN, atol=1e-16)
    masses = []
    for each in (model, built):
        data, mass = mujoco.MjData(each), np.zeros((each.nv, each.nv))
        data.qpos[-1] = 0.7
        mujoco.mj_forward(each, data)
        mujoco.mj_fullM(each, data, mass)
        masses.append(mass)
    # 1e-12 kg m^2 stands for none: 2e-8 of the pendulum's m b^2.
    assert np.allclose(*masses, rtol=1e-7 if scene.load.fill is None else WRITTEN, atol=1e-18)
    assert np.allclose(model.body("incline").quat, built.body("incline").quat, atol=1e-15)
    key = model.key(model.nkey - 1).name
    assert np.array_equal(roll(model, key, 0.2)[1], roll(model, key, 0.2)[1])


def test_the_readme_names_what_the_models_have() -> None:
    sections = (looks.folder() / "README.md").read_text().split("\n## ")
    told = {text.partition("\n")[0]: set(re.findall("`([^`]*)`", text)) for text in sections}
    specs = [mujoco.MjSpec.from_file(str(looks.folder() / f"{name}.xml")) for name in TEMPLATES]
    for section, kind in (("Joints", "joints"), ("Cameras", "cameras"), ("Sensors", "sensors"), ("Keyframes", "keys")):
        assert {each.name for spec in specs for each in getattr(spec, kind)} <= told[section]
    assert {geom.name for spec in specs for geom in spec.geoms if geom.group == DRAWN} <= told["What is drawn"]


# What is missing


def test_no_templates_at_all(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is only stepped needs none."""
    monkeypatch.setattr(looks, "FOLDERS", (tmp_path / "wheel", tmp_path / "checkout"))
    assert simulate(frozen(), 0.1, 1.0).trusted
    with pytest.raises(TemplateError, match=r"no MJCF templates: neither .*wheel nor .*checkout holds them; reinstall"):
        build(frozen(), visuals=True)


@pytest.mark.parametrize("file", ["frozen.xml", "incline.xml"])
@pytest.mark.parametrize("content", [None, "", "<mujoco/>", "<mujoco><worldbody></mujoco>"])
def test_a_file_that_is_missing_or_not_whole_is_named(copy: pathlib.Path, file: str, content: str | None) -> None:
    (copy / file).unlink() if content is None else (copy / file).write_text(content)
    with pytest.raises(TemplateError, match=r"frozen\.xml ") as caught:
        build(frozen(), visuals=True)
    assert content is not None or file in str(caught.value).split("not readable MJCF: ")[1]


# What is edited


def stepped(name: str) -> list[np.ndarray]:
    """The motion of models with visuals in MuJoCo's own loop, for each rolling."""
    found = []
    for rolling in ROLLINGS:
        model = build(TEMPLATES[name], rolling, visuals=True, phi0=0.7, phi_dot0=3.0)
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_step(model, data, 10)
        found.append(np.concatenate([data.qpos, data.qvel]))
    return found


unedited = functools.cache(stepped)
BODY, OUTER = '<body name="can" pos="0 0 0.033">', "</mujoco>"
SAME, REFUSED = "same", "refused"
# In which file, what is replaced by what, and what comes of it: the same motion, or a TemplateError.
EDITS = {
    "colour": ("shared", "0.98 0.63 0.08 1", "0 1 0 1", SAME),
    "camera": ("sliding", '0 -0.3 0.04"', '0 -0.5 0.04"', SAME),
    "mesh": ("sliding", 'mesh name="can" file="can.obj"', 'mesh name="can" file="tab.obj"', SAME),
    "geom that is heavy and in the way": (
        "sliding", BODY, BODY + '<geom name="more" size="0.1" mass="7" contype="3"/>', SAME,
    ),
    "mass": ("sliding", 'mass="0.2052', 'mass="0.3052', SAME),
    "inertia": ("sliding", 'diaginertia="7.15', 'diaginertia="9.15', SAME),
    "depth of the load": ("sliding", 'pos="0 0 -0.014', 'pos="0 0 -0.024', SAME),
    "axis": ("sliding", 'name="swing" type="hinge" axis="0 1 0"', 'name="swing" type="hinge" axis="0 -1 1"', SAME),
    "spring, damping, armature and friction of a joint": (
        "sliding", 'name="swing" type="hinge"',
        'name="swing" type="hinge" stiffness="1" damping="1" armature="1" frictionloss="1" range="-1 1"', SAME,
    ),
    "further joint": ("sliding", BODY, BODY + '<joint name="more" axis="1 0 0"/>', SAME),
    "joints in another order": ("sliding", '<joint name="slide" type="slide" axis="1 0 0"/>', "", SAME),
    "gravity, wind and integrator": (
        "sliding", '<option timestep="0.001" integrator="RK4">',
        '<option timestep="0.1" integrator="Euler" gravity="1 2 3" density="1000" wind="1 2 3" iterations="1">', SAME,
    ),
    "flags": ("sliding", 'refsafe="disable"', 'refsafe="enable" gravity="disable" contact="disable"', SAME),
    "equality": ("sliding", 'polycoef="0 0.033', 'active="false" polycoef="0 0.066', SAME),
    "actuator": ("sliding", OUTER, f'<actuator><motor joint="roll" gear="3"/></actuator>{OUTER}', SAME),
    "tendon with a spring": (
        "sliding", OUTER,
        f'<tendon><fixed stiffness="9"><joint joint="roll" coef="1"/></fixed></tendon>{OUTER}', SAME,
    ),
    "contact that is excluded": (
        "hoop", OUTER, f'<contact><exclude body1="incline" body2="can"/></contact>{OUTER}', SAME,
    ),
    "defaults": (
        "hoop", OUTER,
        '<default><joint damping="1" armature="1" stiffness="1" ref="1"/><geom pos="1 0 0" margin="1"/>'
        f'<site pos="1 0 0"/><pair margin="1" gap="1"/><tendon stiffness="1"/><general gear="3"/></default>{OUTER}',
        SAME,
    ),
    "mean inertia and memory": ("hoop", OUTER, f'<statistic meaninertia="1e9"/><size memory="1K"/>{OUTER}', SAME),
    "gravity compensation": ("hoop", BODY, BODY.replace(">", ' gravcomp="1">'), SAME),
    "bounds of masses": ("sliding", OUTER, f'<compiler boundmass="1" boundinertia="1"/>{OUTER}', REFUSED),
    "further body with a mass": (
        "hoop", BODY, BODY + '<body name="more"><inertial pos="0 0 1" mass="1" diaginertia="1 1 1"/></body>', SAME,
    ),
    "can in a turned frame": ("frozen", BODY, f'<frame euler="0 20 0">{BODY}', REFUSED),
    "can that is lifted": ("frozen", BODY, f'<frame pos="0 0 0.1">{BODY}', REFUSED),
    "can beside the incline": ("frozen", BODY, f"</body>{BODY}", REFUSED),
}  # fmt: skip


def edit(folder: pathlib.Path, name: str) -> str:
    """Make an edit and return the template that shows it."""
    file, old, new, _ = EDITS[name]
    path = folder / f"{file}.xml"
    text = path.read_text()
    assert old in text
    text = text.replace(old, new, 1)
    end = "\n      </body>\n    </body>\n  </worldbody>"
    if "frame" in new:
        text = text.replace(end, end.replace("</body>", "</body></frame>", 1))
    elif name == "can beside the incline":
        text = text.replace(end, "\n      </body>\n  </worldbody>")
    elif "another order" in name:
        text = text.replace('axis="0 1 0"/>', f'axis="0 1 0"/>{old}', 1)
    path.write_text(text)
    return "sliding" if file == "shared" else file


@pytest.mark.slow
@pytest.mark.parametrize("name", EDITS)
def test_an_edited_template_moves_alike_or_is_refused(name: str, copy: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """To the bit where it is seen; what is only stepped does not depend on it; and so is a specification or export."""
    template, wanted = ("sliding" if EDITS[name][0] == "shared" else EDITS[name][0]), EDITS[name][-1]
    before = unedited(template)
    edit(copy, name)
    assert simulate(TEMPLATES[template], 0.01, 0.7).trusted
    makes = [
        lambda: stepped(template),
        lambda: specify(TEMPLATES[template], visuals=True),
        lambda: export(TEMPLATES[template], tmp_path / "model.xml"),
    ]
    if wanted == REFUSED:
        for make in makes:
            with pytest.raises(TemplateError, match=rf"{template}\.xml .*restore the template"):
                make()
        return
    after, *_ = [make() for make in makes]
    for one, other in zip(before, after, strict=True):
        assert np.array_equal(one, other)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["colour", "camera", "mesh"])
def test_looks_are_the_user_s(name: str, copy: pathlib.Path) -> None:
    ordinary = build(TEMPLATES["sliding"], visuals=True)
    edit(copy, name)
    model = build(TEMPLATES["sliding"], visuals=True)
    found = {
        "colour": list(model.mat("beer").rgba) == [0, 1, 0, 1],
        "camera": model.camera("side").pos[1] == -0.5,
        "mesh": model.mesh("can").vertnum[0] != ordinary.mesh("can").vertnum[0],
    }
    assert [each for each, seen in found.items() if seen] == [name]
