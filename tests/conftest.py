"""The environment of whoever runs the tests must not change what programs write, and when; and a fixture of several."""

import os
import pathlib
import shutil

import pytest

from mjbeer.model import templates

for each in ("FORCE_COLOR", "CLICOLOR_FORCE", "COLUMNS", "PYTHONUNBUFFERED"):
    os.environ.pop(each, None)


@pytest.fixture
def copy(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """A copy of the templates in the place of the templates."""
    folder = tmp_path / "mjcf"
    shutil.copytree(templates.folder(), folder)
    monkeypatch.setattr(templates, "_FOLDERS", (folder,))
    return folder
