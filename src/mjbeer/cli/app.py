"""The entry point of `mjbeer`: read the command line, run the command, and turn errors into exit statuses."""

import functools
import signal
import sys
import warnings
from argparse import Namespace
from collections.abc import Callable, Sequence
from types import FrameType
from typing import Any, NoReturn, cast

import mjbeer
from mjbeer import require
from mjbeer.cli import motions, studies, sweep
from mjbeer.cli.arguments import SCENES, STANDING_OPTIONS, Command, Parser, scene_options, scenes_told
from mjbeer.drawing import opengl
from mjbeer.exceptions import AngleWarning, LiquidWarning, MjbeerError, UntrustedWarning
from mjbeer.output import terminal
from mjbeer.output.terminal import say

_ERROR = 2
_DESCRIPTION = """The rolling half-full beer can as a MuJoCo model that can be trusted.
`mjbeer COMMAND --help` shows the options of a command and the scenes, `mjbeer --version` the version."""
_HELP = ("-h", "--help")
_STANDING = "a can that stands on a floor, free in space, with a liquid that sloshes"


COMMANDS: dict[str, Command] = {
    "simulate": motions.simulate,
    "render": motions.render,
    "view": motions.view,
    "export": motions.export,
    "sweep": sweep.sweep,
    "validate": studies.validate,
    "benchmark": studies.benchmark,
    "stability": studies.stability,
    "paper": studies.paper,
    "report": studies.report,
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command that `arguments` ask for, by default those of the process, and return its exit status.

    The status is 0, 1 if a check failed, 2 on an error, or 128 plus the number of the signal that interrupted it.

    Raises:
      SystemExit: after --help.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    for signum in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(signum) == signal.SIG_DFL:  # a signal that is ignored, as under nohup, stays ignored
            signal.signal(signum, _interrupt)
    try:
        if words[:1] == ["--version"]:
            terminal.write(f"mjbeer {mjbeer.__version__}\n")
            return 0
        with terminal.printing():
            command, given = parse(words)
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


def parse(words: Sequence[str]) -> tuple[Command, Namespace]:
    """Return the command that the words of a command line ask for, and its options.

    Raises:
      ParameterError: if the words are not understood.
      SystemExit: after --help.
    """
    first, *rest = words or [""]
    if first in _HELP:
        parser = Parser("mjbeer", _DESCRIPTION, "COMMAND [options]")
        told = {name: str(command.run.__doc__).split("\n\n")[0] for name, command in COMMANDS.items()}
        parser.words("commands", told)
        parser.parse_args([first])
    command = COMMANDS[require.choice("command", first, COMMANDS)]
    told = str(command.run.__doc__)
    parser = Parser(f"mjbeer {first}", told)
    if command.standing and rest[:1] == ["standing"]:
        parser = Parser(f"mjbeer {first} standing", f"{told} The scene: {_STANDING}.")
        parser.set_defaults(scene="standing")
        parser.add((*STANDING_OPTIONS, *command.standing))
        return command, parser.read(rest[1:])
    if command.numbers:
        scene, *rest = rest or [""]
        if scene in _HELP:
            parser, rest = Parser(f"mjbeer {first}", told, "SCENE [options]"), [scene]
            scenes = scenes_told() | ({"standing": _STANDING} if command.standing else {})
            parser.words(f"scenes (`mjbeer {first} SCENE --help` shows the options of each)", scenes)
        else:
            require.choice(f"the scene after {first}", scene, [*SCENES, *(["standing"] if command.standing else [])])
            parser = Parser(f"mjbeer {first} {scene}", f"{told} The scene: {scenes_told()[scene]}")
            parser.set_defaults(scene=scene)
            parser.add(scene_options(scene, command.numbers))
    parser.add(command.options)
    return command, parser.read(rest)


def _show(otherwise: Callable[..., None], message: Warning | str, category: type[Warning], *place: Any) -> None:
    """Say what a liquid's warning says in one line, and show any other warning as Python does."""
    if issubclass(category, LiquidWarning):
        say(f"note: {message}", "yellow")
    else:
        otherwise(message, category, *place)


def _interrupt(signum: int, _: FrameType | None) -> NoReturn:
    """Treat a signal as Ctrl-C, so that files are cleaned up as after Ctrl-C.

    Raises:
      KeyboardInterrupt: always, with the number of the signal.
    """
    raise KeyboardInterrupt(signum)
