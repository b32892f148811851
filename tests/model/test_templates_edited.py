"""An edited template has the same motion to the bit, or is an error that says what is wrong: never another motion."""

import functools
import pathlib
import re
import shutil
from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from mjbeer import MjbeerError, build, frozen, hoop, pendulum, simulate, sliding
from mjbeer.cli.app import main
from mjbeer.drawing.world.display import Display
from mjbeer.exceptions import TemplateError, UnsupportedError
from mjbeer.model import appearance, state, templates
from mjbeer.model.export import export
from tests.support.scenes import METAL

pytestmark = pytest.mark.slow

SCENES = {"sliding": sliding(can=METAL), "frozen": frozen(can=METAL), "pendulum": pendulum(), "hoop": hoop()}
ROLLINGS = ("reduced", "equality", "contact")
START, STEPS, TIMESTEP = (0.7, 3.0), 10, 1e-3
CHECKOUT = templates.folder()


def stepped(name: str, rolling: str) -> bytes:
    """Return the motion of a model with visuals in MuJoCo's own loop, to the bit."""
    model = build(SCENES[name], rolling, visuals=True, timestep=TIMESTEP)
    data, start = mujoco.MjData(model), state.start(model, SCENES[name], *START)
    data.qpos[:], data.qvel[:] = start[: model.nq], start[model.nq :]
    for _ in range(STEPS):
        mujoco.mj_step(model, data)
    return data.qpos.tobytes() + data.qvel.tobytes()


def simulated(name: str, rolling: str) -> bytes:
    """Return what `simulate` gives, to the bit."""
    run = simulate(SCENES[name], STEPS * TIMESTEP, *START, rolling=rolling, timestep=TIMESTEP)
    return np.concatenate([run.u, run.phi, run.u_dot, run.phi_dot, run.roll, run.lift]).tobytes()


@functools.cache
def unedited(move: Callable[[str, str], bytes], name: str, rolling: str) -> bytes:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(templates, "_FOLDERS", (CHECKOUT,))
        return move(name, rolling)


def assert_same_motion(name: str) -> None:
    for rolling in ROLLINGS:
        for move in (simulated, stepped):
            assert move(name, rolling) == unedited(move, name, rolling), (rolling, move)


def insert(folder: pathlib.Path, file: str, more: str) -> None:
    """Write something at the end of a file, in its outermost element."""
    path = folder / f"{file}.xml"
    before, end, after = path.read_text().rpartition("</")
    path.write_text(f"{before}{more}{end}{after}")


def substitute(folder: pathlib.Path, file: str, old: str, new: str) -> None:
    path = folder / f"{file}.xml"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


# Looks: what is edited, and where it is seen in a model.
SEEN: dict[str, tuple[tuple[str, ...], Callable[[mujoco.MjModel], bool]]] = {
    "colour": (("shared", "0.98 0.63 0.08 1", "0 1 0 1"), lambda m: list(m.mat("beer").rgba) == [0, 1, 0, 1]),
    "own colour": (
        ("sliding", 'mesh="load" material="beer"', 'mesh="load" rgba="0 1 0 1"'),
        lambda m: list(m.geom("load").rgba) == [0, 1, 0, 1],
    ),
    "colour of what touches": (
        ("shared", "0.2 0.6 0.9 0.3", "0 1 0 1"), lambda m: list(m.geom("surface").rgba) == [0, 1, 0, 1],
    ),
    "camera": (("sliding", '0 -0.3 0.04"', '0 -0.5 0.04"'), lambda m: m.camera("side").pos[1] == -0.5),
    "camera in degrees": (
        ("shared", 'xyaxes="1 0 0 0 0.2 1"', 'euler="90 0 0"'),
        lambda m: np.allclose(m.camera("overview").quat, [0.5**0.5, 0.5**0.5, 0, 0]),
    ),
    "light": (("shared", "-0.35 0.7 -0.9", "0 0 -1"), lambda m: list(m.light("sun").dir) == [0, 0, -1]),
    "texture": (("shared", "0.94 0.84 0.69", "0 0 0"), lambda m: m.tex_data[m.tex("planks").adr[0]] == 0),
    "picture": (("shared", 'fovy="32"', 'fovy="60"'), lambda m: m.camera("overview").fovy[0] == 60),
    "centre of view": (("shared", 'extent="0.3"', 'extent="0.5"'), lambda m: m.stat.extent == 0.5),
}  # fmt: skip
MORE = {
    "geom": '<geom name="more" type="box" size="0.1 0.1 0.1" density="1e5" friction="1" gap="1" margin="1"/>',
    "site": '<site name="more" pos="0 0 1"/>',
    "camera": '<camera name="more" pos="0 0 1"/>',
    "light": '<light name="more" pos="0 0 1"/>',
    "geom in a frame": '<frame euler="0 0 30"><geom name="more" size="1" contype="3" mass="7"/></frame>',
}
# What is inserted into a template and moves nothing.
HARMLESS = {
    "keyframe": '<keyframe><key name="more" qpos="0 0 0"/></keyframe>',
    "keyframe of another model": '<keyframe><key name="more" qpos="0 0 0 0 0 0 0"/></keyframe>',
    "text": '<custom><text name="more" data="more"/><numeric name="number" data="1"/></custom>',
    "comment": "<!-- more -->",
    "gravity": '<option gravity="1 2 3"/>',
    "fluid": '<option density="1000" viscosity="1" wind="1 2 3"/>',
    "solver": '<option solver="CG" jacobian="sparse" cone="elliptic" iterations="1" noslip_iterations="3"/>',
    "override": '<option o_margin="0.1" o_solref="0.1 1"><flag override="enable"/></option>',
    "sleep": '<option sleep_tolerance="1e9"><flag sleep="enable"/></option>',
    "actuator groups": '<option actuatorgroupdisable="0"/>',
    "little memory": '<size memory="1K"/>',
    "mean inertia": '<statistic meaninertia="1e-9"/>',
    "total mass": '<compiler settotalmass="1"/>',
    "bounds": '<compiler boundmass="1" boundinertia="1" balanceinertia="true"/>',
    "inertia of geoms": '<compiler inertiafromgeom="true" inertiagrouprange="0 5"/>',
    "fused bodies": '<compiler fusestatic="true" discardvisual="true"/>',
    "radians": '<compiler angle="radian"/>',
    "default joint": '<default><joint damping="1 2" armature="1" stiffness="1" axis="1 1 0" ref="1"/></default>',
    "default geom": '<default><geom mass="1" contype="1" fluidshape="ellipsoid" pos="1 0 0"/></default>',
    "default site": '<default><site pos="1 0 0" quat="0 1 0 0"/></default>',
    "default row": '<default><equality active="false" solref="1 1"/><pair margin="1" gap="1" condim="6"/></default>',
    "default tendon": '<default><tendon damping="1" stiffness="1" range="0 1"/></default>',
    "default actuator": '<default><general gear="3" dyntype="filter" dynprm="1" biastype="affine"/></default>',
    "touching": '<worldbody><geom name="more" size="9" pos="0 0 -9" contype="1" conaffinity="1"/></worldbody>',
}
# What is inserted into a template and could move something; and its name in the error.
REFUSED = {
    "body": ('<worldbody><body name="more"><geom size="1"/></body></worldbody>', "body, named 'more'"),
    "free body": ('<worldbody><body name="more"><freejoint/><geom size="1"/></body></worldbody>', "body, named 'more'"),
    "actuator": ('<actuator><motor name="more" joint="roll"/></actuator>', "actuator, named 'more'"),
    "equality": ('<equality><joint name="more" joint1="roll"/></equality>', "equality, named 'more'"),
    "pair": ('<contact><pair name="more" geom1="load" geom2="wall"/></contact>', "pair, named 'more'"),
    "exclude": ('<contact><exclude name="more" body1="can" body2="load"/></contact>', "exclude, named 'more'"),
    "sensor": ('<sensor><jointpos name="more" joint="roll"/></sensor>', "sensor, named 'more'"),
    "tendon": (
        '<tendon><fixed name="more"><joint joint="roll" coef="1"/></fixed></tendon>', "tendon, named 'more'",
    ),
    "cloth": (
        '<worldbody><flexcomp name="more" type="grid" dim="2" count="2 2 1" spacing="1 1 1" mass="1"/></worldbody>',
        "named 'more",
    ),
    "plugin": (
        '<extension><plugin plugin="mujoco.pid"><instance name="more"/></plugin></extension>', "plugin, named 'more'",
    ),
}  # fmt: skip


@pytest.mark.parametrize("edit", SEEN)
def test_looks_are_the_user_s(copy: pathlib.Path, edit: str) -> None:
    change, is_seen = SEEN[edit]
    assert not is_seen(build(SCENES["sliding"], "contact", visuals=True))
    substitute(copy, *change)
    assert_same_motion("sliding")
    assert is_seen(build(SCENES["sliding"], "contact", visuals=True))


@pytest.mark.parametrize("kind", MORE)
def test_more_may_be_drawn(copy: pathlib.Path, kind: str) -> None:
    """In every body; what is heavy and in the way of the can neither weighs nor touches."""
    text = (copy / "sliding.xml").read_text()
    for body in ("incline", "can", "load"):
        text = re.sub(f'(<body name="{body}"[^>]*>)', rf"\1{MORE[kind].replace('more', body + '_more')}", text)
    (copy / "sliding.xml").write_text(text)
    assert_same_motion("sliding")
    for model in (build(SCENES["sliding"], visuals=True), Display.of([SCENES["sliding"]], 0, 1).model):
        assert len(re.findall(rb"\w+_more", model.names)) == 3


@pytest.mark.parametrize("edit", HARMLESS)
def test_what_is_set_from_the_scene_may_be_anything(copy: pathlib.Path, edit: str) -> None:
    insert(copy, "hoop", HARMLESS[edit])
    assert_same_motion("hoop")


@pytest.mark.parametrize("edit", REFUSED)
def test_what_could_act_on_the_motion_is_refused_by_name(copy: pathlib.Path, edit: str) -> None:
    more, named = REFUSED[edit]
    insert(copy, "hoop", more)
    with pytest.raises(TemplateError) as caught:
        build(SCENES["hoop"])
    message = str(caught.value)
    assert message.startswith(f"{copy / 'hoop.xml'} has a further ")
    assert named in message
    assert "could act on the motion and is not allowed; remove it" in message


@pytest.mark.parametrize("joint", ['<joint name="more"/>', "<joint/>"])
def test_a_further_joint_is_refused(copy: pathlib.Path, joint: str) -> None:
    substitute(copy, "hoop", '<joint name="slide"', f'{joint}<joint name="slide"')
    with pytest.raises(TemplateError, match=r"has a further joint, named '(more)?', which could act on the motion"):
        build(SCENES["hoop"])


@pytest.mark.parametrize(
    ("before", "after"),
    [("</body>", ""), ('<frame euler="0 20 0">', "</frame></body>")],
    ids=["beside the incline", "in a frame"],
)
def test_a_body_elsewhere_is_refused(copy: pathlib.Path, before: str, after: str) -> None:
    substitute(copy, "hoop", '<body name="can"', f'{before}<body name="can"')
    substitute(copy, "hoop", "</body>\n  </worldbody>", f"{after}\n  </worldbody>")
    with pytest.raises(TemplateError, match="has the body 'can' elsewhere than directly in 'incline'; put it there"):
        build(SCENES["hoop"])


def test_joints_in_another_order_move_alike(copy: pathlib.Path) -> None:
    """A slide after a hinge would turn with it."""
    text = (copy / "sliding.xml").read_text()
    slide, roll = re.findall(r"<joint name=\"(?:slide|roll)\" type[^>]*>", text)
    (copy / "sliding.xml").write_text(text.replace(slide, "").replace(roll, roll + slide))
    assert_same_motion("sliding")


# The sweeps: whatever is written, the motion is the same or there is an error. With visuals a model has all stages.
def outcome(name: str, rolling: str = "contact") -> str:
    try:
        assert stepped(name, rolling) == unedited(stepped, name, rolling)
    except MjbeerError:
        return "refused"
    return "same"


ATTRIBUTE = re.compile(r'(?<=[\w]=")[^"]*(?=")')
OTHER = {"true": "false", "false": "true", "enable": "disable", "disable": "enable"}


def changed(text: str) -> str:
    """Return another value that MuJoCo mostly takes: the first number doubled and one more, or another word."""
    first, *rest = text.split()
    try:
        return " ".join([repr(2 * float(first) + 1), *rest])
    except ValueError:
        return OTHER.get(text, text + "_")


@pytest.mark.parametrize(
    ("file", "name"), [("sliding", "sliding"), ("hoop", "hoop"), ("shared", "hoop"), ("incline", "hoop")]
)
def test_any_attribute_may_be_another(copy: pathlib.Path, file: str, name: str) -> None:
    path = copy / f"{file}.xml"
    text, outcomes = path.read_text(), []
    for attribute in ATTRIBUTE.finditer(text):
        path.write_text(text[: attribute.start()] + changed(attribute[0]) + text[attribute.end() :])
        outcomes.append(outcome(name))
    assert outcomes.count("same") >= len(outcomes) / 3


# Where attributes are added that the templates do not have: a path in MuJoCo's schema, and elements of a template.
GLOBAL = (
    "compiler", "compiler/lengthrange", "option", "option/flag", "size", "statistic", "default/joint", "default/geom",
    "default/site", "default/equality", "default/pair", "default/tendon", "default/general",
)  # fmt: skip
LOCAL = {
    "(world)body": ("<worldbody", '<body name="incline"', '<body name="can"', '<body name="load"'),
    "(world)body/inertial": ("<inertial",),
    "(world)body/joint": ('<joint name="roll"',),
    "(world)body/geom": ('<geom name="can_mark"',),
    "contact/pair": ('<pair name="rolling"',),
}
NUMBERS = ("0.3", "1", "0.3 0.4", "0.3 0.4 0.5", "1 0.4 0.3 0.5", "0.8 0.9 0.1 0.5 2", "1 0.2 0.3 0.4 0.5 0.6")


@functools.cache
def schema() -> dict[str, list[str]]:
    """Return the attributes of every element of MJCF, by its path."""
    found: dict[str, list[str]] = {}
    path: list[str] = []
    for line in mujoco.mj_printSchema(False, False).splitlines():
        element, attributes = line[:27].rstrip(), line[27:].split()
        if element:
            depth = (len(element) - len(element.lstrip())) // 3
            path = [*path[:depth], element.split()[0]]
        found.setdefault("/".join(path[1:]), []).extend(attributes)
    return found


def outcomes_of(folder: pathlib.Path, write: Callable[[str], str], rolling: str = "contact") -> list[str]:
    """Return what comes of words, and of the first list of numbers, that MuJoCo takes for an attribute."""
    found, shared = [], {file: (folder / file).read_bytes() for file in ("shared.xml", "incline.xml")}
    for values in (*((word,) for word in OTHER), NUMBERS):
        for text in map(write, values):
            try:
                mujoco.MjSpec.from_string(text, include=shared)
            except ValueError:
                continue
            (folder / "hoop.xml").write_text(text)
            found.append(outcome("hoop", rolling))
            break
    return found


@pytest.mark.parametrize("place", GLOBAL)
def test_any_setting_may_be_added(copy: pathlib.Path, place: str) -> None:
    attributes = [attribute for attribute in schema()[place] if attribute not in ("class", "user")]
    assert len(attributes) >= 3
    text, outer, outcomes = (copy / "hoop.xml").read_text(), place.split("/"), []
    rolling = "reduced" if place in ("default/site", "default/tendon", "default/general") else "contact"
    for attribute in attributes:

        def write(value: str, attribute: str = attribute) -> str:
            inner = f'<{outer[-1]} {attribute}="{value}"/>'
            more = inner if len(outer) == 1 else f"<{outer[0]}>{inner}</{outer[0]}>"
            return text.replace("</mujoco>", f"{more}</mujoco>")

        outcomes += outcomes_of(copy, write, rolling)
    assert outcomes.count("same") >= len(attributes) / 2


@pytest.mark.parametrize(("place", "element"), [(place, element) for place in LOCAL for element in LOCAL[place]])
def test_any_attribute_may_be_added(copy: pathlib.Path, place: str, element: str) -> None:
    text, outcomes = (copy / "hoop.xml").read_text(), []
    start = text.index(element)
    end = text.index(">", start)
    for attribute in schema()[place]:
        if attribute in ("name", "class", "childclass", "user"):
            continue

        def write(value: str, attribute: str = attribute) -> str:
            bare = re.sub(rf' {attribute}="[^"]*"', "", text[start:end]).replace(
                element, f'{element} {attribute}="{value}"'
            )
            return text[:start] + bare + text[end:]

        outcomes += outcomes_of(copy, write)
    assert outcomes.count("same") >= len(outcomes) / 2
    assert outcomes or element == "<worldbody"


def test_every_kind_of_element_is_allowed_or_refused() -> None:
    """One that a later MuJoCo adds must be thought about."""
    spec = mujoco.MjSpec()
    kinds = {kind for kind in dir(spec) if isinstance(getattr(type(spec), kind, None), property)
             and kind != "copy_during_attach" and isinstance(getattr(spec, kind), list)}  # fmt: skip
    assert kinds == {"bodies", "frames", *appearance.DRAWN, *templates._MECHANISM}


OBJ = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def test_mesh_files_may_be_the_user_s(copy: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """In the place of the can's, and for a geom of the user's own; an exported file finds them."""
    (copy / "assets" / "own.obj").write_text(OBJ)
    substitute(
        copy, "sliding", 'name="can" file="can.obj"/>', 'name="can" file="own.obj"/><mesh file="own.obj" name="o"/>'
    )
    substitute(copy, "sliding", "</mujoco>", '<worldbody><geom type="mesh" mesh="o"/></worldbody></mujoco>')
    assert_same_motion("sliding")
    model = build(SCENES["sliding"], visuals=True)
    assert model.mesh("can").vertnum[0] == model.mesh("o").vertnum[0] == 4
    export(SCENES["sliding"], tmp_path / "exported.xml")
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "exported.xml")).mesh("o").vertnum[0] == 4


def test_a_mesh_file_that_is_missing_is_named(copy: pathlib.Path, tmp_path: pathlib.Path) -> None:
    substitute(copy, "sliding", 'name="can" file="can.obj"', 'name="can" file="own.obj"')
    assert all(simulated("sliding", rolling) == unedited(simulated, "sliding", rolling) for rolling in ROLLINGS)
    for draw in (lambda scene: Display.of([scene], 0, 1), lambda scene: export(scene, tmp_path / "exported.xml")):
        with pytest.raises(UnsupportedError, match=r"own\.obj"):
            draw(SCENES["sliding"])


def test_the_meshes_that_came_with_mjbeer_are_never_read(copy: pathlib.Path) -> None:
    shutil.rmtree(copy / "assets")
    for name in SCENES:
        assert_same_motion(name)


def test_line_ends_may_be_those_of_another_system(copy: pathlib.Path) -> None:
    for path in copy.glob("*.xml"):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    for name in SCENES:
        assert_same_motion(name)


def test_an_export_of_an_edited_template_moves_alike(copy: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """Defaults and classes that are written to the file must not come back into the motion."""
    for more in ("default joint", "default geom", "default row", "default tendon", "default actuator"):
        insert(copy, "frozen", HARMLESS[more])
    substitute(copy, "frozen", '<body name="can"', '<body name="can" childclass="visual"')
    for rolling in ROLLINGS:
        export(SCENES["frozen"], tmp_path / "exported.xml", *START, rolling, timestep=TIMESTEP)
        model = mujoco.MjModel.from_xml_path(str(tmp_path / "exported.xml"))
        built = build(SCENES["frozen"], rolling, visuals=True, timestep=TIMESTEP)
        for array in ("dof_damping", "dof_armature", "jnt_stiffness", "jnt_axis", "qpos0", "body_mass", "geom_contype",
                      "pair_margin", "pair_gap", "pair_dim", "eq_active0", "actuator_gear", "actuator_dyntype",
                      "site_pos"):  # fmt: skip
            assert np.array_equal(getattr(model, array), getattr(built, array)), array
        for array in ("tendon_damping", "tendon_stiffness", "tendon_armature", "tendon_limited"):
            assert np.array_equal(getattr(model, array)[: built.ntendon], getattr(built, array)), array
            assert not getattr(model, array)[built.ntendon :].any(), array  # those of the sensors


def test_the_command_line_says_it_in_one_line(copy: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    insert(copy, "hoop", REFUSED["actuator"][0])
    assert main(["simulate", "hoop"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith(f"mjbeer: {copy / 'hoop.xml'} has a further actuator, named 'more', which")
    assert said.err.count("\n") == 1
