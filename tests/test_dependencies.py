"""What is installed along with mjbeer: what it imports and no more, and no more of the disk than the README says."""

import ast
import pathlib
import re
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import distribution

from packaging.requirements import Requirement

import mjbeer

CHECKOUT = pathlib.Path(__file__).parents[1]
PACKAGE = pathlib.Path(mjbeer.__file__).parent
PEERS = PACKAGE / "studies" / "benchmark" / "peers"
PROJECT = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]
ALWAYS = {Requirement(text).name for text in PROJECT["dependencies"]}
EXTRAS = {
    extra: {Requirement(text).name for text in texts} for extra, texts in PROJECT["optional-dependencies"].items()
}
OPTIONAL = set().union(*EXTRAS.values())
INSTALLED_AS = {"PIL": "pillow", "imageio_ffmpeg": "imageio-ffmpeg", "llvmlite": "numba", "cycler": "matplotlib"}
"""Packages that are imported under another name, and two that are not declared since they only go with what is."""
BLOCK = 4096
"""Size of the blocks in which file systems usually allot the disk [bytes]."""
ROUNDING = 0.05
"""The README gives the size to a tenth of a gigabyte; from this much more on, it is wrong [GB]."""


def imported(folder: pathlib.Path) -> Iterator[str]:
    """What the modules in a folder import, anywhere, that is neither Python's nor mjbeer's; as it is installed."""
    for path in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            packages = {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"mjbeer"}
            yield from (INSTALLED_AS.get(package, package) for package in packages)


def add(name: str, sizes: dict[str, int]) -> None:
    """Add the disk [bytes] that a distribution takes, and that of all it requires, to `sizes`; extras are left out."""
    if name in sizes:
        return
    here = distribution(name)
    paths = [pathlib.Path(str(file.locate())) for file in here.files or []]
    sizes[name] = sum(-(-path.stat().st_size // BLOCK) * BLOCK for path in paths if path.is_file())
    for requirement in map(Requirement, here.requires or []):
        if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
            add(requirement.name.lower(), sizes)


def test_what_is_imported_is_declared_and_what_is_declared_is_imported() -> None:
    assert set(imported(PACKAGE)) == ALWAYS | OPTIONAL


def test_the_peers_are_optional() -> None:
    assert not ALWAYS & OPTIONAL
    assert set(imported(PEERS)) - ALWAYS == EXTRAS["peers"]


def test_all_that_is_installed_takes_the_disk_that_the_readme_says() -> None:
    """A dependency that adds more than the rounding has to be worth a new number in the README."""
    stated = re.search(r"takes (\d\.\d) GB\s+of\s+disk", (CHECKOUT / "README.md").read_text())
    sizes: dict[str, int] = {}
    for name in ALWAYS:
        add(name, sizes)
    assert {"llvmlite", "ipython", "mujoco-core"} <= set(sizes)  # which the packages that are declared bring along
    assert stated
    assert sum(sizes.values()) / 1e9 < float(stated[1]) + ROUNDING, sorted(sizes.items(), key=lambda item: -item[1])
