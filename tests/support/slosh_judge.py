"""A liquid as several pendulums on the axis of a rolling can: what one mode of it leaves out.

The model is plain MuJoCo, of no template of mjbeer's. The can rolls on level ground: its body
slides along x, with an armature for its turning. The radius of the can is 1, and its gravity is
such that times are those of a can of 33 mm.

`python -m tests.support.slosh_judge` prints the table of the six fills and two cans.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np
from scipy import linalg

from mjbeer import Can, Load, Scene, simulate
from mjbeer.simulation.run import Run
from mjbeer.theory import slosh
from tests.support.scenes import METAL

FILLS = (0.05, 0.1, 0.25, 0.5, 0.75, 0.9)
CANS = {"massless": Can(), "metal": METAL}
GRAVITY = 9.81
PENDULUMS = 8
MASS = 1e6
"""Mass of the liquid: MuJoCo moves no body with a smaller inertia than 1e-15."""
BOB_SHARE = 0.01
"""Share of a pendulum's inertia that its bob has about itself, as MuJoCo moves no point.

The bob is heavier by as much and nearer to the axis, so that the motion stays the pendulum's."""
AMPLITUDE = 1e-4
"""Tilt at the start [rad]. With ten times as much, a shallow liquid in a massless can is so far
from linear that its swing is late by 3e-3 of a radian after two seconds."""
TIMESTEP = 5e-4
DURATION = 2.0


@dataclass(frozen=True)
class Judge:
    """A can with the first modes of a liquid as pendulums."""

    can: Can
    fill: float

    @cached_property
    def ratio(self) -> float:
        """M_e/m, the effective mass of can and liquid divided by the mass of the liquid."""
        mass = Load.segment(self.can.radius, self.can.length, self.fill).mass
        return 1 + self.can.effective_mass / mass

    @cached_property
    def gravity(self) -> float:
        """Gravity where the radius is 1 [1/s^2]."""
        return GRAVITY / self.can.radius

    @cached_property
    def lengths(self) -> np.ndarray:
        """Lengths of the pendulums."""
        return slosh.held(self.fill).lengths[:PENDULUMS]

    @cached_property
    def masses(self) -> np.ndarray:
        """Masses of the pendulums."""
        return MASS * slosh.held(self.fill).masses[:PENDULUMS]

    @property
    def moments(self) -> np.ndarray:
        """Mass times length of each pendulum."""
        return self.masses * self.lengths

    def matrix_modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Lengths and energy shares of the pendulums on the rolling axis, without MuJoCo.

        Without u, and with sqrt(m_n L_n) times the angles as coordinates, the matrix of the lengths
        is diag(L_n) - r r^T/M_e, where r_n = sqrt(m_n L_n). The potential energy is g/2 times the
        square of the coordinates, and r are those of a flat tilt.
        """
        roots = np.sqrt(self.moments)
        coupling = np.outer(roots, roots) / (self.ratio * MASS)
        lengths, vectors = np.linalg.eigh(np.diag(self.lengths) - coupling)
        shares = (roots @ vectors) ** 2 / self.moments.sum()
        return lengths[::-1], shares[::-1]

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The model: a slide along x, and on it a hinge for each pendulum."""
        spec = mujoco.MjSpec()
        spec.option.gravity = [0, 0, -self.gravity]
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
        spec.option.timestep = TIMESTEP
        bobs = self.masses / (1 - BOB_SHARE)
        # The liquid that does not swing, and the effective mass of all that does not.
        still = MASS - bobs.sum()
        moving = self.ratio * MASS - bobs.sum()
        axis = spec.worldbody.add_body(mass=still, inertia=[still] * 3)
        axis.explicitinertial = True
        slide = axis.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
        slide.armature = moving - still
        spins = BOB_SHARE * self.masses * self.lengths**2
        for mode in range(PENDULUMS):
            body = axis.add_body(mass=bobs[mode], inertia=[spins[mode]] * 3)
            body.ipos = [0, 0, -self.lengths[mode] * (1 - BOB_SHARE)]
            body.explicitinertial = True
            body.add_joint(axis=[0, 1, 0])
        return spec.compile()

    def mujoco_lengths(self) -> np.ndarray:
        """g/omega^2 of the small motions by MuJoCo's own inertias and torques."""
        data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, data)
        inertia = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, data, inertia)
        stiffness = np.zeros_like(inertia)
        # A central difference errs by the angle's square divided by 6, rounding by 1e-16/angle.
        angle = 1e-5
        for dof in range(self.model.nv):
            for sign in (1, -1):
                data.qpos[:] = 0
                data.qpos[dof] = sign * angle
                mujoco.mj_forward(self.model, data)
                stiffness[:, dof] += sign * data.qfrc_bias / (2 * angle)
        # The masses differ by many orders of magnitude.
        scale = 1 / np.sqrt(np.diag(inertia))
        inertia *= np.outer(scale, scale)
        stiffness *= np.outer(scale, scale)
        squares = linalg.eigh((stiffness + stiffness.T) / 2, inertia, eigvals_only=True)
        # The first is 0: the can rolls away.
        return self.gravity / squares[1:]

    def let_go(self, duration: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times, mean tilt and position of the axis after a flat tilt by `AMPLITUDE` at rest.

        The mean tilt weighs the pendulums by their moments: b times it is how far the liquid's
        centre of mass is from below the axis.
        """
        steps = round(duration / TIMESTEP)
        data = mujoco.MjData(self.model)
        data.qpos[1:] = AMPLITUDE
        positions = np.empty((steps + 1, self.model.nq))
        for step in range(steps):
            positions[step] = data.qpos
            mujoco.mj_step(self.model, data)
        positions[steps] = data.qpos
        tilt = positions[:, 1:] @ self.moments / self.moments.sum()
        return TIMESTEP * np.arange(steps + 1), tilt, positions[:, 0]

    def lump(self, duration: float) -> Run:
        """The run of mjbeer's load that stands for the liquid, at the same times."""
        scene = Scene(self.can, Load.liquid(self.can, self.fill), 0.0, gravity=GRAVITY)
        return simulate(scene, duration, phi0=AMPLITUDE, timestep=TIMESTEP)


def row(name: str, fill: float) -> str:
    """A row of the table: one can, one fill."""
    judge = Judge(CANS[name], fill)
    exact = slosh.rolling(fill, judge.ratio)
    lengths, shares = judge.matrix_modes()
    frequencies = np.sqrt(judge.gravity / lengths)
    by_mujoco = np.sqrt(judge.gravity / judge.mujoco_lengths())
    most = int(np.argmax(shares))
    _, tilt, _ = judge.let_go(DURATION)
    left_out = (judge.lump(DURATION).phi - tilt) / AMPLITUDE
    cells = (
        f"{fill:.2f}",
        name,
        f"{frequencies[0]:.2f}",
        f"{shares[0]:.4f}",
        f"{most + 1}: {frequencies[most]:.2f}, {shares[most]:.4f}",
        f"{np.sqrt(np.mean(left_out**2)):.4f}",
        f"{np.abs(left_out).max():.4f}",
        f"{np.abs(by_mujoco / frequencies - 1).max():.1e}",
        f"{frequencies[0] * math.sqrt(exact.lengths[0] / judge.gravity) - 1:.1e}",
    )
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    for table_can in CANS:
        for table_fill in FILLS:
            print(row(table_can, table_fill))
