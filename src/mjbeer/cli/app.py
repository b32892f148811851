"""The command line: what `mjbeer` does, a class a command."""

import signal
from collections.abc import Sequence
from types import FrameType
from typing import Annotated, NoReturn

import tyro

from mjbeer.cli.motions import Export, Render, Simulate
from mjbeer.cli.studies import Advise, Benchmark, Paper, Report, Stability, Validate
from mjbeer.drawing import opengl
from mjbeer.exceptions import MjbeerError
from mjbeer.output import terminal
from mjbeer.output.terminal import say

_WRONG = 2
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
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) == signal.SIG_DFL:  # one that is ignored, as under nohup, stays so
            signal.signal(number, _interrupt)
    try:
        with terminal.printing():
            command = parse(arguments)
        opengl.keep_out()
        return command.run()
    except (MjbeerError, OSError) as error:  # OSError: of the machine, as too many processes
        say(f"mjbeer: {error}", "red")
        return _WRONG
    except KeyboardInterrupt as error:
        say("mjbeer: interrupted; what was written is whole", "red")
        (number,) = error.args or (signal.SIGINT,)
        return 128 + number


def _interrupt(number: int, _: FrameType | None) -> NoReturn:
    """Raise for a signal what Ctrl-C raises, with the number of the signal.

    Raises:
      KeyboardInterrupt: always.
    """
    raise KeyboardInterrupt(number)


def parse(arguments: Sequence[str] | None = None) -> Command:
    """What a command line asks for; one that is not understood ends the program, with exit status 2."""
    return tyro.cli(
        _COMMAND,
        prog="mjbeer",
        description="The rolling half-full beer can as a MuJoCo model that can be trusted.",
        args=arguments,
        config=(*_STYLE, tyro.conf.FlagCreatePairsOff),
    )
