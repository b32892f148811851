"""Public functions return a result, or raise an error of mjbeer's that says what came.

Every parameter of everything public gets every value below, while the other arguments are good.
"""

import contextlib
import inspect
import math
import pathlib
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple
from unittest import mock

import mujoco
import numpy as np
import pytest
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st

import mjbeer
from mjbeer import (
    Can,
    Load,
    MjbeerError,
    Scene,
    Trajectory,
    build,
    exact,
    frozen,
    require,
    simulate,
)
from mjbeer.drawing import film, video
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import (
    MJBEER_INTEGRATORS,
    MUJOCO_INTEGRATORS,
    ROLLINGS,
    Integrator,
    Rolling,
    Setting,
)
from mjbeer.require import format_value
from mjbeer.theory.scene import ATTACHMENTS

VALUES: dict[str, Callable[[], object]] = {
    "None": lambda: None,
    "text": lambda: "0.5",
    "long text": lambda: "x" * 300 + ".npz",
    "True": lambda: True,
    "complex": lambda: 1 + 2j,
    "nan": lambda: math.nan,
    "inf": lambda: math.inf,
    "huge": lambda: 1e160,
    "-1": lambda: -1,
    "0": lambda: 0,
    "0.3": lambda: 0.3,
    "single precision": lambda: np.float32(0.3),
    "number in an array": lambda: np.array(0.5),
    "list": lambda: [0.1, 0.2],
    "empty list": list,
    "list of lists": lambda: [[0.0, 0.1]],
    "list with None": lambda: [0.0, None],
    "list of texts": lambda: ["0", "0.1"],
    "list with NaN": lambda: [0.0, math.nan],
    "list from the future": lambda: [0.0, 1e160],
    "list in reverse": lambda: [0.2, 0.1],
    "list before the start": lambda: [-0.1, 0.1],
    "dict": lambda: {0.0: 0.1},
    "object": object,
    "function": lambda: frozen,
    "array": lambda: np.array([0.0, 0.1]),
    "two-dimensional array": lambda: np.zeros((2, 2)),
    "complex array": lambda: np.array([0.0, 1j]),
    "can": Can,
    "load": lambda: Load(0.2, 0.01, 1e-5),
    "scene": frozen,
    "path": lambda: pathlib.Path("somewhere"),
}
MOTION = exact(frozen(), np.linspace(0, 0.1, 11), 1.0)
RUN = simulate(frozen(), 0.01, 1.0)
MODEL = build(frozen())
STOOD = build(mjbeer.standing())
TABLE = pathlib.Path(__file__).parents[1] / "examples" / "synthetic_track.csv"
ROLLED = exact(mjbeer.sliding(), np.linspace(0, 0.5, 30), 0.0)
GOOD: dict[str, Any] = {
    **{name: getattr(MOTION, name) for name in inspect.signature(Trajectory).parameters},
    "can": Can(),
    "load": Load(0.2, 0.01, 1e-5),
    "mass": 0.2,
    "offset": 0.01,
    "amplitude": 0.3,
    "omega": 1.0,
    "phi0": 1.0,
    "phi_dot0": 10.0,
    "duration": 0.01,
    "trajectory": MOTION,
    "path": "can.mp4",
    "make": frozen,
}
"""Good arguments, by the names of the parameters."""
GOOD_HERE: dict[str, dict[str, Any]] = {
    "Track": {"time": ROLLED.time, "along": ROLLED.u},
    "read_track": {"path": TABLE},
    "fit": {"track": mjbeer.Track(ROLLED.time, ROLLED.u), "scene": mjbeer.sliding()},
    "Standing": {
        "can": Can.sheet_metal(),
        "fill": 0.5,
        "name": "beer",
        "density": 1e3,
        "viscosity": 1e-6,
    },
    "frame": {"time": 0.1},
    "export": {"path": "can.xml"},
    "reset": {"model": MODEL, "data": mujoco.MjData(MODEL)},
    "attach": {"can": mjbeer.standing()},
    "refill": {"model": build(mjbeer.standing()), "can": mjbeer.standing()},
    "wall_rise": {"model": STOOD, "data": mujoco.MjData(STOOD), "prefix": ""},
}
"""Those that are others in one function."""
FRESH = {"parent": mujoco.MjSpec}
"""Those that are changed by what gets them."""
COMPUTED = (
    "can mass ",
    "can inertia ",
    "load mass ",
    "load inertia ",
    "rate of ",
    "mass of ",
    "height of ",
)
"""Beginnings of errors that name a quantity which follows from what came."""
NOT_ASKED = {"initial_axis", "replace", "plot", "to_csv", "to_dataframe", "video"}
"""Methods with arguments, or which draw or write: they are called by themselves."""


def public() -> Iterator[tuple[str, Callable[..., object]]]:
    """Everything that is called: public names, their class methods, the methods of what they
    return, and `Setting`."""
    for name in mjbeer.__all__:
        thing = getattr(mjbeer, name)
        # `fit` alone makes a Fit, and `simulate` a Run.
        if not (inspect.isclass(thing) and issubclass(thing, (Exception, mjbeer.Fit, mjbeer.Run))):
            yield name, thing
        if inspect.isclass(thing):
            yield from methods(name, thing, thing)
    for instance in (frozen(), mjbeer.standing(), MOTION, RUN):
        kind = type(instance)
        yield from methods(f"{kind.__name__}()", kind, instance)
    yield "Setting", Setting


def methods(name: str, kind: type, owner: object) -> Iterator[tuple[str, Callable[..., object]]]:
    """The public methods of an instance, or the class methods of a class."""
    for method in public_names(kind):
        static = inspect.getattr_static(kind, method)
        of_an_instance = inspect.isfunction(static) and owner is not kind
        if of_an_instance or isinstance(static, classmethod):
            yield f"{name}.{method}", getattr(owner, method)


def public_names(kind: type) -> list[str]:
    return [name for name in dir(kind) if not name.startswith("_")]


def parameters(function: Callable[..., object]) -> list[inspect.Parameter]:
    """Those that have a name in a call."""
    several = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)
    every = inspect.signature(function).parameters.values()
    return [parameter for parameter in every if parameter.kind not in several]


class Case(NamedTuple):
    """A parameter that gets all values."""

    name: str
    function: Callable[..., object]
    parameter: str


CASES = [
    Case(name, function, parameter.name)
    for name, function in public()
    for parameter in parameters(function)
]
CASES.append(Case("sweep", mjbeer.sweep, "fill"))


def good(case: Case) -> dict[str, Any]:
    """Good arguments for the parameters without a default."""
    arguments = {}
    for parameter in parameters(case.function):
        name = parameter.name
        if parameter.default is not parameter.empty:
            continue
        if name in FRESH:
            arguments[name] = FRESH[name]()
        else:
            arguments[name] = (GOOD | GOOD_HERE.get(case.name, {}))[name]
    return arguments


def use(result: object) -> None:
    """Ask a result for all that it knows; it may be an error of mjbeer's, and a number must be
    one."""
    if not isinstance(result, (Scene, Trajectory)):
        return
    for name in public_names(type(result)):
        if name in NOT_ASKED:
            continue
        try:
            value = getattr(result, name)
            if name == "period":
                value = value(0.1)
            elif callable(value):
                value = value()
        except MjbeerError:
            continue
        if isinstance(value, (float, np.ndarray)):
            assert not np.isnan(value).any(), name


def named(value: object) -> set[str]:
    """Texts by which an error may show a value: it, its number of entries, or an entry, as it came
    or as a double."""
    entries = [value]
    if isinstance(value, (list, tuple, range)) or np.ndim(value) > 0:
        entries = list(value)
    texts = {format_value(value), f" {len(entries)}, got ", f"got {len(entries)}"}
    if isinstance(value, pathlib.PurePath):
        texts.add(format_value(str(value)))
    for entry in entries:
        texts.add(format_value(entry))
        with contextlib.suppress(ParameterError):
            texts.add(format_value(require.number("entry", entry)))
    return texts


@pytest.fixture(autouse=True)
def undrawn(monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    """Draw and encode nothing, and write where nothing is."""

    def one_picture(*_: object, **__: object) -> Iterator[np.ndarray]:
        yield np.zeros((2, 2, 3), np.uint8)

    monkeypatch.setattr(film, "_pictures", one_picture)
    monkeypatch.setattr(video, "_mediapy", lambda: contextlib.nullcontext(mock.MagicMock()))
    monkeypatch.chdir(tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.name}, {case.parameter}")
def test_a_result_or_an_error_that_says_what_came(case: Case) -> None:
    for label, make in VALUES.items():
        value = make()
        arguments = good(case) | {case.parameter: value}
        try:
            use(case.function(**arguments))
        except MjbeerError as error:
            message = str(error)
            assert "\n" not in message, label
            assert len(message) < 500, label
            if isinstance(error, ParameterError) and not message.startswith(COMPUTED):
                assert any(text in message for text in named(value)), f"{label}: {message}"
        except Exception as error:
            pytest.fail(f"{label}: {error!r}")


def decades(lowest: float, highest: float) -> st.SearchStrategy[float]:
    """Magnitudes evenly over their decades, and both ends of them."""
    inside = st.floats(math.log10(lowest), math.log10(highest)).map(lambda exponent: 10.0**exponent)
    return st.one_of(inside, st.sampled_from([lowest, highest]))


def either_sign(highest: float) -> st.SearchStrategy[float]:
    return st.tuples(st.sampled_from([-1.0, 1.0]), decades(1e-20, highest)).map(math.prod)


RATIO = decades(*require.RATIO)
INERTIA = st.one_of(st.just(0.0), decades(1e-12, require.LARGEST_INERTIA))
ANGLES = st.one_of(st.sampled_from([0.0, 1.0, math.pi]), either_sign(require.ANGLE))
RATES = st.one_of(st.just(0.0), either_sign(require.RATE))


@st.composite
def extreme(draw: st.DrawFn) -> Scene:
    """Any scene in the domain, drawn until there is one."""
    radius = draw(decades(*require.SIZE))
    mass = draw(decades(*require.MASS))
    can_mass = draw(st.one_of(st.just(0.0), RATIO)) * mass
    offset = draw(st.one_of(st.floats(0, 1), st.just(1.0), decades(1e-14, 1))) * radius
    can_inertia = draw(INERTIA) * can_mass * radius**2
    load_inertia = draw(INERTIA) * mass * radius**2
    incline = draw(st.one_of(st.floats(*require.INCLINE), st.sampled_from([0.0, -1e-9, 1e-40])))
    gravity = draw(st.one_of(st.just(0.0), decades(*require.GRAVITY)))
    attachment = draw(st.sampled_from(ATTACHMENTS))
    try:
        can = Can(radius, radius, can_mass, can_inertia)
        load = Load(mass, offset, load_inertia)
        return Scene(can, load, incline, attachment, gravity)
    except ParameterError:
        reject()


SEARCH = settings(
    max_examples=70, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck)
)


@pytest.mark.slow
@SEARCH
@given(extreme(), ANGLES, RATES, decades(1e-6, 1e6))
def test_exact_theory_answers_or_refuses(
    scene: Scene, phi0: float, phi_dot0: float, end: float
) -> None:
    """Whatever the sizes: no overflow, no warning, no NaN, and no memory that runs out."""
    use(scene)
    with contextlib.suppress(MjbeerError):
        use(exact(scene, [0.0, end / 3, end], phi0, phi_dot0))


@pytest.mark.slow
@SEARCH
@given(
    scene=extreme(),
    start=st.tuples(ANGLES, RATES),
    rolling=st.sampled_from(ROLLINGS),
    integrator=st.sampled_from((*MUJOCO_INTEGRATORS, *MJBEER_INTEGRATORS)),
    timestep=decades(*require.TIMESTEP),
    friction=decades(1e-5, 1e5),
)
def test_a_simulation_answers_or_refuses(
    scene: Scene,
    start: tuple[float, float],
    rolling: Rolling,
    integrator: Integrator,
    timestep: float,
    friction: float,
) -> None:
    """A few steps of whatever size, of whatever scene: no warning, no NaN, and no fault of MuJoCo's
    that gets out."""
    duration = 5 * timestep
    with contextlib.suppress(MjbeerError):
        use(simulate(scene, duration, *start, rolling, integrator, timestep, friction=friction))
