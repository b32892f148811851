"""heyoka: Taylor's method of any order, compiled for the very equations (https://github.com/bluescarni/heyoka.py).

A tool for one system of equations and no general engine, and so the one to be beaten by. A tolerance is compiled in:
set-up takes up to a third of a second each time, a run then less than a third of a millisecond.
"""

from collections.abc import Generator
from contextlib import contextmanager

import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.studies.benchmark.peers import equations
from mjbeer.studies.benchmark.peers.peer import Integrate, Motion, Peer, decades
from mjbeer.theory.scene import Scene

_MOST_STEPS = 1_000_000  # a run of seconds takes hundreds; without a limit it may go on for ever


def _set_up(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Integrate:
    import heyoka

    start = np.array(equations.start(scene, phi0, phi_dot0))
    grid = times.tolist()  # which heyoka takes in faster than an array
    variables = heyoka.make_vars(*(f"x{index}" for index in range(len(start))))
    rates = equations.right_hand_side(scene, heyoka.sin, heyoka.cos)(0.0, variables)
    with _uncached():
        integrator = heyoka.taylor_adaptive(
            list(zip(variables, rates, strict=True)), start.tolist(), tol=knob, compact_mode=False
        )

    def integrate() -> Motion:
        integrator.time = 0.0
        integrator.state[:] = start
        outcome, _, _, _, _, states = integrator.propagate_grid(grid, max_steps=_MOST_STEPS)
        if outcome != heyoka.taylor_outcome.time_limit:
            raise DivergenceError(f"heyoka: {outcome} at {integrator.time:g} s")
        return equations.coordinates(scene, states)

    return integrate


@contextmanager
def _uncached() -> Generator[None]:
    """Compile anew: heyoka keeps compiled code, also on disk, and set-up would cost what was compiled before it."""
    from heyoka import llvm_state

    before = llvm_state.get_diskcache_enabled()
    llvm_state.set_diskcache_enabled(False)
    llvm_state.clear_memcache()
    try:
        yield
    finally:
        llvm_state.set_diskcache_enabled(before)


PEER = Peer("heyoka", "tolerance", "", decades(3, 16), _set_up)
