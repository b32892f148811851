"""Every peer that can be imported against exact theory, down its ladder, and where it fails."""

import importlib
import math
import sys
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import pytest

from mjbeer import Scene, exact, frozen, pendulum, simulate, sliding
from mjbeer.exceptions import DivergenceError, ParameterError
from mjbeer.studies.benchmark.peers import equations, whole_call, with_heyoka, with_scipy
from mjbeer.studies.benchmark.peers import peer as peers
from mjbeer.studies.benchmark.peers.installed import PEERS, absent, installed
from mjbeer.studies.benchmark.peers.peer import Peer
from mjbeer.studies.cases import STIFF, Case
from tests.support.scenes import METAL

pytestmark = pytest.mark.slow

TIMES = np.linspace(0, 1.024, 65)
STARTS = {
    "sliding, metal can": (sliding(can=METAL), 1.0, 2.0),
    "frozen": (frozen(), 0.0, 0.0),
    "frozen, metal can": (frozen(can=METAL), -0.5, 1.0),
    "pendulum": (pendulum(), 1.0, 0.0),
}
ABSENT = absent()


def skipping(peers: Iterable[Peer]) -> list[Any]:
    """Parameters of a test of peers; for those that are absent it is skipped, with the reason."""
    marks = {name: [pytest.mark.skip(f"{name} is absent: {reason}")] for name, reason in ABSENT.items()}
    return [pytest.param(peer, id=peer.name, marks=marks.get(peer.name, ())) for peer in peers]


ALL = skipping(PEERS)
BARE = skipping(peer for peer in PEERS if peer is not whole_call.PEER)

# A tolerance holds for one step, of which there are some hundreds, and for metres, of which a radian of rolling has
# 0.03. Measured: up to 75 times the tolerance (LSODA).
GLOBAL = 300
# The error over that tolerance is not constant: steps are few, and methods change their order. Measured: 0.90 to 1.13.
SLOPE = 0.2
EPS = float(np.finfo(float).eps)


def error(peer: Peer, scene: Scene, phi0: float, phi_dot0: float, knob: float) -> float:
    """The larger of the errors of phi and u/a, against exact theory."""
    phi, u = peer.prepare(scene, phi0, phi_dot0, TIMES, knob)()
    truth = exact(scene, TIMES, phi0, phi_dot0)
    return max(np.abs(phi - truth.phi).max(), np.abs(u - truth.u).max() / scene.can.radius)


@pytest.mark.parametrize("start", [(sliding(), 1.0, 0.0), *STARTS.values()], ids=["sliding", *STARTS])
@pytest.mark.parametrize("peer", BARE)
def test_tolerances_lead_to_exact_theory(peer: Peer, start: tuple[Scene, float, float]) -> None:
    coarse, fine = 1e-4, 1e-10
    first, last = error(peer, *start, coarse), error(peer, *start, fine)
    assert last <= GLOBAL * fine
    assert math.log(first / last) / math.log(coarse / fine) == pytest.approx(1, abs=SLOPE)


@pytest.mark.parametrize("peer", BARE)
def test_finest_tolerance(peer: Peer) -> None:
    assert error(peer, *STARTS["frozen"], peer.tolerances[-1]) < GLOBAL * max(peer.tolerances[-1], EPS)


@pytest.mark.parametrize("peer", ALL)
def test_runs_repeat_and_ladders_get_finer(peer: Peer) -> None:
    assert list(peer.tolerances) == sorted(peer.tolerances, reverse=True)
    run = peer.prepare(pendulum(), 1.0, 0.0, TIMES, peer.tolerances[2])
    first, second = run(), run()
    assert first[0] is not second[0]
    assert all(np.array_equal(one, two) for one, two in zip(first, second, strict=True))


@pytest.mark.parametrize("peer", skipping(peer for peer in PEERS if peer.name == "heyoka"))
def test_set_up_compiles_anew(peer: Peer) -> None:
    from heyoka import llvm_state

    llvm_state.set_diskcache_enabled(True)  # heyoka's default
    llvm_state.clear_memcache()
    on_disk, kept = llvm_state.get_diskcache_size(), []
    for knob in (1e-3, 1e-4, 1e-3):
        peer.prepare(frozen(), 0.0, 0.0, TIMES, knob)
        kept.append(llvm_state.get_memcache_size())
    assert kept[0] == kept[2]  # what was compiled second is forgotten
    assert llvm_state.get_diskcache_size() == on_disk
    assert llvm_state.get_diskcache_enabled()


def blow_up(scene: Scene, sin: object = None, cos: object = None) -> equations.RightHandSide:
    """phi = 1/(1 - t), which is infinite after 1 s."""
    return lambda _, state: (state[0] * state[0], 0 * state[0])


def no_sine(scene: Scene, sin: object = None, cos: object = None) -> equations.RightHandSide:
    return lambda _, state: (math.sin(math.inf), 0.0)


# What the tools themselves say.
FAILURES = {
    "SciPy DOP853": "step size is less than spacing between numbers",
    "SciPy LSODA": "LSODA: 10000 evaluations did not reach 1.024 s",
    "SciPy odeint": r"(Excess work done|Illegal input detected|Repeated error test failures)",
    "heyoka": r"heyoka: .*err_nf_state.* at (0\.99|1)",
}


@pytest.mark.parametrize("peer", BARE)
def test_a_failure_is_raised(peer: Peer, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(equations, "right_hand_side", blow_up)
    monkeypatch.setattr(with_scipy, "_MOST_EVALUATIONS", 10_000)
    run = peer.prepare(frozen(), 1.0, 0.0, TIMES, 1e-6)
    for _ in range(2):
        with pytest.raises(DivergenceError, match=FAILURES[peer.name]):
            run()
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("peer", [with_scipy.DOP853, with_scipy.LSODA, with_scipy.ODEINT], ids=lambda peer: peer.name)
def test_a_state_without_a_sine(peer: Peer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(equations, "right_hand_side", no_sine)
    with pytest.raises(DivergenceError, match=r"SciPy: .*domain"):
        peer.prepare(frozen(), 1.0, 0.0, TIMES, 1e-6)()


@pytest.mark.parametrize(
    "result",
    [
        lambda times: (np.where(times > 1, np.nan, times), times),
        lambda times: (times, np.where(times > 1, np.inf, times)),
        lambda times: (times[:-1], times[:-1]),
    ],
)
def test_results_are_looked_at(result: Callable[[np.ndarray], peers.Motion]) -> None:
    careless = Peer("careless", (1.0,), lambda scene, phi0, rate, times, knob: lambda: result(times))
    with pytest.raises(DivergenceError, match=r"careless: the motion did not stay finite until 1\.024 s"):
        careless.prepare(frozen(), 0.0, 0.0, TIMES, 1.0)()


@pytest.mark.parametrize("peer", ALL)
def test_nonsense_is_refused(peer: Peer) -> None:
    scene, knob = frozen(), peer.tolerances[0]
    for times in ([0.0], [0.1, 0.2], [0.0, 0.2, 0.2], [0.0, math.nan], [0.0, math.inf], [[0.0, 1.0]]):
        with pytest.raises(ParameterError, match="times must be two or more"):
            peer.prepare(scene, 0.0, 0.0, times, knob)
    with pytest.raises(ParameterError, match="tolerance must be greater than 0"):
        peer.prepare(scene, 0.0, 0.0, TIMES, 0.0)
    with pytest.raises(ParameterError, match="phi0 must be a finite number"):
        peer.prepare(scene, math.nan, 0.0, TIMES, knob)


@pytest.mark.parametrize("missing", [(), ("heyoka",)])
def test_what_is_not_installed_is_absent(missing: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    for name in missing:
        monkeypatch.setitem(sys.modules, name, None)  # which makes Python raise ModuleNotFoundError
    assert {*missing} <= set(absent()) <= {*missing, *ABSENT}
    assert all(name in absent()[name] for name in missing)
    assert [peer.name for peer in installed()] == [peer.name for peer in PEERS if peer.name not in absent()]


BROKEN = [
    ImportError("libfmt.so.11: cannot open shared object file"),
    ImportError("cannot import name 'sin' from 'heyoka'", name="heyoka"),
    ModuleNotFoundError("No module named 'cloudpickle'", name="cloudpickle"),
    OSError("no such driver"),
]


@pytest.mark.parametrize("broken", BROKEN, ids=str)
def test_what_is_broken_is_absent_and_says_why(broken: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    def load(name: str) -> object:
        if name == "heyoka":
            raise broken
        return sys

    monkeypatch.setattr(importlib, "import_module", load)
    assert absent() == {"heyoka": str(broken)}
    assert "heyoka" not in {peer.name for peer in installed()}


def test_a_whole_call_is_that_of_simulate() -> None:
    phi, u = whole_call.PEER.prepare(sliding(), 1.0, 0.0, TIMES, 1e-9)()
    run = simulate(sliding(), float(TIMES[-1]), 1.0, tolerance=1e-9, times=TIMES)
    assert (phi == run.phi).all()
    assert (u == run.u).all()


DAMPED = skipping((with_scipy.LSODA, *with_scipy.STIFF, with_heyoka.PEER))


@pytest.mark.parametrize("peer", DAMPED)
@pytest.mark.parametrize("case", STIFF.values(), ids=STIFF.keys())
def test_stiff_cases_lead_to_exact_theory(peer: Peer, case: Case) -> None:
    """Implicit methods lose some digits more than a tolerance says: measured up to 500 times the tolerance."""
    fine = 1e-7
    assert error(peer, case.scene, case.phi0, 0.0, fine) <= 1000 * fine
