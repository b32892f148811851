"""Tables: a trajectory as CSV, and the validation for the terminal, for programs, as Markdown and as JSON."""

import io
import json
import math
from importlib.metadata import version

import numpy as np
import pytest
from rich.console import Console, RenderableType

from mjbeer import Scene, simulate
from mjbeer.output.terminal import Table
from mjbeer.paper.audit import chapters
from mjbeer.paper.audit.claim import CONFIRMED, CORRECTED, Finding
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


def shown(content: RenderableType) -> str:
    text = io.StringIO()
    Console(file=text, width=200).print(content)
    return text.getvalue()


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
    assert rows.shape == (51, len(columns))
    for column, values in zip(rows.T, columns.values(), strict=True):
        assert np.array_equal(column, values)


def test_the_terminal_table_has_a_verdict_for_every_row() -> None:
    lines = shown(tables.validation([PASSED, FAILED, UNKNOWN])).splitlines()
    (passed,) = (line for line in lines if PASSED.quantity in line)
    (failed,) = (line for line in lines if FAILED.quantity in line)
    (unknown,) = (line for line in lines if UNKNOWN.quantity in line)
    assert all(each in passed for each in ("frozen, reduced", "1.5e-09", "1.0e-07 rad", "pass"))
    assert all(each in failed for each in ("hoop, contact", "2.0e+00", "0.0e+00", "FAIL"))
    assert all(each in unknown for each in ("nan", "5.0e-01 degrees", "FAIL"))


def test_a_narrow_terminal_leaves_no_letter_out() -> None:
    text = io.StringIO()
    Console(file=text, width=24).print(Table("t", ("what", "error"), [("g sin(alpha)/(1+k)", "1e-9")]))
    cells = [line.split("│")[1].strip() for line in text.getvalue().splitlines() if line.startswith("│")]
    assert "".join(cells).replace(" ", "") == "gsin(alpha)/(1+k)"


def test_tabs_for_programs() -> None:
    table = Table("t", ("what", "row"), [("phi", "[green]pass[/]"), ("u, uphill", "[bold red]FAIL[/]")])
    assert table.tabbed() == "what\trow\nphi\tpass\nu, uphill\tFAIL\n"


def test_rows_for_programs_have_all_digits_and_all_that_is_judged() -> None:
    heading, *lines = tables.rows(Validation([PASSED, FAILED], [RIGHT, NO_MISPRINT])).tabbed().splitlines()
    rows = [dict(zip(heading.split("\t"), line.split("\t"), strict=True)) for line in lines]
    assert [row["part"] for row in rows] == ["check", "check", "audit", "audit"]
    assert [row["row"] for row in rows] == ["pass", "FAIL", "pass", "FAIL"]
    assert [row["quantity"] for row in rows] == ["phi over 2 s", "hops", "motion of phi", "rolling"]
    assert [row["by"] for row in rows] == ["frozen, reduced", "hoop, contact", "MuJoCo", "MuJoCo"]
    assert [float(row["error"]) for row in rows] == pytest.approx([1.5e-9, 2, 5e-15, math.nan], rel=0, nan_ok=True)
    assert [float(row["at most"]) for row in rows] == [1e-7, 0, 1e-12, 2e-8]
    assert [row["unit"] for row in rows] == ["rad", "", "relative", "relative"]
    assert [row["equation"] for row in rows] == ["", "", "(16)", "(50)"]
    assert (rows[3]["error of what is printed"], rows[3]["must be"]) == ("1e-09", "0.059")
    assert rows[2]["error of what is printed"] == rows[0]["must be"] == ""


def test_every_cell_of_the_rows_is_whole() -> None:
    """The library that prints takes some brackets for markup; none of the texts of the validation may be lost so."""
    texts = {text for check in motions.checks() for text in (check.quantity, check.by, check.reason)}
    texts |= {text for claim in chapters.claims() for text in (claim.equation, claim.quantity, claim.reason)}
    rows = [(text,) for text in sorted(texts)]
    assert Table("t", ("text",), rows).tabbed().splitlines()[1:] == sorted(texts)


def test_the_sentence_counts_what_passed() -> None:
    assert tables.sentence(Validation([PASSED, FAILED], [RIGHT, MISPRINT])) == (
        "1 of 2 checks and 2 of 2 rows of the audit passed"
    )


def test_a_failure_says_what_it_missed() -> None:
    assert tables.failures(Validation([PASSED, FAILED, UNKNOWN], [RIGHT, NO_MISPRINT])) == [
        "hops (hoop, contact): error 2.0e+00, at most 0.0e+00",
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


def test_json_has_versions_verdict_and_rows() -> None:
    content = json.loads(tables.to_json(Validation([PASSED, FAILED], [])))
    assert content["versions"] == {each: version(each) for each in ("mjbeer", "mujoco", "numpy", "scipy", "numba")}
    assert content["passed"] is False
    assert content["checks"] == [
        {
            "quantity": "phi over 2 s", "by": "frozen, reduced", "error": 1.5e-9, "bound": 1e-7, "unit": "rad",
            "reason": "RK4", "passed": True,
        },
        {
            "quantity": "hops", "by": "hoop, contact", "error": 2.0, "bound": 0.0, "unit": "",
            "reason": "it hops or not", "passed": False,
        },
    ]  # fmt: skip
    assert json.loads(tables.to_json(Validation([PASSED], [])))["passed"] is True


def test_json_of_an_error_that_is_no_number_is_still_json() -> None:
    # Python would write NaN, which no other reader of JSON takes.
    text = tables.to_json(Validation([UNKNOWN], []))
    (row,) = json.loads(text, parse_constant=pytest.fail)["checks"]
    assert row["error"] is None
    assert row["passed"] is False


def test_the_audit_for_the_terminal() -> None:
    lines = shown(tables.audit([RIGHT, MISPRINT, NO_MISPRINT])).splitlines()
    right, misprint, none = (next(line for line in lines if each in line) for each in ("(16)", "(49)", "(50)"))
    assert all(each in right for each in ("confirmed", "5.0e-15", "1.0e-12", "pass"))
    assert all(each in misprint for each in ("corrected", "0.059", "4.0e-10", "2.0e-08", "pass"))
    assert all(each in none for each in ("1e-09", "nan", "FAIL"))


def test_the_audit_as_markdown() -> None:
    assert tables.audit([RIGHT, NO_MISPRINT], document=True).markdown(title=False) == (
        "| equation | quantity | verdict | witness | error, printed | error, right | at most | what dominates |\n"
        "|---|---|---|---|---:|---:|---:|---|\n"
        "| (16) | motion of phi | confirmed | MuJoCo | 5.0e-15 |  | 1.0e-12 | rounding |\n"
        "| (50) | rolling | confirmed after correction | MuJoCo | 1e-09 | nan | 2.0e-08 **FAIL** | drift |\n"
    )


def test_json_has_the_audit_and_a_misprint_decides() -> None:
    content = json.loads(tables.to_json(Validation([PASSED], [RIGHT, NO_MISPRINT])), parse_constant=pytest.fail)
    assert content["passed"] is False
    right, none = content["audit"]
    assert right == {
        "equation": "(16)", "quantity": "motion of phi", "verdict": "confirmed", "witness": "MuJoCo", "printed": 5e-15,
        "right": None, "bound": 1e-12, "misses_by": None, "reason": "rounding", "passed": True,
    }  # fmt: skip
    assert (none["right"], none["passed"]) == (None, False)
    assert json.loads(tables.to_json(Validation([PASSED], [RIGHT, MISPRINT])))["passed"] is True
