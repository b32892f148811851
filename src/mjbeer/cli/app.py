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
`mjbeer COMMAND --help` shows the scenes or the options of a command,
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
"""The function that runs each command: its docstring is the help, and it may return a status."""
SCENES_OF: dict[str, dict[str, Callable[..., Any]]] = {
    "simulate": SCENES,
    "fit": SCENES,
    "sweep": SCENES,
    "render": SCENES | STANDING,
    "view": SCENES | STANDING,
    "export": SCENES | STANDING,
}
"""The scenes that a command takes; one of them must follow it."""


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
    """Run the command of a command line, by default that of the process.

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
        _import_mujoco()
        with warnings.catch_warnings():
            _choose_warnings(given.command)
            return COMMANDS[given.command](given) or 0
    # The system raises an OSError at a limit of its own, such as too many processes.
    except (MjbeerError, OSError) as error:
        # A note names the job that failed.
        notes = getattr(error, "__notes__", ())
        message = ", ".join([str(error), *notes])
        say(f"mjbeer: {message}", "red")
        return 2
    except KeyboardInterrupt as error:
        say("mjbeer: interrupted; every file written is complete", "red")
        (signum,) = error.args or (signal.SIGINT,)
        return 128 + signum


def _import_mujoco() -> None:
    """Import MuJoCo without OpenGL.

    When it is imported MuJoCo loads the OpenGL that MUJOCO_GL names, and fails if it cannot. Only
    drawing needs OpenGL, and `drawing.opengl` then makes a context of its own.
    """
    asked_for = os.environ.get("MUJOCO_GL", "")
    os.environ["MUJOCO_GL"] = "disable"
    import mujoco  # noqa: F401

    os.environ["MUJOCO_GL"] = asked_for


def _choose_warnings(command: str) -> None:
    """Let Python show the warnings that a command does not tell in its own words, as notes."""
    warnings.simplefilter("ignore", UntrustedWarning)
    # This one is about degrees that were taken for radians, and here angles are in degrees.
    warnings.simplefilter("ignore", AngleWarning)
    # A study simulates liquids that are no lump on purpose, and its documents say so.
    takes_scene = command in SCENES_OF
    warnings.simplefilter("always" if takes_scene else "ignore", LiquidWarning)
    cast("Any", warnings).showwarning = _show_warning


def parse(words: Sequence[str]) -> Namespace:
    """Return the values of a command line's options, and the `command` that takes them.

    Raises:
      ParameterError: if a word is not understood, or one is missing.
      SystemExit: after --help and --version.
    """
    top = Parser(description=_DESCRIPTION, prog="mjbeer")
    top.add_argument("--version", action="version", version=f"mjbeer {mjbeer.__version__}")
    parsers = top.add_subparsers(title="commands", dest="command", metavar="COMMAND", required=True)
    for name, run in COMMANDS.items():
        parser = parsers.add_parser(name, help=_first_sentence(run), description=run.__doc__)
        if name not in SCENES_OF:
            parser.add_options(OPTIONS[name])
        elif name in words:
            # A command that is not among the words can do without the options of its scenes.
            _add_scenes(parser, name)
    given, others = top.parse_known_args(words)
    if given.command == "fit" and given.file is None:
        raise ParameterError("the following arguments are required: FILE; see `mjbeer fit --help`")
    if others:
        place = f"mjbeer {given.command} {getattr(given, 'scene', '')}".rstrip()
        raise ParameterError(f"{others[0]} is not understood here; see `{place} --help`")
    return given


def _add_scenes(parser: Parser, command: str) -> None:
    """Add the scenes that may follow a command, with their options."""
    before_scene = parser.prog
    if command == "fit":
        what = "table of the track, as Tracker or phyphox export it"
        # If it were not optional here, "fit liquid --help" would take "liquid" for the file.
        parser.add_argument("file", metavar="FILE", nargs="?", help=what)
        parser.usage = f"{parser.prog} [-h] FILE SCENE ..."
        before_scene += " FILE"
    parsers = parser.add_subparsers(
        title="scenes", dest="scene", metavar="SCENE", required=True, prog=before_scene
    )
    for scene, make in SCENES_OF[command].items():
        about = _first_sentence(make)
        scene_parser = parsers.add_parser(scene, usage="%(prog)s [options]", help=about)
        scene_parser.description = f"{COMMANDS[command].__doc__} The scene: {about}."
        scene_parser.add_options(scene_options(scene, command))


def _first_sentence(function: Callable[..., Any]) -> str:
    """Return the first sentence of a docstring without its stop; of a scene, what the scene is."""
    sentence, *_ = re.split(r"\.(?:\n|$)", str(function.__doc__))
    return sentence.removeprefix("Return ").removeprefix("the scene of ")


def _show_warning(message: Warning | str, *_: Any) -> None:
    say(f"note: {message}", "yellow")


def _interrupt(signum: int, _: FrameType | None) -> NoReturn:
    # Files are then cleaned up as after Ctrl-C.
    raise KeyboardInterrupt(signum)
