"""Templates that are missing, broken or not whole: the error names the file and what is missing."""

import pathlib
import xml.etree.ElementTree as ET

import pytest

from mjbeer import Can, Load, Scene, build, frozen, hoop, pendulum, sliding
from mjbeer.cli.app import main
from mjbeer.exceptions import TemplateError
from mjbeer.model import templates

SCENES = {"sliding": sliding(), "frozen": frozen(), "pendulum": pendulum(), "hoop": hoop()}
NEEDED = [
    *(("hoop", kind, name) for kind, names in templates._EVERYWHERE.items() for name in names),
    ("sliding", "mesh", "load"),
    ("frozen", "mesh", "load"),
]


def remove(folder: pathlib.Path, kind: str, name: str) -> None:
    """Remove an element from all files of the templates."""
    for path in folder.glob("*.xml"):
        tree = ET.parse(path)
        for parent in list(tree.iter()):
            for element in parent.findall(kind):
                if name in (element.get("name"), element.get("class") if kind == "default" else None):
                    parent.remove(element)
        tree.write(path)


@pytest.mark.parametrize(("template", "kind", "name"), NEEDED)
def test_an_element_that_is_missing_is_named(copy: pathlib.Path, template: str, kind: str, name: str) -> None:
    remove(copy, kind, name)
    with pytest.raises(TemplateError) as caught:
        build(SCENES[template])
    message = str(caught.value)
    assert message.startswith(f"{copy / template}.xml ")
    if "not readable" in message:  # MuJoCo was the first to miss it
        empty = "incline.xml" if name == "board" else name  # the file has nothing else
        assert f"'{empty}'" in message
    elif kind != "body":  # the first that is missing is in the body that is
        assert f"has no {kind} named {name!r}, which mjbeer uses; restore the template" in message


def test_no_templates_at_all(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(templates, "_FOLDERS", (tmp_path / "wheel", tmp_path / "checkout"))
    with pytest.raises(TemplateError) as caught:
        build(frozen())
    assert str(caught.value) == (
        f"no MJCF templates: neither {tmp_path / 'wheel'} nor {tmp_path / 'checkout'} holds them; reinstall mjbeer"
    )


@pytest.mark.parametrize("file", ["frozen.xml", "incline.xml"])
@pytest.mark.parametrize("content", [None, "", "<mujoco/>", "<mujocoinclude/>", "<mujoco><worldbody></mujoco>"])
def test_a_file_that_is_missing_or_not_whole_is_named(copy: pathlib.Path, file: str, content: str | None) -> None:
    if content is None:
        (copy / file).unlink()
    else:
        (copy / file).write_text(content)
    with pytest.raises(TemplateError) as caught:
        build(frozen())
    assert str(caught.value).startswith(f"{copy / 'frozen.xml'} ")
    if content is None:
        assert file in str(caught.value).split("not readable MJCF: ")[1]


def test_the_command_line_says_it_in_one_line(copy: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    remove(copy, "camera", "side")
    assert main(["simulate", "hoop"]) == 2
    assert capsys.readouterr() == (
        "",
        f"mjbeer: {copy / 'hoop.xml'} has no camera named 'side', which mjbeer uses; restore the template\n",
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
