"""What is installed along with mjbeer: what it imports and no more."""

import ast
import pathlib
import sys
import tomllib
from collections.abc import Iterator

import pytest
from packaging.requirements import Requirement

import mjbeer

CHECKOUT = pathlib.Path(__file__).parents[1]
PACKAGE = pathlib.Path(mjbeer.__file__).parent
PEERS = PACKAGE / "studies" / "benchmark" / "other_tools.py"
PROJECT = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]
ALWAYS = {Requirement(text).name for text in PROJECT["dependencies"]}
EXTRAS = {
    extra: {Requirement(text).name for text in texts} for extra, texts in PROJECT["optional-dependencies"].items()
}
OPTIONAL = set().union(*EXTRAS.values())
INSTALLED_AS = {
    **{"PIL": "pillow", "imageio_ffmpeg": "imageio-ffmpeg", "OpenGL": "pyopengl"},
    **{"llvmlite": "numba", "cycler": "matplotlib"},
}
"""Packages that are imported under another name, and two that are not declared since they only go with what is."""


def imported(*modules: pathlib.Path) -> Iterator[str]:
    """What modules import, anywhere, that is neither Python's nor mjbeer's; as it is installed."""
    for path in modules:
        for node in ast.walk(ast.parse(path.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            packages = {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"mjbeer"}
            yield from (INSTALLED_AS.get(package, package) for package in packages)


@pytest.mark.slow
def test_what_is_imported_is_declared_and_what_is_declared_is_imported() -> None:
    assert set(imported(*PACKAGE.rglob("*.py"))) == ALWAYS | OPTIONAL


def test_the_packages_that_the_project_was_asked_for_are_always_installed_and_used() -> None:
    asked = {"mujoco", "numpy", "scipy", "mediapy"}
    assert asked <= ALWAYS
    assert asked <= set(imported(*PACKAGE.rglob("*.py")))


def test_a_film_alone_takes_mediapy() -> None:
    """It loads IPython and all of matplotlib, half a second that nothing else should take."""
    users = [path for path in PACKAGE.rglob("*.py") if "mediapy" in imported(path)]
    assert users == [PACKAGE / "drawing" / "video.py"]


def test_the_peers_are_optional() -> None:
    assert not ALWAYS & OPTIONAL
    assert set(imported(PEERS)) - ALWAYS == EXTRAS["peers"]
