"""Stand-ins for what takes long: a validation table of made-up rows, and videos that are not drawn."""

import inspect
import pathlib
from collections.abc import Callable
from typing import Any

import pytest

from mjbeer import output, validation, video
from mjbeer.exceptions import RenderingError
from mjbeer.row import Row


def validate(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the validation table one of rows with a quantity and an error each, and the bound 1e-3."""
    rows = [Row(name, "a stub", 1e-3, "rad", "none", lambda error=error: error) for name, error in errors.items()]
    monkeypatch.setattr(validation, "rows", lambda: rows)


def draw(monkeypatch: pytest.MonkeyPatch, fail_at: str = "") -> list[dict[str, Any]]:
    """Make videos and pictures text files, and the one of a name fail; the arguments of all calls so far."""
    calls: list[dict[str, Any]] = []

    def stub(name: str, real: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(real)

        def instead(*args: object, **kwargs: object) -> None:
            call = signature.bind(*args, **kwargs).arguments
            call["path"] = pathlib.Path(call["path"])
            if call["path"].name == fail_at:
                raise RenderingError(f"cannot draw {fail_at}")
            output.write(call["path"], name)
            calls.append({"function": name, **call})

        return instead

    for name in ("render", "save_frame"):
        monkeypatch.setattr(video, name, stub(name, getattr(video, name)))
    return calls
