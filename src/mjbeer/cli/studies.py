"""The commands that check and measure: validate, report, benchmark, stability and paper."""

import pathlib
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import tyro

from mjbeer.cli.arguments import CaseName
from mjbeer.exceptions import ParameterError
from mjbeer.output import files, terminal
from mjbeer.output.terminal import STDERR, say, show
from mjbeer.studies.cases import DEFAULT
from mjbeer.studies.rows import told

if TYPE_CHECKING:
    from mjbeer.studies.validation.run import Validation

_FAILED = 1


@dataclass(frozen=True)
class Validate:
    """Check models and paper against exact theory; exit status 1 if a check fails."""

    table: bool = False
    """Print every row, not only those that failed."""
    json: bool = False
    """Print the results as JSON."""

    def run(self) -> int:
        """Run the command and return its exit status: 0, or 1 if a check failed."""
        from mjbeer.studies.validation.run import validate

        began = time.perf_counter()
        validation = validate(STDERR)
        if self.json:
            terminal.write(validation.json())
        elif self.table and terminal.is_read_by_eye():
            show(*validation.tables())
        elif self.table:
            show(validation.table())
        return _conclude(validation, began)


@dataclass(frozen=True)
class Report:
    """Validate, draw the scenes and the paper's stories, and write a page that shows it all.

    The exit status is 1 if a check fails. Without OpenGL or ffmpeg there are no films.
    """

    output: pathlib.Path = pathlib.Path("report")
    """Folder to write to."""
    quick: bool = False
    """Draw smaller videos with fewer frames, and no films for the paper's scenarios."""
    table: bool = False
    """Also print the tables of the validation, which are on the page."""

    def run(self) -> int:
        """Run the command and return its exit status: 0, or 1 if a check failed."""
        from mjbeer.report.write import write

        began = time.perf_counter()
        validation, not_drawn = write(self.output, self.quick, STDERR)
        if self.table:
            show(*validation.tables())
        if not_drawn:
            say(not_drawn, "yellow")
        say(f"the report is in {self.output / 'index.html'}")
        return _conclude(validation, began)


@dataclass(frozen=True)
class Benchmark:
    """Measure error against run time of integrators and other tools, in seven minutes."""

    scenes: Annotated[tuple[CaseName, ...], tyro.conf.Positional] = DEFAULT
    """Scenes to measure."""
    output: pathlib.Path = pathlib.Path("benchmark")
    """Folder to write to; an interrupted study in it is continued."""
    quick: bool = False
    """Try fewer timesteps and tolerances; takes two minutes."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.studies.benchmark import measure, tables

        with files.locked(self.output):
            study = measure.conduct(names=self.scenes, folder=self.output, quick=self.quick, console=STDERR)
            tables.write(study, self.output)
        show(*tables.tables(study))
        say(f"the study is in {self.output / 'summary.md'}")
        return 0


@dataclass(frozen=True)
class Stability:
    """Test stiff and extreme cases and the limits of stability, in five minutes; exit status 1 if theory disagrees."""

    output: pathlib.Path = pathlib.Path("stability")
    """Folder to write to; an interrupted study in it is continued."""
    long: bool = False
    """Run the whole study: all integrators, finer maps, 20000 random runs; takes forty minutes."""
    quick: bool = False
    """Make 250 random runs instead of 3000; takes two minutes."""
    maps: bool = False
    """Make only the maps of timestep and stiffness or damping, but all 58 of them, and fine; takes five minutes."""
    json: bool = False
    """Print the results as JSON."""

    def run(self) -> int:
        """Run the command and return its exit status: 0, or 1 if a check failed.

        Raises:
          ParameterError: if more than one of long, quick and maps is asked for.
        """
        from mjbeer.studies.stability import study as stability

        asked = [extent for extent in ("long", "quick", "maps") if getattr(self, extent)]
        if len(asked) > 1:
            options = " and ".join(f"--{extent}" for extent in asked)
            raise ParameterError(f"{options} exclude each other: take one of them, or neither")
        extent = asked[0] if asked else "usual"
        with files.locked(self.output):
            study = stability.conduct(self.output, extent, STDERR)
            stability.write(study, self.output)
        if self.json:
            terminal.write(stability.to_json(study))
        else:
            show(*stability.tables(study))
        for result in study.failed:
            say(f"not as theory expects: {result.group}: {told(result)}", "red")
        say(f"the study is in {self.output / 'summary.md'}")
        return _FAILED if study.failed else 0


@dataclass(frozen=True)
class Paper:
    """Plot each of the paper's scenarios, and write a folder with a summary."""

    output: pathlib.Path = pathlib.Path("paper")
    """Folder to write to."""
    films: bool = False
    """Also draw films of the motions."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.drawing import opengl
        from mjbeer.paper import stories

        missing = stories.write(self.output, self.films, STDERR)
        say(f"the stories are in {self.output / 'stories.md'}")
        if missing:
            say(opengl.missing(missing), "yellow")
        return 0


def _conclude(validation: "Validation", began: float) -> int:
    """Print what failed and, on the last line, what passed since the moment `began`; return the exit status."""
    for failure in validation.failures:
        say(f"FAILED: {failure}", "red")
    style = "green" if validation.passed else "red"
    say(f"{validation.sentence}, in {time.perf_counter() - began:.0f} s", style)
    return 0 if validation.passed else _FAILED
