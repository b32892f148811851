"""The documents keep their word: their Python runs, their commands exist, a program writes their
tables."""

import contextlib
import math
import pathlib
import re
import shlex
import tomllib
from typing import Any

import pytest

from mjbeer import sliding
from mjbeer.cli.app import parse
from tests.support import stubs
from tools import documents

CHECKOUT = pathlib.Path(__file__).parents[1]
README = CHECKOUT / "README.md"
DOCUMENTS = sorted(
    path
    for pattern in ("*.md", "docs/*.md", "mjcf/*.md", "engines/*.md")
    for path in CHECKOUT.glob(pattern)
)
SHELLS = ("console", "bash", "sh", "shell")
FENCE = re.compile(r"^```(?P<language>\w*)[^\n]*\n(?P<text>.*?)^```", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\((?P<target>[^)#\s]+)[^)]*\)")


def commands(block: re.Match[str]) -> list[str]:
    """The command lines of a block of code: those after a prompt, or all of them where there is
    none."""
    lines = block["text"].replace("\\\n", " ").splitlines()
    prompted = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    return prompted or [line for line in lines if line.strip() and not line.startswith("#")]


BLOCKS = [(path, block) for path in DOCUMENTS for block in FENCE.finditer(path.read_text())]
SHELL_BLOCKS = [block for _, block in BLOCKS if block["language"] in SHELLS]
COMMANDS = list(dict.fromkeys(line for block in SHELL_BLOCKS for line in commands(block)))


@pytest.mark.slow
def test_python_runs_and_has_what_the_text_names(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Block after block, as a reader would run it; videos are not drawn."""
    monkeypatch.chdir(tmp_path)
    stubs.draw(monkeypatch)
    names: dict[str, object] = {}
    for path, block in BLOCKS:
        if block["language"] == "python":
            # An error names its line in the document.
            lines = block.string.count("\n", 0, block.start("text"))
            exec(compile("\n" * lines + block["text"], str(path), "exec"), names)
    spans = re.findall(r"`(\w+)\.(\w+)[^`]*`", README.read_text())
    named = [(owner, attribute) for owner, attribute in spans if owner in names]
    assert named
    assert not [
        (owner, attribute) for owner, attribute in named if not hasattr(names[owner], attribute)
    ]


@pytest.mark.parametrize(
    "command", [command for command in COMMANDS if shlex.split(command)[0] == "mjbeer"]
)
def test_commands_are_understood(command: str) -> None:
    """Their words and their values."""
    words = shlex.split(re.split(r"[|>]", command)[0], comments=True)[1:]
    if words != ["--version"]:
        with contextlib.suppress(SystemExit) if "--help" in words else contextlib.nullcontext():
            parse(words)


def test_targets_of_make_exist_and_there_are_no_other_commands() -> None:
    makefile = (CHECKOUT / "Makefile").read_text()
    for command in COMMANDS:
        program, *words = shlex.split(command, comments=True)
        assert program in ("mjbeer", "make"), command
        targets = [word for word in words if program == "make" and "=" not in word]
        for target in targets:
            assert re.search(rf"^{re.escape(target)}:", makefile, re.MULTILINE), command


@pytest.mark.skipif(not (CHECKOUT / "renders").is_dir(), reason="a source distribution lacks them")
def test_links_and_paths_lead_somewhere() -> None:
    for path in DOCUMENTS:
        text = path.read_text()
        targets = [link["target"] for link in LINK.finditer(text) if "://" not in link["target"]]
        paths = re.findall(r"(?<![\w/])(?:mjcf|src|tests|renders|examples)/[\w/]*(?:\.\w+)?", text)
        assert not [target for target in targets if not (path.parent / target).exists()], path
        assert not [named for named in paths if not (CHECKOUT / named).exists()], path


def written() -> list[Any]:
    """The documents of which a program writes a part."""
    cases = []
    for path in documents.DOCUMENTS:
        if "<!-- made:" in path.read_text():
            # Two seconds. Its numbers change with MuJoCo, or where the study is made anew.
            marks = [pytest.mark.costly] if path.name == "stability.md" else []
            cases.append(pytest.param(path, id=path.name, marks=marks))
    return cases


@pytest.mark.slow
@pytest.mark.parametrize("path", written())
def test_what_a_program_writes_is_what_it_writes_now(path: pathlib.Path) -> None:
    """`make tables` writes it anew. What is measured there is far from a border of the digits that
    are shown."""
    text = path.read_text()
    marked = len(documents.MARKED.findall(text))
    assert text.count("<!-- made:") == marked
    assert text.count("<!-- end -->") == marked
    assert documents.anew(text) == text


def test_a_swing_of_a_radian_has_its_frequency_in_the_physics() -> None:
    """The page says by how much it is below that of small swings."""
    scene = sliding()
    lower = 1 - 2 * math.pi / scene.period(1.0) / scene.frequency()
    told = re.findall(r"\b1 rad\b[^.%]*?(\d+) %", (CHECKOUT / "docs" / "physics.md").read_text())
    assert told == [f"{100 * lower:.0f}"]


def test_the_version_is_that_of_the_citation_and_of_the_newest_entry_of_the_changelog() -> None:
    version = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]["version"]
    assert f"\nversion: {version}\n" in (CHECKOUT / "CITATION.cff").read_text()
    assert (
        re.findall(r"^## (\S+)", (CHECKOUT / "CHANGELOG.md").read_text(), re.MULTILINE)[0]
        == version
    )
