"""Tables: a trajectory as CSV, and the validation by eye, for programs, as Markdown and as JSON."""

import io
import json
import math
import sys
from importlib.metadata import version
from typing import Any

import numpy as np
import pytest

from mjbeer import Scene, simulate
from mjbeer.checks.check import Result
from mjbeer.output import terminal
from mjbeer.output.terminal import Table
from mjbeer.paper.claim import CONFIRMED, CORRECTED, ClaimResult, PrintedError
from mjbeer.studies.validation.validate import Validation
from mjbeer.theory.trajectory import csv
from tests.support.scenes import SCENES

PASSED = Result("", "phi over 2 s", "frozen, reduced", 1e-7, "rad", "RK4", 1.5e-9)
FAILED = Result("", "hops", "hoop, contact", 0.0, "", "it hops or not", 2.0)
UNKNOWN = Result("", "lift-off", "hoop, contact", 0.5, "degrees", "penetration", math.nan)

RIGHT = ClaimResult(
    "(16)", "motion of phi", "MuJoCo", 1e-12, "", "rounding", 5e-15, verdict=CONFIRMED
)


def misprint(printed: float, right: float) -> ClaimResult:
    return ClaimResult(
        "(49)",
        "motion of phi",
        "MuJoCo",
        2e-8,
        "",
        "drift",
        right,
        verdict=CORRECTED,
        printed=PrintedError(printed, expected=0.059),
    )


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
    one = Table("One", ("name", "value [rad]"), [("phi", "1.5")])
    other = Table("Other", ("name",), [("F",)])
    terminal.show(one, other)
    assert capsys.readouterr().out == "# One\nname\tvalue [rad]\nphi\t1.5\n\n# Other\nname\nF\n"
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    terminal.show(one)
    shown = capsys.readouterr().out
    assert "│ phi  │ " in shown
    assert "value [rad]" in shown


def test_json_has_versions_checks_and_a_verdict_that_one_decides() -> None:
    def judged(checks: list[Result], audit: list[ClaimResult]) -> dict[str, Any]:
        # Python would write NaN, which no other reader of JSON takes.
        return json.loads(Validation(checks, audit).json(), parse_constant=pytest.fail)

    assert judged([PASSED], [RIGHT, misprint(0.0589, 4e-10)])["passed"] is True
    for wrong in (misprint(1e-9, 4e-10), misprint(0.0589, math.nan), misprint(0.0589, 3e-8)):
        assert judged([PASSED], [wrong])["passed"] is False
    content = judged([PASSED, UNKNOWN], [RIGHT, misprint(0.0589, 4e-10)])
    assert content["passed"] is False
    assert content["versions"]["mujoco"] == version("mujoco")
    passed, unknown = content["checks"]
    assert (passed["name"], passed["error"], passed["passed"]) == ("phi over 2 s", 1.5e-9, True)
    assert (unknown["name"], unknown["error"], unknown["passed"]) == ("lift-off", None, False)
    assert [row["values"] for row in content["audit"]] == [
        {"verdict": CONFIRMED},
        {"verdict": CORRECTED, "printed": 0.0589, "expected_error": 0.059},
    ]


def test_a_document_has_the_verdict_of_the_audit_and_what_failed() -> None:
    checks, audit = Validation([PASSED, FAILED], [RIGHT, misprint(0.0589, 4e-10)]).tables()
    assert checks.rows[1][2].endswith(" **FAIL**")
    assert [row[2] for row in audit.rows] == [CONFIRMED, CORRECTED]
    assert audit.rows[1][4:6] == ("0.059", "4.0e-10")


def test_the_verdict_counts_a_corrected_claim_only_if_it_came_out_as_expected() -> None:
    audit = [RIGHT, misprint(0.0589, 4e-10), misprint(0.0589, 3e-8)]
    assert Validation([PASSED, UNKNOWN], audit).sentence == (
        "1 of 2 checks passed, and 2 of 3 claims of the paper came out as expected "
        "(1 hold as printed, 1 only after a correction)"
    )
