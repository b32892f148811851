"""Templates that are missing, broken or tampered with: the error names the file and what is wrong with it."""

import pathlib
import xml.etree.ElementTree as ET

import pytest

from mjbeer import Can, Load, Scene, build, frozen, hoop, pendulum, sliding
from mjbeer.cli.app import main
from mjbeer.exceptions import TemplateError
from mjbeer.model import templates

SCENES = {"sliding": sliding(), "frozen": frozen(), "pendulum": pendulum(), "hoop": hoop()}
# What nothing refers to by name: without it, a template is only not as it came.
SPARE = {
    ("geom", "can_wall"), ("geom", "can_end"), ("geom", "can_mark"), ("geom", "can_spot"), ("geom", "axle"),
    ("geom", "load_arm"), ("geom", "wall"), ("light", "sun"), ("texture", "sky"),
}  # fmt: skip
KIND = {("equality", "joint"): "equality", ("asset", "mesh"): "mesh", ("contact", "pair"): "pair"}


def elements(file: str) -> list[tuple[str, str, str]]:
    """Parent's tag, tag and name of all named elements of a template but its keyframes."""
    tree = ET.parse(templates.folder() / file)
    return [
        (parent.tag, each.tag, name)
        for parent in tree.iter()
        for each in parent
        if (name := each.get("name") or each.get("class") if each.tag == "default" else each.get("name"))
        and each.tag != "key"
    ]


NEEDED = [
    (file, *element)
    for file in ("sliding.xml", "frozen.xml", "pendulum.xml", "hoop.xml", "shared.xml", "incline.xml")
    for element in elements(file)
    if element[1:] not in SPARE
]


def remove(path: pathlib.Path, parent_tag: str, tag: str, name: str) -> None:
    tree = ET.parse(path)
    found = [
        (parent, each)
        for parent in tree.iter(parent_tag)
        for each in parent
        if each.tag == tag and name in (each.get("name"), each.get("class"))
    ]
    for parent, each in found:
        parent.remove(each)
    assert found
    tree.write(path)


@pytest.mark.parametrize(("file", "parent", "tag", "name"), NEEDED)
def test_an_element_that_is_missing_is_named(copy: pathlib.Path, file: str, parent: str, tag: str, name: str) -> None:
    remove(copy / file, parent, tag, name)
    # What is missing in a shared file is missing in all templates.
    template = file.removesuffix(".xml") if file.removesuffix(".xml") in SCENES else "sliding"
    with pytest.raises(TemplateError) as caught:
        templates.read(template)
    message, kind = str(caught.value), KIND.get((parent, tag), tag)
    assert message.startswith(f"{copy / template}.xml ")
    if "not readable" in message:  # MuJoCo was the first to miss it
        assert f"'{name}'" in message
    else:
        assert message == (
            f"{copy / template}.xml has no {kind} named {name!r}, which mjbeer uses; restore the template"
        )


def test_no_templates_at_all(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(templates, "_FOLDERS", (tmp_path / "wheel", tmp_path / "checkout"))
    with pytest.raises(TemplateError) as caught:
        build(frozen())
    assert str(caught.value) == (
        f"no MJCF templates: neither {tmp_path / 'wheel'} nor {tmp_path / 'checkout'} holds them; reinstall mjbeer"
    )


@pytest.mark.parametrize("file", ["frozen.xml", "incline.xml"])
def test_a_file_that_is_missing_is_named(copy: pathlib.Path, file: str) -> None:
    (copy / file).unlink()
    with pytest.raises(TemplateError) as caught:
        build(frozen())
    assert str(caught.value).startswith(f"{copy / 'frozen.xml'} is not readable MJCF: ")
    assert file in str(caught.value).split("not readable MJCF: ")[1]


def test_what_is_not_xml_has_mujoco_s_reason(copy: pathlib.Path) -> None:
    (copy / "frozen.xml").write_text("<mujoco><worldbody></mujoco>")
    with pytest.raises(TemplateError, match=r"frozen\.xml is not readable MJCF: XML parse error"):
        build(frozen())


def test_the_command_line_says_it_in_one_line(copy: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    remove(copy / "hoop.xml", "body", "joint", "slide")
    assert main(["simulate", "hoop"]) == 2
    assert capsys.readouterr() == (
        "",
        f"mjbeer: {copy / 'hoop.xml'} has no joint named 'slide', which mjbeer uses; restore the template\n",
    )


@pytest.mark.parametrize(
    ("scene", "name"),
    [
        *((scene, name) for name, scene in SCENES.items()),
        (Scene(Can(0.1, 0.1, 1.0), Load(1.0, 0.05, 1e-3)), "pendulum"),
        (Scene(Can(0.1, 0.1, 1.0), Load(1.0, 0.05, 1e-3), attachment="frozen"), "hoop"),
        (Scene(Can(0.1, 0.1, 1.0), Load.segment(0.1, 0.1, 0.1), attachment="frozen"), "frozen"),
    ],
)
def test_the_template_of_a_scene(scene: Scene, name: str) -> None:
    assert templates.name(scene) == name
    assert templates.read(name).modelname == name
