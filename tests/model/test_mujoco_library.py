"""What is set in the loaded library, and restored."""

import ctypes

import mujoco

from mjbeer.model.mujoco_library import library, quiet


def test_the_clock_is_off_while_it_is_quiet() -> None:
    """Also after an MjData is made, and until the outer one of two blocks ends."""
    clock = ctypes.c_void_p.in_dll(library(), "mjcb_time")
    installed = clock.value
    assert installed is not None
    with quiet():
        with quiet():
            assert clock.value is None
        mujoco.MjData(mujoco.MjModel.from_xml_string("<mujoco/>"))
        assert clock.value is None
    assert clock.value == installed
