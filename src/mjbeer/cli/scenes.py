"""The command `mjbeer scenes`: the scenes with their options, as the classes of the arguments have them."""

import ast
import dataclasses
import inspect
import itertools
import re
from dataclasses import dataclass

from mjbeer.cli.arguments import SCENES, otherwise
from mjbeer.output import terminal
from mjbeer.output.terminal import Table

_UNIT = re.compile(r" \[(?P<unit>.*?)\]")
_COLUMNS = ("option", "default", "unit", "meaning")


@dataclass(frozen=True)
class Scenes:
    """List the scenes with their options, defaults and units."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        if terminal.is_read_by_eye():
            terminal.show(_scenes(), _shared())
        else:
            rows = [(name, *row) for name in SCENES for row in options(name)]
            terminal.show(Table("Options of each scene", ("scene", *_COLUMNS), rows))
        return 0


def _scenes() -> Table:
    """Return a table of what each scene is."""
    return Table("Scenes", ("scene", "is"), [(name, scene.__doc__ or "") for name, scene in SCENES.items()], (0, 1))


def _shared() -> Table:
    """Return a table with a row for each option, however many scenes have it."""
    owners: dict[tuple[str, str, str], list[str]] = {}
    for name in SCENES:
        for option, default, unit, meaning in options(name):
            owners.setdefault((option, f"{default} {unit}".strip(), meaning), []).append(name)
    rows = [(*row, "all" if len(names) == len(SCENES) else ", ".join(names)) for row, names in owners.items()]
    return Table("Their options", ("option", "default", "meaning", "scenes"), rows, left=(0, 1, 2, 3))


def options(name: str) -> list[tuple[str, str, str, str]]:
    """Return the options of a scene: the name, the default, the unit and the meaning of each."""
    scene = SCENES[name]
    told = documented(scene)
    rows = []
    for field in dataclasses.fields(scene):
        default = f"{field.default:g}" if isinstance(field.default, float) else str(field.default)
        if field.default is None:
            default = otherwise(field)
        unit = _UNIT.search(told[field.name])
        meaning = _UNIT.sub("", told[field.name])
        rows.append(("--" + field.name.replace("_", "-"), default, unit["unit"] if unit else "", meaning))
    return rows


def documented(owner: type) -> dict[str, str]:
    """Return the docstrings of the fields of a dataclass and of its bases, which Python keeps only in the source."""
    found = {}
    for base in reversed(owner.__mro__[:-1]):
        (definition,) = ast.parse(inspect.getsource(base)).body
        for field, text in itertools.pairwise(definition.body if isinstance(definition, ast.ClassDef) else ()):
            match field, text:
                case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(told))):
                    found[name] = " ".join(told.split())
    return found
