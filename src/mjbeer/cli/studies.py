"""The commands that check and measure: validate, benchmark, stability, paper and report."""

import pathlib
import time
from argparse import Namespace
from typing import TYPE_CHECKING

from mjbeer import require
from mjbeer.cli.arguments import Option, command
from mjbeer.exceptions import ParameterError
from mjbeer.output import files, terminal
from mjbeer.output.terminal import STDERR, say, show
from mjbeer.studies.benchmark.points import CASES, DEFAULT

if TYPE_CHECKING:
    from mjbeer.studies.validation.validate import Validation

_FAILED = 1
_KEPT = "folder to write to; an interrupted study in it is continued"


def _folder(name: str, told: str = "folder to write to") -> Option:
    return Option("output", told, pathlib.Path(name), pathlib.Path)


def _flag(name: str, told: str) -> Option:
    return Option(name, told, kind=bool)


@command(_flag("table", "print every row, not only those that failed"), _flag("json", "print the results as JSON"))
def validate(given: Namespace) -> int:
    """Check models and paper against exact theory; exit status 1 if a check fails."""
    from mjbeer.studies.validation.validate import validate

    began = time.perf_counter()
    validation = validate(STDERR)
    if given.json:
        terminal.write(validation.json())
    elif given.table:
        show(*validation.tables())
    return _conclude(validation, began)


@command(
    _folder("report"),
    _flag("quick", "draw smaller videos with fewer frames, and no films for the paper's scenarios"),
    _flag("table", "also print the tables of the validation, which are on the page"),
)
def report(given: Namespace) -> int:
    """Validate, draw the scenes and the paper's stories, and write a page that shows it all.

    The exit status is 1 if a check fails. Without OpenGL there are no films.
    """
    from mjbeer.report.write import write

    began = time.perf_counter()
    validation, not_drawn = write(given.output, given.quick, STDERR)
    if given.table:
        show(*validation.tables())
    if not_drawn:
        say(not_drawn, "yellow")
    say(f"the report is in {given.output / 'index.html'}")
    return _conclude(validation, began)


@command(
    Option("scenes", f"scenes to measure, of {', '.join(CASES)}", DEFAULT),
    _folder("benchmark"),
    _flag("quick", "try fewer timesteps and tolerances; takes two minutes"),
)
def benchmark(given: Namespace) -> int:
    """Measure error against run time of integrators and other tools, in seven minutes."""
    from mjbeer.studies.benchmark import benchmark_tables, timing

    names = [require.choice("scene", name, CASES) for name in given.scenes] or DEFAULT
    with files.locked(given.output):
        study = timing.conduct(names, given.quick, STDERR)
        benchmark_tables.write(study, given.output)
    show(*benchmark_tables.tables(study))
    say(f"the study is in {given.output / 'summary.md'}")
    return 0


@command(
    _folder("stability", _KEPT),
    _flag("long", "run the whole study: all integrators, finer maps, 20000 random runs; takes forty minutes"),
    _flag("quick", "make 250 random runs instead of 3000; takes two minutes"),
    _flag("maps", "make only the maps of timestep and stiffness or damping, but all 34, and fine; takes three minutes"),
    _flag("json", "print the results as JSON"),
)
def stability(given: Namespace) -> int:
    """Test stiff and extreme cases and the limits of stability, in five minutes; exit status 1 if theory disagrees."""
    from mjbeer.studies.stability import stability_study as stability

    asked = [f"--{each}" for each in ("long", "quick", "maps") if getattr(given, each)]
    if len(asked) > 1:
        raise ParameterError(f"{' and '.join(asked)} exclude each other: take one of them, or neither")
    extent = asked[0].strip("-") if asked else "usual"
    with files.locked(given.output):
        study = stability.conduct(given.output, extent, STDERR)
        stability.write(study, given.output)
    if given.json:
        terminal.write(stability.to_json(study))
    else:
        show(*stability.tables(study))
    for result in study.failed:
        say(f"not as it must be: {result.summary_line()}", "red")
    say(f"the study is in {given.output / 'summary.md'}")
    return _FAILED if study.failed else 0


@command(_folder("paper"), _flag("films", "also draw films of the motions"))
def paper(given: Namespace) -> int:
    """Plot each of the paper's scenarios, and write a folder with a summary."""
    from mjbeer.paper import stories

    not_drawn = stories.write(given.output, given.films, STDERR)
    say(f"the stories are in {given.output / 'stories.md'}")
    if not_drawn:
        say(not_drawn, "yellow")
    return 0


def _conclude(validation: "Validation", began: float) -> int:
    """Print what failed and, on the last line, what passed since the moment `began`; return the exit status."""
    for failure in validation.failures:
        say(f"FAILED: {failure}", "red")
    style = "green" if validation.passed else "red"
    say(f"{validation.sentence}, in {time.perf_counter() - began:.0f} s", style)
    return 0 if validation.passed else _FAILED
