"""The theory needs neither a simulator nor a compiler."""

import subprocess
import sys

import pytest

THEORY = [
    *("can", "cases", "checks", "clock", "conserved", "diagnostics", "equations", "exact", "exceptions", "forces"),
    *("load", "motion", "oscillator", "predictions", "scene", "segment", "trajectory"),
    *("claim", "closed_forms", "quantities", "paper_sliding", "paper_can", "paper_frozen", "paper_hopping"),
    *("paper_pendulum", "paper_segment", "linear_stability", "soft_rows", "small_motions"),
]
USE = "import mjbeer; assert mjbeer.exact(mjbeer.frozen(), [0.0, 1.0], 0.5).trusted; mjbeer.sliding().period(1.0)"
LOADED = "import sys; print(sorted({'mujoco', 'numba', 'llvmlite', 'mediapy', 'OpenGL'} & set(sys.modules)))"


@pytest.mark.parametrize("code", ["import mjbeer", "; ".join(f"import mjbeer.{each}" for each in THEORY), USE])
def test_theory_imports_no_simulator(code: str) -> None:
    ran = subprocess.run([sys.executable, "-c", f"{code}; {LOADED}"], capture_output=True, text=True, check=False)
    assert (ran.stdout.strip(), ran.stderr) == ("[]", "")


def test_unknown_names_are_attribute_errors() -> None:
    import mjbeer

    with pytest.raises(AttributeError, match="module 'mjbeer' has no attribute 'Bottle'"):
        _ = mjbeer.Bottle
