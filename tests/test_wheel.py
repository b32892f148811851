"""The built wheel, installed away from the checkout: all there, and it simulates."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from email import message_from_string
from email.message import Message

import numpy as np
import pytest

from hatch_build import long_description
from mjbeer import frozen, hoop, pendulum, simulate, sliding
from mjbeer.theory.trajectory import csv

pytestmark = pytest.mark.costly

CHECKOUT = pathlib.Path(__file__).parents[1]
README = (CHECKOUT / "README.md").read_text()
SOURCES = (
    "pyproject.toml", "hatch_build.py", "Makefile", "README.md", "LICENSE", "src", "examples", "mjcf", "docs",
    "renders",
)  # fmt: skip
TARGET = re.compile(r"\]\(([^)]*)\)")
"""Where a link leads, or a picture comes from."""
SCENES = {"sliding": sliding(), "frozen": frozen(), "pendulum": pendulum(), "hoop": hoop()}
SIMULATE = """
import json, pathlib, sys
import mjbeer
from mjbeer.model.setting import mjcf_folder
package = pathlib.Path(mjbeer.__file__).parent
assert package == pathlib.Path(sys.argv[1]) / "mjbeer", package
assert mjcf_folder() == package / "mjcf", mjcf_folder()
found = {}
for name in ("sliding", "frozen", "pendulum", "hoop"):
    scene = getattr(mjbeer, name)()
    assert mjbeer.build(scene, visuals=True).nmesh > 0
    found[name] = mjbeer.simulate(scene, 0.1, 1.0).phi.tolist()
loaded = [pathlib.Path(each.__file__) for name, each in sys.modules.items() if name.startswith("mjbeer")]
assert all(each.is_relative_to(package) for each in loaded), loaded
print(json.dumps(found))
"""


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """The folder of a wheel and a source distribution of a copy of the checkout, built without a network."""
    copy = tmp_path_factory.mktemp("checkout")
    for name in SOURCES:
        if (CHECKOUT / name).is_dir():
            shutil.copytree(CHECKOUT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(CHECKOUT / name, copy / name)
    command = [sys.executable, "-m", "hatchling", "build", "--directory", "out"]
    subprocess.run(command, cwd=copy, check=True, capture_output=True)
    return copy / "out"


@pytest.fixture(scope="module")
def wheel(built: pathlib.Path) -> pathlib.Path:
    """The wheel."""
    (found,) = built.glob("*.whl")
    return found


@pytest.fixture(scope="module")
def installed(wheel: pathlib.Path, tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A folder with the wheel installed, and nothing else."""
    folder = tmp_path_factory.mktemp("installed")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--quiet", "--no-deps", "--no-index"]
    subprocess.run([*pip, "--no-compile", "--target", str(folder), str(wheel)], check=True, capture_output=True)
    return folder


def run(installed: pathlib.Path, elsewhere: pathlib.Path, *command: str) -> str:
    """Output of a command that finds the installed wheel before the checkout."""
    environment = os.environ | {"PYTHONPATH": str(installed), "PYTHONSAFEPATH": "1"}
    done = subprocess.run(command, cwd=elsewhere, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_wheel_holds_the_package_and_all_templates(wheel: pathlib.Path) -> None:
    """Every file of either, as it is in the checkout."""
    templates = {each.relative_to(CHECKOUT) for each in (CHECKOUT / "mjcf").rglob("*") if each.is_file()}
    source = CHECKOUT / "src"
    package = {each.relative_to(source) for each in (source / "mjbeer").rglob("*") if each.is_file()}
    expected = {f"mjbeer/{each.as_posix()}" for each in templates}
    expected |= {each.as_posix() for each in package if each.parent.name != "__pycache__"}
    assert {each.suffix or each.name for each in templates} == {".xml", ".obj", ".md", ".png", "LICENSE"}
    assert {"mjbeer/py.typed", "mjbeer/studies/benchmark/study.json"} < expected
    assert {name for name in zipfile.ZipFile(wheel).namelist() if name.startswith("mjbeer/")} == expected


def metadata(wheel: pathlib.Path) -> Message:
    """The metadata in a wheel; the payload is the long description."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        return message_from_string(archive.read(name).decode())


def test_the_wheel_has_license_and_entry_point(wheel: pathlib.Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (folder,) = {name.split("/")[0] for name in archive.namelist()} - {"mjbeer"}
        assert archive.read(f"{folder}/licenses/LICENSE") == (CHECKOUT / "LICENSE").read_bytes()
        assert "mjbeer = mjbeer.cli.app:main" in archive.read(f"{folder}/entry_points.txt").decode()
    assert metadata(wheel)["License-Expression"] == "Apache-2.0"


def test_the_long_description_needs_no_checkout(built: pathlib.Path, wheel: pathlib.Path) -> None:
    """Its links lead to the web, or name files of the source distribution; with an address, to the repository."""
    text = str(metadata(wheel).get_payload())
    assert metadata(wheel)["Description-Content-Type"] == "text/markdown"
    assert all(target.startswith(("http://", "https://")) for target in TARGET.findall(text))
    (source,) = built.glob("*.tar.gz")
    with tarfile.open(source) as archive:
        inside = {name.partition("/")[2] for name in archive.getnames()}
    named = re.findall(r"\[`([^`]*)`\]", text)
    assert set(named) == {target for target in TARGET.findall(README) if "://" not in target}
    assert {"Makefile", *named} <= inside
    linked = long_description(
        "![A can](renders/can.png)\n[how](docs/how.md) [MuJoCo](https://mujoco.org)", "https://a.b/c"
    )
    assert linked.splitlines() == [
        "![A can](https://a.b/c/raw/HEAD/renders/can.png)",
        "[how](https://a.b/c/blob/HEAD/docs/how.md) [MuJoCo](https://mujoco.org)",
    ]


def test_the_installed_wheel_builds_and_simulates(installed: pathlib.Path, tmp_path: pathlib.Path) -> None:
    found = json.loads(run(installed, tmp_path, sys.executable, "-c", SIMULATE, str(installed)))
    for name, scene in SCENES.items():
        assert np.array_equal(found[name], simulate(scene, 0.1, 1.0).phi), name


def test_the_installed_command_runs(installed: pathlib.Path, tmp_path: pathlib.Path) -> None:
    words = ("simulate", "frozen", "--phi0", "0", "--duration", "0.1", "--output", "-")
    assert run(installed, tmp_path, str(installed / "bin" / "mjbeer"), *words) == csv(simulate(frozen(), 0.1, 0.0))
    assert not os.listdir(tmp_path)
