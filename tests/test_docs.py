"""The documents keep their word: their Python runs, their commands exist, their tables are the program's."""

import contextlib
import pathlib
import re
import shlex
import tomllib
from dataclasses import dataclass

import pytest

from mjbeer import paper
from mjbeer.cli.app import parse
from mjbeer.paper.row import CORRECTED, LIMIT
from mjbeer.studies.validation.run import rows as validated
from tests.support import stubs

CHECKOUT = pathlib.Path(__file__).parents[1]
README = CHECKOUT / "README.md"
DOCUMENTS = sorted([*CHECKOUT.glob("*.md"), *CHECKOUT.glob("docs/*.md"), *CHECKOUT.glob("mjcf/*.md")])
SHELLS = ("console", "bash", "sh", "shell")
FENCE = re.compile(r"^```(?P<language>\w*)[^\n]*\n(?P<text>.*?)^```", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\((?P<target>[^)#\s]+)[^)]*\)")


@dataclass(frozen=True)
class Block:
    """A block of code in a document."""

    path: pathlib.Path
    line: int
    language: str
    text: str

    @property
    def commands(self) -> list[str]:
        """Its command lines: those after a prompt, or all of them where there is none."""
        lines = self.text.replace("\\\n", " ").splitlines()
        prompted = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
        return prompted or [line for line in lines if line.strip() and not line.startswith("#")]


def blocks(path: pathlib.Path) -> list[Block]:
    text = path.read_text()
    return [
        Block(path, text[: each.start()].count("\n") + 2, each["language"], each["text"])
        for each in FENCE.finditer(text)
    ]


BLOCKS = [block for path in DOCUMENTS for block in blocks(path)]
COMMANDS = list(dict.fromkeys(command for block in BLOCKS if block.language in SHELLS for command in block.commands))


def test_python_runs_and_has_what_the_text_names(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Block after block, as a reader would run it; videos are not drawn."""
    monkeypatch.chdir(tmp_path)
    stubs.draw(monkeypatch)
    names: dict[str, object] = {}
    for block in BLOCKS:
        if block.language == "python":
            exec(compile("\n" * (block.line - 1) + block.text, str(block.path), "exec"), names)
    spans = [each.split(".") for each in re.findall(r"`(\w+\.\w+)[^`]*`", README.read_text())]
    named = [(owner, attribute) for owner, attribute in spans if owner in names]
    assert named
    assert not [(owner, attribute) for owner, attribute in named if not hasattr(names[owner], attribute)]


@pytest.mark.parametrize("command", [command for command in COMMANDS if shlex.split(command)[0] == "mjbeer"])
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
        assert all(re.search(rf"^{re.escape(target)}:", makefile, re.MULTILINE) for target in targets), command


def test_links_and_paths_lead_somewhere() -> None:
    for path in DOCUMENTS:
        text = path.read_text()
        targets = [each["target"] for each in LINK.finditer(text) if "://" not in each["target"]]
        paths = re.findall(r"(?<![\w/])(?:mjcf|src|tests|renders|examples)/[\w/]*(?:\.\w+)?", text)
        assert not [target for target in targets if not (path.parent / target).exists()], path
        assert not [named for named in paths if not (CHECKOUT / named).exists()], path


def rows(document: str, head: str) -> list[list[str]]:
    """Return the cells of the table with a head, in a document of the folder docs."""
    _, start, after = (CHECKOUT / "docs" / document).read_text().partition(head)
    assert start, head
    return [line.strip("| ").split(" | ") for line in after.partition("\n\n")[0].splitlines()[2:]]


def test_the_table_of_the_validation_is_that_of_the_program() -> None:
    """An error of today's differs in its digits, not in its being within the bound."""
    checks, told = validated(), rows("validation.md", "| check | by | error | at most |")
    bounds = [f"{check.bound:.1e} {check.unit}".strip() for check in checks]
    assert [(quantity, by, bound, reason) for quantity, by, _, bound, reason in told] == [
        (check.name, check.by, bound, check.reason) for check, bound in zip(checks, bounds, strict=True)
    ]
    assert all(float(row[2]) <= check.bound for row, check in zip(told, checks, strict=True))


def test_misprints_and_limits_of_the_physics_are_those_of_the_audit() -> None:
    """With what each misprint misses by; and the tests that are named exist."""
    claims, told = paper.rows(), rows("physics.md", "| equation | printed | right | misses by |")
    corrected = [each for each in claims if each.verdict == CORRECTED]
    assert sorted((row[0], float(row[3])) for row in told) == sorted(
        (each.equation, each.misses_by) for each in corrected
    )
    named = {each for row in rows("physics.md", "| where | claim | holds |") for each in row[0].split(", ")}
    assert named == {each for claim in claims if claim.verdict == LIMIT for each in claim.equation.split(", ")}
    tests = "".join(path.read_text() for path in (CHECKOUT / "tests").rglob("test_*.py"))
    shown = re.findall(r"`(test_\w+)`", (CHECKOUT / "docs" / "physics.md").read_text())
    assert len(shown) > 20
    assert not [name for name in shown if f"def {name}(" not in tests]


def test_the_version_is_that_of_the_citation_and_of_the_newest_entry_of_the_changelog() -> None:
    version = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]["version"]
    assert f"\nversion: {version}\n" in (CHECKOUT / "CITATION.cff").read_text()
    assert re.findall(r"^## (\S+)", (CHECKOUT / "CHANGELOG.md").read_text(), re.MULTILINE)[0] == version
