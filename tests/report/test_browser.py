"""The page in a real browser: films play, plots open, nothing is cut off or fetched, and everyone can read it."""

from collections.abc import Generator
from dataclasses import dataclass, field

import pytest
from playwright.sync_api import Browser, Page

from mjbeer.report import films, page
from tests.support import browser, pages

pytestmark = [pytest.mark.costly, pytest.mark.browses]

PHONE, LAPTOP, PROJECTOR = 360, 1000, 1600
"""Widths of screens [pixels]: the narrowest, one on which two columns just fit, and the widest."""
LONGEST = slice(15, 19)
"""Those of the misprints that have the longest formulas, eqs. (39) to (49)."""
CUT = """[...document.querySelectorAll('body *')].filter(each => !each.closest('.scroll, .skip, .close, .plot > *') && (
each.getBoundingClientRect().right > innerWidth + 1 ||
each.matches('dd, dl > div, p, li, summary, figcaption') && each.clientWidth && each.scrollWidth > each.clientWidth + 1
)).map(each => each.outerHTML.slice(0, 80))"""
"""What sticks out of the screen or of its box; tables and plots may be wider than theirs, in which they are moved."""


@dataclass
class Visit:
    """The page as it is open in the browser, with all that it asked for and all that went wrong."""

    page: Page
    asked: list[str] = field(default_factory=list)
    said: list[str] = field(default_factory=list)


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Where the page is, with films of a second, and with a few misprints: axe-core looks at every letter for long."""
    folder = tmp_path_factory.mktemp("report")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mjbeer.paper.stories.STORIES", pages.stories())
        pages.fill(folder, encoded=True)
        text = page.html(folder, pages.validation(LONGEST), quick=False, not_drawn="")
    (folder / "index.html").write_text(text)
    return (folder / "index.html").as_uri()


@pytest.fixture(scope="module")
def chromium() -> Generator[Browser]:
    with browser.chromium() as started:
        yield started


@pytest.fixture
def visit(chromium: Browser, address: str, request: pytest.FixtureRequest) -> Generator[Visit]:
    """The page, opened in a window of the width and the colours that a test asks for; at the end nothing was amiss."""
    width, colours = getattr(request, "param", (PROJECTOR, "light"))
    context = chromium.new_context(viewport={"width": width, "height": 900}, color_scheme=colours)
    context.set_default_timeout(600_000)  # only a guard: how long the machine takes is not tested
    visit = Visit(context.new_page())
    visit.page.on("request", lambda asked: visit.asked.append(asked.url))
    visit.page.on("console", lambda message: visit.said.append(message.text))
    visit.page.on("pageerror", lambda error: visit.said.append(str(error)))
    visit.page.goto(address)
    yield visit
    assert {each.partition("#")[0] for each in visit.asked if not each.startswith("data:")} == {address}
    assert not visit.said
    context.close()


def test_every_film_plays(visit: Visit) -> None:
    count = visit.page.locator("video").count()
    assert count == len(films.FILMS) + 1  # with the story
    for place in range(count):
        film = visit.page.locator("video").nth(place)
        film.scroll_into_view_if_needed()
        assert film.evaluate("film => film.paused")
        film.evaluate("film => { film.muted = true; film.play().catch(() => {}); }")  # it may never say that it cannot
        visit.page.wait_for_function("film => film.currentTime > 0.2", arg=film.element_handle())
        assert film.evaluate("film => [film.videoWidth, film.duration]") == [pages.SIZE[0], pytest.approx(1, abs=0.1)]


def test_a_plot_opens_over_the_whole_screen_and_closes_by_keyboard_as_well(visit: Visit) -> None:
    plot, box = visit.page.locator("#large-told"), {"x": 0, "y": 0, "width": PROJECTOR, "height": 900}
    plot.focus()
    visit.page.keyboard.press("Enter")
    assert plot.bounding_box() == box
    visit.page.keyboard.press("Tab")
    visit.page.keyboard.press("Enter")
    assert plot.bounding_box() != box
    visit.page.locator("#large-error-frozen").click()
    assert visit.page.locator("#large-error-frozen").bounding_box() == box


def test_the_keyboard_reaches_the_content(visit: Visit) -> None:
    visit.page.keyboard.press("Tab")
    assert visit.page.evaluate("document.activeElement.className") == "skip"
    visit.page.keyboard.press("Enter")
    assert visit.page.evaluate("document.activeElement.id") == "content"


@pytest.mark.parametrize("visit", [(width, "light") for width in (PHONE, LAPTOP, PROJECTOR)], indirect=True)
def test_nothing_is_cut_off(visit: Visit) -> None:
    visit.page.evaluate("for (const each of document.querySelectorAll('details')) each.open = true")
    assert visit.page.evaluate("document.documentElement.scrollWidth") <= visit.page.evaluate("innerWidth")
    assert not visit.page.evaluate(CUT)


@pytest.mark.parametrize("visit", [(PHONE, "light"), (PROJECTOR, "dark")], indirect=True)
def test_axe_finds_nothing(visit: Visit) -> None:
    """Among its rules are contrast, names of controls, the order of headings, and landmarks."""
    visit.page.evaluate("for (const each of document.querySelectorAll('details')) each.open = true")
    visit.page.evaluate(browser.AXE.read_text())
    found = visit.page.evaluate("axe.run({resultTypes: ['violations']})")
    assert {rule["id"] for rule in found["passes"]} >= {"color-contrast", "heading-order", "image-alt", "region"}
    assert not [(rule["id"], node["html"][:120]) for rule in found["violations"] for node in rule["nodes"]]
