"""The long description of the package: the README, so that it can also be read apart from the checkout.

A package index shows the text alone: what the README links to by a relative path is not there.
"""

import pathlib
import re

from hatchling.metadata.plugin.interface import MetadataHookInterface

_RELATIVE = re.compile(r"(?P<image>!?)\[(?P<text>[^]]*)\]\((?![a-z]+:|#)(?P<path>[^)\s]+)\)")
"""A link to a file of the checkout, or a picture from it."""
_NOTE = "*The pictures, the documents and the Makefile that this text names are in the source distribution.*"


class LongDescription(MetadataHookInterface):
    """The hook that hatchling calls for each field of the metadata that `pyproject.toml` calls dynamic."""

    def update(self, metadata: dict) -> None:
        """Add the long description to the metadata of the project."""
        readme = pathlib.Path(self.root, "README.md").read_text(encoding="utf-8")
        text = long_description(readme, metadata.get("urls", {}).get("Repository"))
        metadata["readme"] = {"content-type": "text/markdown", "text": text}


def long_description(readme: str, repository: str | None) -> str:
    """Return the README without relative links.

    Each link leads into the `repository` on GitHub. Where that has no public address, None, the file is named instead.
    """
    if repository is None:
        title, rest = readme.split("\n", maxsplit=1)
        return f"{title}\n\n{_NOTE}\n" + _RELATIVE.sub(r"\g<text> [`\g<path>`]", rest)

    def absolute(link: re.Match[str]) -> str:
        view = "raw" if link["image"] else "blob"
        return (
            f"{link['image']}[{link['text']}]({repository.rstrip('/')}/{view}/HEAD/{link['path']})"
        )

    return _RELATIVE.sub(absolute, readme)
