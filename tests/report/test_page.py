"""`mjbeer validate` and `mjbeer report`: exit status, streams, and one whole page."""

import base64
import html.parser
import json
import math
import os
import pathlib
import re
import shlex

import pytest

from mjbeer import paper
from mjbeer.cli.app import main, parse
from mjbeer.drawing import opengl
from mjbeer.drawing.film import MotionFilm
from mjbeer.output import folders
from mjbeer.paper.claim import CORRECTED, Bound, Claim, ClaimResult, PrintedError, Witness
from mjbeer.report import films, page
from mjbeer.report.films import FILMS
from mjbeer.studies.validation.validate import Validation
from tests.support import stubs

SENTENCE = (
    "{} of {} checks passed, and {} of {} claims of the paper came out as expected "
    "({} hold as printed, {} only after a correction)"
)
MISPRINTS = [row for row in paper.claims() if row.misprint]


class Page(html.parser.HTMLParser):
    """A page as a list of its elements with their attributes; each element must be closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in ("meta", "link", "img", "source", "input", "mspace", "br"):
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def values(self, attribute: str, *tags: str) -> list[str]:
        """Return the values of an attribute, of all elements or of those with some tags."""
        values = []
        for tag, attributes in self.elements:
            if attribute in attributes and (tag in tags or not tags):
                values.append(str(attributes[attribute]))
        return values


@pytest.mark.parametrize("option", ["", "--table", "--json"])
@pytest.mark.parametrize(("error", "status"), [(1e-3, 0), (2e-3, 1), (math.nan, 1)])
def test_validate_tells_a_failure_whatever_is_asked_for(
    option: str,
    error: float,
    status: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    stubs.validate(monkeypatch, first=1e-5, second=error)
    bound = Bound(1e-3, "")
    claims = [
        Claim("good", "a stub", Witness("none", lambda: 1e-6), bound, "observed", scale="1"),
        Claim("other", "a stub", Witness("none", lambda: error), bound, "observed", scale="1"),
    ]
    monkeypatch.setattr(paper, "claims", lambda: claims)
    assert main(["validate", *option.split()]) == status
    out, err = capsys.readouterr()
    messages = []
    if status:
        problem = f"error {error:.1e}, at most 1.0e-03"
        messages = [
            f"FAILED: stubs: second (a stub): {problem} rad",
            f"FAILED: other: a stub (none): {problem}",
        ]
    good = 2 - status
    assert err.splitlines() == [*messages, SENTENCE.format(good, 2, good, 2, good, 0)]
    if option == "--json":
        content = json.loads(out, parse_constant=pytest.fail)
        assert content["passed"] == (status == 0)
        assert [row["error"] for row in content["checks"]] == [
            1e-5,
            None if math.isnan(error) else error,
        ]
    else:
        assert ("\nfirst\t" in out) == bool(option)


@pytest.mark.slow
@pytest.mark.parametrize("quick", [True, False])
def test_a_report_is_one_page_with_all_films(
    quick: bool,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    stubs.validate(monkeypatch, first=1e-5, second=2e-5)
    calls = stubs.draw(monkeypatch)
    folder = tmp_path / "report"
    assert main(["report", "--output", str(folder), *(["--quick"] if quick else [])]) == 0
    shown = {name for name in os.listdir(folder) if not name.startswith(".")}
    names = [*FILMS] if quick else [*FILMS, "told"]
    files = {f"{name}.mp4" for name in names}
    assert shown == {"index.html", "live.html", "stability-more.svg"} | files
    text = (folder / "index.html").read_text()
    assert files <= set(Page(text).values("href", "a"))
    sources = [source.partition(",")[2] for source in Page(text).values("src", "source")]
    assert [base64.b64decode(source).decode() for source in sources] == [
        f"film {name}" for name in names
    ]
    assert ("The films were left out of this quick report." in text) == quick
    for words in (SENTENCE.format(2, 2, 0, 0, 0, 0), "A plot &amp; a title", "<td>first</td>"):
        assert words in text
    assert {call.width for call in calls} == {640 if quick else 768}
    where = f"the report is in {folder / 'index.html'}"
    assert capsys.readouterr().err.endswith(f"{where}\n{SENTENCE.format(2, 2, 0, 0, 0, 0)}\n")


@pytest.mark.slow
def test_without_opengl_a_report_has_all_but_films_and_says_so(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A failed check is in page and exit status."""
    stubs.validate(monkeypatch, first=2e-3)
    assert not stubs.draw(monkeypatch)
    monkeypatch.setattr(opengl, "problem", lambda: "there is none")
    assert main(["report", "--output", str(tmp_path)]) == 1
    line = opengl.missing_films_message([*FILMS, "told"])
    assert f"{line}\nthe report is in " in capsys.readouterr().err
    text = (tmp_path / "index.html").read_text()
    assert line.replace("&", "&amp;") in text
    assert "2.0e-03 <strong>FAIL</strong>" in text
    assert "<video" not in text


def test_a_film_that_fails_leaves_the_old_page(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stubs.validate(monkeypatch, first=1e-5)
    stubs.draw(monkeypatch, fail_at="pendulum.mp4")
    with folders.owned(tmp_path, "mjbeer report"):
        (tmp_path / "index.html").write_text("of an earlier report")
    assert main(["report", "--output", str(tmp_path)]) == 2
    assert capsys.readouterr().err.endswith("mjbeer: cannot draw pendulum.mp4\n")
    shown = [path.name for path in tmp_path.iterdir() if not path.name.startswith(".")]
    assert shown == ["index.html"]
    assert (tmp_path / "index.html").read_text() == "of an earlier report"


@pytest.fixture(scope="module")
def text() -> str:
    """Return a page with a result for each misprint; the errors are made up."""
    results = [
        ClaimResult(
            group=row.equation,
            name=row.quantity,
            by="a witness",
            bound=1e-6,
            reason="rounding",
            error=1.7e-9 * (place + 1),
            verdict=CORRECTED,
            printed=PrintedError(0.0127 * (place + 1), expected=0.0123 * (place + 1)),
        )
        for place, row in enumerate(MISPRINTS)
    ]
    with pytest.MonkeyPatch.context() as patch:
        stubs.draw(patch)
        jobs = [job for job in page.plot_jobs(pathlib.Path()) if job.in_memory]
        plots = {job.path.name: job.write() for job in jobs}
        return page.page(
            Validation([], results), {"race": page.ShownFilm(b"film", b"still")}, plots, False, ""
        )


def test_nothing_comes_from_elsewhere_and_nothing_runs(text: str) -> None:
    """The only addresses are links for a reader; the page's policy forbids others, and scripts."""
    shown = Page(text)
    loaded = shown.values("src") + shown.values("poster") + shown.values("href", "link")
    assert all(address.startswith(("data:", "#")) for address in loaded)
    (policy,) = shown.values("content", "meta")[:1]
    assert "default-src 'none'" in policy
    assert not re.search(r"\bhttps?:|\*|script", policy)

    names = shown.values("id")
    links = shown.values("href", "a")
    targets = {link.removeprefix("#") for link in links if link.startswith("#")}
    assert len(names) == len(set(names))
    assert set(shown.values("id", "section")) <= targets <= set(names)
    assert all(shown.values("alt", "img"))


def test_the_misprints_have_their_kinds_and_the_numbers_of_the_results(text: str) -> None:
    shown = re.findall(r'misses by <data value="([^"]*)">(.*?)</data>', text)
    expected = []
    for place in range(len(MISPRINTS)):
        expected += [0.0127 * (place + 1), 1.7e-9 * (place + 1)]
    assert [float(value) for value, _ in shown] == expected
    assert [words for _, words in shown[:2]] == [
        "1.3 %",
        "1.7&thinsp;·&thinsp;10<sup>\N{MINUS SIGN}9</sup>",
    ]
    assert "consequence of (39)" in text
    assert text.count("<blockquote>") == sum(bool(row.quote) for row in MISPRINTS)


@pytest.mark.parametrize("name", films.COMMANDS)
def test_a_film_s_command_makes_the_same_motion(name: str) -> None:
    from mjbeer.cli.motions import run_of

    film = FILMS[name]
    assert isinstance(film, MotionFilm)
    given = parse(shlex.split(films.COMMANDS[name])[1:])
    filmed = film.trajectory()
    commanded = run_of(given)
    # The degrees of a command have seven digits.
    assert filmed.phi0 == pytest.approx(commanded.phi0, abs=1e-6)
    assert filmed.phi_dot0 == pytest.approx(commanded.phi_dot0, abs=1e-6)
    assert filmed.scene == commanded.scene
    assert filmed.rolling == commanded.rolling
    assert filmed.integrator == commanded.integrator


@pytest.mark.parametrize("row", MISPRINTS, ids=lambda row: row.equation)
def test_formulas_are_mathml_without_what_was_not_understood(row) -> None:
    for latex in (row.misprint.printed_latex, row.misprint.right_latex):
        shown = page.mathml(latex)
        assert shown.count("<math") >= 1
        assert "\\" not in re.sub("<[^>]*>", "", shown)
        assert (r"\textcolor" in latex) == ('class="differs"' in shown)
    assert page.letters("phi_0^2 and u_ddot") == "φ₀² and u\N{COMBINING DIAERESIS}"


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (0.0, "0 %"),
        (0.0123, "1.2 %"),
        (0.0996, "10 %"),
        (0.996, "100 %"),
        (1.134, "113 %"),
        (10.5, "1050 %"),
        (3.1e-7, "3.1&thinsp;·&thinsp;10<sup>\N{MINUS SIGN}7</sup>"),
    ],
)
def test_a_share_is_a_percentage_in_plain_digits_or_a_power_of_ten(
    value: float, written: str
) -> None:
    assert page.share(value) == written
