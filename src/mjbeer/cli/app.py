"""The entry point of `mjbeer`: read the command line, run the command, and turn errors into exit statuses."""

import functools
import re
import signal
import sys
import warnings
from argparse import Namespace
from collections.abc import Callable, Sequence
from types import FrameType
from typing import Any, NoReturn, cast

import mjbeer
from mjbeer.cli import fit, motions, studies
from mjbeer.cli.arguments import SCENE_MEANINGS, STANDING, STANDING_OPTIONS, Command, Parser, scene_options
from mjbeer.drawing import opengl
from mjbeer.exceptions import AngleWarning, LiquidWarning, MjbeerError, ParameterError, UntrustedWarning
from mjbeer.output import terminal
from mjbeer.output.terminal import say

_ERROR = 2
_DESCRIPTION = """The rolling half-full beer can as a MuJoCo model that can be trusted.
`mjbeer COMMAND --help` shows the options of a command and the scenes, `mjbeer --version` the version."""

_NAMES = "sweep", "validate", "benchmark", "stability", "paper", "report"
COMMANDS: dict[str, Command] = {name: getattr(motions, name) for name in ("simulate", "render", "view", "export")}
COMMANDS |= {"fit": fit.fit} | {name: getattr(studies, name) for name in _NAMES}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command that `arguments` ask for, by default those of the process, and return its exit status.

    The status is 0, 1 if a check failed, 2 on an error, or 128 plus the number of the signal that interrupted it.

    Raises:
      SystemExit: after --help and --version.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    for signum in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(signum) == signal.SIG_DFL:  # a signal that is ignored, as under nohup, stays ignored
            signal.signal(signum, _interrupt)
    try:
        with terminal.printing():
            given = parse(words)
        command = COMMANDS[given.command]
        opengl.import_mujoco_without_gl()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UntrustedWarning)  # the commands say it in their own words
            warnings.simplefilter("ignore", AngleWarning)  # angles are in degrees here
            # A study goes where a liquid is no lump on purpose, and its documents say so.
            warnings.simplefilter("always" if command.numbers else "ignore", LiquidWarning)
            cast("Any", warnings).showwarning = functools.partial(_show, warnings.showwarning)
            return command.run(given)
    except (MjbeerError, OSError) as error:  # OSError: a limit of the machine, such as too many processes
        say(f"mjbeer: {error}", "red")
        return _ERROR
    except KeyboardInterrupt as error:
        say("mjbeer: interrupted; what was written is whole", "red")
        (signum,) = error.args or (signal.SIGINT,)
        return 128 + signum


def parse(words: Sequence[str]) -> Namespace:
    """Return the options that the words of a command line ask for, with the `command` that takes them.

    Raises:
      ParameterError: if the words are not understood.
      SystemExit: after --help and --version.
    """
    top = Parser(description=_DESCRIPTION, prog="mjbeer")
    top.add_argument("--version", action="version", version=f"mjbeer {mjbeer.__version__}")
    parsers = top.add_words("commands", "COMMAND", {name: str(each.run.__doc__) for name, each in COMMANDS.items()})
    # Only the command that is meant gets its options, which are many.
    if name := next((word for word in words if word in COMMANDS), ""):
        at, command = parsers[name], COMMANDS[name]
        if command.numbers is None:
            at.add_options(command.options)
        else:
            if command.file:
                at.add_argument("file", metavar="FILE", help=command.file)
            scenes = SCENE_MEANINGS | ({"standing": STANDING} if command.standing else {})
            for scene, below in at.add_words("scenes", "SCENE", scenes, f"{command.run.__doc__} The scene: ").items():
                if scene == "standing":
                    below.add_options((*STANDING_OPTIONS, *command.standing))
                else:
                    below.add_options((*scene_options(scene, command.numbers), *command.options))
    # argparse takes -1e-3 and -1:1:5 for options, unless they are joined to theirs.
    joined = re.sub(r"\0(?=-[\d.])", "=", "\0".join(["", *words])).split("\0")[1:]
    given, others = top.parse_known_args(joined)
    if others:
        place = " ".join(filter(None, ("mjbeer", given.command, getattr(given, "scene", ""))))
        raise ParameterError(f"{others[0]} is not understood here; see `{place} --help`")
    return given


def _show(otherwise: Callable[..., None], message: Warning | str, category: type[Warning], *place: Any) -> None:
    """Say what a liquid's warning says in one line, and show any other warning as Python does."""
    if issubclass(category, LiquidWarning):
        say(f"note: {message}", "yellow")
    else:
        otherwise(message, category, *place)


def _interrupt(signum: int, _: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt(signum)  # so that files are cleaned up as after Ctrl-C
