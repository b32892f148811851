"""heyoka: Taylor's method, compiled for the equations of one scene (https://github.com/bluescarni/heyoka.py).

Its code is specific to these equations, where MuJoCo is a general engine: of all tools it is the one expected to be
faster. The tolerance is compiled in: set-up takes up to a third of a second for each, and a run then less than a third
of a millisecond.
"""

from collections.abc import Generator
from contextlib import contextmanager

import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.studies.benchmark.peers import equations
from mjbeer.studies.benchmark.peers.peer import Integrate, Motion, Peer, decades
from mjbeer.theory.scene import Scene

_MOST_STEPS = 1_000_000  # a run over seconds takes hundreds; without a limit it may never end


def _set_up(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Integrate:
    import heyoka

    start = np.array(equations.start(scene, phi0, phi_dot0))
    grid = times.tolist()  # heyoka reads a list faster than an array
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
    """Turn off heyoka's caches of compiled code, so that the time of set-up does not depend on what ran before."""
    from heyoka import llvm_state

    before = llvm_state.get_diskcache_enabled()
    llvm_state.set_diskcache_enabled(False)
    llvm_state.clear_memcache()
    try:
        yield
    finally:
        llvm_state.set_diskcache_enabled(before)


PEER = Peer(name="heyoka", tolerances=decades(3, 16), set_up=_set_up)
