"""The folders are as `docs/architecture.md` says, and theory needs neither a simulator nor a compiler."""

import ast
import functools
import pathlib
import re
import subprocess
import sys
from importlib.metadata import packages_distributions

import pytest

import mjbeer

pytestmark = pytest.mark.slow

PACKAGE = pathlib.Path(mjbeer.__file__).parent
DOCUMENT = (pathlib.Path(__file__).parents[1] / "docs" / "architecture.md").read_text()
FOLDERS = sorted(path.name for path in PACKAGE.iterdir() if path.is_dir() and any(path.glob("*.py")))
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


@pytest.mark.costly
def test_the_packages_that_theory_must_not_load_are_seen_where_they_are_loaded() -> None:
    """Without this, a misspelt name or a blind test would pass those above."""
    assert loaded("import mjbeer.simulation.tolerance, matplotlib, OpenGL") >= HEAVY


def imported(folder: str) -> set[str]:
    """The other folders and modules of mjbeer that the modules of a folder import anything from."""
    names = set()
    for path in (PACKAGE / folder).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module == "mjbeer":
                names |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and (module := node.module or "").startswith("mjbeer."):
                names.add(module.split(".")[1])
    return names - {folder}


def test_the_document_has_the_folders_and_what_they_import() -> None:
    rows = re.findall(r"^\| `(\w+)/` \| .* \| (.*) \|$", DOCUMENT, re.MULTILINE)
    assert sorted(folder for folder, _ in rows) == FOLDERS
    for folder, named in rows:
        documented = set(named.replace("nothing", "").replace(",", " ").split())
        assert documented == imported(folder) - {"require", "checks", "exceptions"}, folder  # all may import these


LAYERS = (
    "exceptions, require, output, theory, predictions model, integrators, drawing simulation, paper, studies, "
    "report, cli"
)
"""The folders and modules from below; what has no comma between it stands side by side."""
LOADERS = {"import_module", "__import__", "find_spec", "resolve_name"}
"""What imports a module by a text, which no linter follows."""


def loaded_by_text(path: pathlib.Path) -> set[str]:
    """The modules of mjbeer that a file names in a text, if it imports anything by a text."""
    tree = ast.parse(path.read_text())
    words = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    words |= {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    if not words & LOADERS:
        return set()
    texts = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    return {text for text in texts if re.fullmatch(r"mjbeer(\.\w+)+", text)}


def test_nothing_is_imported_upward_by_a_text() -> None:
    """Only `mjbeer` itself, above all, loads by name what it promises."""
    height = {name: level for level, names in enumerate(LAYERS.split(", ")) for name in names.split()}
    assert loaded_by_text(PACKAGE / "__init__.py") >= {"mjbeer.drawing.views", "mjbeer.simulation.simulate"}
    for path in sorted(PACKAGE.rglob("*.py")):
        if path.parent == PACKAGE and path.stem.startswith("__"):
            continue
        own = path.relative_to(PACKAGE).with_suffix("").parts[0]
        for module in loaded_by_text(path):
            assert height.get(module.split(".")[1], 0) <= height[own], f"{path} loads {module}"


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
