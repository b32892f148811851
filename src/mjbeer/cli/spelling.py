"""Words of the command line that are no command, scene or option: an error that says what may have been meant."""

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import tyro

from mjbeer import require
from mjbeer.cli.arguments import SCENES, AnyScene
from mjbeer.cli.sweep import SweptScene
from mjbeer.exceptions import ParameterError

_SHELLS = ("bash", "zsh", "fish")
_COMPLETION = {"--tyro-print-completion", "--tyro-write-completion"}
_HELP = {"-h", "--help"}
_SCENE = (AnyScene, SweptScene)
"""The types of an option that is a scene."""


def check(words: Sequence[str], commands: Mapping[str, type[Any]]) -> None:
    """Raise an error for the first of the words that is no command, scene or option where it stands.

    What is a value, and whether it is allowed, is left to the library that reads the command line.

    Raises:
      ParameterError: if there is such a word, or the command or its scene is missing.
    """
    if not words:
        raise ParameterError(f"a command is missing: {_listed(commands)}; see `mjbeer --help`")
    first, *rest = words
    if first in _COMPLETION:
        if not rest or rest[0] not in _SHELLS:
            raise ParameterError(f"{first} must be followed by {_listed(_SHELLS)}")
    elif first not in commands and first not in _HELP:
        close = _close(first, [*commands, "--help", "--version"])
        raise ParameterError(f"{first!r} is no command; " + (close or f"the commands are {_listed(commands, 'and')}"))
    elif first in commands:
        _check_rest(first, rest, commands)


def _check_rest(command: str, words: Sequence[str], commands: Mapping[str, type[Any]]) -> None:
    """Check the words after the command."""
    called, allowed = f"mjbeer {command}", options(commands[command])
    takes_scene = any(field.type in _SCENE for field in dataclasses.fields(commands[command]))
    scene = None
    left = iter(words)
    for word in left:
        if word in _HELP:
            return
        if word.startswith("--"):
            name, equals, _ = word.partition("=")
            option = name.replace("_", "-")
            if option not in allowed:
                raise _unknown_option(called, option, allowed, takes_scene and scene is None, commands)
            if allowed[option] and not equals:
                next(left, None)  # its value
        elif takes_scene and scene is None and not word.startswith("-"):
            if word not in SCENES:
                close = _close(word, SCENES)
                raise ParameterError(f"{word!r} is no scene; " + (close or f"the scenes are {_listed(SCENES, 'and')}"))
            scene, called, allowed = word, f"{called} {word}", allowed | options(SCENES[word])
    if takes_scene and scene is None:
        raise ParameterError(f"a scene is missing: {_listed(SCENES)}; see `mjbeer scenes`")


def options(owner: type[Any]) -> dict[str, bool]:
    """Return the options of a command or a scene, each with whether a value follows it."""
    return {
        "--" + field.name.replace("_", "-"): field.type is not bool
        for field in dataclasses.fields(owner)
        if field.type not in _SCENE and tyro.conf.Positional not in getattr(field.type, "__metadata__", ())
    }


def _unknown_option(
    called: str, option: str, allowed: Iterable[str], before_scene: bool, commands: Mapping[str, type[Any]]
) -> ParameterError:
    """Return an error that says where there is such an option, or which ones are spelled like it."""
    scenes = [name for name, scene in SCENES.items() if option in options(scene)]
    others = [f"`mjbeer {name}`" for name, command in commands.items() if option in options(command)]
    told = f"`{called}` has no option {option}"
    if before_scene and scenes:
        return ParameterError(f"{option} is an option of the scene: write it after {_listed(scenes)}")
    if owners := [*scenes, *others]:
        return ParameterError(f"{told}; {_listed(owners, 'and')} {'has' if len(owners) == 1 else 'have'} it")
    return ParameterError(f"{told}; " + (_close(option, allowed) or f"`{called} --help` lists them"))


def _close(word: str, allowed: Iterable[str]) -> str:
    """Return a question after the one or two allowed words that are most like this one; empty if none is."""
    close = require.spelled_alike(word, allowed)
    return f"did you mean {_listed(close)}?" if close else ""


def _listed(words: Iterable[str], link: str = "or") -> str:
    *others, last = words
    return f"{', '.join(others)} {link} {last}" if others else last
