"""The entry point of `mjbeer`: read the command line, run the command, and turn errors into exit statuses."""

import argparse
import os
import re
import signal
import sys
import warnings
from argparse import Namespace
from collections.abc import Callable, Iterable, Sequence
from types import FrameType
from typing import Any, NoReturn, cast

import mjbeer
from mjbeer.cli import motions, studies
from mjbeer.cli.arguments import OPTIONS, SCENES, STANDING, Option, of_scene
from mjbeer.exceptions import AngleWarning, LiquidWarning, MjbeerError, ParameterError, UntrustedWarning
from mjbeer.output import terminal
from mjbeer.output.terminal import say

_DESCRIPTION = """The rolling half-full beer can as a MuJoCo model that can be trusted.
`mjbeer COMMAND --help` shows the options of a command and the scenes, `mjbeer --version` the version."""
# The functions that run commands, whose docstrings are their help; one may return an exit status.
COMMANDS = {name: getattr(motions, name, None) or getattr(studies, name) for name in OPTIONS}
OF_SCENES: dict[str, dict[str, Callable[..., Any]]] = {  # the scenes of which one must follow a command
    **dict.fromkeys(("simulate", "fit", "sweep"), SCENES),
    **dict.fromkeys(("render", "view", "export"), SCENES | STANDING),
}


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line each."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)
        self._negative_number_matcher = re.compile(r"-[\d.]")  # -1e-3 and -1:1:5 are values and not options

    def error(self, message: str) -> NoReturn:
        raise ParameterError(f"{message}; see `{self.prog} --help`")

    def add_options(self, options: Iterable[Option]) -> None:
        """Add options, whose help ends with their defaults."""
        for name, meaning, default, kind in options:
            how: dict[str, Any] = {"help": meaning, "default": default}
            how |= {"choices": kind} if isinstance(kind, tuple) else {"type": kind, "metavar": kind.__name__.upper()}
            if isinstance(default, list):
                how["nargs"] = "+" if name.startswith("-") else "*"
            elif default is False:
                how = {"help": meaning, "action": "store_true"}
            elif default is not None:
                how["help"] += " (default: %(default)s)"
            self.add_argument(name, **how)


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
        # MuJoCo loads the OpenGL that MUJOCO_GL names at once, and fails where it cannot.
        asked, os.environ["MUJOCO_GL"] = os.environ.get("MUJOCO_GL", ""), "disable"
        import mujoco  # noqa: F401

        os.environ["MUJOCO_GL"] = asked
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UntrustedWarning)  # the commands say it in their own words
            warnings.simplefilter("ignore", AngleWarning)  # angles are in degrees here
            # A study goes where a liquid is no lump on purpose, and its documents say so.
            warnings.simplefilter("always" if given.command in OF_SCENES else "ignore", LiquidWarning)
            cast("Any", warnings).showwarning = lambda message, *_: say(f"note: {message}", "yellow")
            return COMMANDS[given.command](given) or 0
    except (MjbeerError, OSError) as error:  # OSError: a limit of the machine, such as too many processes
        say(f"mjbeer: {error}", "red")
        return 2
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
    parsers = top.add_subparsers(title="commands", dest="command", metavar="COMMAND", required=True)
    for name, run in COMMANDS.items():
        parser = parsers.add_parser(name, help=_first_sentence(run), description=run.__doc__)
        if name not in OF_SCENES:
            parser.add_options(OPTIONS[name])
        elif name in words:  # only the command that is meant gets the options of all scenes, which are many
            if name == "fit":
                parser.add_argument("file", metavar="FILE", help="table of the track, as Tracker or phyphox export it")
            below = parser.add_subparsers(title="scenes", dest="scene", metavar="SCENE", required=True)
            for scene, make in OF_SCENES[name].items():
                parser = below.add_parser(scene, usage="%(prog)s [options]", help=_first_sentence(make))
                parser.description = f"{run.__doc__} The scene: {_first_sentence(make)}."
                parser.add_options(of_scene(scene, name))
    given, others = top.parse_known_args(words)
    if others:
        place = " ".join(filter(None, ("mjbeer", given.command, getattr(given, "scene", ""))))
        raise ParameterError(f"{others[0]} is not understood here; see `{place} --help`")
    return given


def _first_sentence(function: Callable[..., Any]) -> str:
    return re.split(r"\.(\n|$)", str(function.__doc__))[0].removeprefix("Return ").removeprefix("the scene of ")


def _interrupt(signum: int, _: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt(signum)  # so that files are cleaned up as after Ctrl-C
