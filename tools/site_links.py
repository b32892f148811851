"""Looks for what is broken in a folder of HTML pages: `python tools/site_links.py FOLDER`.

Broken is a link or a picture that leads to no file, an anchor that its page has not, and whatever
is loaded from another host. A link to another host is followed by a reader alone, and not tried.
"""

import pathlib
import re
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from typing import NamedTuple
from urllib.parse import unquote, urlsplit

ADDRESSES = ("href", "src", "poster", "data", "srcset", "xlink:href")
LOADED_BY_STYLE = re.compile(r"""(?:url\(|@import)\s*["']?(?P<address>(?:https?:)?//[^"')\s]+)""")
ONLY_NAMED = ("a", "link rel=canonical")
"""Elements that load nothing from the address they have."""


NOT_FOUND = "404.html"
"""The page that a host shows for any address: it cannot say where another page is from there."""
SETTING = re.compile(r"[\w-]+=")
"""What stands in place of an anchor where a script of the page reads it."""


class Reference(NamedTuple):
    """An address in a page."""

    element: str
    address: str


class Page(HTMLParser):
    """What a page refers to, and the anchors that it has."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.references: list[Reference] = []
        self.anchors = {"", "top"}
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note the addresses and the anchor of an element."""
        values = {name: value or "" for name, value in attrs}
        element = f"{tag} rel={values['rel']}" if "rel" in values and tag == "link" else tag
        self.anchors |= {values.get("id", ""), values.get("name", "")}
        for name in ADDRESSES:
            if name in values:
                self.references.append(Reference(element, values[name]))


def broken(folder: pathlib.Path) -> Iterator[str]:
    """Yield a line for everything that is broken in the pages and the styles of a folder."""
    pages = {}
    for path in sorted(folder.rglob("*.html")):
        if path.name == NOT_FOUND:
            continue
        pages[path.resolve()] = Page(path.read_text(encoding="utf-8"))
    for path, page in pages.items():
        for reference in page.references:
            reason = fault(reference, path, pages)
            if reason:
                place = path.relative_to(folder.resolve())
                yield f"{place}: <{reference.element}> {reference.address} {reason}"
    for path in sorted([*folder.rglob("*.html"), *folder.rglob("*.css")]):
        for address in LOADED_BY_STYLE.findall(path.read_text(encoding="utf-8")):
            yield f"{path.relative_to(folder)}: a style loads {address} from another host"


def fault(reference: Reference, page: pathlib.Path, pages: dict[pathlib.Path, Page]) -> str:
    """Return what is wrong with a reference of a page, or ""."""
    address = urlsplit(reference.address)
    if address.netloc:
        return "" if reference.element in ONLY_NAMED else "is loaded from another host"
    if address.scheme:
        return ""
    if address.path.startswith("/"):
        return "leads nowhere where the folder is not the whole of a host"
    path = (page.parent / unquote(address.path)).resolve() if address.path else page
    path = path / "index.html" if path.is_dir() else path
    if not path.is_file():
        return "leads to no file"
    if path in pages and not SETTING.match(address.fragment):
        return "" if unquote(address.fragment) in pages[path].anchors else "leads to no anchor"
    return ""


if __name__ == "__main__":
    checked = pathlib.Path(sys.argv[1])
    faults = list(broken(checked))
    print(*faults, sep="\n")
    number = len(list(checked.rglob("*.html")))
    sys.exit(f"{len(faults)} faults in {number} pages" if faults or not number else 0)
