"""A run in one line."""

import pytest

from mjbeer import frozen, simulate


def test_a_run_is_one_line_and_does_not_run_again(monkeypatch: pytest.MonkeyPatch) -> None:
    run = simulate(frozen(), 0.5, 1.0, rolling="contact")
    monkeypatch.setattr(
        "mjbeer.simulation.second_run.compare_uneven", lambda _: pytest.fail("a second run")
    )

    line = repr(run)

    assert line == (
        "<Run frozen, contact, RK4: 501 samples to t = 0.5 s, "
        f"phi = {run.phi[-1]:.6g} rad, u = {run.u[-1]:.6g} m>"
    )
