"""`import mjbeer` is light, theory needs neither a simulator nor a compiler, and the package runs as a module."""

import functools
import pathlib
import subprocess
import sys
from importlib.metadata import packages_distributions

import pytest

import mjbeer

pytestmark = pytest.mark.slow

PACKAGE = pathlib.Path(mjbeer.__file__).parent
THEORY = [
    ".".join(("mjbeer", *path.relative_to(PACKAGE).with_suffix("").parts))
    for folder in ("theory", "predictions")
    for path in sorted((PACKAGE / folder).glob("*.py"))
    if path.stem != "__init__"
]
IMPORTS = "; ".join(f"import {module}" for module in (*THEORY, "mjbeer.paper.claim"))
USE = "import mjbeer; assert mjbeer.exact(mjbeer.frozen(), [0.0, 1.0], 0.5).trusted; mjbeer.sliding().period(1.0)"
COMPILER = {"numba", "llvmlite"}
HEAVY = {"mujoco", *COMPILER, "matplotlib", "OpenGL"}
"""What takes most of the time to import: the simulator, the compiler, and what draws."""


@functools.cache
def installed() -> set[str]:
    """The packages that are installed but mjbeer."""
    return set(packages_distributions()) - {"mjbeer"}


def loaded(code: str) -> set[str]:
    """Which of the installed packages `code` loads in a new process; mjbeer is left out."""
    program = f"import sys; started = {{*sys.modules}}; {code}; print(*{{*sys.modules}} - started)"
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ran.stderr == ""
    return set(ran.stdout.split()) & installed()


def test_importing_the_package_loads_numpy_alone() -> None:
    assert loaded("import mjbeer") == {"numpy"}


@pytest.mark.parametrize("code", [IMPORTS, USE])
def test_theory_needs_numpy_and_scipy_alone(code: str) -> None:
    assert loaded(code) <= {"numpy", "scipy"}


def test_a_file_of_numbers_needs_no_plots(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "run.csv"
    found = loaded(f"{USE}; mjbeer.exact(mjbeer.frozen(), [0.0], 0.5).to_csv({str(path)!r})")
    assert found.isdisjoint(HEAVY | {"pandas", "rich"})
    assert path.read_text().startswith("time [s],u [m],")


def test_the_integrators_of_mujoco_need_no_compiler() -> None:
    assert loaded("import mjbeer; mjbeer.simulate(mjbeer.sliding(), 1.0, 0.1).warnings").isdisjoint(COMPILER)


def test_the_names_of_the_package_are_the_public_ones() -> None:
    """Before any of them is loaded; and each can be."""
    code = "import mjbeer; print(sorted(dir(mjbeer)) == sorted(mjbeer.__all__))"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout == "True\n"
    assert all(getattr(mjbeer, name) is not None for name in mjbeer.__all__)
    with pytest.raises(AttributeError, match="module 'mjbeer' has no attribute 'Bottle'"):
        _ = mjbeer.Bottle


def test_the_package_runs_as_a_module() -> None:
    command = [sys.executable, "-m", "mjbeer", "simulate", "frozen", "--duration", "0.1", "--output", "-"]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    assert ran.stdout.startswith("time [s],")
