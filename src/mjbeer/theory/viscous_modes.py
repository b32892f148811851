"""Small motions about steady rolling: three modes exp(s t), the roots of a cubic.

With P = m b cos(phi), k = m g b cos(alpha + phi), N = M I - P^2 and J_f = M a^2 + I - 2 P a at the tilt phi, the slopes
c of the damping and d of the drag at the terminal speed, and M = m + m_can + I_can/a^2,

    N s^3 + (c J_f/a^2 + d I) s^2 + (M k + c d) s + k (c/a^2 + d) = 0.

For c to 0 the swing is that of a sliding load, for c to infinity that of a frozen one, each at this tilt.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from mjbeer.exceptions import ParameterError
from mjbeer.theory.crest import root
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.steady_rolling import steady_rolling

if TYPE_CHECKING:
    from mjbeer.theory.scene import Scene


def modes(scene: "Scene") -> np.ndarray:
    """Return the three roots s [1/s], sorted by their real and then their imaginary parts.

    Raises:
      DissipationError: if the scene has neither damping nor drag.
      NoEquilibriumError: if it has no steady rolling.
      ParameterError: if the roots are beyond double precision.
    """
    steady, can, load = steady_rolling(scene), scene.can, scene.load
    mass, moment = scene.mass + can.inertia / can.radius**2, load.mass * load.offset * math.cos(steady.tilt)
    inertia, k = load.inertia + load.mass * load.offset**2, steady.stiffness
    damping = float(scene.damping_law.slope(steady.slip))
    drag = 2 * scene.drag * abs(steady.speed)
    swinging = mass * float(scene.oscillator.inertia(steady.tilt))  # N, without a difference
    frozen = Oscillator.frozen(can=can, load=load, incline=scene.incline, gravity=scene.gravity)
    along = damping / can.radius**2
    square = (float(frozen.inertia(steady.tilt)) * along + inertia * drag) / swinging
    scale = math.sqrt(mass * k / swinging) or square or 1.0
    square /= scale
    linear = (mass * k + damping * drag) / swinging / scale**2
    constant = k * (along + drag) / swinging / scale**3
    # A B - C of s^3 + A s^2 + B s + C, by M J_f - N = (M a - P)^2 and M I - N = P^2 a sum in which nothing cancels.
    excess = k * along * (mass * can.radius - moment) ** 2 / swinging / swinging / scale**3
    excess += k * drag * moment**2 / swinging / swinging / scale**3 + damping * drag / swinging * square / scale**2
    if not all(math.isfinite(each) for each in (square**2, linear, constant, excess * square)):
        raise ParameterError(f"the modes of this scene are beyond double precision: {scene!r}")
    return np.sort_complex(scale * _roots(square, linear, constant, excess))


def _roots(square: float, linear: float, constant: float, excess: float) -> np.ndarray:
    """Return the roots of s^3 + A s^2 + B s + C with none negative, and with A B - C = `excess` given to all digits.

    The sum of the two slow roots, -pair, obeys pair^3 - 2 A pair^2 + (A^2 + B) pair = A B - C. It keeps its digits,
    which those of the coefficients would hide where the decay is slow.
    """

    def gap(pair: float) -> float:
        return ((pair - 2 * square) * pair + square**2 + linear) * pair - excess

    bend = square**2 - 3 * linear  # where positive, the cubic has a largest value before its last root
    highest = (2 * square - math.sqrt(bend)) / 3 if bend > 0 else square
    end = highest if gap(highest) >= 0 else square
    unit = excess / (square**2 + linear) if excess > 0 else 1.0  # the root's size where it is small
    pair = unit * root(lambda share: gap(unit * share), 0.0, end / unit) if excess > 0 else 0.0
    single = pair - square
    if -single < square / 16:  # a small difference: the root of pair s^2 + B s + C next to it has its digits
        both = linear + math.sqrt(max(linear**2 - 4 * pair * constant, 0.0))
        if both > 0:
            single = min(-2 * constant / both, -both / (2 * pair), key=lambda root: abs(root - (pair - square)))
    product = -constant / single if single else linear
    half, spread = pair / 2, pair**2 / 4 - product
    if spread < 0:
        swing = complex(-half, math.sqrt(-spread))
        return np.array([single, swing, swing.conjugate()])
    fast = -(half + math.sqrt(spread))
    return np.array([single, fast, product / fast if fast else 0.0], complex)
