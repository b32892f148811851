"""Every public signature says what goes in and what comes out."""

import functools
import inspect
import re
from collections.abc import Callable, Iterator
from typing import Any, get_args, get_origin

import mjbeer


def public_functions() -> Iterator[tuple[str, Callable[..., object]]]:
    """Every public function and method of mjbeer's own by its name; a class is its constructor."""
    for name in mjbeer.__all__:
        thing = getattr(mjbeer, name)
        if not (inspect.isclass(thing) and issubclass(thing, Exception)):
            yield name, thing
        if inspect.isclass(thing):
            for member_name, member in inspect.getmembers_static(thing):
                function = underlying(member)
                if function and not member_name.startswith("_"):
                    yield f"{name}.{member_name}", function


def underlying(member: object) -> Callable[..., object] | None:
    """The function of a method or a property, or None if it is not mjbeer's."""
    match member:
        case property():
            function = member.fget
        case functools.cached_property():
            function = member.func
        case classmethod() | staticmethod():
            function = member.__func__
        case _:
            function = member
    return function if inspect.isfunction(function) and "mjbeer" in function.__module__ else None


def is_vague(annotation: object) -> bool:
    """Whether a type has `Any` in it, or there is none; what numpy's own types have does not
    count."""
    if isinstance(annotation, str):
        return bool(re.search(r"\bAny\b", annotation))
    if annotation in (Any, inspect.Parameter.empty):
        return True
    if getattr(get_origin(annotation), "__module__", "").startswith("numpy"):
        return False
    return any(map(is_vague, get_args(annotation)))


def vague(function: Callable[..., object]) -> list[str]:
    """The parameters of a function whose types are vague, and "return"."""
    signature = inspect.signature(function)
    found = []
    for name, parameter in signature.parameters.items():
        if name not in ("self", "cls") and is_vague(parameter.annotation):
            found.append(name)
    if inspect.isfunction(function) and is_vague(signature.return_annotation):
        found.append("return")
    return found


def test_a_public_signature_says_its_types() -> None:
    functions = dict(public_functions())
    assert {"simulate", "Can", "Can.hoop", "Run.plot", "Scene.oscillator"} <= set(functions)
    found = {name: vague(function) for name, function in functions.items()}
    assert {name: places for name, places in found.items() if places} == {}


def test_a_vague_type_is_found() -> None:
    def one(first: Any, second: list[Any], third: "dict[str, Any]", fourth: float): ...

    assert vague(one) == ["first", "second", "third", "return"]
