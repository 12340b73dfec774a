"""Pages in headless Chromium: what they ask for, what they complain of, how they look."""

import shutil
from contextlib import contextmanager
from dataclasses import dataclass, field

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]
needs_chromium = pytest.mark.skipif(
    CHROMIUM is None, reason="Chromium is not installed (apt-get install chromium), so no page can be opened"
)


@dataclass
class Visit:
    """A page that is open, and what was heard of it."""

    page: object
    requests: list = field(default_factory=list)
    complaints: list = field(default_factory=list)
    """Messages of the console, errors of scripts, requests that failed."""


@contextmanager
def visiting():
    """Gives a function that opens an address; every page of it has a visit of its own."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)

        def open_page(address):
            visit = Visit(browser.new_page(viewport={"width": 1100, "height": 900}))
            visit.page.on("request", lambda request: visit.requests.append(request.url))
            visit.page.on("requestfailed", lambda request: visit.complaints.append(request.url))
            visit.page.on("console", lambda message: visit.complaints.append(message.text))
            visit.page.on("pageerror", lambda error: visit.complaints.append(str(error)))
            visit.page.goto(address, wait_until="load")
            return visit

        try:
            yield open_page
        finally:
            browser.close()
