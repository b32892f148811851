"""The commands that check and measure: validate, report, benchmark, advise, stability and paper."""

import pathlib
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import tyro

from mjbeer.cli.arguments import CaseName, if_given
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import Rolling
from mjbeer.output import files, terminal
from mjbeer.output.terminal import STDERR, say, show
from mjbeer.studies.cases import DEFAULT

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
        from mjbeer.studies.validation import tables
        from mjbeer.studies.validation.run import validate

        began = time.perf_counter()
        validation = validate(STDERR)
        if self.json:
            terminal.write(tables.to_json(validation))
        elif self.table and terminal.is_read_by_eye():
            show(tables.validation(validation.results), tables.audit(validation.findings))
        elif self.table:
            show(tables.rows(validation))
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
        from mjbeer.studies.validation import tables

        began = time.perf_counter()
        validation, not_drawn = write(self.output, self.quick, STDERR)
        if self.table:
            show(tables.validation(validation.results), tables.audit(validation.findings))
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
        from mjbeer.studies.benchmark import report, tables
        from mjbeer.studies.benchmark import run as benchmark
        from mjbeer.studies.sweep import speed

        with files.locked(self.output):
            study = benchmark.conduct(names=self.scenes, folder=self.output, quick=self.quick, console=STDERR)
            count, rounds = (50, 1) if self.quick else (200, 4)
            say(f"timing sweeps of {count} scenes")
            many = speed.table(speed.compare(count, rounds))
            report.write(study, self.output, [many])
        show(*tables.tables(study), many)
        say(f"the study is in {self.output / 'summary.md'}")
        return 0


@dataclass(frozen=True)
class Advise:
    """Print the fastest setting that met a tolerance in a stored benchmark."""

    scene: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar=f"{{{','.join(DEFAULT)}}}")]
    """Scene of the benchmark that is most like yours; a study of your own may have others."""
    tolerance: float = 1e-6
    """Largest error allowed in phi and u/radius [rad]."""
    rolling: Annotated[Rolling | None, if_given(Rolling, "the fastest way")] = None
    """What makes the can roll."""
    study: Annotated[pathlib.Path | None, if_given(pathlib.Path, "the study that comes with mjbeer")] = None
    """A study.json that `mjbeer benchmark` wrote."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.studies.benchmark import advice

        terminal.write(advice.advise(self.scene, self.tolerance, self.rolling, self.study) + "\n")
        return 0


@dataclass(frozen=True)
class Stability:
    """Test stiff and extreme cases and the limits of stability, in five minutes; exit status 1 if theory disagrees."""

    output: pathlib.Path = pathlib.Path("stability")
    """Folder to write to; an interrupted study in it is continued."""
    long: bool = False
    """Run the whole study: all integrators, finer maps, 20000 random runs, a million swings; takes forty minutes."""
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
        from mjbeer.studies.stability import report, tables
        from mjbeer.studies.stability import run as stability

        asked = [extent for extent in ("long", "quick", "maps") if getattr(self, extent)]
        if len(asked) > 1:
            options = " and ".join(f"--{extent}" for extent in asked)
            raise ParameterError(f"{options} exclude each other: take one of them, or neither")
        extent = asked[0] if asked else "usual"
        with files.locked(self.output):
            study = stability.conduct(self.output, extent, STDERR)
            report.write(study, self.output)
        if self.json:
            terminal.write(study.json())
        else:
            show(*tables.tables(study))
        for name in study.unexpected:
            say(f"not as theory expects: {name}", "red")
        say(f"the study is in {self.output / 'summary.md'}")
        return _FAILED if study.unexpected else 0


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
    from mjbeer.studies.validation import tables

    for failure in tables.failures(validation):
        say(f"FAILED: {failure}", "red")
    style = "green" if validation.passed else "red"
    say(f"{tables.sentence(validation)}, in {time.perf_counter() - began:.0f} s", style)
    return 0 if validation.passed else _FAILED
