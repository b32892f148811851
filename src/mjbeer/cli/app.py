"""The entry point of `mjbeer`: parse the command line, run the command, and turn errors into exit statuses."""

import contextlib
import functools
import io
import re
import signal
import sys
import warnings
from collections.abc import Callable, Sequence
from types import FrameType
from typing import Any, NoReturn, cast

import tyro
from rich.text import Text

import mjbeer
from mjbeer.cli.motions import Export, Render, Simulate
from mjbeer.cli.scenes import Scenes
from mjbeer.cli.studies import Benchmark, Paper, Report, Stability, Validate
from mjbeer.cli.sweep import Sweep
from mjbeer.cli.view import View
from mjbeer.drawing import opengl
from mjbeer.exceptions import AngleWarning, LiquidWarning, MjbeerError, ParameterError, UntrustedWarning
from mjbeer.output import terminal
from mjbeer.output.terminal import say

_ERROR = 2
Command = Simulate | Render | View | Export | Scenes | Sweep | Validate | Benchmark | Stability | Report | Paper
_DESCRIPTION = """The rolling half-full beer can as a MuJoCo model that can be trusted.
`mjbeer COMMAND --help` shows the options, `mjbeer --version` the version."""
_STYLE = (
    tyro.conf.OmitSubcommandPrefixes,
    tyro.conf.OmitArgPrefixes,
    tyro.conf.CascadeSubcommandArgs,
    tyro.conf.FlagCreatePairsOff,
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command that `arguments` ask for, by default those of the process, and return its exit status.

    The status is 0, 1 if a check failed, 2 on an error, or 128 plus the number of the signal that interrupted it.

    Raises:
      SystemExit: after --help.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) == signal.SIG_DFL:  # a signal that is ignored, as under nohup, stays ignored
            signal.signal(number, _interrupt)
    try:
        if words[:1] == ["--version"]:
            terminal.write(f"mjbeer {mjbeer.__version__}\n")
            return 0
        with terminal.printing():
            command = parse(words)
        opengl.keep_out()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UntrustedWarning)  # the commands say it in their own words
            warnings.simplefilter("ignore", AngleWarning)  # angles are in degrees here
            # A study goes where a liquid is no lump on purpose, and its documents say so.
            warnings.simplefilter("always" if hasattr(command, "scene") else "ignore", LiquidWarning)
            cast("Any", warnings).showwarning = functools.partial(_show, warnings.showwarning)
            return command.run()
    except (MjbeerError, OSError) as error:  # OSError: a limit of the machine, such as too many processes
        say(f"mjbeer: {error}", "red")
        return _ERROR
    except KeyboardInterrupt as error:
        say("mjbeer: interrupted; what was written is whole", "red")
        (number,) = error.args or (signal.SIGINT,)
        return 128 + number


def _show(otherwise: Callable[..., None], message: Warning | str, category: type[Warning], *place: Any) -> None:
    """Say what a liquid's warning says in one line, and show any other warning as Python does."""
    if issubclass(category, LiquidWarning):
        say(f"note: {message}", "yellow")
    else:
        otherwise(message, category, *place)


def _interrupt(number: int, _: FrameType | None) -> NoReturn:
    """Treat a signal as Ctrl-C, so that files are cleaned up as after Ctrl-C.

    Raises:
      KeyboardInterrupt: always, with the number of the signal.
    """
    raise KeyboardInterrupt(number)


def parse(words: Sequence[str]) -> Command:
    """Return the command that the words of a command line ask for.

    Raises:
      ParameterError: if the words are not understood.
      SystemExit: after --help.
    """
    told = io.StringIO()
    try:
        with contextlib.redirect_stderr(told):
            return tyro.cli(Command, prog="mjbeer", description=_DESCRIPTION, args=words, config=_STYLE)
    except SystemExit as ended:
        if ended.code:
            raise ParameterError(_sentence(told.getvalue())) from None
        raise
    except ImportError:  # tyro completes for any other shell with a package that is not there
        raise ParameterError("words are completed in bash, zsh and fish") from None


def _sentence(box: str) -> str:
    """Return in one line an error that tyro drew: a title, and parts between ruled lines.

    The first part says what is wrong. The second may have what was meant: commands, or options with where they are.
    """
    _, *rows = (row.strip("│ ") for row in Text.from_ansi(box).plain.splitlines())
    what, meant, *_ = [*filter(None, map(str.strip, re.split(r"(?m)^[─╰╯-]+$", "\n".join(rows)))), ""]
    told, meant_in_line = " ".join(what.split("\n\n")[0].split()), " ".join(meant.split())
    options = dict.fromkeys(re.findall(r"(?m)^--(?!help)\S+", meant))
    if meant.startswith("Available"):
        return f"{told}; {meant_in_line.lower()}"
    if options and next(iter(options)) not in told.replace("=", " ").split():
        return f"{told}; did you mean {' or '.join(options)}?"
    owners = dict.fromkeys(re.findall(r" in (mjbeer[ \w]+?)(?: \(other subcommands\))? --help", meant_in_line))
    return f"{told}; it belongs to {' or '.join(owners)}" if options else told
