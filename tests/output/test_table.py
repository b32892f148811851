"""Tables: a trajectory as CSV, and the validation by eye, for programs, as Markdown and as JSON."""

import io
import json
import math
from importlib.metadata import version
from typing import Any

import numpy as np
import pytest

from mjbeer import Scene, simulate
from mjbeer.output import terminal
from mjbeer.output.terminal import Table
from mjbeer.paper.claim import CONFIRMED, CORRECTED, Finding
from mjbeer.studies.study import Result
from mjbeer.studies.validation.run import Validation
from mjbeer.theory.trajectory import csv
from tests.support.scenes import SCENES

PASSED = Result("", "phi over 2 s", "frozen, reduced", 1e-7, "rad", "RK4", 1.5e-9)
FAILED = Result("", "hops", "hoop, contact", 0.0, "", "it hops or not", 2.0)
UNKNOWN = Result("", "lift-off", "hoop, contact", 0.5, "degrees", "penetration", math.nan)

RIGHT = Finding("(16)", "motion of phi", CONFIRMED, "MuJoCo", 5e-15, None, 1e-12, None, "rounding")
MISPRINT = Finding("(49)", "motion of phi", CORRECTED, "MuJoCo", 0.0589, 4e-10, 2e-8, 0.059, "drift")
NO_MISPRINT = Finding("(50)", "rolling", CORRECTED, "MuJoCo", 1e-9, math.nan, 2e-8, 0.059, "drift")


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_csv_gives_every_number_back_to_the_last_bit(scene: Scene) -> None:
    run = simulate(scene, 0.05, 1.0, 2.0)
    header, *_ = csv(run).splitlines()
    rows = np.loadtxt(io.StringIO(csv(run)), delimiter=",", skiprows=1)
    columns = {
        "time [s]": run.time,
        "u [m]": run.u,
        "phi [rad]": run.phi,
        "u_dot [m/s]": run.u_dot,
        "phi_dot [rad/s]": run.phi_dot,
        "roll [rad]": run.roll,
        "lift [m]": run.lift,
        "slip [m]": run.slip,
        "energy [J]": run.energy,
        "normal force needed [N]": run.forces.normal,
        "friction force needed [N]": run.forces.friction,
    }
    assert header.split(",") == list(columns)
    assert np.array_equal(rows.T, list(columns.values()))


def test_a_program_reads_tabs_and_an_eye_lines(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    one, other = Table("One", ("name", "value"), [("phi", "[green]1.5[/]")]), Table("Other", ("name",), [("F",)])
    terminal.show(one)
    terminal.show(one, other)
    tabs = "name\tvalue\nphi\t1.5\n"
    assert capsys.readouterr().out == f"{tabs}# One\n{tabs}\n# Other\nname\nF\n"
    monkeypatch.setattr(terminal, "is_read_by_eye", lambda: True)
    terminal.show(one)
    assert "│ phi  │   1.5 │" in capsys.readouterr().out


def test_json_has_versions_rows_and_a_verdict_that_one_row_decides() -> None:
    def judged(checks: list[Result], findings: list[Finding]) -> dict[str, Any]:
        # Python would write NaN, which no other reader of JSON takes.
        return json.loads(Validation(checks, findings).json(), parse_constant=pytest.fail)

    assert judged([PASSED], [RIGHT, MISPRINT])["passed"] is True
    assert judged([PASSED], [NO_MISPRINT])["passed"] is False
    content = judged([PASSED, UNKNOWN], [RIGHT])
    assert content["passed"] is False
    assert content["versions"] == {each: version(each) for each in ("mjbeer", "mujoco", "numpy", "scipy", "numba")}
    assert content["checks"] == [
        {
            "quantity": "phi over 2 s", "by": "frozen, reduced", "error": 1.5e-9, "bound": 1e-7, "unit": "rad",
            "reason": "RK4", "passed": True,
        },
        {
            "quantity": "lift-off", "by": "hoop, contact", "error": None, "bound": 0.5, "unit": "degrees",
            "reason": "penetration", "passed": False,
        },
    ]  # fmt: skip
    assert content["audit"] == [{
        "equation": "(16)", "quantity": "motion of phi", "verdict": "confirmed", "witness": "MuJoCo", "printed": 5e-15,
        "right": None, "bound": 1e-12, "expected_error": None, "reason": "rounding", "passed": True,
    }]  # fmt: skip
