"""The documents keep their word: their Python runs, their commands exist, their table is the program's."""

import pathlib
import re
import shlex
from dataclasses import dataclass

import pytest

from mjbeer.cli.app import main
from mjbeer.paper.audit import chapters
from mjbeer.paper.audit.claim import CORRECTED, LIMIT
from mjbeer.paper.stories import letters
from mjbeer.studies.benchmark import advice, overview, tables
from mjbeer.studies.benchmark.points import Benchmark
from mjbeer.studies.validation import motions
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


def test_every_block_says_its_language() -> None:
    assert not [f"{block.path.name}:{block.line}" for block in BLOCKS if not block.language]


def test_the_readme_shows_both_ways_to_use_it() -> None:
    languages = {block.language for block in blocks(README)}
    assert "python" in languages
    assert languages & set(SHELLS)


@pytest.fixture
def names(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, object]:
    """What the README's Python leaves behind, run block after block as a reader would; videos are not drawn."""
    monkeypatch.chdir(tmp_path)
    stubs.draw(monkeypatch)
    found: dict[str, object] = {}
    for block in BLOCKS:
        if block.language == "python":
            exec(compile("\n" * (block.line - 1) + block.text, str(block.path), "exec"), found)
    return found


def test_python_runs_and_has_what_the_text_names(names: dict[str, object]) -> None:
    spans = [each.split(".") for each in re.findall(r"`(\w+\.\w+)[^`]*`", README.read_text())]
    named = [(owner, attribute) for owner, attribute in spans if owner in names]
    assert named
    assert not [(owner, attribute) for owner, attribute in named if not hasattr(names[owner], attribute)]


def test_no_command_is_left_out_below() -> None:
    assert {shlex.split(command)[0] for command in COMMANDS} == {"mjbeer", "make"}


@pytest.mark.slow
@pytest.mark.parametrize("command", [command for command in COMMANDS if shlex.split(command)[0] == "mjbeer"])
def test_commands_run(command: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With no rows to validate, videos that are not drawn, and short studies."""
    monkeypatch.chdir(tmp_path)
    stubs.validate(monkeypatch)
    stubs.draw(monkeypatch)
    stubs.benchmark(monkeypatch, stubs.FEW)
    stubs.stability(monkeypatch)
    words = re.split(r"[|>]", command)[0]
    try:
        status = main(shlex.split(words, comments=True)[1:])
    except SystemExit as ended:  # --help and completion
        status = ended.code or 0
    assert status == 0


@pytest.mark.parametrize("command", [command for command in COMMANDS if shlex.split(command)[0] == "make"])
def test_targets_of_make_exist(command: str) -> None:
    makefile = (CHECKOUT / "Makefile").read_text()
    targets = [word for word in shlex.split(command, comments=True)[1:] if "=" not in word]
    assert all(re.search(rf"^{re.escape(target)}:", makefile, re.MULTILINE) for target in targets)


def test_links_and_paths_lead_somewhere() -> None:
    for path in DOCUMENTS:
        text = path.read_text()
        targets = [each["target"] for each in LINK.finditer(text) if "://" not in each["target"]]
        paths = re.findall(r"(?<![\w/])(?:mjcf|src|tests|renders|examples)/[\w/]*(?:\.\w+)?", text)
        assert not [target for target in targets if not (path.parent / target).exists()], path
        assert not [named for named in paths if not (CHECKOUT / named).exists()], path


def test_run_times_are_those_of_the_study_that_comes_with_mjbeer() -> None:
    stored, text = Benchmark.load(advice.SHIPPED), (CHECKOUT / "docs" / "benchmark.md").read_text()
    cheapest = tables.cheapest(stored, "frozen")
    for table in (cheapest, tables.others(stored), tables.tolerances(stored), tables.usual(stored)):
        assert table.markdown(title=False).strip() in text, table.title


def test_the_small_diagram_is_drawn_from_the_study_that_comes_with_mjbeer(tmp_path: pathlib.Path) -> None:
    overview.draw(Benchmark.load(advice.SHIPPED), tmp_path / "overview")
    assert (tmp_path / "overview.svg").read_bytes() == (CHECKOUT / "renders" / "overview.svg").read_bytes()


def test_the_sketch_is_drawn_by_the_program(tmp_path: pathlib.Path) -> None:
    letters.draw(tmp_path / "letters")
    assert (tmp_path / "letters.svg").read_bytes() == (CHECKOUT / "docs" / "figures" / "letters.svg").read_bytes()


def test_the_table_of_the_validation_is_that_of_the_program() -> None:
    text = (CHECKOUT / "docs" / "validation.md").read_text()
    _, start, after = text.partition(
        "| check | by | error | at most | what dominates the error |\n|---|---|---:|---:|---|\n"
    )
    table = [line.strip("| ").split(" | ") for line in after.partition("\n\n")[0].splitlines()]
    rows = motions.checks()
    bounds = [f"{row.bound:.1e} {row.unit}".strip() for row in rows]
    assert start
    assert [(quantity, by, bound, reason) for quantity, by, _, bound, reason in table] == [
        (row.quantity, row.by, bound, row.reason) for row, bound in zip(rows, bounds, strict=True)
    ]
    # An error of today's differs in its digits, not in its being within the bound.
    assert all(float(error) <= row.bound for (_, _, error, *_), row in zip(table, rows, strict=True))
    assert f"these {len(rows)} rows" in text


PHYSICS = CHECKOUT / "docs" / "physics.md"


def test_the_misprints_of_the_physics_are_those_of_the_audit() -> None:
    """Row by row, with what they miss by; and the tests that are named exist."""
    _, _, after = PHYSICS.read_text().partition("| equation | printed | right | misses by | derived or shown in |\n")
    rows = [line.strip("| ").split(" | ") for line in after.partition("\n\n")[0].splitlines()[1:]]
    claims = [each for each in chapters.claims() if each.verdict == CORRECTED]
    told = sorted((row[0], float(row[3])) for row in rows)
    assert told == sorted((each.equation, float(each.misses_by or 0)) for each in claims)
    tests = "".join(path.read_text() for path in (CHECKOUT / "tests").rglob("test_*.py"))
    assert not [row[4] for row in rows if f"def {row[4].strip('`')}(" not in tests]


def test_every_figure_is_in_a_document() -> None:
    texts = "".join(each.read_text() for each in CHECKOUT.glob("docs/*.md"))
    shown = set(re.findall(r"\(figures/([\w-]+)\.svg\)", texts))
    assert shown == {each.stem for each in (CHECKOUT / "docs" / "figures").iterdir()}


def test_the_limits_of_the_physics_are_those_of_the_audit() -> None:
    _, _, after = PHYSICS.read_text().partition("| where | claim | holds | beyond that |\n")
    named = {
        each
        for line in after.partition("\n\n")[0].splitlines()[1:]
        for each in line.split(" | ")[0].strip("| ").split(", ")
    }
    limits = {each for claim in chapters.claims() if claim.verdict == LIMIT for each in claim.equation.split(", ")}
    assert named == limits
