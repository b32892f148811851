"""The theory needs neither a simulator nor a compiler."""

import pathlib
import subprocess
import sys

import pytest

import mjbeer

PACKAGE = pathlib.Path(mjbeer.__file__).parent
THEORY = [
    ".".join(("mjbeer", *path.relative_to(PACKAGE).with_suffix("").parts))
    for folder in ("theory", "predictions", "paper/equations")
    for path in sorted((PACKAGE / folder).glob("*.py"))
    if path.stem != "__init__"
]
IMPORTS = "; ".join(f"import {module}" for module in (*THEORY, "mjbeer.paper.letters", "mjbeer.paper.audit.claim"))
USE = "import mjbeer; assert mjbeer.exact(mjbeer.frozen(), [0.0, 1.0], 0.5).trusted; mjbeer.sliding().period(1.0)"
LOADED = "import sys; print(sorted({'mujoco', 'numba', 'llvmlite', 'mediapy', 'OpenGL'} & set(sys.modules)))"


@pytest.mark.parametrize(
    "code",
    [
        "import mjbeer",
        "; ".join(f"import {module}" for module in (*THEORY, "mjbeer.paper.letters", "mjbeer.paper.audit.claim")),
        USE,
    ],
)
def test_theory_imports_no_simulator(code: str) -> None:
    ran = subprocess.run([sys.executable, "-c", f"{code}; {LOADED}"], capture_output=True, text=True, check=False)
    assert (ran.stdout.strip(), ran.stderr) == ("[]", "")


def test_unknown_names_are_attribute_errors() -> None:
    with pytest.raises(AttributeError, match="module 'mjbeer' has no attribute 'Bottle'"):
        _ = mjbeer.Bottle
