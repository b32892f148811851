"""Rows of the audit: the half cylinder (7)-(9), the can's metal and the circular segment (30)-(38)."""

import math
from collections.abc import Callable, Iterator

import mujoco
import numpy as np

from mjbeer.model.build import build
from mjbeer.paper.audit.claim import Claim, confirmed, corrected
from mjbeer.paper.equations import segment as equations
from mjbeer.paper.letters import Terms
from mjbeer.theory.can import ALUMINIUM, LENGTH, RADIUS, THICKNESS, Can
from mjbeer.theory.load import BEER, Load
from mjbeer.theory.scene import sliding
from mjbeer.theory.segment import Segment, segment

FILLS = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)
"""Fills at which the formulas of section 3 are compared with quadrature, on both sides of a half-full can."""
_QUADRATURE, _SHELL = "segment quadrature", "MuJoCo's shell of a cylinder"
_BOUND, _REASON = 1e-13, "rounding; the closed forms cancel at small fills"


def claims() -> Iterator[Claim]:
    """The rows."""
    yield from _half()
    yield from _metal()
    yield from _segment()
    yield from _figures()


def _half() -> Iterator[Claim]:
    half = segment(0.5)
    yield confirmed(
        "(7)", "b/a of a half cylinder", _QUADRATURE, lambda: (equations.eq_7(), -half.offset), _BOUND, _REASON
    )
    yield confirmed(
        "(8)", "I_axis/(m a^2) of a half cylinder", _QUADRATURE, lambda: (0.5, -half.inertia, -(half.offset**2)),
        _BOUND, _REASON,
    )  # fmt: skip
    yield confirmed(
        "(9)",
        "I_cm/(m a^2) of a half cylinder",
        _QUADRATURE,
        lambda: (equations.eq_9(), -half.inertia),
        _BOUND,
        _REASON,
    )
    yield confirmed(
        "(9)", "I_cm = 0.32 m a^2", _QUADRATURE, lambda: (0.32, -half.inertia), 1.6e-2, "half a unit of the last digit"
    )


def _metal() -> Iterator[Claim]:
    sizes = RADIUS, LENGTH, THICKNESS, ALUMINIUM
    yield confirmed("(30)", "m_can", _SHELL, lambda: (equations.eq_30(*sizes), -_shell()[0]), _BOUND, "rounding")
    yield confirmed("(31)", "I_can", _SHELL, lambda: (equations.eq_31(*sizes), -_shell()[1]), _BOUND, "rounding")
    yield confirmed(
        "(31)", "I_can/(m_can a^2)", _SHELL,
        lambda: (equations.ratio_31(RADIUS, LENGTH), -_shell()[1] / (_shell()[0] * RADIUS**2)), _BOUND, "rounding",
    )  # fmt: skip
    yield confirmed(
        "(31)", "I_can = 0.89 m_can a^2", _SHELL, lambda: (0.89, -_shell()[1] / (_shell()[0] * RADIUS**2)), 5.6e-3,
        "half a unit of the last digit",
    )  # fmt: skip


def _segment() -> Iterator[Claim]:
    yield confirmed(
        "(32)", "h/a", "chord of a circle", lambda: (_all(lambda each: equations.eq_32(each.half_angle)), _chord()),
        _BOUND, _REASON,
    )  # fmt: skip
    yield confirmed(
        "(34)", "mass of the beer", _QUADRATURE, lambda: (_all(_mass), -np.array([_filled(fill) for fill in FILLS])),
        _BOUND, _REASON,
    )  # fmt: skip
    for equation, quantity, form, seen in (
        ("(33)", "area, middle form", lambda beta: equations.eq_33(beta)[0], _area),
        ("(33)", "area, last form", lambda beta: equations.eq_33(beta)[1], _area),
        ("(35)", "b, with A", lambda beta: equations.eq_35(beta)[0], _offset),
        ("(35)", "b, last form", lambda beta: equations.eq_35(beta)[1], _offset),
        ("(36)", "I_axis, second line", equations.integral_36, _axial),
        ("(36)", "I_axis, last form", equations.eq_36, _axial),
        ("(37)", "I_cm", equations.eq_37, _own),
    ):
        yield confirmed(
            equation, quantity, _QUADRATURE, lambda form=form, seen=seen: _compared(form, seen), _BOUND, _REASON
        )
    yield corrected(
        "(36)", "I_axis, third line: sin(2 beta) sin^2(beta)/4; printed /8", _QUADRATURE,
        lambda: _compared(lambda beta: equations.middle_36(beta, 8), _axial),
        lambda: _compared(equations.middle_36, _axial), 0.23, _BOUND, _REASON,
    )  # fmt: skip
    yield confirmed("(38)", "centre of mass of can and beer", "MuJoCo, subtree_com", _whole, _BOUND, "rounding")


def _figures() -> Iterator[Claim]:
    """What the text says of its two figures, at beta = pi/2 and pi and in between."""
    half, full = segment(0.5), segment(1.0)
    yield confirmed(
        "figure of (36)", "k is 1/2 at beta = pi/2 and at pi", _QUADRATURE,
        lambda: (np.full(2, 0.5), -np.array([_axial(half), _axial(full)])), _BOUND, _REASON,
    )  # fmt: skip
    yield confirmed(
        "figure of (36)", "k is 1 for a film (fill 1e-9)", _QUADRATURE, lambda: (1.0, -_axial(segment(1e-9))), 1e-8,
        "the film's height",
    )  # fmt: skip
    yield confirmed(
        "figure of (36)", "in between k dips, to 0.456 at 115 degrees", _QUADRATURE, lambda: (0.456, -_least()), 2e-3,
        "half a unit of the last digit; the paper gives no number",
    )  # fmt: skip
    own = np.array([_own(segment(float(fill))) for fill in np.linspace(1e-3, 1, 1000)])
    yield confirmed(
        "figure of (37)", "k rises all the way: it is never below what it was", _QUADRATURE,
        lambda: (own, -np.maximum.accumulate(own)), _BOUND, "rounding",
    )  # fmt: skip
    yield confirmed(
        "figure of (37)", "k goes from 0 by 0.32 at beta = pi/2 to 0.5", _QUADRATURE,
        lambda: (np.array([0.0, 0.32, 0.5]), -np.array([_own(segment(fill)) for fill in (1e-9, 0.5, 1.0)])),
        1e-3, "half a unit of the last digit",
    )  # fmt: skip


def _all(value: Callable[[Segment], float]) -> np.ndarray:
    """Of all fills."""
    return np.array([value(segment(fill)) for fill in FILLS])


def _compared(form: Callable[[float], float], seen: Callable[[Segment], float]) -> Terms:
    return _all(lambda each: form(each.half_angle)), -_all(seen)


def _area(shape: Segment) -> float:
    return shape.area


def _offset(shape: Segment) -> float:
    return shape.offset


def _own(shape: Segment) -> float:
    return shape.inertia


def _axial(shape: Segment) -> float:
    return shape.inertia + shape.offset**2


def _mass(shape: Segment) -> float:
    return equations.eq_34(shape.half_angle, RADIUS, LENGTH, BEER)


def _filled(fill: float) -> float:
    return Load.segment(fill=fill).mass


def _chord() -> np.ndarray:
    """-h/a of the chords that are seen from the axis under the angles 2 beta, from half their lengths."""
    sides = _all(lambda each: math.sin(each.half_angle))
    below = np.array([1.0 if fill <= 0.5 else -1.0 for fill in FILLS])
    return below * np.sqrt(1 - sides**2) - 1


def _least() -> float:
    """The least k of eq. (36), over some thousand fills."""
    return min(_axial(segment(float(fill))) for fill in np.linspace(0.5, 0.999, 1000))


def _shell() -> tuple[float, float]:
    """Mass [kg] and axial inertia [kg m^2] that MuJoCo gives a closed cylinder of sheet."""
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="can").add_geom(
        type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[RADIUS, LENGTH / 2, 0], density=THICKNESS * ALUMINIUM,
        typeinertia=mujoco.mjtGeomInertia.mjINERTIA_SHELL,
    )  # fmt: skip
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    can, axes = model.body("can"), data.body("can").ximat.reshape(3, 3)
    return float(can.mass[0]), float((axes @ np.diag(can.inertia) @ axes.T)[2, 2])


def _whole() -> Terms:
    scene = sliding(can=Can.sheet_metal())
    model = build(scene, "equality")
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    d = float(np.linalg.norm(data.subtree_com[model.body("can").id] - data.body("can").xpos))
    return equations.eq_38(scene.load.mass, scene.can.mass, scene.load.offset), -d
