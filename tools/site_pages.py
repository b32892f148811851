"""What the site has besides the folder `docs/site/pages`: `mkdocs.yml` names this file as its hook.

Pages keep their paths in the checkout, so that a link leads to the same place as on a code host,
and what they link to comes with them. Formulas, written as code hosts read them, become MathML.
A page shows the films of the report, which are files beside it.
"""

import base64
import pathlib
import re
from collections.abc import Iterator

from latex2mathml.converter import convert
from markdown import Extension, Markdown
from markdown.inlinepatterns import InlineProcessor
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files, InclusionLevel

CHECKOUT = pathlib.Path(__file__).parents[1]
REPORT = CHECKOUT / "report"
PAGES = [
    *CHECKOUT.glob("*.md"),
    *sorted(CHECKOUT.glob("docs/*.md")),
    CHECKOUT / "mjcf/README.md",
    *sorted(CHECKOUT.glob("engines/*.md")),
]
LINK = re.compile(r"\]\((?!\w+:|#)(?P<path>[^)#\s]+)")
"""A link to a file."""
PROGRAM = re.compile(r"(\]\((?!\w+:)[^)#\s]+\.py)(?=[)#])")
"""A link to a program."""
FUNCTION = re.compile(r"<mi>(?=[a-z]{2})")
FILM = re.compile(
    r'<figure class="\w+" id="(?P<name>[\w-]+)">\s*<h3>(?P<title>[^<]*)</h3>'
    r"(?P<pictures>(?:(?!</figure>).)*<video.*?)<figcaption>(?P<caption>.*?)<p",
    re.DOTALL,
)
"""A film in the report."""
STILL = re.compile(r'poster="data:image/webp;base64,(?P<content>[^"]+)"')
"""The still of a film."""
RENDERED = re.compile(
    r"(?<!!)(?P<words>\[[^]!]*\]\((?:\.\./)*)renders/(?P<name>[\w-]+)\.webp(?=\))"
)
"""A link to a small copy of a film, which a code host can show."""


class Formula(InlineProcessor):
    """A formula in a line, between a dollar with a backtick and a backtick with a dollar."""

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[str, int, int]:  # noqa: N802
        """Return the MathML, and where the formula begins and ends."""
        return self.md.htmlStash.store(mathml(m[1])), m.start(), m.end()


class Formulas(Extension):
    """Formulas in lines, which are looked for before code in backticks."""

    def extendMarkdown(self, md: Markdown) -> None:  # noqa: N802
        """Add them to what Markdown reads."""
        md.inlinePatterns.register(Formula(r"\$`([^`]+)`\$", md), "formula", 195)


def display_formula(latex: str, *_: object, **__: object) -> str:
    """Return the MathML of a formula that stands by itself, its number apart."""
    shown = mathml(latex.replace(r"\tag", r"\qquad\tag"), display="block")
    return f'<div class="formula">{shown}</div>'


def mathml(latex: str, display: str = "inline") -> str:
    """Return the MathML of a formula; the names of functions are of the class "function"."""
    return FUNCTION.sub(r'<mi class="function">', convert(latex, display=display))


def on_config(config: MkDocsConfig) -> None:
    """Let formulas be read, and put every guide into the navigation."""
    config.markdown_extensions.append(Formulas())
    config.mdx_configs["pymdownx.superfences"] = {
        "custom_fences": [{"name": "math", "class": "math", "format": display_formula}]
    }
    guides = next(part["Guides"] for part in config.nav if "Guides" in part)
    named = str(config.nav)
    guides += [place(page) for page in PAGES if f"'{place(page)}'" not in named]


def on_files(files: Files, config: MkDocsConfig) -> None:
    """Add the pages, what they link to, the report, and its films."""
    linked = {(page.parent / path).resolve() for page in PAGES for path in links(page)}
    for path in sorted({*PAGES, *linked, *REPORT.glob("[!.]*")}):
        if path.suffix == ".py":
            page = f"# {path.name}\n\n````python\n{path.read_text(encoding='utf-8')}````\n"
            program = File.generated(config, f"{place(path)}.md", content=page)
            program.inclusion = InclusionLevel.NOT_IN_NAV
            files.append(program)
        elif path.is_file():
            files.append(File.generated(config, place(path), abs_src_path=str(path)))
    for path, content in films():
        files.append(File.generated(config, path, content=content))


def on_page_markdown(markdown: str, **_: object) -> str:
    """Let a link to a program lead to its page, and one to a small copy of a film to the film."""
    markdown = RENDERED.sub(r"\g<words>films.md#\g<name>", markdown)
    return PROGRAM.sub(r"\1.md", markdown)


def place(path: pathlib.Path) -> str:
    """Return a path as it is in the checkout."""
    return path.relative_to(CHECKOUT).as_posix()


def links(page: pathlib.Path) -> list[str]:
    """Return the relative links of a page, without anchors."""
    return LINK.findall(page.read_text(encoding="utf-8"))


def films() -> Iterator[tuple[str, str | bytes]]:
    """Yield the stills of the films, and the page that shows the films."""
    page = ["# Films", "Each film is a file with its name, for a lecture to take."]
    for film in FILM.finditer((REPORT / "index.html").read_text(encoding="utf-8")):
        name = film["name"]
        for still in STILL.finditer(film["pictures"]):
            yield f"films/{name}.webp", base64.b64decode(still["content"])
        page += [
            f'<span id="{name}"></span>',
            f"## {film['title']}",
            f'<video controls preload="none" src="report/{name}.mp4" poster="films/{name}.webp">'
            "</video>",
            f"[{name}.mp4](report/{name}.mp4): {film['caption']}",
        ]
    yield "films.md", "\n\n".join(page)
