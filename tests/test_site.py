"""The site's own tool finds what is broken; workflows name targets and files that exist."""

import pathlib
import re
import shlex
from typing import Any

import pytest
import yaml

from tools.site_links import broken

CHECKOUT = pathlib.Path(__file__).parents[1]
WORKFLOWS = sorted(CHECKOUT.glob(".github/workflows/*.yml"))
FORMS = sorted(CHECKOUT.glob(".github/ISSUE_TEMPLATE/*.yml"))
WHOLE = (
    '<h1 id="one">1</h1><a href="#one">1</a><a href="sub/two.html#two">2</a><img src="a.svg">'
    '<a href="https://example.org">3</a><a href="mailto:a@example.org">4</a>'
    '<link rel="canonical" href="https://example.org/"><img src="data:image/png;base64,AA==">'
    '<a href="sub/two.html#incline=5">5</a><a href="sub/">6</a>'
)


@pytest.fixture
def site(tmp_path: pathlib.Path) -> pathlib.Path:
    """A whole site of three pages."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "index.html").write_text(WHOLE)
    (tmp_path / "a.svg").write_text("<svg/>")
    (tmp_path / "sub" / "two.html").write_text('<p id="two"><a href="../index.html#one">1</a></p>')
    (tmp_path / "sub" / "index.html").write_text("<style>p { background: url(../a.svg) }</style>")
    return tmp_path


def test_a_whole_site_has_no_faults(site: pathlib.Path) -> None:
    assert list(broken(site)) == []


@pytest.mark.parametrize(
    ("html", "reason"),
    [
        ('<a href="three.html">', "no file"),
        ('<img src="b.svg">', "no file"),
        ('<video poster="b.webp">', "no file"),
        ('<a href="#two">', "no anchor"),
        ('<a href="sub/two.html#one">', "no anchor"),
        ('<a href="/sub/two.html">', "leads nowhere"),
        ('<script src="https://example.org/a.js">', "another host"),
        ('<link rel="stylesheet" href="//example.org/a.css">', "another host"),
        ("<style>@import 'https://example.org/a.css'</style>", "another host"),
        ('<p style="background: url(https://example.org/a.png)">', "another host"),
    ],
)
def test_a_fault_is_found(site: pathlib.Path, html: str, reason: str) -> None:
    (site / "new.html").write_text(html)
    (fault,) = broken(site)
    assert fault.startswith("new.html: ")
    assert reason in fault


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_runs_what_there_is(path: pathlib.Path) -> None:
    text = path.read_text()
    workflow = yaml.safe_load(text)
    assert missing(workflow) == []
    assert "secrets." not in text


def missing(workflow: dict[str, Any]) -> list[str]:
    """What a workflow names and the checkout lacks: targets of make, scripts, and its own jobs."""
    makefile = (CHECKOUT / "Makefile").read_text()
    jobs = workflow["jobs"]
    lacking = []
    for job in jobs.values():
        if job.get("needs", next(iter(jobs))) not in jobs:
            lacking.append(job["needs"])
        for line in "\n".join(step.get("run", "") for step in job["steps"]).splitlines():
            match shlex.split(line):
                case ["make", *targets]:
                    lacking += [name for name in targets if not is_target(name, makefile)]
                case ["bash", script] if not (CHECKOUT / script).is_file():
                    lacking.append(script)
    return lacking


def is_target(name: str, makefile: str) -> bool:
    return bool(re.search(rf"^{re.escape(name)}:", makefile, re.MULTILINE))


def test_what_a_workflow_lacks_is_found() -> None:
    steps = [{"run": "make site sight\nbash .ci/walk"}, {"uses": "actions/checkout@v6"}]
    workflow = {"jobs": {"one": {"needs": "two", "steps": steps}}}
    assert missing(workflow) == ["two", "sight", ".ci/walk"]


def test_who_reports_a_fault_is_asked_for_version_command_and_output() -> None:
    (form,) = FORMS
    asked = yaml.safe_load(form.read_text())["body"]
    assert [field["attributes"]["label"] for field in asked] == [
        "Version",
        "Command or program",
        "Output",
    ]
    assert all(field["validations"]["required"] for field in asked)
