"""The entry point of `mjbeer`: parse the command line, run the command, and turn errors into exit statuses."""

import signal
from collections.abc import Sequence
from types import FrameType
from typing import Annotated, NoReturn

import tyro

from mjbeer.cli.motions import Export, Render, Simulate
from mjbeer.cli.studies import Advise, Benchmark, Paper, Report, Stability, Validate
from mjbeer.cli.view import View
from mjbeer.drawing import opengl
from mjbeer.exceptions import MjbeerError
from mjbeer.output import terminal
from mjbeer.output.terminal import say

_ERROR = 2
Command = Simulate | Render | View | Export | Validate | Benchmark | Advise | Stability | Report | Paper
_COMMAND = (
    Annotated[Simulate, tyro.conf.subcommand("simulate")]
    | Annotated[Render, tyro.conf.subcommand("render")]
    | Annotated[View, tyro.conf.subcommand("view")]
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
    """Run the command that `arguments` ask for, by default those of the process, and return its exit status.

    The status is 0, 1 if a check failed, 2 on an error, or 128 plus the number of the signal that interrupted it.

    Raises:
      SystemExit: after --help, and with status 2 if the arguments are not understood.
    """
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) == signal.SIG_DFL:  # a signal that is ignored, as under nohup, stays ignored
            signal.signal(number, _interrupt)
    try:
        with terminal.printing():
            command = parse(arguments)
        opengl.keep_out()
        return command.run()
    except (MjbeerError, OSError) as error:  # OSError: a limit of the machine, such as too many processes
        say(f"mjbeer: {error}", "red")
        return _ERROR
    except KeyboardInterrupt as error:
        say("mjbeer: interrupted; what was written is whole", "red")
        (number,) = error.args or (signal.SIGINT,)
        return 128 + number


def _interrupt(number: int, _: FrameType | None) -> NoReturn:
    """Treat a signal as Ctrl-C, so that files are cleaned up as after Ctrl-C.

    Raises:
      KeyboardInterrupt: always, with the number of the signal.
    """
    raise KeyboardInterrupt(number)


def parse(arguments: Sequence[str] | None = None) -> Command:
    """Return the command that `arguments` ask for, by default those of the process.

    Raises:
      SystemExit: after --help, and with status 2 if the arguments are not understood.
    """
    return tyro.cli(
        _COMMAND,
        prog="mjbeer",
        description="The rolling half-full beer can as a MuJoCo model that can be trusted.",
        args=arguments,
        config=(*_STYLE, tyro.conf.FlagCreatePairsOff),
    )
