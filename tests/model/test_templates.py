"""The MJCF as a stock MuJoCo user finds it, where a file is missing, and where one is edited.

An edited file is stepped as it stands, or is an error.
"""

import math
import pathlib
import re
import shutil
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Callable
from typing import NamedTuple

import mujoco
import numpy as np
import pytest

from mjbeer import (
    Run,
    Scene,
    build,
    exact,
    export,
    frozen,
    hoop,
    pendulum,
    refill,
    simulate,
    sliding,
    specify,
    standing,
)
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
KEYS = [
    (name, key.attrib["name"])
    for name in FILES
    for key in ET.parse(OWN / f"{name}.xml").iter("key")
]
# The softness of the constraints, and RK4 at the file's timestep: 2e-5 rad at worst, on 89 rad of
# roll-down.
PROMISE = 1e-3


def load(name: str) -> mujoco.MjModel:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return mujoco.MjModel.from_xml_path(str(OWN / f"{name}.xml"))


def places_of_phi(model: mujoco.MjModel) -> list[int]:
    """Return where qpos has the angles that add up to phi, and qvel their rates."""
    places = joint_addresses(model)
    return [places[name] for name in ("roll", "swing", "phi") if name in places]


class Roll(NamedTuple):
    """What plain mj_step does from a keyframe, after every ten steps."""

    times: np.ndarray
    phi: np.ndarray
    end: mujoco.MjData


def at_key(model: mujoco.MjModel, key: str) -> mujoco.MjData:
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    return data


def roll(model: mujoco.MjModel, key: str, duration: float) -> Roll:
    data = at_key(model, key)
    times = [0.0]
    positions = [data.qpos.copy()]
    while data.time < duration:
        mujoco.mj_step(model, data, 10)
        times.append(data.time)
        positions.append(data.qpos.copy())
    phi = np.array(positions)[:, places_of_phi(model)].sum(axis=1)
    return Roll(np.array(times), phi, data)


def start_of(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
    """Return phi [rad] and phi_dot [rad/s] of a state."""
    places = places_of_phi(model)
    return float(data.qpos[places].sum()), float(data.qvel[places].sum())


@pytest.mark.parametrize(("name", "key"), KEYS)
def test_the_positions_of_a_keyframe_are_those_of_its_phi(name: str, key: str) -> None:
    model = load(name)
    data = at_key(model, key)

    qpos, _ = initial_joints(joint_addresses(model), FILES[name], *start_of(model, data))

    assert np.allclose(data.qpos, qpos, rtol=1e-11, atol=1e-15)  # the file has twelve digits


@pytest.mark.slow
@pytest.mark.parametrize(("name", "key"), KEYS)
def test_keyframes_move_as_theory_says(name: str, key: str) -> None:
    """They are followed for 2 s, and the hoop until it hops."""
    scene = FILES[name]
    model = load(name)
    start = start_of(model, at_key(model, key))
    hops = math.inf
    if name == "hoop":
        hops = exact(scene, np.linspace(0, 2, 2_001), *start).rolls_until()

    rolled = roll(model, key, 2.0)

    before = rolled.times <= hops
    truth = exact(scene, rolled.times[before], *start)
    assert np.abs(rolled.phi[before] - truth.phi).max() < PROMISE
    assert not any(warning.number for warning in rolled.end.warning)


@pytest.mark.parametrize("name", FILES)
def test_all_cans_that_roll_have_three_keyframes(name: str) -> None:
    assert {"home", "equilibrium", "swing"} <= {key for file, key in KEYS if file == name}


@pytest.mark.parametrize("name", FILES)
def test_a_can_is_at_rest_at_phi_0_at_home(name: str) -> None:
    model = load(name)

    home = at_key(model, "home")

    assert not home.qpos[places_of_phi(model)].any()
    assert not home.qvel[places_of_phi(model)].any()


@pytest.mark.parametrize("path", sorted(OWN.rglob("*.xml")), ids=lambda path: path.stem)
def test_a_file_has_one_worldbody_and_one_element_a_line(path: pathlib.Path) -> None:
    text = path.read_text()
    assert text.count("<worldbody>") <= 1
    without_comments = re.sub("<!--.*?-->", "", text, flags=re.DOTALL)
    assert max(line.count("<") for line in without_comments.splitlines()) == 1


@pytest.mark.parametrize(("key", "duration", "height"), [("hop", 0.43, 1e-6), ("push", 0.3, 0.02)])
def test_the_hoop_hops(key: str, duration: float, height: float) -> None:
    """It hops by 15 um if it is let go, and by a radius of 33 mm if it is pushed.

    A penetration would be negative.
    """
    end = roll(load("hoop"), key, duration).end

    assert end.joint("lift").qpos[0] > height


@pytest.mark.parametrize("name", templates.TEMPLATES)
def test_what_a_viewer_opens_is_made_from_mechanics_and_looks(name: str) -> None:
    """`make templates` writes them."""
    assert (OWN / f"{name}.xml").read_text() == templates.text(name, OWN)


@pytest.fixture(scope="module")
def readme() -> dict[str, str]:
    """Return the sections of the README by their headings."""
    sections = (OWN / "README.md").read_text().split("\n## ")
    return {text.partition("\n")[0]: text for text in sections}


class Parameter(NamedTuple):
    """A number of the README's table: its element, its attribute and the files that have it."""

    element: str
    attribute: str
    files: str


@pytest.fixture(scope="module")
def parameters(readme: dict[str, str]) -> list[Parameter]:
    """Return the README's table of parameters; a row may have several attributes."""
    table = re.findall(
        r"^\| `(.*?)` \| `(.*?)` \|.*\| ([^|]*) \|$", readme["Parameters"], re.MULTILINE
    )
    return [
        Parameter(element, attribute, files)
        for element, attributes, files in table
        for attribute in attributes.split("`, `")
    ]


@pytest.mark.parametrize("name", MECHANICS)
def test_the_readme_lists_each_number_that_mjbeer_writes(
    name: str, parameters: list[Parameter]
) -> None:
    scene, rolling = MECHANICS[name]

    written = set(ModelNumbers(scene, Setting(rolling)).parameters)

    listed = {
        (parameter.element, parameter.attribute)
        for parameter in parameters
        if fits(name, parameter.files)
    }
    assert listed == written


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize(
    ("section", "kind"),
    [
        ("Joints", "joints"),
        ("Cameras", "cameras"),
        ("Sensors", "sensors"),
        ("Keyframes", "keys"),
    ],
)
def test_the_readme_lists_what_can_be_named(
    section: str, kind: str, name: str, readme: dict[str, str]
) -> None:
    listed = set(re.findall("`([^`]*)`", readme[section]))

    spec = mujoco.MjSpec.from_file(str(OWN / f"{name}.xml"))

    assert {named.name for named in getattr(spec, kind)} <= listed


def fits(name: str, files: str) -> bool:
    """Return whether a row of the table is about a mechanics file.

    The row names "all", or parts, and the name of the file has all words of one part.
    """
    return files == "all" or any(
        all(word in name for word in part.split()) for part in files.split(", ")
    )


# What is missing


@pytest.mark.parametrize("file", ["mechanics/frozen_reduced.xml", "looks/frozen.xml", "scene.xml"])
@pytest.mark.parametrize("content", [None, "", "<mujoco>", "<mujoco><worldbody></mujoco>"])
def test_a_file_that_is_missing_or_not_whole_is_named(
    copy: pathlib.Path, file: str, content: str | None
) -> None:
    if content is None:
        (copy / file).unlink()
    else:
        (copy / file).write_text(content)

    with pytest.raises(TemplateError, match=rf"{pathlib.Path(file).name} is not readable MJCF: "):
        build(frozen(), visuals=True)


def test_a_parameter_that_has_no_place_is_named(copy: pathlib.Path) -> None:
    edit(copy, "mechanics/sliding_reduced", '<fixed name="damper"', '<fixed name="other"')
    with pytest.raises(
        TemplateError,
        match=r"sliding_reduced\.xml has no 'fixed damper', into which mjbeer writes damp",
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


class Edit(NamedTuple):
    """In which file what is replaced by what, and what comes of it."""

    file: str
    old: str
    new: str
    outcome: str = ERROR


WRONG = "gives phi an acceleration that differs from theory by .*|gives .* rows of constraints"
EDITS = {
    "colour": Edit("assets", "0.98 0.63 0.08 1", "0 1 0 1", SAME),
    "camera": Edit("looks/sliding", '0 -0.3 0.04"', '0 -0.5 0.04"', SAME),
    "mesh": Edit(
        "assets", 'mesh name="can" file="can.obj"', 'mesh name="can" file="tab.obj"', SAME
    ),
    "drawn geom that is heavy": Edit(
        "looks/sliding",
        '<geom name="can_end"',
        '<geom name="more" class="visual" type="mesh" mesh="lid" mass="7"/><geom name="can_end"',
        SAME,
    ),
    "further sensors": Edit(
        REDUCED, "<sensor>", '<sensor><clock/><framepos objtype="body" objname="can"/>', SAME
    ),
    "geom that touches nothing": Edit(
        EQUALITY, CAN, f'{CAN}<geom size="0.01" contype="0" conaffinity="0"/>', SAME
    ),
    "motor that nobody turns": Edit(
        FROZEN, "<actuator>", '<actuator><motor joint="phi" gear="3"/>', SAME
    ),
    "damped joint": Edit(REDUCED, PHI, f'{PHI} damping="1e-4"', ERROR),
    "spring of the tendon": Edit(
        REDUCED, 'name="damper"', 'name="damper" stiffness="1e-3" springlength="0.1"', ERROR
    ),
    "another axis": Edit(REDUCED, PHI, PHI.replace("0 1 0", "0 -1 1"), ERROR),
    "dry friction": Edit(EQUALITY, SWING, f'{SWING} frictionloss="1e-4"', ERROR),
    "limit": Edit(EQUALITY, SWING, f'{SWING} range="-90 90"', ERROR),
    "further joint": Edit(REDUCED, CAN, f'{CAN}<joint name="more" axis="1 0 0"/>', ERROR),
    "second load": Edit(
        EQUALITY,
        CAN,
        f'{CAN}<body><inertial pos="0 0 0.01" mass="0.01" diaginertia="1e-6 1e-6 1e-6"/></body>',
        ERROR,
    ),
    "wind": Edit(REDUCED, "<option ", '<option density="1.2" wind="1 0 0" ', ERROR),
    "no damping": Edit(
        REDUCED, 'constraint="disable"', 'constraint="disable" damper="disable"', ERROR
    ),
    "no actuation": Edit(
        FROZEN, 'constraint="disable"', 'constraint="disable" actuation="disable"', ERROR
    ),
    "shorter arm of the chord": Edit(
        FROZEN, 'name="chord_end" pos="0 0 -1"', 'name="chord_end" pos="0 0 -0.9"', ERROR
    ),
    "gear of the weight": Edit(FROZEN, 'name="weight"', 'name="weight" gear="2"', ERROR),
    "bounds of masses": Edit(
        REDUCED, OUTER, f'<compiler boundmass="1" boundinertia="1"/>{OUTER}', ERROR
    ),
    "heavier wheel": Edit(EQUALITY, 'mass="0.00856', 'mass="0.0856', PARAMETER),
    "heavier load": Edit(FROZEN, 'mass="0.205', 'mass="0.493', PARAMETER),
    "steeper incline": Edit(REDUCED, 'euler="0 10 0"', 'euler="0 20 0"', PARAMETER),
}


def edit(folder: pathlib.Path, file: str, old: str, new: str) -> None:
    path = folder / f"{file}.xml"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def shown_by(file: str) -> tuple[Scene, Rolling]:
    """Return a scene that shows a file, and how it rolls."""
    folder, _, name = file.partition("/")
    return MECHANICS[name] if folder == "mechanics" else (sliding(can=METAL), "equality")


def accelerations(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Return the accelerations at the start, of which each rate is multiplied by its place."""
    data = at_key(model, "start")
    data.qvel[:] *= np.arange(1, model.nv + 1)
    mujoco.mj_forward(model, data)
    return data.qacc.copy()


START = {"phi0": 0.7, "phi_dot0": 3.0}
NAMES_THE_PARAMETER = "mjbeer writes a scene's own numbers into"
HARMLESS = [name for name, change in EDITS.items() if change.outcome == SAME]
HARMFUL = [name for name, change in EDITS.items() if change.outcome != SAME]
# What has no joint to compare or moves nothing in the state of `accelerations`.
UNMOVED = ("no damping", "dry friction", "limit", "further joint")
MOVED = [name for name in HARMFUL if EDITS[name].outcome == ERROR and name not in UNMOVED]


class Edited(NamedTuple):
    """A folder in which a file is edited, and a scene that shows the file."""

    scene: Scene
    rolling: Rolling
    path: str
    """Of the file, as a regular expression."""
    exported: pathlib.Path
    """Where the scene is exported to."""

    def run(self) -> Run:
        return simulate(self.scene, 0.02, **START, rolling=self.rolling)

    def export(self) -> None:
        export(self.scene, self.exported, **START, rolling=self.rolling)


@pytest.fixture
def edited(name: str, copy: pathlib.Path, tmp_path: pathlib.Path) -> Edited:
    """Make the edit of a name in a copy of the folder, which mjbeer then reads."""
    change = EDITS[name]
    edit(copy, change.file, change.old, change.new)
    scene, rolling = shown_by(change.file)
    path = re.escape(str(copy / f"{change.file}.xml"))
    return Edited(scene, rolling, path, tmp_path / "model.xml")


@pytest.mark.slow
@pytest.mark.parametrize("name", HARMLESS)
def test_an_edit_that_changes_no_motion_is_taken_without_a_word(edited: Edited) -> None:
    right = simulate(edited.scene, 0.02, **START, rolling=edited.rolling, mjcf=OWN)

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = edited.run()
        edited.export()
        build(edited.scene, edited.rolling, visuals=True)
        specify(edited.scene, edited.rolling)

    assert run.phi.tobytes() == right.phi.tobytes()


@pytest.mark.slow
@pytest.mark.parametrize("make", [Edited.run, Edited.export])
@pytest.mark.parametrize("name", HARMFUL)
def test_an_edit_that_changes_the_motion_ends_runs_and_exports(
    name: str, make: Callable[[Edited], object], edited: Edited
) -> None:
    message = f"^{edited.path} ({WRONG}|gives the joints|has other numbers)"

    with pytest.raises(TemplateError, match=message) as caught:
        make(edited)

    assert (NAMES_THE_PARAMETER in str(caught.value)) == (EDITS[name].outcome == PARAMETER)


@pytest.mark.slow
@pytest.mark.parametrize("make", [specify, build])
@pytest.mark.parametrize("name", HARMFUL)
def test_a_model_warns_of_an_edit_that_changes_the_motion(
    make: Callable[[Scene, Rolling], object], edited: Edited
) -> None:
    with pytest.warns(UntrustedWarning, match=f"^{edited.path} "):
        make(edited.scene, edited.rolling)


@pytest.mark.slow
@pytest.mark.parametrize("name", MOVED)
def test_a_model_has_the_edit_that_it_warns_of(edited: Edited) -> None:
    ordinary = build(edited.scene, edited.rolling, **START, mjcf=OWN)

    with pytest.warns(UntrustedWarning, match=f"^{edited.path} "):
        model = build(edited.scene, edited.rolling, **START)

    found = accelerations(model, edited.scene)
    assert not np.allclose(found, accelerations(ordinary, edited.scene), rtol=1e-9)


METRES = 'joint1="slide" joint2="roll" polycoef="0 0.033 0 0 0"'
ANGLES = 'joint1="roll" joint2="slide" polycoef="0 30.303030303 0 0 0"'


def slip_from(text: str, key: str) -> float:
    """Return the largest slip [m] in two seconds of plain mj_step from a keyframe of a text."""
    model = mujoco.MjModel.from_xml_string(text)
    data = at_key(model, key)
    sensor = data.sensor("slip").data
    slip = 0.0
    while data.time < 2:
        mujoco.mj_step(model, data)
        slip = max(slip, abs(sensor[0]))
    return slip


@pytest.mark.parametrize("name", ["frozen_equality", "sliding_equality"])
def test_an_equality_in_angles_needs_no_flag(name: str) -> None:
    """Without the flags it slips by what the files say; a row in metres slips 1000 times that."""
    text = (OWN / "mechanics" / f"{name}.xml").read_text()
    assert ANGLES in text
    without_flags = text.replace('diagexact="enable" refsafe="disable" ', "")
    assert without_flags != text

    assert slip_from(text, "swing") < 3e-10
    assert 1e-9 < slip_from(without_flags, "swing") < 4.2e-9
    assert slip_from(without_flags.replace(ANGLES, METRES), "swing") > 1e-6


def test_an_equality_as_usually_written_hardly_rolls() -> None:
    """It is in metres and has MuJoCo's own softness, on a roll-down that is 89 radii long."""
    text = (OWN / "mechanics" / "frozen_equality.xml").read_text()
    soft = re.sub(r'solref="0.0005 1"\s+solimp="0.9999 0.9999"', "", text.replace(ANGLES, METRES))
    usual = soft.replace('diagexact="enable"', "")

    slip_in_radii = slip_from(usual, "roll_down") / METAL.radius

    assert 1.0 < slip_in_radii < 10.0


@pytest.mark.parametrize(
    ("name", "slip", "slip_without"),
    [("frozen_contact", 1.4e-9, 2.2e-7), ("sliding_contact", 2.8e-8, 7.2e-8)],
)
def test_a_contact_needs_its_options(name: str, slip: float, slip_without: float) -> None:
    """What the comment in the file says is lost in a world without them."""
    text = (OWN / "mechanics" / f"{name}.xml").read_text()
    options = (
        r'cone="elliptic" impratio="100"\s+tolerance="[^"]*"|diagexact="enable" refsafe="disable" '
    )
    without_options, count = re.subn(options, "", text)
    assert count == 2

    # In metres, to about the one digit that the comments show.
    assert slip_from(text, "swing") == pytest.approx(slip, rel=0.2)
    assert slip_from(without_options, "swing") == pytest.approx(slip_without, rel=0.2)


def places_from(text: str, key: str) -> np.ndarray:
    """Return where a free can is in two seconds from a keyframe, shape (samples, nq)."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    places = []
    for _ in range(2000):
        places.append(data.qpos.copy())
        mujoco.mj_step(model, data)
    return np.array(places)


def test_a_lying_can_needs_its_options() -> None:
    """It slides instead of rolling by as much as the comment in the file says."""
    text = (OWN / "mechanics" / "lying.xml").read_text()
    without_options, count = re.subn(
        r'cone="elliptic" impratio="100"|<flag refsafe="disable"/>', "", text
    )
    assert count == 2

    for file, expected in ((text, 2.9e-8), (without_options, 1.05e-7)):
        places = places_from(file, "swing")
        along = places[:, 0] * np.cos(np.radians(10)) - places[:, 2] * np.sin(np.radians(10))
        turn = np.unwrap(2 * np.arctan2(places[:, 5], places[:, 3]))
        slip = np.ptp(along - METAL.radius * turn)
        assert slip == pytest.approx(expected, rel=0.2)


def test_a_standing_can_needs_its_cone() -> None:
    """It creeps by as much as the comment in the file says, to the one digit that is there."""
    text = (OWN / "mechanics" / "standing.xml").read_text()
    pyramidal = text.replace('cone="elliptic"', "")
    assert pyramidal != text

    assert np.ptp(places_from(text, "slosh")[:, 0]) == pytest.approx(2.4e-5, rel=0.2)
    assert np.ptp(places_from(pyramidal, "slosh")[:, 0]) == pytest.approx(4.8e-5, rel=0.2)


def test_a_constraint_that_is_softer_is_stepped_as_it_stands(copy: pathlib.Path) -> None:
    """Its accelerations are those of rolling, and what it creeps shows in the run."""
    edit(copy, "mechanics/frozen_contact", 'solimp="0.9999 0.9999"', 'solimp="0.9 0.9"')

    hard = simulate(frozen(), 0.5, 1.0, rolling="contact", mjcf=OWN)
    soft = simulate(frozen(), 0.5, 1.0, rolling="contact")

    assert np.abs(soft.slip).max() > 100 * np.abs(hard.slip).max()


ROLL = '<joint name="roll" axis="0 1 0"'
SLIDE = '<joint name="slide" type="slide" axis="1 0 0" damping="0 0 0"'
SURFACE = '<body name="can"'
WALL = '<geom name="wall" type="box" size="0.01 1 1" pos="0.2 0 0.5"'
WALL_TOUCHES = f'{WALL} contype="2"/>{SURFACE}'
FAR = '<fixed name="far" {}><joint joint="slide" coef="1"/></fixed></tendon>'
SLACK = FAR.format('stiffness="9" springlength="-1 0.3"')
# What acts only later in a run, or nowhere near the states at which a file is compared with theory.
# The can leaves the first centimetres after 0.1 s.
LATE = {
    "limit of the slide": [Edit(EQUALITY, SLIDE, f'{SLIDE} limited="true" range="-0.5 0.5"')],
    "limit of the slide with a margin": [
        Edit(EQUALITY, SLIDE, f'{SLIDE} limited="true" range="-9 0.9" margin="0.5"')
    ],
    "limit of the turn": [Edit(EQUALITY, ROLL, f'{ROLL} limited="true" range="-700 700"')],
    "limit of a tendon": [Edit(EQUALITY, "</tendon>", FAR.format('limited="true" range="-1 0.3"'))],
    "slack spring": [Edit(EQUALITY, "</tendon>", SLACK)],
    "slack spring of a reduced can": [Edit(REDUCED, "</tendon>", SLACK)],
    "wall": [
        Edit(CONTACT, SURFACE, WALL_TOUCHES),
        Edit(
            CONTACT, 'quat="1 1 0 0" contype="0" conaffinity="0"', 'quat="1 1 0 0" conaffinity="2"'
        ),
    ],
}


@pytest.mark.parametrize("times", [None, [0.1, 3.0]], ids=["all steps", "two times"])
@pytest.mark.parametrize("name", LATE)
def test_an_edit_that_acts_late_is_an_error(
    name: str, times: list[float] | None, copy: pathlib.Path
) -> None:
    """A short run, in which it does not act, is no error."""
    for change in LATE[name]:
        edit(copy, change.file, change.old, change.new)
    edited = LATE[name][0].file  # all edits of a name are in one file
    _, rolling = shown_by(edited)
    scene = sliding(can=METAL, damping=1e-4)
    simulate(scene, 0.02, 1.0, rolling=rolling)

    path = re.escape(str(copy / f"{edited}.xml"))
    message = f"^{path} ({WRONG}|lets geoms touch other).* in a state of this run$"
    with pytest.raises(TemplateError, match=message):
        simulate(scene, 3.0, 1.0, rolling=rolling, times=times)


def test_an_edit_that_changes_little_is_an_error(copy: pathlib.Path) -> None:
    """A run may claim an error of 1e-10 rad: an edit must not be ten times that."""
    edit(copy, EQUALITY, '<body name="can"', '<body name="can" gravcomp="1e-8"')
    with pytest.raises(TemplateError, match="gives phi an acceleration"):
        simulate(sliding(can=METAL), 1.0, 1.0, rolling="equality")


def test_the_digests_are_those_of_the_shipped_files() -> None:
    """`make templates` writes them."""
    assert check.SHIPPED.read_text() == templates.digests(OWN)


@pytest.mark.parametrize(("scene", "rolling"), MECHANICS.values(), ids=MECHANICS)
def test_runs_of_a_shipped_file_need_no_check(scene: Scene, rolling: Rolling) -> None:
    assert not check.is_edited(ModelNumbers(scene, Setting(rolling, mjcf=OWN)))


def test_a_file_with_one_comment_more_is_another_one(copy: pathlib.Path) -> None:
    edit(copy, EQUALITY, "</mujoco>", "<!-- more --></mujoco>")

    assert check.is_edited(ModelNumbers(sliding(can=METAL), Setting("equality")))


def test_all_files_move_as_theory_says() -> None:
    for name, (scene, rolling) in MECHANICS.items():
        assert check_file(OWN, scene.attachment, rolling) is None, name


@pytest.fixture
def rewritten(file: str, copy: pathlib.Path) -> pathlib.Path:
    """Return the path of a mechanics file, or of one that it includes from now on."""
    path = copy / f"{file}.xml"
    mechanics = copy / "mechanics" / "sliding_equality.xml"
    if path != mechanics:
        text = mechanics.read_text()
        (part,) = re.findall(r"<equality>.*</equality>", text, re.DOTALL)
        path.write_text(f"<mujoco>{part}</mujoco>")
        mechanics.write_text(text.replace(part, '<include file="included.xml"/>'))
    return path


itself_or_what_it_includes = pytest.mark.parametrize(
    "file", ["mechanics/sliding_equality", "mechanics/included"]
)
MORE = '<equality><joint joint1="swing"/></equality></mujoco>'
MORE_ROWS = r"sliding_equality\.xml gives \d+ rows of constraints"


@itself_or_what_it_includes
def test_a_run_reads_a_file_again_that_is_edited_between_two_calls(rewritten: pathlib.Path) -> None:
    scene = sliding(can=METAL)
    before = rewritten.read_text()
    right = simulate(scene, 0.02, 1.0, rolling="equality")

    rewritten.write_text(before.replace("</mujoco>", MORE))
    with pytest.raises(TemplateError, match=MORE_ROWS):
        simulate(scene, 0.02, 1.0, rolling="equality")

    rewritten.write_text(before)
    assert simulate(scene, 0.02, 1.0, rolling="equality").phi.tobytes() == right.phi.tobytes()


@itself_or_what_it_includes
def test_a_model_reads_a_file_again_that_is_edited_between_two_calls(
    rewritten: pathlib.Path,
) -> None:
    """Its warning goes once the file is restored."""
    scene = sliding(can=METAL)
    before = rewritten.read_text()
    build(scene, "equality")

    rewritten.write_text(before.replace("</mujoco>", MORE))
    with pytest.warns(UntrustedWarning, match=MORE_ROWS):
        build(scene, "equality")

    rewritten.write_text(before)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        build(scene, "equality")


def test_a_mesh_that_is_edited_between_two_calls_is_read_again(copy: pathlib.Path) -> None:
    before = build(sliding(can=METAL), "equality", visuals=True).nmeshvert

    shutil.copy(copy / "assets" / "tab.obj", copy / "assets" / "can.obj")

    assert build(sliding(can=METAL), "equality", visuals=True).nmeshvert != before


@pytest.fixture
def other_folder(
    copy: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> pathlib.Path:
    """Return a folder whose mjcf is edited; the one that the process is in has one that is not."""
    other = tmp_path / "other"
    other.mkdir()
    shutil.copytree(copy, other / "mjcf")
    damped = EDITS["damped joint"]
    edit(other / "mjcf", damped.file, damped.old, damped.new)
    monkeypatch.chdir(tmp_path)
    return other


def test_a_run_keeps_the_relative_folder_of_its_call(
    other_folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`chdir` does not make the folder another one for a run that was made before."""
    run = simulate(sliding(), 0.02, 1.0, mjcf="mjcf")

    monkeypatch.chdir(other_folder)

    assert run.error_estimate < 1e-6


def test_after_chdir_a_relative_folder_is_another_one(
    other_folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulate(sliding(), 0.02, 1.0, mjcf="mjcf")

    monkeypatch.chdir(other_folder)

    with pytest.raises(
        TemplateError, match=r"other/mjcf/mechanics/sliding_reduced\.xml gives phi an acc"
    ):
        simulate(sliding(), 0.02, 1.0, mjcf="mjcf")


def test_a_folder_of_one_s_own_has_looks_of_its_own(
    copy: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The environment names it, or a parameter."""
    colour = EDITS["colour"]
    edit(copy, colour.file, colour.old, colour.new)
    green = [0, 1, 0, 1]

    assert list(build(SCENES["sliding"], visuals=True).mat("beer").rgba) == green

    monkeypatch.delenv("MJBEER_MJCF")
    assert list(build(SCENES["sliding"], visuals=True).mat("beer").rgba) != green
    assert list(build(SCENES["sliding"], visuals=True, mjcf=copy).mat("beer").rgba) == green


# What stands


TURNED = np.random.default_rng(5).normal(size=(200, 4))


@pytest.mark.parametrize("fill", [None, 0.05, 0.1, 0.2, 0.5, 0.8, 0.97])
def test_what_is_drawn_of_a_standing_can_s_beer_stays_inside_the_wall(fill: float | None) -> None:
    """It does however the pendulum hangs.

    This is so of the file that a viewer opens, and of a half-full can that is `refill`ed.
    """
    model = load("standing") if fill is None else build(standing(fill=0.5), visuals=True)
    if fill is not None:
        refill(model, standing(fill=fill), prefix="")
    data = mujoco.MjData(model)
    radius, half_length, _ = model.geom("can").size
    length = 2 * half_length
    turn = np.linspace(0, 2 * np.pi, 33)

    for quat in (*np.eye(4)[:1], *TURNED):
        data.joint("slosh1").qpos[:] = quat / np.linalg.norm(quat)
        mujoco.mj_kinematics(model, data)

        for name in ("beer", "beer_top"):
            drawn = data.geom(name)
            wide, half, _ = model.geom(name).size
            rim = np.stack([wide * np.cos(turn), wide * np.sin(turn), np.zeros_like(turn)])
            above = np.array([[0], [0], [half]])
            rims = np.concatenate([rim - above, rim + above], axis=1)
            x, y, z = drawn.xmat.reshape(3, 3) @ rims + drawn.xpos[:, np.newaxis]
            assert np.hypot(x, y).max() < radius * (1 + 1e-6)  # the file has ten digits
            if wide > 1e-3 * radius:  # what does not show, as its pivot is too high, may be above
                assert z.min() > -1e-6 * length
                assert z.max() < length * (1 + 1e-6)
