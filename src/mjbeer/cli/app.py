"""The entry point of `mjbeer`: read the command line, run the command, return a status."""

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
from mjbeer.cli.arguments import OPTIONS, SCENES, STANDING, Option, scene_options
from mjbeer.exceptions import (
    AngleWarning,
    LiquidWarning,
    MjbeerError,
    ParameterError,
    UntrustedWarning,
)
from mjbeer.output import terminal
from mjbeer.output.terminal import say

_DESCRIPTION = """The rolling half-full beer can as a MuJoCo model that can be trusted.
`mjbeer COMMAND --help` shows the options of a command and the scenes,
`mjbeer --version` the version."""
COMMANDS: dict[str, Callable[[Namespace], int | None]] = {
    "simulate": motions.simulate,
    "render": motions.render,
    "view": motions.view,
    "export": motions.export,
    "fit": motions.fit,
    "sweep": studies.sweep,
    "validate": studies.validate,
    "benchmark": studies.benchmark,
    "stability": studies.stability,
    "paper": studies.paper,
    "report": studies.report,
}
"""What runs each command. The docstrings are the help; one may return an exit status."""
SCENES_OF: dict[str, dict[str, Callable[..., Any]]] = {
    "simulate": SCENES,
    "fit": SCENES,
    "sweep": SCENES,
    "render": SCENES | STANDING,
    "view": SCENES | STANDING,
    "export": SCENES | STANDING,
}
"""The scenes of which one must follow a command."""


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line each."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)
        # -1e-3 and -1:1:5 are values and not options.
        self._negative_number_matcher = re.compile(r"-[\d.]")

    def error(self, message: str) -> NoReturn:
        raise ParameterError(f"{message}; see `{self.prog} --help`")

    def add_options(self, options: Iterable[Option]) -> None:
        """Add options, whose help ends with their defaults."""
        for option in options:
            if option.flag:
                self.add_argument(option.name, help=option.help, action="store_true")
                continue
            settings: dict[str, Any] = {"help": option.help, "default": option.default}
            if option.choices:
                settings["choices"] = option.choices
            else:
                settings["type"] = option.read
                settings["metavar"] = option.read.__name__.upper()
            if option.several:
                settings["nargs"] = "+" if option.name.startswith("-") else "*"
            elif option.default is not None:
                settings["help"] += " (default: %(default)s)"
            self.add_argument(option.name, *option.synonyms, **settings)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command that `arguments` ask for, by default those of the process.

    Return the exit status: 0, 1 if a check failed, 2 on an error, or 128 plus the number of the
    signal that interrupted the command.

    Raises:
      SystemExit: after --help and --version.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    for signum in (signal.SIGTERM, signal.SIGHUP):
        # A signal that is ignored, as under nohup, stays ignored.
        if signal.getsignal(signum) == signal.SIG_DFL:
            signal.signal(signum, _interrupt)
    try:
        with terminal.printing():
            given = parse(words)
        # MuJoCo loads the OpenGL that MUJOCO_GL names at once, and fails where it cannot.
        asked_for = os.environ.get("MUJOCO_GL", "")
        os.environ["MUJOCO_GL"] = "disable"
        import mujoco  # noqa: F401

        os.environ["MUJOCO_GL"] = asked_for
        with warnings.catch_warnings():
            # The commands say it in their own words.
            warnings.simplefilter("ignore", UntrustedWarning)
            # Angles are in degrees here.
            warnings.simplefilter("ignore", AngleWarning)
            # A study goes where a liquid is no lump on purpose, and its documents say so.
            of_scene = given.command in SCENES_OF
            warnings.simplefilter("always" if of_scene else "ignore", LiquidWarning)
            cast("Any", warnings).showwarning = _show_warning
            return COMMANDS[given.command](given) or 0
    except (MjbeerError, OSError) as error:  # OSError: a limit, such as too many processes
        # A note names the job that failed.
        words = [str(error), *getattr(error, "__notes__", ())]
        say(f"mjbeer: {', '.join(words)}", "red")
        return 2
    except KeyboardInterrupt as error:
        say("mjbeer: interrupted; what was written is whole", "red")
        (signum,) = error.args or (signal.SIGINT,)
        return 128 + signum


def parse(words: Sequence[str]) -> Namespace:
    """Return the options that a command line asks for, with the `command` that takes them.

    Raises:
      ParameterError: if the words are not understood.
      SystemExit: after --help and --version.
    """
    top = Parser(description=_DESCRIPTION, prog="mjbeer")
    top.add_argument("--version", action="version", version=f"mjbeer {mjbeer.__version__}")
    parsers = top.add_subparsers(title="commands", dest="command", metavar="COMMAND", required=True)
    for name, run in COMMANDS.items():
        parser = parsers.add_parser(name, help=_first_sentence(run), description=run.__doc__)
        if name not in SCENES_OF:
            parser.add_options(OPTIONS[name])
        elif (
            name in words
        ):  # only the command that is meant gets its scenes' options, which are many
            _add_scenes(parser, name)
    given, others = top.parse_known_args(words)
    if others:
        place = f"mjbeer {given.command} {getattr(given, 'scene', '')}".rstrip()
        raise ParameterError(f"{others[0]} is not understood here; see `{place} --help`")
    return given


def _add_scenes(parser: Parser, command: str) -> None:
    """Add the scenes that may follow a command, with their options."""
    if command == "fit":
        parser.add_argument(
            "file", metavar="FILE", help="table of the track, as Tracker or phyphox export it"
        )
    below = parser.add_subparsers(title="scenes", dest="scene", metavar="SCENE", required=True)
    for scene, make in SCENES_OF[command].items():
        what = _first_sentence(make)
        of_scene = below.add_parser(scene, usage="%(prog)s [options]", help=what)
        of_scene.description = f"{COMMANDS[command].__doc__} The scene: {what}."
        of_scene.add_options(scene_options(scene, command))


def _first_sentence(function: Callable[..., Any]) -> str:
    sentence, *_ = re.split(r"\.(?:\n|$)", str(function.__doc__))
    return sentence.removeprefix("Return ").removeprefix("the scene of ")


def _show_warning(message: Warning | str, *_: Any) -> None:
    say(f"note: {message}", "yellow")


def _interrupt(signum: int, _: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt(signum)  # so that files are cleaned up as after Ctrl-C
