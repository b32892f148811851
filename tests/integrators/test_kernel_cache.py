"""Compiled kernels are kept by all files that their code comes from, and nobody else's are kept with them."""

import ast
import importlib
import os
import pathlib
import shutil
import subprocess
import sys
import time

import pytest
from numba import config, njit
from numba.core.dispatcher import Dispatcher

import mjbeer
from mjbeer.integrators import kernel_cache
from mjbeer.model import setting

pytestmark = pytest.mark.slow

PACKAGE = pathlib.Path(mjbeer.__file__).parent
KERNEL = """
from mjbeer.integrators.dynamics import compiled
from mjbeer.integrators.uneven_time import kahan_add

@compiled
def add(first, second):
    return kahan_add((first, 0.0), second)[0]
"""
ADD = "from mjbeer.simulation.kernel import add; print(add(1.0, 2.0), *add.stats.cache_hits.values())"


@pytest.fixture
def package(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """A copy of the package with one more kernel, which calls a function of another file."""
    copied = tmp_path / "mjbeer"
    shutil.copytree(PACKAGE, copied, ignore=shutil.ignore_patterns("__pycache__"))
    (copied / "simulation" / "kernel.py").write_text(KERNEL)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setenv("MJBEER_MJCF", str(setting.mjcf_folder()))
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    return copied


def in_a_new_process(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()


def change(path: pathlib.Path, old: str, new: str) -> None:
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))


def test_a_change_in_the_file_of_a_callee_takes_effect(package: pathlib.Path) -> None:
    assert in_a_new_process(ADD) == "3.0"
    assert in_a_new_process(ADD) == "3.0 1", "the kernel was not loaded from the cache"
    change(package / "integrators" / "uneven_time.py", "new = total[0] + term\n", "new = total[0] + 10 * term\n")
    assert in_a_new_process(ADD) == "21.0"


def test_folders_of_other_sources_go_when_they_are_not_used_any_more(package: pathlib.Path) -> None:
    where = "from mjbeer.integrators.kernel_cache import FOLDER; print(FOLDER)"
    first = pathlib.Path(in_a_new_process(where))
    assert first.is_relative_to(package)
    change(package / "integrators" / "uneven_time.py", "LAG = 2\n", "LAG = 3\n")
    second = pathlib.Path(in_a_new_process(where))
    assert second != first
    assert first.exists(), "a process that has begun before the change may still write there"
    days_ago = time.time() - 3 * 24 * 3600
    for folder in (first, second):
        os.utime(folder, (days_ago, days_ago))
    assert pathlib.Path(in_a_new_process(where)) == second
    assert second.exists()
    assert not first.exists()


def kernels() -> list[tuple[pathlib.Path, str, Dispatcher]]:
    """All compiled functions, each with its file and its name."""
    found = []
    for path in (*PACKAGE.glob("integrators/*.py"), PACKAGE / "simulation" / "smooth_recorder.py"):
        module = importlib.import_module(".".join(("mjbeer", *path.relative_to(PACKAGE).with_suffix("").parts)))
        for name, value in vars(module).items():
            if isinstance(value, Dispatcher) and value.py_func.__module__ == module.__name__:
                found.append((path, name, value))
    return found


def test_what_kernels_take_from_other_files_is_in_the_hash() -> None:
    """Functions that are compiled into them, and constants."""
    taken = set()
    for path, _, kernel in kernels():
        names = set(kernel.py_func.__code__.co_names)
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("mjbeer."):
                module = importlib.import_module(str(node.module))
                if any(alias.name in names for alias in node.names):
                    taken.add(pathlib.Path(str(module.__file__)))
    assert PACKAGE / "integrators" / "uneven_time.py" in taken
    assert taken <= set(kernel_cache.SOURCES)


def test_every_kernel_is_kept_there_and_no_function_of_a_user() -> None:
    kept = {f"{path.stem}.{name}": kernel.stats.cache_path for path, name, kernel in kernels()}
    in_a_folder = {name: pathlib.Path(folder) for name, folder in kept.items() if folder is not None}
    assert set(in_a_folder) == {"dop853._advance", "gauss_jackson._advance", "smooth_recorder._update"}
    assert all(folder.is_relative_to(kernel_cache.FOLDER) for folder in in_a_folder.values())
    assert os.environ.get("NUMBA_CACHE_DIR", "") == config.CACHE_DIR
    own = njit(cache=True)(in_a_new_process).stats.cache_path
    assert not pathlib.Path(own).is_relative_to(kernel_cache.FOLDER)
