"""The environment of whoever runs the tests must not change what programs write, and when; and a
fixture of several.

What the machine lacks is skipped, and counted; with MJBEER_EVERYTHING in the environment, it ends
the tests instead, and any warning is an error but those that `pyproject.toml` lets pass.
"""

import functools
import gc
import os
import pathlib
import shutil

import pytest

from mjbeer.drawing import opengl
from mjbeer.model import setting

for variable in (
    "FORCE_COLOR",
    "CLICOLOR_FORCE",
    "COLUMNS",
    "PYTHONUNBUFFERED",
    "PYTHONDONTWRITEBYTECODE",
):
    os.environ.pop(variable, None)

# Nothing of what is imported and collected, a million objects, is rubbish, and to look through it
# again and again takes a tenth of all the time.
gc.disable()

_no_opengl = functools.cache(opengl.problem)
"""Asked once a process, before any test makes OpenGL fail."""


def pytest_configure(config: pytest.Config) -> None:
    """If everything is to be there, take warnings for errors, and end the tests with a list of what
    is not there."""
    if not os.environ.get("MJBEER_EVERYTHING"):
        return
    # Below the others, of which the last that fits decides.
    config.getini("filterwarnings").insert(0, "error")
    if not hasattr(config, "workerinput"):  # and not once more in each worker
        from mjbeer.studies.benchmark.other_tools import absent

        lacking = [f"{name} is absent: {reason}" for name, reason in absent().items()]
        lacking += [reason for reason in (_no_opengl(),) if reason]
        if lacking:
            raise pytest.UsageError(
                "MJBEER_EVERYTHING is set, and not all is here:\n" + "\n".join(lacking)
            )


def pytest_collection_finish() -> None:
    """Look from now on for the rubbish of the tests."""
    gc.freeze()
    gc.enable()


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a test that draws where nothing can be drawn."""
    if item.get_closest_marker("draws") and _no_opengl():
        pytest.skip(f"no OpenGL; this brings it to Debian and Ubuntu: {opengl.INSTALL}")


@pytest.fixture
def copy(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """A copy of the MJCF, which is read instead."""
    folder = tmp_path / "mjcf"
    shutil.copytree(setting.mjcf_folder(), folder)
    monkeypatch.setenv("MJBEER_MJCF", str(folder))
    return folder
