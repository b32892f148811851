"""The command sweep: one scene with ranges of its options, as a map, a table or a file."""

import contextlib
import dataclasses
import functools
import operator
import pathlib
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, cast

import numpy as np
import tyro

from mjbeer import require
from mjbeer.cli.arguments import SCENES, degrees, if_given, otherwise
from mjbeer.cli.scenes import documented
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import Integrator, Rolling
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Values: TypeAlias = tuple[float, ...]
"""One number, or several."""
_MOST = 100_000_000
"""Largest number of values of an option: they take a gigabyte."""
PLOTS = (".png", ".svg")
ENDINGS = (*PLOTS, ".csv", ".npz", ".nc")
Name = Literal[
    "phi", "u", "phi_dot", "u_dot", "error", "lowest_normal", "friction_needed", "parting_time", "energy_drift",
    "trusted", "status", "period",
]  # fmt: skip


def values(text: str) -> Values:
    """Return the numbers that a text stands for: "3", "1,2,5", or "1:20:39", which is 39 numbers from 1 to 20.

    Raises:
      ParameterError: if it is none of these.
    """
    try:
        if ":" in text:
            first, last, count = text.split(":")
            if not 1 <= int(count) <= _MOST:
                raise ValueError
            ends = require.number(text, float(first)), require.number(text, float(last))
            numbers = tuple(np.linspace(*ends, int(count)).tolist())
        else:
            numbers = tuple(float(each) for each in text.split(","))
    except ValueError:
        raise ParameterError(
            f"{text!r} is no number, no list as 1,2,5, and no range as 1:20:39, which is 39 numbers from 1 to 20"
        ) from None
    return tuple(require.number(text, number) for number in numbers)


_NUMBERS: Any = Annotated[
    Values,
    tyro.constructors.PrimitiveConstructorSpec(
        nargs=1,
        metavar="NUMBERS",
        instance_from_str=lambda words: values(words[0]),
        is_instance=lambda value: isinstance(value, tuple),
        str_from_instance=lambda numbers: [",".join(f"{number:g}" for number in numbers or ())],
    ),
]
"""How tyro reads an option that takes one number or several."""


def _option(field: dataclasses.Field[Any], text: str) -> tuple[str, Any, Any]:
    """Return name, type and default of an option, of which a number may be several.

    The type has the help: a class that is made here has no docstrings to read it from.
    """
    kind: Any = field.type
    default = dataclasses.field(default=field.default)
    if field.default is None:  # a number that may be left out
        described = tyro.conf.arg(help=text, constructor=_NUMBERS, help_behavior_hint=f"(default: {otherwise(field)})")
        return field.name, Annotated[Values | None, described], default
    if isinstance(field.default, float):
        kind, default = _NUMBERS, dataclasses.field(default=(field.default,))
    return field.name, Annotated[kind, tyro.conf.arg(help=text)], default


def _swept(scene: type[Any]) -> type[Any]:
    """Return the options of a scene as a class in which every number may be several."""
    told = documented(scene)
    options = [_option(field, told[field.name]) for field in dataclasses.fields(scene)]
    made = dataclasses.make_dataclass(scene.__name__, options, frozen=True)
    made.__doc__ = scene.__doc__
    return made


SWEPT: dict[str, type[Any]] = {name: _swept(scene) for name, scene in SCENES.items()}
"""The classes of the scenes, in which every number may be several, by their names on the command line."""
SweptScene: Any = functools.reduce(operator.or_, SWEPT.values())


@dataclass(frozen=True)
class Sweep:
    """Simulate a scene for ranges of its options, as --incline 1:20:39, which is 39 numbers from 1 to 20."""

    scene: SweptScene
    phi0: _NUMBERS = (60.0,)
    """Initial phi, the angle of the load [degrees]: 0 where its centre of mass is nearest to the incline."""
    phi_dot0: _NUMBERS = (0.0,)
    """Initial rate of change of phi [degrees/s]."""
    duration: float = 2.0
    """Duration of each motion [s]."""
    rolling: Rolling = "reduced"
    """What makes the can roll: reduced coordinates, a joint equality, or contact with friction."""
    integrator: Annotated[Integrator | None, if_given(Integrator, "what keeps the tolerance")] = None
    """Integrator with a fixed timestep: one of MuJoCo's, by its name in MJCF, DOP853 or GaussJackson."""
    timestep: float = 1e-3
    """Timestep of such an integrator, and what a contact is tuned to [s]."""
    tolerance: Annotated[float | None, if_given(float, "1e-6, without an integrator")] = None
    """Largest error allowed in phi and u/radius [rad]."""
    friction: float = 1.0
    """Coefficient of friction of a contact."""
    quantity: Name = "phi"
    """Quantity of the plot; files have all of them. phi, u, phi_dot and u_dot are those at the end, error is the
    estimate, and parting_time the time from which N < 0. period is measured only if it is asked for."""
    output: pathlib.Path = pathlib.Path("sweep.png")
    """File to write: a plot (.png or .svg) over one or two options, a table (.csv), or all arrays (.npz for NumPy,
    .nc for xarray). An interrupted sweep to .npz goes on where it was."""
    overwrite: bool = False
    """Replace a .npz of another sweep, and begin the same one anew."""

    def run(self) -> int:
        """Run the command and return its exit status, 0.

        Raises:
          ParameterError: if an option is not allowed, or the plot would have other than one or two dimensions.
        """
        from mjbeer.studies.sweep.result import checked
        from mjbeer.studies.sweep.run import sweep

        checked(self.output, ENDINGS)
        name = type(self.scene).__name__.lower()
        chosen = {field.name: getattr(self.scene, field.name) for field in dataclasses.fields(self.scene)}
        inclines = chosen.pop("incline")
        for index, incline in enumerate(inclines):
            if not abs(incline) < 90:
                raise ParameterError(
                    f"incline{_place(index, inclines)} must be between -90 and 90 [degrees], got {incline!r}"
                )
        phi0 = degrees("phi0", self.phi0[0]) if len(self.phi0) == 1 else _radians(self.phi0)
        angles: dict[str, Any] = {"incline": _radians(inclines), "phi0": phi0, "phi_dot0": _radians(self.phi_dot0)}
        others = {option: _one_or_more(value) for option, value in chosen.items()}
        varied = [each for each in (*angles.values(), *others.values()) if isinstance(each, np.ndarray)]
        if self.output.suffix in PLOTS and len(varied) not in (1, 2):
            raise ParameterError(
                f"a plot needs one or two options with several values, got {len(varied)}: write .csv, .npz or .nc "
                "instead"
            )
        tolerance = 1e-6 if self.tolerance is None and self.integrator is None else self.tolerance
        resumed = self.output if self.output.suffix == ".npz" else None
        with files.whole(self.output) if resumed is None else contextlib.nullcontext() as temporary:
            result = sweep(
                _Maker(name),
                self.duration,
                tolerance=tolerance,
                integrator=self.integrator,
                timestep=self.timestep,
                rolling=self.rolling,
                friction=self.friction,
                quantity=self.quantity,
                output=resumed,
                overwrite=self.overwrite,
                **angles,
                **others,
            )
            if temporary and self.output.suffix in PLOTS:
                cast("Figure", result.plot(self.quantity).figure).savefig(temporary, facecolor="white", dpi=150)
            elif temporary:
                result.save(temporary)
        alike: dict[str, list[Any]] = {}
        for failure in result.failed:  # reasons that differ in nothing but numbers are one
            alike.setdefault(re.sub(r"\d[\d.e+-]*", "", failure.reason), []).append(failure)
        for first, *others in sorted(alike.values(), key=len, reverse=True):
            place = _in_degrees(result, first.index)
            say(f"failed: {1 + len(others)} scene{'s' * bool(others)}, the first at {place}: {first.reason}", "yellow")
        say(f"wrote {self.output}")
        terminal.write(f"{result.counts}\n")
        return 0


@dataclass(frozen=True)
class _Maker:
    """Makes scenes from the options of the command line, but with the incline in radians."""

    kind: str

    @property
    def __name__(self) -> str:
        """The name of the scene, by which a sweep is known."""
        return self.kind

    def __call__(self, incline: float, **options: Any) -> Scene:
        return cast("type[Any]", SCENES[self.kind])(**options).at(incline)


def _in_degrees(result: Any, index: tuple[int, ...]) -> str:
    """Return the parameters of a scene in words, with its angles as they were given."""
    from mjbeer.studies.sweep.result import shown

    return ", ".join(
        f"{name} = {shown(name, result[name])[place]:.6g}" for name, place in zip(result.dims, index, strict=True)
    )


def _radians(degrees: Values) -> Any:
    return _one_or_more(tuple(np.radians(degrees).tolist()))


def _one_or_more(option: Any) -> Any:
    """Return the value of an option with one value, an array of those with several, and anything else as it is."""
    if not isinstance(option, tuple):
        return option
    return np.array(option) if len(option) > 1 else option[0]


def _place(index: int, inclines: Values) -> str:
    return f"[{index}]" if len(inclines) > 1 else ""
