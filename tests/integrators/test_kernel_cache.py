"""Compiled kernels are kept by all files that their code comes from, and nobody else's are kept
with them."""

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
CALLEE = """
from mjbeer.integrators.compiling import kernel

@kernel
def scaled(term):
    return 2 * term
"""
CALLER = """
from mjbeer.integrators.compiling import kernel
from mjbeer.integrators.callee import scaled

@kernel
def add(total, term):
    return total + scaled(term)
"""
ADD = """
from mjbeer.simulation.caller import add
print(add(1.0, 3.0), *add.stats.cache_hits.values())
"""


@pytest.fixture
def package(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """A copy of the package with two more kernels, of which one calls that of another file."""
    copied = tmp_path / "mjbeer"
    shutil.copytree(PACKAGE, copied, ignore=shutil.ignore_patterns("__pycache__"))
    (copied / "integrators" / "callee.py").write_text(CALLEE)
    (copied / "simulation" / "caller.py").write_text(CALLER)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setenv("MJBEER_MJCF", str(setting.mjcf_folder()))
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    return copied


def in_a_new_process(code: str) -> str:
    command = [sys.executable, "-c", code]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


# Three processes that import numba, and the tests below find its likely causes.
@pytest.mark.costly
def test_a_change_in_the_file_of_a_callee_takes_effect(package: pathlib.Path) -> None:
    assert in_a_new_process(ADD) == "7.0"
    assert in_a_new_process(ADD) == "7.0 1", "the kernel was not loaded from the cache"
    (package / "integrators" / "callee.py").write_text(CALLEE.replace("2 * term", "10 * term"))
    assert in_a_new_process(ADD) == "31.0"


def test_folders_of_other_sources_go_when_they_are_not_used_any_more(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = tmp_path / "callee.py"
    monkeypatch.setattr(kernel_cache, "SOURCES", (source,))
    monkeypatch.setattr(kernel_cache, "_numba_folder", lambda: tmp_path / "kept")

    def begin_a_process() -> pathlib.Path:
        """Do what every process does with the folder when it begins."""
        folder = kernel_cache._folder()
        monkeypatch.setattr(kernel_cache, "FOLDER", folder)
        kernel_cache._tidy()
        return folder

    source.write_text(CALLEE)
    first = begin_a_process()
    source.write_text(f"{CALLEE}\n")
    second = begin_a_process()
    assert second != first
    assert first.exists(), "a process that has begun before the change may still write there"

    days_ago = time.time() - 3 * 24 * 3600
    for folder in (first, second):
        os.utime(folder, (days_ago, days_ago))
    assert begin_a_process() == second

    assert second.exists()
    assert not first.exists()


def compiled_functions() -> dict[str, Dispatcher]:
    """All functions that numba compiles in files that import `compiling`, by file and name."""
    functions = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        if "from mjbeer.integrators.compiling import" in path.read_text():
            file = path.relative_to(PACKAGE).with_suffix("")
            module = importlib.import_module(".".join(("mjbeer", *file.parts)))
            for name, value in vars(module).items():
                if isinstance(value, Dispatcher) and value.py_func.__module__ == module.__name__:
                    functions[f"{file}.{name}"] = value
    return functions


def test_all_that_is_compiled_and_what_it_takes_from_other_files_is_in_the_hash() -> None:
    """Functions and constants."""
    taken = set()
    for function in compiled_functions().values():
        path = pathlib.Path(function.py_func.__code__.co_filename)
        taken.add(path)
        names = set(function.py_func.__code__.co_names)
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and names & {alias.name for alias in node.names}:
                source = importlib.import_module(str(node.module))
                taken.add(pathlib.Path(str(source.__file__)))
    assert PACKAGE / "integrators" / "gauss_jackson" / "weights.py" in taken
    assert PACKAGE / "model" / "mujoco_library.py" in taken
    ours = {path for path in taken if path.is_relative_to(PACKAGE)}
    assert ours <= set(kernel_cache.SOURCES)


def test_every_kernel_is_kept_there_and_no_function_of_a_user() -> None:
    kept = {}
    for name, function in compiled_functions().items():
        if function.stats.cache_path is not None:
            kept[name] = pathlib.Path(function.stats.cache_path)
    for integrator in ("integrators/dop853", "integrators/gauss_jackson"):
        assert any(name.startswith(integrator) for name in kept)
    for name, folder in kept.items():
        assert folder.is_relative_to(kernel_cache.FOLDER), name
    assert os.environ.get("NUMBA_CACHE_DIR", "") == config.CACHE_DIR
    users = njit(cache=True)(in_a_new_process).stats.cache_path
    assert not pathlib.Path(users).is_relative_to(kernel_cache.FOLDER)
