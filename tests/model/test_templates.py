"""The MJCF: as a stock MuJoCo user finds it, missing, and edited, which is stepped as it stands, or is an error."""

import math
import pathlib
import re
import shutil
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from mjbeer import Scene, build, exact, export, frozen, hoop, pendulum, refill, simulate, sliding, specify, standing
from mjbeer.exceptions import TemplateError, UntrustedWarning
from mjbeer.model import check, setting
from mjbeer.model.check import check_file
from mjbeer.model.joints import initial_joints, joint_addresses
from mjbeer.model.model_numbers import ModelNumbers
from mjbeer.model.setting import ROLLINGS, Rolling, Setting
from tests.support.scenes import METAL, SCENES
from tools import templates

OWN = setting.mjcf_folder()
MECHANICS: dict[str, tuple[Scene, Rolling]] = {
    "sliding_reduced": (sliding(), "reduced"),
    "sliding_equality": (sliding(can=METAL), "equality"),
    "sliding_contact": (sliding(can=METAL), "contact"),
    "frozen_reduced": (frozen(), "reduced"),
    "frozen_equality": (frozen(), "equality"),
    "frozen_contact": (frozen(), "contact"),
}
SEEN = {"sliding": sliding(can=METAL), "frozen": frozen(), "pendulum": pendulum(), "hoop": hoop()}
FILES = {f"mechanics/{name}": scene for name, (scene, _) in MECHANICS.items()} | SEEN
KEYS = [(name, key.attrib["name"]) for name in FILES for key in ET.parse(OWN / f"{name}.xml").iter("key")]
# The softness of the constraints, and RK4 at the file's timestep: 2e-5 rad at worst, on 89 rad of roll-down.
PROMISE = 1e-3


def load(name: str) -> mujoco.MjModel:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return mujoco.MjModel.from_xml_path(str(OWN / f"{name}.xml"))


def phi(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
    joints = [data.joint(name) for name in joint_addresses(model) if name in ("roll", "swing", "phi")]
    return sum(float(joint.qpos[0]) for joint in joints), sum(float(joint.qvel[0]) for joint in joints)


def roll(model: mujoco.MjModel, key: str, duration: float) -> tuple[np.ndarray, np.ndarray, mujoco.MjData]:
    """Times and phi of plain mj_step from a keyframe."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    times = [0.0]
    angles = [phi(model, data)[0]]
    while data.time < duration:
        mujoco.mj_step(model, data)
        times.append(data.time)
        angles.append(phi(model, data)[0])
    return np.array(times), np.array(angles), data


@pytest.mark.slow
@pytest.mark.parametrize(("name", "key"), KEYS)
def test_keyframes_move_as_theory_says(name: str, key: str) -> None:
    """For 2 s; the hoop until it hops."""
    scene = FILES[name]
    model = load(name)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    start = phi(model, data)
    joints = joint_addresses(model)
    assert np.allclose(data.qpos, initial_joints(joints, scene, *start)[0], rtol=1e-11, atol=1e-15)
    hops = exact(scene, np.linspace(0, 2, 20_001), *start).rolls_until() if name == "hoop" else math.inf
    times, angles, data = roll(model, key, 2.0)
    before = times <= hops
    truth = exact(scene, times[before], *start)
    assert np.abs(angles[before] - truth.phi).max() < PROMISE
    assert not any(warning.number for warning in data.warning)


@pytest.mark.parametrize("name", FILES)
def test_all_cans_that_roll_have_three_keyframes(name: str) -> None:
    keys = {key for file, key in KEYS if file == name}
    assert {"home", "equilibrium", "swing"} <= keys
    model = load(name)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    assert phi(model, data) == (0, 0)


@pytest.mark.parametrize("path", sorted(OWN.rglob("*.xml")), ids=lambda path: path.stem)
def test_a_file_has_one_worldbody_and_one_element_a_line(path: pathlib.Path) -> None:
    text = path.read_text()
    assert text.count("<worldbody>") <= 1
    without_comments = re.sub("<!--.*?-->", "", text, flags=re.DOTALL)
    assert max(line.count("<") for line in without_comments.splitlines()) == 1


@pytest.mark.parametrize(("key", "duration", "height"), [("hop", 0.43, 1e-6), ("push", 0.3, 0.02)])
def test_the_hoop_hops(key: str, duration: float, height: float) -> None:
    """By 15 um let go, by a radius of 33 mm pushed; a penetration would be negative."""
    *_, data = roll(load("hoop"), key, duration)
    assert data.joint("lift").qpos[0] > height


@pytest.mark.parametrize("name", templates.TEMPLATES)
def test_what_a_viewer_opens_is_made_from_mechanics_and_looks(name: str) -> None:
    """`make templates` writes them."""
    assert (OWN / f"{name}.xml").read_text() == templates.text(name, OWN)


def test_the_readme_lists_the_parameters_and_what_can_be_named() -> None:
    """Element, attribute and files of each parameter are what mjbeer writes; and all names are there."""
    sections = (OWN / "README.md").read_text().split("\n## ")
    told = {text.partition("\n")[0]: text for text in sections}
    table = re.findall(r"^\| `(.*?)` \| `(.*?)` \|.*\| ([^|]*) \|$", told["Parameters"], re.MULTILINE)
    rows = [
        (element, attribute, files) for element, attributes, files in table for attribute in attributes.split("`, `")
    ]
    for name, (scene, rolling) in MECHANICS.items():
        written = {(element, attribute) for element, attribute in ModelNumbers(scene, Setting(rolling)).parameters}
        here = {(element, attribute) for element, attribute, files in rows if fits(name, files)}
        assert here == written, name
    for section, kind in (("Joints", "joints"), ("Cameras", "cameras"), ("Sensors", "sensors"), ("Keyframes", "keys")):
        names = set(re.findall("`([^`]*)`", told[section]))
        for name in FILES:
            spec = mujoco.MjSpec.from_file(str(OWN / f"{name}.xml"))
            assert {named.name for named in getattr(spec, kind)} <= names, (name, kind)


def fits(name: str, files: str) -> bool:
    """Whether a mechanics file is among those that a row of the table names: all, or with all words of one part."""
    return files == "all" or any(all(word in name for word in part.split()) for part in files.split(", "))


# What is missing


@pytest.mark.parametrize("file", ["mechanics/frozen_reduced.xml", "looks/frozen.xml", "scene.xml"])
@pytest.mark.parametrize("content", [None, "", "<mujoco>", "<mujoco><worldbody></mujoco>"])
def test_a_file_that_is_missing_or_not_whole_is_named(copy: pathlib.Path, file: str, content: str | None) -> None:
    (copy / file).unlink() if content is None else (copy / file).write_text(content)
    with pytest.raises(TemplateError, match=rf"{pathlib.Path(file).name} is not readable MJCF: "):
        build(frozen(), visuals=True)


def test_a_parameter_that_has_no_place_is_named(copy: pathlib.Path) -> None:
    edit(copy, "mechanics/sliding_reduced", '<fixed name="damper"', '<fixed name="other"')
    with pytest.raises(
        TemplateError, match=r"sliding_reduced\.xml has no 'fixed damper', into which mjbeer writes damp"
    ):
        simulate(sliding(), 0.1, 1.0)


# What is edited


REDUCED, EQUALITY, CONTACT = (f"mechanics/sliding_{rolling}" for rolling in ROLLINGS)
FROZEN = "mechanics/frozen_reduced"
CAN = '<body name="can" pos="0 0 0.033">'
OUTER = "</mujoco>"
PHI = '<joint name="phi" axis="0 1 0"'
SWING = '<joint name="swing" axis="0 1 0" damping="0 0 0"'
SAME = "nothing changes"
ERROR = "an error"
PARAMETER = "an error that names the parameter"
# In which file, what is replaced by what, and what comes of it.
EDITS = {
    "colour": ("assets", "0.98 0.63 0.08 1", "0 1 0 1", SAME),
    "camera": ("looks/sliding", '0 -0.3 0.04"', '0 -0.5 0.04"', SAME),
    "mesh": ("assets", 'mesh name="can" file="can.obj"', 'mesh name="can" file="tab.obj"', SAME),
    "drawn geom that is heavy": (
        "looks/sliding", '<geom name="can_end"',
        '<geom name="more" class="visual" type="mesh" mesh="lid" mass="7"/><geom name="can_end"', SAME,
    ),
    "further sensors": (REDUCED, "<sensor>", '<sensor><clock/><framepos objtype="body" objname="can"/>', SAME),
    "geom that touches nothing": (EQUALITY, CAN, f'{CAN}<geom size="0.01" contype="0" conaffinity="0"/>', SAME),
    "motor that nobody turns": (FROZEN, "<actuator>", '<actuator><motor joint="phi" gear="3"/>', SAME),
    "damped joint": (REDUCED, PHI, f'{PHI} damping="1e-4"', ERROR),
    "spring of the tendon": (REDUCED, 'name="damper"', 'name="damper" stiffness="1e-3" springlength="0.1"', ERROR),
    "another axis": (REDUCED, PHI, PHI.replace("0 1 0", "0 -1 1"), ERROR),
    "dry friction": (EQUALITY, SWING, f'{SWING} frictionloss="1e-4"', ERROR),
    "limit": (EQUALITY, SWING, f'{SWING} range="-90 90"', ERROR),
    "further joint": (REDUCED, CAN, f'{CAN}<joint name="more" axis="1 0 0"/>', ERROR),
    "second load": (
        EQUALITY, CAN, f'{CAN}<body><inertial pos="0 0 0.01" mass="0.01" diaginertia="1e-6 1e-6 1e-6"/></body>', ERROR,
    ),
    "wind": (REDUCED, "<option ", '<option density="1.2" wind="1 0 0" ', ERROR),
    "no damping": (REDUCED, 'constraint="disable"', 'constraint="disable" damper="disable"', ERROR),
    "no actuation": (FROZEN, 'constraint="disable"', 'constraint="disable" actuation="disable"', ERROR),
    "shorter arm of the chord": (FROZEN, 'name="chord_end" pos="0 0 -1"', 'name="chord_end" pos="0 0 -0.9"', ERROR),
    "gear of the weight": (FROZEN, 'name="weight"', 'name="weight" gear="2"', ERROR),
    "bounds of masses": (REDUCED, OUTER, f'<compiler boundmass="1" boundinertia="1"/>{OUTER}', ERROR),
    "heavier wheel": (EQUALITY, 'mass="0.00856', 'mass="0.0856', PARAMETER),
    "heavier load": (FROZEN, 'mass="0.205', 'mass="0.493', PARAMETER),
    "steeper incline": (REDUCED, 'euler="0 10 0"', 'euler="0 20 0"', PARAMETER),
}  # fmt: skip


def edit(folder: pathlib.Path, file: str, old: str, new: str) -> None:
    path = folder / f"{file}.xml"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def of(file: str) -> tuple[Scene, Rolling]:
    """Which scene shows a file."""
    return MECHANICS[file.partition("/")[2]] if "mechanics" in file else (sliding(can=METAL), "equality")


def accelerations(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Of a state of rolling, and of one that is twisted."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    data.qvel[:] *= np.arange(1, model.nv + 1)
    mujoco.mj_forward(model, data)
    return data.qacc.copy()


@pytest.mark.slow
@pytest.mark.parametrize("name", EDITS)
def test_an_edit_drives_the_motion_or_is_an_error(name: str, copy: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """Runs and exports end with it; `build` and `specify` warn of it, and have it."""
    file, old, new, outcome = EDITS[name]
    scene, rolling = of(file)
    start = {"phi0": 0.7, "phi_dot0": 3.0}
    ordinary = build(scene, rolling, **start, mjcf=OWN)
    right = simulate(scene, 0.02, **start, rolling=rolling, mjcf=OWN).phi
    edit(copy, file, old, new)
    makes: list[Callable[[], object]] = [
        lambda: simulate(scene, 0.02, **start, rolling=rolling),
        lambda: export(scene, tmp_path / "model.xml", **start, rolling=rolling),
    ]
    if outcome == SAME:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            run = simulate(scene, 0.02, **start, rolling=rolling)
            makes[1](), build(scene, rolling, visuals=True), specify(scene, rolling)
        assert run.phi.tobytes() == right.tobytes()
        return
    path = re.escape(str(copy / f"{file}.xml"))
    told = "accelerates phi by up to .* otherwise than theory|gives .* rows of constraints|gives the joints"
    for make in makes:
        with pytest.raises(TemplateError, match=f"^{path} ({told}|has other numbers)") as caught:
            make()
    assert ("mjbeer writes a scene's own numbers into" in str(caught.value)) == (outcome == PARAMETER)
    for make in (build, specify):
        with pytest.warns(UntrustedWarning, match=f"^{path} "):
            made = make(scene, rolling)
    if outcome == ERROR and name not in ("no damping", "dry friction", "limit", "further joint"):
        with pytest.warns(UntrustedWarning):
            model = build(scene, rolling, **start)
        assert not np.allclose(accelerations(model, scene), accelerations(ordinary, scene), rtol=1e-9), made


METRES = 'joint1="slide" joint2="roll" polycoef="0 0.033 0 0 0"'
ANGLES = 'joint1="roll" joint2="slide" polycoef="0 30.303030303 0 0 0"'


def slip_from(text: str, key: str) -> float:
    """The largest slip [m] in two seconds of plain mj_step from a keyframe of an MJCF text."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    slip = 0.0
    while data.time < 2:
        mujoco.mj_step(model, data)
        slip = max(slip, abs(data.sensor("slip").data[0]))
    return slip


@pytest.mark.parametrize("name", ["frozen_equality", "sliding_equality"])
def test_an_equality_in_angles_needs_no_flag(name: str) -> None:
    """Without the flags it slips by what the files say, and a row in metres 1000 times as far."""
    text = (OWN / "mechanics" / f"{name}.xml").read_text()
    assert ANGLES in text
    without_flags = text.replace('diagexact="enable" refsafe="disable" ', "")
    assert without_flags != text
    assert slip_from(text, "swing") < 3e-10
    assert 1e-9 < slip_from(without_flags, "swing") < 4.2e-9
    assert slip_from(without_flags.replace(ANGLES, METRES), "swing") > 1e-6


def test_an_equality_as_usually_written_hardly_rolls() -> None:
    """In metres and with MuJoCo's own softness, on the roll-down, which is 89 radii long."""
    text = (OWN / "mechanics" / "frozen_equality.xml").read_text()
    soft = re.sub(r'solref="0.0005 1"\s+solimp="0.9999 0.9999"', "", text.replace(ANGLES, METRES))
    assert 1.0 < slip_from(soft.replace('diagexact="enable"', ""), "roll_down") / METAL.radius < 10.0


def test_a_contact_needs_its_options() -> None:
    """What the comment in the file says is lost in a world without them."""
    text = (OWN / "mechanics" / "frozen_contact.xml").read_text()
    options = r'cone="elliptic" impratio="100"\s+tolerance="[^"]*"|diagexact="enable" refsafe="disable" '
    without_options, count = re.subn(options, "", text)
    assert count == 2
    assert slip_from(text, "swing") < 2e-9
    assert 1e-7 < slip_from(without_options, "swing") < 3e-7


def test_a_constraint_that_is_softer_is_stepped_as_it_stands(copy: pathlib.Path) -> None:
    """Its accelerations are those of rolling, and what it creeps shows in the run."""
    edit(copy, "mechanics/frozen_contact", 'solimp="0.9999 0.9999"', 'solimp="0.9 0.9"')
    hard, soft = (simulate(frozen(), 0.5, 1.0, rolling="contact", mjcf=folder) for folder in (OWN, None))
    assert np.abs(soft.slip).max() > 100 * np.abs(hard.slip).max()


ROLL = '<joint name="roll" axis="0 1 0"'
SLIDE = '<joint name="slide" type="slide" axis="1 0 0" damping="0 0 0"'
SURFACE = '<body name="can"'
WALL = '<geom name="wall" type="box" size="0.01 1 1" pos="0.2 0 0.5"'
# What acts only later in a run, or nowhere near the states at which a file is compared with theory: in which file,
# what is replaced by what, and what else. The can leaves the first centimetres after 0.1 s.
LATE = {
    "limit of the slide": (EQUALITY, SLIDE, f'{SLIDE} limited="true" range="-0.5 0.5"'),
    "limit of the slide with a margin": (EQUALITY, SLIDE, f'{SLIDE} limited="true" range="-9 0.9" margin="0.5"'),
    "limit of the turn": (EQUALITY, ROLL, f'{ROLL} limited="true" range="-700 700"'),
    "limit of a tendon": (
        EQUALITY, "</tendon>",
        '<fixed name="far" limited="true" range="-1 0.3"><joint joint="slide" coef="1"/></fixed></tendon>',
    ),
    "slack spring": (
        EQUALITY, "</tendon>",
        '<fixed name="far" stiffness="9" springlength="-1 0.3"><joint joint="slide" coef="1"/></fixed></tendon>',
    ),
    "slack spring of a reduced can": (
        REDUCED, "</tendon>",
        '<fixed name="far" stiffness="9" springlength="-1 0.3"><joint joint="slide" coef="1"/></fixed></tendon>',
    ),
    "wall": (
        CONTACT, SURFACE, f'{WALL} contype="2"/>{SURFACE}',
        'contype="0" conaffinity="0"', 'conaffinity="2"',
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LATE)
def test_an_edit_that_acts_late_is_an_error(name: str, copy: pathlib.Path) -> None:
    """Though the file moves as theory says from where a run starts: a short one is as exact as without the edit."""
    file, old, new, *more = LATE[name]
    edit(copy, file, old, new)
    if more:
        text = (copy / f"{file}.xml").read_text()
        can, surface, rest = text.rpartition('<geom name="can"')
        (copy / f"{file}.xml").write_text(can + surface + rest.replace(*more, 1))
    rolling = MECHANICS[file.partition("/")[2]][1]
    scene = sliding(can=METAL, damping=1e-4)
    simulate(scene, 0.02, 1.0, rolling=rolling)
    path = re.escape(str(copy / f"{file}.xml"))
    told = "accelerates phi by up to .* otherwise than theory|gives .* rows of constraints|lets other geoms touch"
    for duration, times in ((3.0, None), (3.0, [0.1, 3.0])):
        with pytest.raises(TemplateError, match=f"^{path} ({told}).* in a state of this run$"):
            simulate(scene, duration, 1.0, rolling=rolling, times=times)


def test_an_edit_that_changes_little_is_an_error(copy: pathlib.Path) -> None:
    """A run may claim an error of 1e-10 rad: an edit must not be ten times that."""
    edit(copy, EQUALITY, '<body name="can"', '<body name="can" gravcomp="1e-8"')
    with pytest.raises(TemplateError, match="accelerates phi"):
        simulate(sliding(can=METAL), 1.0, 1.0, rolling="equality")


def test_the_shipped_files_are_those_whose_runs_need_no_check(copy: pathlib.Path) -> None:
    """`make templates` writes their digests. A file with a comment more is another one."""
    assert check.SHIPPED.read_text() == templates.digests(OWN)
    for scene, rolling in MECHANICS.values():
        assert not check.is_edited(ModelNumbers(scene, Setting(rolling, mjcf=OWN)))
    edit(copy, EQUALITY, "</mujoco>", "<!-- more --></mujoco>")
    assert check.is_edited(ModelNumbers(sliding(can=METAL), Setting("equality")))


def test_all_files_move_as_theory_says() -> None:
    assert [check_file(OWN, scene.attachment, rolling) for scene, rolling in MECHANICS.values()] == [None] * len(
        MECHANICS
    )


@pytest.mark.parametrize("file", ["mechanics/sliding_equality", "mechanics/included"])
def test_a_file_that_is_edited_between_two_calls_is_read_again(file: str, copy: pathlib.Path) -> None:
    """Or one that it includes: by runs, and by models, whose warning goes once the file is restored."""
    scene = sliding(can=METAL)
    path = copy / f"{file}.xml"
    mechanics = copy / "mechanics" / "sliding_equality.xml"
    if path != mechanics:
        text = mechanics.read_text()
        (part,) = re.findall(r"<equality>.*</equality>", text, re.DOTALL)
        path.write_text(f"<mujoco>{part}</mujoco>")
        mechanics.write_text(text.replace(part, '<include file="included.xml"/>'))
    right = simulate(scene, 0.02, 1.0, rolling="equality")
    build(scene, "equality")
    before = path.read_text()
    path.write_text(before.replace("</mujoco>", '<equality><joint joint1="swing"/></equality></mujoco>'))
    with pytest.raises(TemplateError, match=r"sliding_equality\.xml gives \d+ rows of constraints"):
        simulate(scene, 0.02, 1.0, rolling="equality")
    with pytest.warns(UntrustedWarning, match=r"sliding_equality\.xml gives \d+ rows of constraints"):
        build(scene, "equality")
    path.write_text(before)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        build(scene, "equality")
    assert simulate(scene, 0.02, 1.0, rolling="equality").phi.tobytes() == right.phi.tobytes()


def test_a_mesh_that_is_edited_between_two_calls_is_read_again(copy: pathlib.Path) -> None:
    before = build(sliding(can=METAL), "equality", visuals=True).nmeshvert
    shutil.copy(copy / "assets" / "tab.obj", copy / "assets" / "can.obj")
    assert build(sliding(can=METAL), "equality", visuals=True).nmeshvert != before


def test_a_relative_folder_is_that_of_the_call(
    copy: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After `chdir` it is another one, but not for a run that was made before."""
    (tmp_path / "other").mkdir()
    shutil.copytree(copy, tmp_path / "other" / "mjcf")
    edit(tmp_path / "other" / "mjcf", *EDITS["damped joint"][:3])
    monkeypatch.chdir(tmp_path)
    run = simulate(sliding(), 0.02, 1.0, mjcf="mjcf")
    monkeypatch.chdir("other")
    assert run.error_estimate < 1e-6
    with pytest.raises(TemplateError, match=r"other/mjcf/mechanics/sliding_reduced\.xml accelerates phi"):
        simulate(sliding(), 0.02, 1.0, mjcf="mjcf")


def test_a_folder_of_one_s_own_has_looks_of_its_own(copy: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the environment, or by a parameter."""
    edit(copy, *EDITS["colour"][:3])
    green = [0, 1, 0, 1]
    assert list(build(SCENES["sliding"], visuals=True).mat("beer").rgba) == green
    monkeypatch.delenv("MJBEER_MJCF")
    assert list(build(SCENES["sliding"], visuals=True).mat("beer").rgba) != green
    assert list(build(SCENES["sliding"], visuals=True, mjcf=copy).mat("beer").rgba) == green


# What stands


TURNED = np.random.default_rng(5).normal(size=(200, 4))


@pytest.mark.parametrize("fill", [None, 0.05, 0.1, 0.2, 0.5, 0.8, 0.97])
def test_what_is_drawn_of_a_standing_can_s_beer_stays_inside_the_wall(fill: float | None) -> None:
    """However the pendulum hangs: the file that a viewer opens, and a can of any fill, from which it is `refill`ed."""
    model = load("standing") if fill is None else build(standing(fill=0.5), visuals=True)
    if fill is not None:
        refill(model, standing(fill=fill), prefix="")
    data, radius, length = mujoco.MjData(model), *(model.geom("can").size[:2] * [1, 2])
    turn = np.linspace(0, 2 * np.pi, 33)
    for quat in (*np.eye(4)[:1], *TURNED):
        data.joint("slosh1").qpos[:] = quat / np.linalg.norm(quat)
        mujoco.mj_kinematics(model, data)
        for name in ("beer", "beer_top"):
            drawn = data.geom(name)
            (wide, half, _) = model.geom(name).size
            rims = [np.stack([wide * np.cos(turn), wide * np.sin(turn), 0 * turn + end]) for end in (-half, half)]
            x, y, z = drawn.xmat.reshape(3, 3) @ np.concatenate(rims, axis=1) + drawn.xpos[:, np.newaxis]
            assert np.hypot(x, y).max() < radius * (1 + 1e-6)  # the file has ten digits
            if wide > 1e-3 * radius:  # what does not show, as its pivot is too high, may be above
                assert z.min() > -1e-6 * length
                assert z.max() < length * (1 + 1e-6)
