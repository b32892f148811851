"""Tables: a trajectory as CSV, and the validation by eye, for programs, as Markdown and as JSON."""

import io
import json
import math
from importlib.metadata import version
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from mjbeer import Scene, paper, simulate
from mjbeer.output import terminal
from mjbeer.output.terminal import Table
from mjbeer.paper.row import CONFIRMED, CORRECTED, Finding
from mjbeer.studies.check import Result
from mjbeer.studies.validation import motions, tables
from mjbeer.studies.validation.run import Validation
from mjbeer.theory.trajectory import csv
from tests.support.scenes import SCENES

PASSED = Result("phi over 2 s", "frozen, reduced", 1.5e-9, 1e-7, "rad", "RK4")
FAILED = Result("hops", "hoop, contact", 2.0, 0.0, "", "it hops or not")
UNKNOWN = Result("lift-off", "hoop, contact", math.nan, 0.5, "degrees", "penetration")

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


def test_a_narrow_terminal_leaves_no_letter_out() -> None:
    text = io.StringIO()
    Console(file=text, width=24).print(Table("t", ("what", "error"), [("g sin(alpha)/(1+k)", "1e-9")]))
    cells = [line.split("│")[1].strip() for line in text.getvalue().splitlines() if line.startswith("│")]
    assert "".join(cells).replace(" ", "") == "gsin(alpha)/(1+k)"
    text = io.StringIO()
    with terminal.progress_bar(Console(file=text, width=40, force_terminal=True), 123456) as begin:
        begin("appendix B m >> M: omega^2 = g cos(alpha) m/(2 M b), without bound: beyond, m = M")
    assert " 1/123456 " in text.getvalue()


def test_every_cell_of_the_rows_is_whole() -> None:
    """The library that prints takes some brackets for markup; none of the texts of the validation may be lost so."""
    texts = {text for check in motions.checks() for text in (check.quantity, check.by, check.reason)}
    texts |= {text for row in paper.rows() for text in (row.equation, row.quantity, row.bound.reason)}
    rows = [(text,) for text in sorted(texts)]
    assert Table("t", ("text",), rows).tabbed().splitlines()[1:] == sorted(texts)


def test_rows_for_programs_have_all_digits_and_all_that_is_judged() -> None:
    heading, *lines = tables.rows(Validation([PASSED, FAILED], [RIGHT, NO_MISPRINT])).tabbed().splitlines()
    rows = [dict(zip(heading.split("\t"), line.split("\t"), strict=True)) for line in lines]
    assert [(row["part"], row["row"], row["quantity"], row["by"], row["unit"], row["equation"]) for row in rows] == [
        ("check", "pass", "phi over 2 s", "frozen, reduced", "rad", ""),
        ("check", "FAIL", "hops", "hoop, contact", "", ""),
        ("audit", "pass", "motion of phi", "MuJoCo", "relative", "(16)"),
        ("audit", "FAIL", "rolling", "MuJoCo", "relative", "(50)"),
    ]
    assert [float(row["error"]) for row in rows] == pytest.approx([1.5e-9, 2, 5e-15, math.nan], rel=0, nan_ok=True)
    assert [float(row["at most"]) for row in rows] == [1e-7, 0, 1e-12, 2e-8]
    assert (rows[3]["error of what is printed"], rows[3]["must be"]) == ("1e-09", "0.059")
    assert rows[2]["error of what is printed"] == rows[0]["must be"] == ""


def test_sentence_and_failures() -> None:
    assert tables.sentence(Validation([PASSED, FAILED], [RIGHT, MISPRINT])) == (
        "1 of 2 checks and 2 of 2 rows of the audit passed"
    )
    assert tables.failures(Validation([PASSED, UNKNOWN], [RIGHT, NO_MISPRINT])) == [
        "lift-off (hoop, contact): error nan, at most 5.0e-01 degrees",
        "(50) rolling (MuJoCo): error nan, at most 2.0e-08; as printed 1e-09, expected 0.059",
    ]


def test_markdown() -> None:
    assert tables.validation([PASSED, FAILED], document=True).markdown(title=False) == (
        "| check | by | error | at most | what dominates the error |\n"
        "|---|---|---:|---:|---|\n"
        "| phi over 2 s | frozen, reduced | 1.5e-09 | 1.0e-07 rad | RK4 |\n"
        "| hops | hoop, contact | 2.0e+00 **FAIL** | 0.0e+00 | it hops or not |\n"
    )
    assert tables.audit([RIGHT, NO_MISPRINT], document=True).markdown(title=False).splitlines()[2:] == [
        "| (16) | motion of phi | confirmed | MuJoCo | 5.0e-15 |  | 1.0e-12 | rounding |",
        "| (50) | rolling | confirmed after correction | MuJoCo | 1e-09 | nan | 2.0e-08 **FAIL** | drift |",
    ]


def test_json_has_versions_rows_and_a_verdict_that_one_row_decides() -> None:
    def judged(checks: list[Result], audit: list[Finding]) -> dict[str, Any]:
        # Python would write NaN, which no other reader of JSON takes.
        return json.loads(tables.to_json(Validation(checks, audit)), parse_constant=pytest.fail)

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
        "right": None, "bound": 1e-12, "misses_by": None, "reason": "rounding", "passed": True,
    }]  # fmt: skip
