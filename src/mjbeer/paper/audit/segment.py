"""Claims about masses and inertias: the half cylinder (7)-(9), the can's metal and the circular segment (30)-(38)."""

import math
from collections.abc import Callable, Iterator

import mujoco
import numpy as np

from mjbeer.model.build import build
from mjbeer.paper.audit.claim import Claim, confirmed, corrected
from mjbeer.paper.equations import segment as equations
from mjbeer.paper.letters import Terms
from mjbeer.theory.can import ALUMINIUM, LENGTH, RADIUS, THICKNESS, Can
from mjbeer.theory.load import BEER, Load, Segment, segment
from mjbeer.theory.named import sliding

FILLS = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)
"""Fills at which the formulas of section 3 are compared with quadrature, on both sides of a half-full can."""
_QUADRATURE, _SHELL = "segment quadrature", "MuJoCo's shell of a cylinder"
_BOUND, _REASON = 1e-13, "rounding; the closed forms cancel at small fills"
"""Largest error of the formulas in closed form, and its cause."""


def claims() -> Iterator[Claim]:
    """Yield the claims of this chapter."""
    yield from _half_can()
    yield from _sheet_metal()
    yield from _segment()
    yield from _figures()


def _half_can() -> Iterator[Claim]:
    half = segment(0.5)
    yield confirmed(
        "(7)",
        "b/a of a half cylinder",
        witness=_QUADRATURE,
        terms=lambda: (equations.eq_7(), -half.offset),
        bound=_BOUND,
        reason=_REASON,
    )
    yield confirmed(
        "(8)",
        "I_axis/(m a^2) of a half cylinder",
        witness=_QUADRATURE,
        terms=lambda: (0.5, -half.inertia, -(half.offset**2)),
        bound=_BOUND,
        reason=_REASON,
    )
    yield confirmed(
        "(9)",
        "I_cm/(m a^2) of a half cylinder",
        witness=_QUADRATURE,
        terms=lambda: (equations.eq_9(), -half.inertia),
        bound=_BOUND,
        reason=_REASON,
    )
    yield confirmed(
        "(9)",
        "I_cm = 0.32 m a^2",
        witness=_QUADRATURE,
        terms=lambda: (0.32, -half.inertia),
        bound=1.6e-2,
        reason="half a unit of the last digit",
    )


def _sheet_metal() -> Iterator[Claim]:
    sizes = RADIUS, LENGTH, THICKNESS, ALUMINIUM
    yield confirmed(
        "(30)",
        "m_can",
        witness=_SHELL,
        terms=lambda: (equations.eq_30(*sizes), -_shell_of_mujoco()[0]),
        bound=_BOUND,
        reason="rounding",
    )
    yield confirmed(
        "(31)",
        "I_can",
        witness=_SHELL,
        terms=lambda: (equations.eq_31(*sizes), -_shell_of_mujoco()[1]),
        bound=_BOUND,
        reason="rounding",
    )
    yield confirmed(
        "(31)",
        "I_can/(m_can a^2)",
        witness=_SHELL,
        terms=lambda: (
            equations.ratio_31(RADIUS, LENGTH),
            -_shell_of_mujoco()[1] / (_shell_of_mujoco()[0] * RADIUS**2),
        ),
        bound=_BOUND,
        reason="rounding",
    )
    yield confirmed(
        "(31)",
        "I_can = 0.89 m_can a^2",
        witness=_SHELL,
        terms=lambda: (0.89, -_shell_of_mujoco()[1] / (_shell_of_mujoco()[0] * RADIUS**2)),
        bound=5.6e-3,
        reason="half a unit of the last digit",
    )


def _segment() -> Iterator[Claim]:
    yield confirmed(
        "(32)",
        "h/a",
        witness="chord of a circle",
        terms=lambda: (_at_fills(lambda shape: equations.eq_32(shape.half_angle)), _chord()),
        bound=_BOUND,
        reason=_REASON,
    )
    yield confirmed(
        "(34)",
        "mass of the beer",
        witness=_QUADRATURE,
        terms=lambda: (_at_fills(_mass), -np.array([_mass_of_load(fill) for fill in FILLS])),
        bound=_BOUND,
        reason=_REASON,
    )
    for equation, quantity, form, measure in (
        ("(33)", "area, middle form", lambda beta: equations.eq_33(beta)[0], _area),
        ("(33)", "area, last form", lambda beta: equations.eq_33(beta)[1], _area),
        ("(35)", "b, with A", lambda beta: equations.eq_35(beta)[0], _offset),
        ("(35)", "b, last form", lambda beta: equations.eq_35(beta)[1], _offset),
        ("(36)", "I_axis, second line", equations.integral_36, _axial_inertia),
        ("(36)", "I_axis, last form", equations.eq_36, _axial_inertia),
        ("(37)", "I_cm", equations.eq_37, _own_inertia),
    ):
        yield confirmed(
            equation,
            quantity,
            witness=_QUADRATURE,
            terms=lambda form=form, measure=measure: _compare(form, measure),
            bound=_BOUND,
            reason=_REASON,
        )
    yield corrected(
        "(36)",
        "I_axis, third line: sin(2 beta) sin^2(beta)/4; printed /8",
        witness=_QUADRATURE,
        printed=lambda: _compare(lambda beta: equations.middle_36(beta, 8), _axial_inertia),
        right=lambda: _compare(equations.middle_36, _axial_inertia),
        misses_by=0.23,
        bound=_BOUND,
        reason=_REASON,
    )
    yield confirmed(
        "(38)",
        "centre of mass of can and beer",
        witness="MuJoCo, subtree_com",
        terms=_centre_of_mass,
        bound=_BOUND,
        reason="rounding",
    )


def _figures() -> Iterator[Claim]:
    """Yield what the text says about the figures of eqs. (36) and (37), at beta = pi/2, at pi and in between."""
    half, full = segment(0.5), segment(1.0)
    yield confirmed(
        "figure of (36)",
        "k is 1/2 at beta = pi/2 and at pi",
        witness=_QUADRATURE,
        terms=lambda: (np.full(2, 0.5), -np.array([_axial_inertia(half), _axial_inertia(full)])),
        bound=_BOUND,
        reason=_REASON,
    )
    yield confirmed(
        "figure of (36)",
        "k is 1 for a film (fill 1e-5)",
        witness=_QUADRATURE,
        terms=lambda: (1.0, -_axial_inertia(segment(1e-5))),
        bound=1e-4,
        reason="the film's height",
    )
    yield confirmed(
        "figure of (36)",
        "in between k dips, to 0.456 at 115 degrees",
        witness=_QUADRATURE,
        terms=lambda: (0.456, -_least_axial_inertia()),
        bound=2e-3,
        reason="half a unit of the last digit; the paper gives no number",
    )
    own = np.array([_own_inertia(segment(float(fill))) for fill in np.linspace(1e-3, 1, 1000)])
    yield confirmed(
        "figure of (37)",
        "k rises all the way: it is never below what it was",
        witness=_QUADRATURE,
        terms=lambda: (own, -np.maximum.accumulate(own)),
        bound=_BOUND,
        reason="rounding",
    )
    yield confirmed(
        "figure of (37)",
        "k goes from 0 by 0.32 at beta = pi/2 to 0.5",
        witness=_QUADRATURE,
        terms=lambda: (
            np.array([0.0, 0.32, 0.5]),
            -np.array([_own_inertia(segment(fill)) for fill in (1e-5, 0.5, 1.0)]),
        ),
        bound=1e-3,
        reason="half a unit of the last digit",
    )


def _at_fills(value: Callable[[Segment], float]) -> np.ndarray:
    """Return a quantity of the segments of all `FILLS`."""
    return np.array([value(segment(fill)) for fill in FILLS])


def _compare(form: Callable[[float], float], measure: Callable[[Segment], float]) -> Terms:
    """Return the terms of: a formula in beta gives the same as quadrature, at all `FILLS`."""
    return _at_fills(lambda shape: form(shape.half_angle)), -_at_fills(measure)


def _area(shape: Segment) -> float:
    return shape.area


def _offset(shape: Segment) -> float:
    return shape.offset


def _own_inertia(shape: Segment) -> float:
    return shape.inertia


def _axial_inertia(shape: Segment) -> float:
    return shape.inertia + shape.offset**2


def _mass(shape: Segment) -> float:
    return equations.eq_34(shape.half_angle, RADIUS, LENGTH, BEER)


def _mass_of_load(fill: float) -> float:
    return Load.segment(fill=fill).mass


def _chord() -> np.ndarray:
    """Return -h/a at all `FILLS`, from half the length of the chord that subtends the angle 2 beta at the axis."""
    sides = _at_fills(lambda shape: math.sin(shape.half_angle))
    below = np.array([1.0 if fill <= 0.5 else -1.0 for fill in FILLS])
    return below * np.sqrt(1 - sides**2) - 1


def _least_axial_inertia() -> float:
    """Return the least I_axis/(m a^2) among a thousand fills."""
    return min(_axial_inertia(segment(float(fill))) for fill in np.linspace(0.5, 0.999, 1000))


def _shell_of_mujoco() -> tuple[float, float]:
    """Return the mass [kg] and the axial inertia [kg m^2] that MuJoCo computes for a closed cylinder of sheet metal."""
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="can").add_geom(
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[RADIUS, LENGTH / 2, 0],
        density=THICKNESS * ALUMINIUM,
        typeinertia=mujoco.mjtGeomInertia.mjINERTIA_SHELL,
    )
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    can, axes = model.body("can"), data.body("can").ximat.reshape(3, 3)
    return float(can.mass[0]), float((axes @ np.diag(can.inertia) @ axes.T)[2, 2])


def _centre_of_mass() -> Terms:
    """Return the terms of eq. (38) [m], with MuJoCo's distance of the common centre of mass from the axis."""
    scene = sliding(can=Can.sheet_metal())
    model = build(scene, "equality")
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    d = float(np.linalg.norm(data.subtree_com[model.body("can").id] - data.body("can").xpos))
    return equations.eq_38(scene.load.mass, scene.can.mass, scene.load.offset), -d
