"""What is loaded and installed: `import mjbeer` is light, theory needs no simulator, and all
imports are declared."""

import ast
import functools
import pathlib
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import packages_distributions

import pytest
from packaging.requirements import Requirement

import mjbeer

pytestmark = pytest.mark.slow

PACKAGE = pathlib.Path(mjbeer.__file__).parent
MODULES = set(PACKAGE.rglob("*.py"))
THEORY = [
    f"mjbeer.theory.{path.stem}"
    for path in (PACKAGE / "theory").glob("*.py")
    if path.stem != "__init__"
]
USE = """
import mjbeer
assert mjbeer.exact(mjbeer.frozen(), [0.0, 1.0], 0.5).trusted
mjbeer.sliding().period(1.0)
"""
COMPILER = {"numba", "llvmlite"}
PEERS = PACKAGE / "studies" / "benchmark" / "other_tools.py"
PYPROJECT = pathlib.Path(__file__).parents[1] / "pyproject.toml"
PROJECT = tomllib.loads(PYPROJECT.read_text())["project"]
ALWAYS = {Requirement(text).name for text in PROJECT["dependencies"]}
EXTRAS = PROJECT["optional-dependencies"].values()
OPTIONAL = {Requirement(text).name for extra in EXTRAS for text in extra}
INSTALLED_AS = {
    "PIL": "pillow",
    "imageio_ffmpeg": "imageio-ffmpeg",
    "OpenGL": "pyopengl",
    "llvmlite": "numba",
    "cycler": "matplotlib",
}
"""Packages that are imported under another name, and two that are not declared since they only go
with what is."""


TAKEN_BY_NUMPY = {"charset_normalizer"}
"""What NumPy imports if it happens to be installed."""


@functools.cache
def installed() -> set[str]:
    """What can be imported from other packages; they are many, and finding them takes a while."""
    return set(packages_distributions()) - {"mjbeer"}


def loaded(code: str) -> set[str]:
    """Which of the installed packages `code` loads in a new process; mjbeer is left out."""
    program = f"""
import sys
started = {{*sys.modules}}
{code}
print(*{{*sys.modules}} - started)
"""
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ran.stderr == ""
    return set(ran.stdout.split()) & installed()


def test_importing_the_package_loads_numpy_alone() -> None:
    assert loaded("import mjbeer") == {"numpy"}


@pytest.mark.parametrize("code", [f"import {', '.join(THEORY)}, mjbeer.paper.claim", USE])
def test_theory_needs_numpy_and_scipy_alone(code: str) -> None:
    assert loaded(code) - TAKEN_BY_NUMPY <= {"numpy", "scipy"}


def test_a_file_of_numbers_needs_no_plots(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "run.csv"
    found = loaded(f"{USE}\nmjbeer.exact(mjbeer.frozen(), [0.0], 0.5).to_csv({str(path)!r})")
    assert found.isdisjoint({"mujoco", "matplotlib", "OpenGL", "pandas", "rich"} | COMPILER)
    assert path.read_text().startswith("time [s],u [m],")


def test_the_integrators_of_mujoco_need_no_compiler() -> None:
    found = loaded("import mjbeer; mjbeer.simulate(mjbeer.sliding(), 1.0, 0.1).warnings")
    assert found.isdisjoint(COMPILER)


def test_the_names_of_the_package_are_the_public_ones() -> None:
    """Before any of them is loaded; and each can be."""
    code = "import mjbeer; print(sorted(dir(mjbeer)) == sorted(mjbeer.__all__))"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout == "True\n"
    assert all(getattr(mjbeer, name) is not None for name in mjbeer.__all__)


def test_the_package_runs_as_a_module() -> None:
    command = [
        sys.executable,
        "-m",
        "mjbeer",
        "simulate",
        "frozen",
        "--duration",
        "0.1",
        "--output",
        "-",
    ]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    assert ran.stdout.startswith("time [s],")


def imported(*modules: pathlib.Path) -> Iterator[str]:
    """What modules import, anywhere, that is neither Python's nor mjbeer's; as it is installed."""
    for path in modules:
        for node in ast.walk(ast.parse(path.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            packages = (
                {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"mjbeer"}
            )
            yield from (INSTALLED_AS.get(package, package) for package in packages)


def test_what_is_imported_is_declared_and_what_is_declared_is_imported() -> None:
    """The other tools of the benchmark are optional; what the project was asked for is always
    used."""
    assert {"mujoco", "numpy", "scipy", "mediapy"} <= set(imported(*MODULES - {PEERS})) == ALWAYS
    assert set(imported(PEERS)) - ALWAYS == OPTIONAL
