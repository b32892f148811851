"""Models whose constraint is as hard as one says, in MuJoCo's own terms."""

from collections.abc import Sequence

import mujoco

from mjbeer.model.build import specify
from mjbeer.simulation.simulate import Make
from mjbeer.theory.scene import Scene


def constrained(
    scene: Scene,
    rolling: str,
    solref: Sequence[float] | None = None,
    impedance: float | None = None,
    impratio: float | None = None,
    refsafe: bool = False,
    friction: float = 1.0,
) -> Make:
    """Makes models as MJCF has them, and keeps what is not given as `build` tunes it.

    `solref` is (time constant [s], damping ratio), or (-stiffness [1/s^2], -damping [1/s]); `impedance` stands for
    both of solimp's; `impratio` is the hardness of friction over that of the normal force; `refsafe` has MuJoCo raise
    a time constant to two timesteps.
    """

    def make(integrator: str, timestep: float) -> mujoco.MjModel:
        spec = specify(scene, rolling, integrator=integrator, timestep=timestep, friction=friction)
        row = spec.equality("rolling") if rolling == "equality" else spec.pair("rolling")
        if solref is not None:
            row.solref = list(solref)
        if impedance is not None:
            row.solimp = [impedance, impedance, *row.solimp[2:]]
        if impratio is not None:
            spec.option.impratio = impratio
        if refsafe:
            spec.option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
        return spec.compile()

    return make
