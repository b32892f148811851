"""A template that someone has changed never ends in a model that is wrong: it is refused, whatever was changed."""

import pathlib
import re
import shutil

import pytest

from mjbeer import build, frozen, hoop, pendulum, sliding
from mjbeer.cli.app import main
from mjbeer.exceptions import TemplateError
from mjbeer.model import templates

SCENES = {"sliding": sliding(), "frozen": frozen(), "pendulum": pendulum(), "hoop": hoop()}
FILES = ("sliding", "frozen", "pendulum", "hoop", "shared", "incline")
# What compiles, and changes the motion or what MuJoCo makes of the numbers.
ADDED = (
    '<option gravity="0 0 -1"/>', '<option density="1.2" viscosity="2e-5"/>', '<option wind="1 0 0"/>',
    '<option><flag gravity="disable"/></option>', '<compiler settotalmass="1"/>', '<compiler boundmass="1"/>',
    '<compiler boundinertia="1"/>', '<compiler balanceinertia="true"/>', '<compiler inertiafromgeom="true"/>',
    '<default><joint damping="1"/></default>', '<worldbody><body><joint/><geom size="1"/></body></worldbody>',
    '<actuator><motor joint="roll"/></actuator>', '<equality><joint joint1="roll"/></equality>',
    '<tendon><fixed name="t"><joint joint="roll" coef="1"/></fixed></tendon>', "<!-- a word -->",
)  # fmt: skip
JOINT = ("damping", "armature", "stiffness", "frictionloss", "springref", "ref", "gravcomp")
ATTRIBUTE = re.compile(r'(?<=[\w]=")[^"]*(?=")')


def scene_of(file: str) -> str:
    return file if file in SCENES else "sliding"


def changed(text: str) -> str:
    """Another value that MuJoCo mostly takes: the first number doubled, or the word longer."""
    first, *rest = text.split()
    try:
        return " ".join([repr(2 * float(first) + 1), *rest])
    except ValueError:
        return {"true": "false", "false": "true", "enable": "disable", "disable": "enable"}.get(text, text + "_")


def assert_refused(file: str) -> str:
    with pytest.raises(TemplateError) as caught:
        templates.read(scene_of(file))
    return str(caught.value)


@pytest.mark.parametrize("file", FILES)
def test_every_attribute_counts(copy: pathlib.Path, file: str) -> None:
    path = copy / f"{file}.xml"
    text = path.read_text()
    found = list(ATTRIBUTE.finditer(text))
    assert len(found) >= 8
    for each in found:
        path.write_text(text[: each.start()] + changed(each[0]) + text[each.end() :])
        assert_refused(file)
    path.write_text(text)
    templates.read(scene_of(file))


@pytest.mark.parametrize("file", FILES)
@pytest.mark.parametrize("more", ADDED)
def test_nothing_may_be_added(copy: pathlib.Path, file: str, more: str) -> None:
    path = copy / f"{file}.xml"
    before, end, after = path.read_text().rpartition("</")
    path.write_text(f"{before}{more}{end}{after}")
    assert_refused(file)


@pytest.mark.parametrize("file", SCENES)
@pytest.mark.parametrize("attribute", JOINT)
def test_no_joint_may_get_another_attribute(copy: pathlib.Path, file: str, attribute: str) -> None:
    path = copy / f"{file}.xml"
    text = path.read_text()
    for each in re.finditer(r'<joint name="(slide|lift|roll|swing)" ', text):
        path.write_text(f'{text[: each.end()]}{attribute}="1" {text[each.end() :]}')
        assert_refused(file)


@pytest.mark.parametrize("file", FILES)
@pytest.mark.parametrize("content", ["", "<mujoco/>", "<mujocoinclude/>", "half"])
def test_a_file_that_is_not_whole(copy: pathlib.Path, file: str, content: str) -> None:
    path = copy / f"{file}.xml"
    path.write_text(path.read_text()[: path.stat().st_size // 2] if content == "half" else content)
    assert str(copy) in assert_refused(file)


def test_the_message_names_the_file_and_the_remedy(copy: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = copy / "shared.xml"
    path.write_text(path.read_text().replace("</mujocoinclude>", '<option wind="1 0 0"/></mujocoinclude>'))
    assert main(["simulate", "frozen"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith(f"mjbeer: {path} is not as it came with mjbeer")
    assert "restore the template" in said.err


def test_line_ends_may_be_those_of_another_system(copy: pathlib.Path) -> None:
    for path in copy.glob("*.xml"):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    for scene in SCENES.values():
        build(scene, visuals=True)


def test_the_meshes_of_the_templates_are_never_read(copy: pathlib.Path) -> None:
    shutil.rmtree(copy / "assets")
    for scene in SCENES.values():
        build(scene)
        build(scene, visuals=True)


def test_every_template_has_its_digest() -> None:
    assert {path.stem: templates.digest(path) for path in templates.folder().glob("*.xml")} == templates._DIGESTS
