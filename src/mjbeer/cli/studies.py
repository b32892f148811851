"""Commands that check and measure: validate, report, benchmark, advise, stability, paper."""

import pathlib
from dataclasses import dataclass
from typing import Annotated

import tyro

from mjbeer.cli.arguments import CaseName
from mjbeer.model.setting import Rolling
from mjbeer.output import files, terminal
from mjbeer.output.terminal import STDERR, say, show
from mjbeer.studies.cases import DEFAULT

_FAILED = 1


@dataclass(frozen=True)
class Validate:
    """Check the models against exact theory and the paper against both, row by row; exit status 1 if a row fails."""

    json: bool = False
    """Print the table as JSON."""

    def run(self) -> int:
        """Run the command and return its exit status: 0, or 1 if a check failed."""
        from mjbeer.studies.validation import tables
        from mjbeer.studies.validation.run import validate

        validation = validate(STDERR)
        if self.json:
            terminal.write(tables.to_json(validation))
        else:
            show(tables.validation(validation.results), tables.audit(validation.findings))
        return 0 if validation.passed else _FAILED


@dataclass(frozen=True)
class Report:
    """Validate, then draw the four scenes, into a folder with a summary; exit status 1 if a row fails.

    Without OpenGL there are no films, and the summary says so.
    """

    output: pathlib.Path = pathlib.Path("report")
    """Folder to write to."""
    quick: bool = False
    """Smaller videos with fewer frames."""

    def run(self) -> int:
        """Run the command and return its exit status: 0, or 1 if a check failed."""
        from mjbeer import report
        from mjbeer.studies.validation import tables

        validation, missing = report.write(self.output, self.quick, STDERR)
        show(tables.validation(validation.results), tables.audit(validation.findings))
        say(f"the report is in {self.output / 'summary.md'}")
        _tell(missing)
        return 0 if validation.passed else _FAILED


@dataclass(frozen=True)
class Benchmark:
    """Measure error against run time, in six minutes: integrators, ways of rolling, and other tools."""

    scenes: Annotated[tuple[CaseName, ...], tyro.conf.Positional] = DEFAULT
    """Scenes to measure."""
    output: pathlib.Path = pathlib.Path("benchmark")
    """Folder to write to; a study that was interrupted there goes on."""
    quick: bool = False
    """Shorter ladders: about a minute."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.studies.benchmark import report, tables
        from mjbeer.studies.benchmark import run as benchmark

        with files.locked(self.output):
            study = benchmark.conduct(self.scenes, self.output, self.quick, STDERR)
            report.write(study, self.output)
        show(*tables.tables(study))
        say(f"the study is in {self.output / 'summary.md'}")
        return 0


@dataclass(frozen=True)
class Advise:
    """Print the cheapest setting that met a tolerance in a stored study."""

    scene: Annotated[CaseName, tyro.conf.Positional]
    """Scene of the study that is most like yours."""
    tolerance: float = 1e-6
    """Largest error of phi and u/a [rad]."""
    rolling: Rolling | None = None
    """Way of rolling; any if not given."""
    study: pathlib.Path | None = None
    """A study.json that `mjbeer benchmark` wrote; the one that came with mjbeer if not given."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.studies.benchmark import advice

        terminal.write(advice.advise(self.scene, self.tolerance, self.rolling, self.study) + "\n")
        return 0


@dataclass(frozen=True)
class Stability:
    """Try stiff and extreme cases, find where stability ends, against theory; exit status 1 if they disagree."""

    output: pathlib.Path = pathlib.Path("stability")
    """Folder to write to; a study that was interrupted there goes on."""
    long: bool = False
    """Everything: all integrators, finer maps, 3000 random runs, a million swings."""
    json: bool = False
    """Print the results as JSON."""

    def run(self) -> int:
        """Run the command and return its exit status: 0, or 1 if a check failed."""
        from mjbeer.studies.stability import report, tables
        from mjbeer.studies.stability import run as stability

        with files.locked(self.output):
            found = stability.conduct(self.output, not self.long, STDERR)
            report.write(found, self.output)
        if self.json:
            terminal.write(found.json())
        else:
            show(*tables.tables(found))
        for each in found.unexpected:
            say(f"not as theory expects: {each}", "red")
        say(f"the study is in {self.output / 'summary.md'}")
        return _FAILED if found.unexpected else 0


@dataclass(frozen=True)
class Paper:
    """Draw the paper's stories, a plot each, into a folder with a summary."""

    output: pathlib.Path = pathlib.Path("paper")
    """Folder to write to."""
    films: bool = False
    """Films of what moves, too."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.paper.stories import report

        missing = report.write(self.output, self.films, STDERR)
        say(f"the stories are in {self.output / 'stories.md'}")
        _tell(missing)
        return 0


def _tell(missing: list[str]) -> None:
    """Say which films were not drawn for lack of OpenGL, if any, and what brings them, on a line."""
    from mjbeer.drawing import opengl

    if missing:
        say(opengl.missing(missing), "yellow")
