"""The command line: what `mjbeer` does, a class a command."""

import pathlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

import tyro
from rich.console import RenderableType

from mjbeer import gl, interruption, output, streams
from mjbeer.arguments import AnyScene, CaseName, Rolling, Run, radians
from mjbeer.cases import DEFAULT
from mjbeer.exceptions import MjbeerError
from mjbeer.exclusive import claimed

_FAILED, _WRONG = 1, 2
_out, _err = streams.Teller(), streams.Teller(stderr=True)


@dataclass(frozen=True)
class Simulate(Run):
    """Simulate a scene; show what the run says about itself, and write the motion as CSV."""

    output: pathlib.Path | None = None
    """CSV file to write; "-" for standard output."""

    def run(self) -> int:
        """Do it; the exit status."""
        from mjbeer import table

        file = None if str(self.output) == "-" else self.output
        if file is not None:
            output.check(file)
        trajectory = self.simulate()
        if file is not None:
            output.write(file, table.csv(trajectory))
            _say(f"wrote {file}")
        if file == self.output:
            _show(table.summary(trajectory))
        else:
            streams.show(table.csv(trajectory))
            _err.print(table.summary(trajectory))
        _warn(trajectory.warnings)
        return 0


@dataclass(frozen=True)
class Render(Run):
    """Simulate a scene and draw it as a video (MP4)."""

    output: pathlib.Path = pathlib.Path("mjbeer.mp4")
    """Video to write."""
    speed: float = 1.0
    """Playback speed: 1 is real time, 0.25 four times slower."""
    camera: str = "side"
    """Camera: side, quarter or overview."""
    width: int = 1280
    """Width [pixels]."""
    height: int = 720
    """Height [pixels]."""

    def run(self) -> int:
        """Do it; the exit status."""
        from mjbeer.video import render

        output.check(self.output)
        trajectory = self.simulate()
        _warn(trajectory.warnings)
        render(trajectory, self.output, self.width, self.height, speed=self.speed, camera=self.camera)
        _say(f"wrote {self.output}")
        return 0


@dataclass(frozen=True)
class Export:
    """Write a scene as one MJCF file that any MuJoCo loads, with its start as a keyframe."""

    scene: AnyScene
    output: pathlib.Path
    """MJCF file to write."""
    phi0: float = 60.0
    """Start angle of the load to the incline, the paper's phi [degrees]."""
    phi_dot0: float = 0.0
    """Start rate of phi [degrees/s]."""
    rolling: Rolling = "reduced"
    """What makes the can roll; the reduced model of a frozen load turns on the spot."""
    integrator: Literal["Euler", "implicit", "implicitfast", "discrete", "RK4"] = "RK4"
    """Integrator."""
    timestep: float = 1e-3
    """Timestep [s]."""
    friction: float = 1.0
    """Friction coefficient of a contact."""

    def run(self) -> int:
        """Do it; the exit status."""
        from mjbeer.export import export

        start = radians("phi0", self.phi0), radians("phi_dot0", self.phi_dot0, "degrees/s")
        settings = self.rolling, self.integrator, self.timestep, self.friction
        export(self.scene.scene(), self.output, *start, *settings)
        _say(f"wrote {self.output}")
        return 0


@dataclass(frozen=True)
class Validate:
    """Check the models against exact theory and the paper against both, row by row; exit status 1 if a row fails."""

    json: bool = False
    """Print the table as JSON."""

    def run(self) -> int:
        """Do it; the exit status."""
        from mjbeer import report, table

        verdict = report.check(_err)
        if self.json:
            streams.show(table.validation_json(verdict.checks, verdict.findings))
        else:
            _show(table.validation(verdict.checks), table.audit(verdict.findings))
        return 0 if verdict.passed else _FAILED


@dataclass(frozen=True)
class Report:
    """Validate, then draw the four scenes, into a folder with a summary; exit status 1 if a row fails."""

    output: pathlib.Path = pathlib.Path("report")
    """Folder to write to."""
    quick: bool = False
    """Smaller videos with fewer frames."""

    def run(self) -> int:
        """Do it; the exit status."""
        from mjbeer import report, table

        with claimed(self.output), claimed(self.output / "paper"):
            verdict = report.write(self.output, self.quick, _err)
        _show(table.validation(verdict.checks), table.audit(verdict.findings))
        _say(f"the report is in {self.output / 'summary.md'}")
        return 0 if verdict.passed else _FAILED


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
        """Do it; the exit status."""
        from mjbeer import benchmark, benchmark_report, benchmark_tables

        with claimed(self.output):
            study = benchmark.run(self.scenes, self.output, self.quick, _err)
            benchmark_report.write(study, self.output)
        for grid in benchmark_tables.tables(study):
            _show(grid.rich())
        _say(f"the study is in {self.output / 'summary.md'}")
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
        """Do it; the exit status."""
        from mjbeer import advice

        streams.show(advice.advise(self.scene, self.tolerance, self.rolling, self.study) + "\n")
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
        """Do it; the exit status."""
        from mjbeer import stability, stability_report

        with claimed(self.output):
            found = stability.run(self.output, not self.long, _err)
            stability_report.write(found, self.output)
        if self.json:
            streams.show(found.json())
        else:
            _show(*(grid.rich() for grid in stability_report.tables(found)))
        for each in found.unexpected:
            _say(f"not as theory expects: {each}", "red")
        _say(f"the study is in {self.output / 'summary.md'}")
        return _FAILED if found.unexpected else 0


@dataclass(frozen=True)
class Paper:
    """Draw the paper's stories, a plot each, into a folder with a summary."""

    output: pathlib.Path = pathlib.Path("paper")
    """Folder to write to."""
    films: bool = False
    """Films of what moves, too."""

    def run(self) -> int:
        """Do it; the exit status."""
        from mjbeer import stories

        with claimed(self.output):
            stories.write(self.output, self.films, _err)
        _say(f"the stories are in {self.output / 'stories.md'}")
        return 0


Command = Simulate | Render | Export | Validate | Benchmark | Advise | Stability | Report | Paper
_COMMAND = (
    Annotated[Simulate, tyro.conf.subcommand("simulate")]
    | Annotated[Render, tyro.conf.subcommand("render")]
    | Annotated[Export, tyro.conf.subcommand("export")]
    | Annotated[Validate, tyro.conf.subcommand("validate")]
    | Annotated[Benchmark, tyro.conf.subcommand("benchmark")]
    | Annotated[Advise, tyro.conf.subcommand("advise")]
    | Annotated[Stability, tyro.conf.subcommand("stability")]
    | Annotated[Report, tyro.conf.subcommand("report")]
    | Annotated[Paper, tyro.conf.subcommand("paper")]
)
_STYLE = (tyro.conf.OmitSubcommandPrefixes, tyro.conf.OmitArgPrefixes, tyro.conf.CascadeSubcommandArgs)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line: exit status 0, 1 (a check failed), 2 (an error), or 128 and the signal that ended it."""
    streams.open_closed()
    with interruption.heeded():
        try:
            with streams.printing():
                command = parse(arguments)
            gl.keep_out()
            return command.run()
        except MjbeerError as error:
            _say(f"mjbeer: {error}", "red")
        except OSError as error:  # of the machine: too many processes, no standard output, ...
            _say(f"mjbeer: {error}", "red")
        except interruption.Interrupted as error:
            _say("mjbeer: interrupted; what was written is whole", "red")
            return error.status
    return _WRONG


def parse(arguments: Sequence[str] | None = None) -> Command:
    """What a command line asks for; one that is not understood ends the program, with exit status 2."""
    return tyro.cli(
        _COMMAND,
        prog="mjbeer",
        description="The rolling half-full beer can as a MuJoCo model that can be trusted.",
        args=arguments,
        config=(*_STYLE, tyro.conf.FlagCreatePairsOff),
    )


def _warn(warnings: tuple[str, ...]) -> None:
    for each in warnings:
        _say(f"not to be trusted: {each}", "yellow")


def _show(*tables: RenderableType) -> None:
    with streams.printing():
        _out.print(*tables)


def _say(text: str, style: str = "") -> None:
    """A line on standard error; names of files may have brackets in them, which are no markup."""
    _err.print(text, style=style, highlight=False, markup=False, soft_wrap=True)
