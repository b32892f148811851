"""The page: it is whole, it needs nothing from elsewhere, and it says what the audit found."""

import base64
import itertools
import pathlib
import re
import shlex
import shutil
from collections.abc import Generator

import pytest

from mjbeer import paper
from mjbeer.cli.app import main
from mjbeer.drawing.film import Take
from mjbeer.output import files
from mjbeer.paper import stories
from mjbeer.paper.claim import Misprint
from mjbeer.report import films, formulas, page
from mjbeer.studies.benchmark import work_precision
from mjbeer.studies.stability import stability_maps
from tests.support import pages, stubs
from tests.support.pages import Page

SECTIONS = ["verdict", "races", "scenes", "errors", "stability", "stories", "misprints", "machine"]
MISPRINTS = [row.misprint for row in paper.claims() if row.misprint]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Generator[pathlib.Path]:
    """The files of a report with two stories and a race."""
    folder = tmp_path_factory.mktemp("report")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stories, "STORIES", pages.stories())
        pages.fill(folder)
        yield folder


@pytest.fixture(scope="module")
def text(folder: pathlib.Path) -> str:
    return page.html(folder, pages.validation(), quick=False, not_drawn="")


@pytest.fixture(scope="module")
def read(text: str) -> Page:
    return Page.of(text)


def test_nothing_comes_from_elsewhere_and_nothing_runs(text: str, read: Page) -> None:
    """Links that a reader may follow are the only addresses; the policy forbids the rest, and all scripts."""
    taken = [each.attributes[name] for each in read.elements for name in ("src", "poster") if name in each.attributes]
    taken += [each.attributes["href"] for each in read.all("link", "image", "use")]
    assert len(taken) > 10
    assert all(each.startswith(("data:", "#")) for each in taken)
    assert not re.search(r"url\(|@import", "".join(element.text for element in read.all("style")))
    (policy,) = (element.attributes["content"] for element in read.all("meta") if "http-equiv" in element.attributes)
    assert "default-src 'none'" in policy
    assert not re.search(r"\bhttps?:|\*|script", policy)
    assert "<script" not in text


def test_sections_headings_and_links_are_in_order_and_everything_has_a_name_of_its_own(read: Page) -> None:
    assert [element.attributes["id"] for element in read.all("section")] == SECTIONS
    levels = [int(element.name[1]) for element in read.all("h1", "h2", "h3")]
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in itertools.pairwise([0, *levels]))
    names = [element.attributes["id"] for element in read.elements if "id" in element.attributes]
    assert len(names) == len(set(names))
    inside = [each.attributes["href"][1:] for each in read.all("a", "use") if each.attributes["href"][0] == "#"]
    assert set(inside) <= set(names)
    assert set(SECTIONS) <= set(inside)
    assert all(element.attributes["alt"] for element in read.all("img"))
    assert all(element.attributes["aria-label"] for element in read.all("video"))


def test_every_film_is_in_the_page_whole(folder: pathlib.Path, read: Page) -> None:
    names = [*films.RACES, *(name for name in films.FILMS if name not in films.RACES), "paper/told"]
    assert [base64.b64decode(each.attributes["src"].partition(",")[2]) for each in read.all("source")] == [
        (folder / f"{name}.mp4").read_bytes() for name in names
    ]


def test_a_film_that_the_page_has_no_room_for_is_linked(folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "LIMIT", 1)
    read = Page.of(page.html(folder, pages.validation(), quick=False, not_drawn=""))
    assert len(read.all("source")) == len(films.FILMS)
    assert "paper/told.mp4" in [element.attributes["href"] for element in read.all("a")]


def test_a_plot_has_its_title_as_heading_opens_large_and_its_points_tell_what_they_are(read: Page) -> None:
    headings = [element.text for element in read.all("h3")]
    assert {"A plot of told", "A plot of error-frozen", "A plot of stability-solref"} <= set(headings)
    opened = [each.attributes for each in read.all("a") if each.attributes.get("class") == "plot"]
    assert all(each["href"] == f"#{each['id']}" for each in opened)
    assert [element.text for element in read.all("use")].count("a setting") == 4
    shown = page.Plot(
        "name", "title", '<svg viewBox="0 0 9 9"><g id="a"/><use href="#a" style="fill: url(#a)"/></svg>', 9
    )
    assert shown.inline.count("name-a") == 3


def test_the_plots_of_a_page_are_those_that_are_drawn_for_it(
    folder: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def draw(path: pathlib.Path) -> None:
        files.write(path.with_name(f"{path.name}.svg"), "")

    monkeypatch.setattr(work_precision, "draw", lambda study, path: draw(path))
    monkeypatch.setattr(stability_maps, "draw", lambda path, **_: draw(path))
    for plot in page.plots(tmp_path):
        plot.write()
    assert {each.name for each in tmp_path.iterdir()} == {each.name for each in (folder / "plots").iterdir()}


def test_a_plot_is_cut_below_its_title(tmp_path: pathlib.Path) -> None:
    (tmp_path / "told.svg").write_text(pages.PLOT.format("beer &amp; ice"))
    plot = page.Plot.of(tmp_path / "told.svg")
    assert (plot.title, plot.width) == ("A plot of beer & ice", 900)
    assert 'viewBox="0 23 900 277"' in plot.svg


def test_a_quick_page_has_no_films_of_stories_and_says_so(folder: pathlib.Path) -> None:
    text = page.html(folder, pages.validation(), quick=True, not_drawn="")
    assert len(Page.of(text).all("source")) == len(films.FILMS)
    assert "The films were left out of this quick report." in text
    assert "mjbeer report --quick" in re.sub("<[^>]*>", "", text)


def test_the_misprints_have_their_kinds_the_paper_s_words_and_the_numbers_of_the_findings(
    text: str, read: Page
) -> None:
    found = pages.validation().audit
    numbers = [float(element.attributes["value"]) for element in read.all("data")]
    assert numbers == [number for finding in found for number in (finding.values["printed"], finding.error)]
    told = [element.text for element in read.all("data")]
    assert told[:4] == ["1.3 %", "1.7\u2009·\u200910\N{MINUS SIGN}9", "2.5 %", "3.4\u2009·\u200910\N{MINUS SIGN}9"]
    kinds = [element.text for element in read.all("span") if element.attributes.get("class") == "kind"]
    assert kinds == [f"{each.kind} of {each.of}" if each.of else each.kind for each in MISPRINTS]
    assert "consequence of (39)" in kinds
    quotes = [row.quote for row in paper.claims() if row.misprint and row.quote]
    assert [element.text for element in read.all("blockquote")] == [f"“{quote}”" for quote in quotes]
    (found_line,) = (each.text for each in read.all("li") if "The audit measured" in each.text)
    assert " ".join(found_line.split()).startswith(
        "The audit measured 25 claims of the paper and corrected 25: 18 misprints, 4 consequences of another misprint, "
        "and 3 approximations"
    )


@pytest.mark.parametrize("misprint", MISPRINTS, ids=lambda misprint: misprint.about)
def test_formulas_are_mathml_with_what_differs_marked_and_nothing_left_of_latex(misprint: Misprint) -> None:
    assert misprint.printed != misprint.right
    for latex in (misprint.printed, misprint.right):
        assert not re.search("[<|>]", latex)
        assert Page.of(formulas.mathml(latex)).all("math")
        shown = re.sub("<[^>]*>", "", formulas.mathml(latex))
        assert not re.search(r"[\\{}_^]", shown)
    assert 'class="differs"' in formulas.mathml(misprint.right)


def test_a_formula_may_be_broken_between_its_terms() -> None:
    shown = Page.of(formulas.mathml(r"a+b\textcolor{differs}{-c}=-(d+\varphi)"))
    assert [element.text for element in shown.all("math")] == ["a", "+b", "−c", "=−(d", "+φ)"]


def test_letters_and_numbers_of_the_audit() -> None:
    assert formulas.letters("phi_0^2/8, (omega h)^4, sin(theta), alphabet") == "φ₀²/8, (ω h)⁴, sin(θ), alphabet"
    assert formulas.letters("u_ddot, phi_dot") == "u\N{COMBINING DIAERESIS}, φ\N{COMBINING DOT ABOVE}"
    assert [page.power(value) for value in (0.0, 0.01, 1e-12)] == ["0", "0.01", "10<sup>\N{MINUS SIGN}12</sup>"]
    assert [page.share(value) for value in (1.92, 0.0053)] == ["192 %", "0.53 %"]


def test_the_verdict_has_its_tables_and_what_failed(text: str, read: Page) -> None:
    (verdict,) = (element for element in read.all("p") if element.attributes.get("class", "").startswith("verdict"))
    assert verdict.text.startswith("1 of 2 checks and 25 of 25 claims of the paper passed")
    assert verdict.attributes["class"] == "verdict failed"
    assert {"fine", "a <stub>", "φ₀²"} <= {element.text for element in read.all("td")}
    assert [element.text for element in read.all("strong")] == ["FAILED:", "FAIL"]
    assert "a <stub>" not in text


def test_without_films_the_page_says_why(folder: pathlib.Path, tmp_path: pathlib.Path) -> None:
    folder = pathlib.Path(shutil.copytree(folder, tmp_path / "report", ignore=shutil.ignore_patterns("*.mp4")))
    read = Page.of(page.html(folder, pages.validation(), quick=False, not_drawn="not drawn because of <a test>"))
    assert not read.all("video")
    assert "They were not drawn because of <a test>." in "".join(element.text for element in read.all("p"))


@pytest.mark.parametrize("name", films.COMMANDS)
def test_the_command_under_a_film_draws_that_film(
    name: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = stubs.draw(monkeypatch)
    assert main([*shlex.split(films.COMMANDS[name])[1:], "--output", str(tmp_path / "film.mp4")]) == 0
    (call,) = calls
    drawn, film = call["trajectory"], films.FILMS[name]
    assert isinstance(film, Take)
    wanted = film.trajectory()
    assert call["speed"] == film.speed
    assert drawn.scene == wanted.scene
    assert drawn.time[-1] == wanted.time[-1]
    # The command has degrees to four decimals; a motion carries that difference on.
    assert drawn.phi[0] == pytest.approx(wanted.phi[0], abs=1e-6)
    assert abs(drawn.phi[-1] - wanted.phi[-1]) < 1e-3
