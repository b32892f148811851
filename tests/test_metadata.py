"""What is said of the package in several places is the same in all of them."""

import pathlib
import re
import tomllib

CHECKOUT = pathlib.Path(__file__).parents[1]
PROJECT = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]
CITATION = (CHECKOUT / "CITATION.cff").read_text()
CONTRIBUTING = (CHECKOUT / "CONTRIBUTING.md").read_text()
ARCHITECTURE = (CHECKOUT / "docs" / "architecture.md").read_text()


def cited(key: str) -> str:
    """The value of a key at the top of the citation file, which is written without quotes."""
    (value,) = re.findall(rf"^{key}: (.*)$", CITATION, re.MULTILINE)
    return value


def test_the_citation_is_that_of_this_version() -> None:
    assert cited("title") == PROJECT["name"]
    assert cited("version") == PROJECT["version"]
    assert cited("license") == PROJECT["license"]
    assert cited("abstract") == f"{PROJECT['description']}."
    assert re.findall(r"^authors:\n((?:  - .*\n)*)", CITATION, re.MULTILINE) == [
        "".join(f"  - name: {author['name']}\n" for author in PROJECT["authors"])
    ]


def test_the_newest_entry_of_the_changelog_is_this_version() -> None:
    newest = re.search(r"^## (\S+)", (CHECKOUT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert newest
    assert newest[1] == PROJECT["version"]


def test_the_ten_words_are_those_of_the_architecture() -> None:
    words = re.findall(r"^\| ([A-Z]\w+) \| ", ARCHITECTURE.partition("## Ten words")[2], re.MULTILINE)
    assert len(words) == 10
    assert f"each: {', '.join(words)}." in CONTRIBUTING
