"""The commands that check and measure: validate, report, benchmark, advise, stability and paper."""

import pathlib
from dataclasses import dataclass
from typing import Annotated

import tyro

from mjbeer.cli.arguments import CaseName
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import Rolling
from mjbeer.output import files, terminal
from mjbeer.output.terminal import STDERR, say, show
from mjbeer.studies.cases import DEFAULT

_FAILED = 1


@dataclass(frozen=True)
class Validate:
    """Check the models against exact theory, and the paper's equations against both; exit status 1 if a check fails."""

    json: bool = False
    """Print the results as JSON."""

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
    """Validate, draw the four scenes, and write a folder with a summary; exit status 1 if a check fails.

    Without OpenGL there are no films, and the summary says so.
    """

    output: pathlib.Path = pathlib.Path("report")
    """Folder to write to."""
    quick: bool = False
    """Draw smaller videos with fewer frames, and no films for the paper's scenarios."""

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
    """Measure error against run time for integrators, ways of rolling and other tools; takes six minutes."""

    scenes: Annotated[tuple[CaseName, ...], tyro.conf.Positional] = DEFAULT
    """Scenes to measure."""
    output: pathlib.Path = pathlib.Path("benchmark")
    """Folder to write to; an interrupted study in it is continued."""
    quick: bool = False
    """Try fewer timesteps and tolerances; takes a minute and a half."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.studies.benchmark import report, tables
        from mjbeer.studies.benchmark import run as benchmark

        with files.locked(self.output):
            study = benchmark.conduct(names=self.scenes, folder=self.output, quick=self.quick, console=STDERR)
            report.write(study, self.output)
        show(*tables.tables(study))
        say(f"the study is in {self.output / 'summary.md'}")
        return 0


@dataclass(frozen=True)
class Advise:
    """Print the fastest setting that met a tolerance in a stored benchmark."""

    scene: Annotated[CaseName, tyro.conf.Positional]
    """Scene of the benchmark that is most like yours."""
    tolerance: float = 1e-6
    """Largest error allowed in phi and u/radius [rad]."""
    rolling: Rolling | None = None
    """What makes the can roll; if not given, the fastest way is taken."""
    study: pathlib.Path | None = None
    """A study.json that `mjbeer benchmark` wrote; if not given, the one that comes with mjbeer."""

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
    json: bool = False
    """Print the results as JSON."""

    def run(self) -> int:
        """Run the command and return its exit status: 0, or 1 if a check failed.

        Raises:
          ParameterError: if the study is to be both long and quick.
        """
        from mjbeer.studies.stability import report, tables
        from mjbeer.studies.stability import run as stability

        if self.long and self.quick:
            raise ParameterError("--long and --quick exclude each other: take one of them, or neither")
        extent = "long" if self.long else "quick" if self.quick else "usual"
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
