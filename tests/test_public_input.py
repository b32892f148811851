"""Public functions return a result, or raise an error of mjbeer's that says what came.

Every parameter of everything public gets every value below, while the other arguments are good.
"""

import contextlib
import inspect
import math
import pathlib
from collections.abc import Callable, Iterator
from typing import Any
from unittest import mock

import mujoco
import numpy as np
import pytest
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st

import mjbeer
from mjbeer import Can, Load, MjbeerError, Scene, Trajectory, build, exact, frozen, require, simulate
from mjbeer.drawing import film, video
from mjbeer.exceptions import ParameterError
from mjbeer.model.export import export
from mjbeer.model.setting import MJBEER_INTEGRATORS, MUJOCO_INTEGRATORS, ROLLINGS, Setting
from mjbeer.require import format_value
from mjbeer.theory.scene import ATTACHMENTS

VALUES: dict[str, Callable[[], object]] = {
    "None": lambda: None, "text": lambda: "0.5", "long text": lambda: "x" * 300 + ".npz", "True": lambda: True,
    "complex": lambda: 1 + 2j, "nan": lambda: math.nan, "inf": lambda: math.inf, "huge": lambda: 1e160,
    "-1": lambda: -1, "0": lambda: 0, "0.3": lambda: 0.3, "single precision": lambda: np.float32(0.3),
    "number in an array": lambda: np.array(0.5), "list": lambda: [0.1, 0.2], "empty list": list,
    "list of lists": lambda: [[0.0, 0.1]], "list with None": lambda: [0.0, None], "list of texts": lambda: ["0", "0.1"],
    "list with NaN": lambda: [0.0, math.nan], "list from the future": lambda: [0.0, 1e160],
    "list in reverse": lambda: [0.2, 0.1], "list before the start": lambda: [-0.1, 0.1], "dict": lambda: {0.0: 0.1},
    "object": object, "function": lambda: frozen, "array": lambda: np.array([0.0, 0.1]),
    "two-dimensional array": lambda: np.zeros((2, 2)), "complex array": lambda: np.array([0.0, 1j]),
    "can": Can, "load": lambda: Load(0.2, 0.01, 1e-5), "scene": frozen, "path": lambda: pathlib.Path("somewhere"),
}  # fmt: skip
MOTION = exact(frozen(), np.linspace(0, 0.1, 11), 1.0)
RUN = simulate(frozen(), 0.01, 1.0)
MODEL = build(frozen())
TABLE = pathlib.Path(__file__).parents[1] / "examples" / "synthetic_track.csv"
ROLLED = exact(mjbeer.sliding(), np.linspace(0, 0.5, 30), 0.0)
GOOD: dict[str, Any] = {
    **{name: getattr(MOTION, name) for name in inspect.signature(Trajectory).parameters},
    **{"can": Can(), "load": Load(0.2, 0.01, 1e-5), "mass": 0.2, "offset": 0.01, "amplitude": 0.3, "omega": 1.0},
    **{"phi0": 1.0, "phi_dot0": 10.0, "duration": 0.01, "trajectory": MOTION, "path": "can.mp4", "make": frozen},
}
"""Good arguments, by the names of the parameters."""
GOOD_HERE: dict[str, dict[str, Any]] = {
    "Track": {"time": ROLLED.time, "along": ROLLED.u}, "read_track": {"path": TABLE},
    "fit": {"track": mjbeer.Track(ROLLED.time, ROLLED.u), "scene": mjbeer.sliding()},
    "Standing": {"can": Can.sheet_metal(), "fill": 0.5, "name": "beer", "density": 1e3, "viscosity": 1e-6},
    "frame": {"time": 0.1}, "export": {"path": "can.xml"},
    "reset": {"model": MODEL, "data": mujoco.MjData(MODEL)}, "attach": {"can": mjbeer.standing()},
    "refill": {"model": build(mjbeer.standing()), "can": mjbeer.standing()},
}  # fmt: skip
"""Those that are others in one function."""
FRESH = {"parent": mujoco.MjSpec}
"""Those that are changed by what gets them."""
COMPUTED = ("can mass ", "can inertia ", "load mass ", "load inertia ", "rate of ", "mass of ", "height of ")
"""Beginnings of errors that name a quantity which follows from what came."""
NOT_ASKED = ("initial_axis", "replace", "plot", "to_csv", "to_dataframe", "video")
"""Methods with arguments, or which draw or write: they are called by themselves."""


def public() -> Iterator[tuple[str, Callable[..., object]]]:
    """Everything that is called: public names, their class methods, the methods of what they return, and some more."""
    for name in mjbeer.__all__:
        thing = getattr(mjbeer, name)
        # `fit` alone makes a Fit, and `simulate` a Run.
        if not (inspect.isclass(thing) and issubclass(thing, (Exception, mjbeer.Fit, mjbeer.Run))):
            yield name, thing
        if inspect.isclass(thing):
            yield from methods(name, thing, thing)
    for name, instance in (
        ("Scene()", frozen()),
        ("Standing()", mjbeer.standing()),
        ("Trajectory()", MOTION),
        ("Run()", RUN),
    ):
        yield from methods(name, type(instance), instance)
    for more in (Setting, export):
        yield more.__name__, more


def methods(name: str, kind: type, owner: object) -> Iterator[tuple[str, Callable[..., object]]]:
    """The public methods of an instance, or the class methods of a class."""
    for each in dir(kind):
        static = inspect.getattr_static(kind, each)
        if not each.startswith("_") and (
            isinstance(static, classmethod) or (inspect.isfunction(static) and owner is not kind)
        ):
            yield f"{name}.{each}", getattr(owner, each)


CASES = {
    f"{name}, {parameter}": (name, function, parameter)
    for name, function in public()
    for parameter, each in inspect.signature(function).parameters.items()
    if each.kind not in (each.VAR_KEYWORD, each.VAR_POSITIONAL)
} | {"sweep, fill": ("sweep", mjbeer.sweep, "fill")}


def good(name: str, function: Callable[..., object]) -> dict[str, Any]:
    """Good arguments for the parameters without a default."""
    parameters = inspect.signature(function).parameters.values()
    several = inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL
    needed = [each.name for each in parameters if each.default is each.empty and each.kind not in several]
    return {each: FRESH[each]() if each in FRESH else (GOOD | GOOD_HERE.get(name, {}))[each] for each in needed}


def use(result: object) -> None:
    """Ask a result for all that it knows; it may be an error of mjbeer's, and a number must be one."""
    if isinstance(result, (Scene, Trajectory)):
        for name in (each for each in dir(type(result)) if not each.startswith("_") and each not in NOT_ASKED):
            try:
                value = getattr(result, name)
                value = value(*([0.1] if name == "period" else [])) if callable(value) else value
            except MjbeerError:
                continue
            assert not (isinstance(value, float) and math.isnan(value)), name
            assert not (isinstance(value, np.ndarray) and np.isnan(value).any()), name


def named(value: object) -> set[str]:
    """Texts by which an error may show a value: it, its number of entries, or an entry, as it came or as a double."""
    several = isinstance(value, (list, tuple, range)) or (isinstance(value, np.ndarray) and value.ndim > 0)
    entries = list(value) if several else [value]
    texts = {format_value(value), f" {len(entries)}, got ", f"got {len(entries)}"} | {
        format_value(each) for each in entries
    }
    texts |= {format_value(str(value))} if isinstance(value, pathlib.PurePath) else set()
    for each in entries:
        with contextlib.suppress(ParameterError):
            texts.add(format_value(require.number("entry", each)))
    return texts


@pytest.fixture(autouse=True)
def undrawn(monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    """Draw and encode nothing, and write where nothing is."""
    monkeypatch.setattr(film, "_pictures", lambda *_, **__: (np.zeros((2, 2, 3), np.uint8) for _ in range(1)))
    monkeypatch.setattr(video, "_mediapy", lambda: contextlib.nullcontext(mock.MagicMock()))
    monkeypatch.chdir(tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_a_result_or_an_error_that_says_what_came(case: str) -> None:
    name, function, parameter = CASES[case]
    for label, make in VALUES.items():
        value = make()
        try:
            use(function(**(good(name, function) | {parameter: value})))
        except MjbeerError as error:
            said = str(error)
            assert "\n" not in said, label
            assert len(said) < 500, label
            if isinstance(error, ParameterError) and not said.startswith(COMPUTED):
                assert any(text in said for text in named(value)), f"{label}: {said}"
        except Exception as error:
            pytest.fail(f"{label}: {error!r}")


def decades(lowest: float, highest: float) -> st.SearchStrategy[float]:
    """Magnitudes evenly over their decades, and both ends of them."""
    inside = st.floats(math.log10(lowest), math.log10(highest)).map(lambda exponent: 10.0**exponent)
    return st.one_of(inside, st.sampled_from([lowest, highest]))


def either_sign(highest: float) -> st.SearchStrategy[float]:
    return st.tuples(st.sampled_from([-1.0, 1.0]), decades(1e-20, highest)).map(math.prod)


RATIO = decades(*require.RATIO)
ANGLES = st.one_of(st.sampled_from([0.0, 1.0, math.pi]), either_sign(require.ANGLE))
RATES = st.one_of(st.just(0.0), either_sign(require.RATE))


@st.composite
def extreme(draw: st.DrawFn) -> Scene:
    """Any scene in the domain, drawn until there is one."""
    radius, mass = draw(decades(*require.SIZE)), draw(decades(*require.MASS))
    can_mass = draw(st.one_of(st.just(0.0), RATIO)) * mass
    offset = draw(st.one_of(st.floats(0, 1), st.just(1.0), decades(1e-14, 1))) * radius
    inertias = [draw(st.one_of(st.just(0.0), decades(1e-12, require.LARGEST_INERTIA))) * radius**2 for _ in range(2)]
    try:
        can, load = Can(radius, radius, can_mass, can_mass * inertias[0]), Load(mass, offset, mass * inertias[1])
        incline = draw(st.one_of(st.floats(*require.INCLINE), st.sampled_from([0.0, -1e-9, 1e-40])))
        gravity = draw(st.one_of(st.just(0.0), decades(*require.GRAVITY)))
        return Scene(can, load, incline, draw(st.sampled_from(ATTACHMENTS)), gravity)
    except ParameterError:
        reject()


SEARCH = settings(max_examples=100, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


@pytest.mark.slow
@SEARCH
@given(extreme(), ANGLES, RATES, decades(1e-6, 1e6))
def test_exact_theory_answers_or_refuses(scene: Scene, phi0: float, phi_dot0: float, end: float) -> None:
    """Whatever the sizes: no overflow, no warning, no NaN, and no memory that runs out."""
    use(scene)
    with contextlib.suppress(MjbeerError):
        use(exact(scene, [0.0, end / 3, end], phi0, phi_dot0))


@pytest.mark.slow
@SEARCH
@given(extreme(), st.tuples(ANGLES, RATES), decades(*require.TIMESTEP), decades(1e-5, 1e5), st.data())
def test_a_simulation_answers_or_refuses(
    scene: Scene, start: tuple[float, float], timestep: float, friction: float, data: st.DataObject
) -> None:
    """A few steps of whatever size, of whatever scene: no warning, no NaN, and no fault of MuJoCo's that gets out."""
    how = data.draw(st.sampled_from(ROLLINGS)), data.draw(st.sampled_from((*MUJOCO_INTEGRATORS, *MJBEER_INTEGRATORS)))
    with contextlib.suppress(MjbeerError):
        use(simulate(scene, 5 * timestep, *start, *how, timestep, friction=friction))
