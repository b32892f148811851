"""A real browser without a window, which may ask for nothing but the page."""

import pathlib
import shutil
from collections.abc import Generator
from contextlib import contextmanager

import axe_playwright_python
from playwright.sync_api import Browser, sync_playwright

AXE = pathlib.Path(axe_playwright_python.__file__).with_name("axe.min.js")
"""The rules of accessibility of axe-core."""
_FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


def program() -> str | None:
    """The Chromium that is installed here, or None."""
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def problem() -> str | None:
    """Why there is no browser here, or None if there is one."""
    return (
        None if program() else "no Chromium; on Debian this installs it: apt-get update && apt-get install -y chromium"
    )


@contextmanager
def chromium() -> Generator[Browser]:
    """Start Chromium, and end it with the block."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program(), args=[*_FLAGS])
        try:
            yield browser
        finally:
            browser.close()
