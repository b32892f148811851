"""The map of damped cans: MuJoCo carries a load over the top beyond theory's border, and not before."""

import math

import numpy as np
import pytest

from mjbeer.studies.sweep import damped_map
from mjbeer.theory.can import Can
from mjbeer.theory.named import frozen

pytestmark = pytest.mark.slow
DAMPING = 3e-3
ASIDE = math.radians(0.2)
"""Four times the error of the border."""


def test_mujoco_turns_the_load_over_beyond_the_border_of_theory() -> None:
    """The border is between those of a frozen load: where it rolls over if let go so, and where it has no rest."""
    border = damped_map.border(DAMPING)
    beside = np.array([border - ASIDE, border + ASIDE])
    assert damped_map.turned(np.array([DAMPING]), beside).tolist() == [[False, True]]
    assert border < frozen(can=Can.sheet_metal()).largest_incline()
    held = frozen(border, can=Can.sheet_metal())
    assert not held.separatrix()[0] < -border < held.separatrix()[1]
