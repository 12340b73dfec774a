"""The documentation as a site: built strictly, complete, without a broken link or a request to elsewhere."""

import functools
import os
import subprocess
import sys
import threading
from html.parser import HTMLParser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import unquote, urljoin, urlsplit

import pytest

from browser import needs_chromium, visiting

ROOT = Path(__file__).parents[2]
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("site")]


class Links(HTMLParser):
    """Where a page leads, what it loads, and which names its parts have."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loads, self.names = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.names |= {attributes[key] for key in ("id", "name") if attributes.get(key)}
        if tag == "a" and attributes.get("href"):
            self.links.append(attributes["href"])
        elif tag in ("img", "script", "iframe") and attributes.get("src"):
            self.loads.append(attributes["src"])
        elif tag == "link" and attributes.get("rel") in ("stylesheet", "icon", "preconnect"):
            self.loads.append(attributes["href"])


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The built site; a warning is an error."""
    target = tmp_path_factory.mktemp("site")
    # Not --quiet: it would hide warnings from --strict as well.
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "-d", str(target)]
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300, env=environment)
    assert done.returncode == 0, done.stderr
    return target


@pytest.fixture(scope="module")
def address(site):
    """A server of the site on this machine."""

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, *args):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(site)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()
    server.server_close()


def pages_of(site):
    return sorted(path for path in site.rglob("*.html") if path.name != "404.html")


def place(site, page, link):
    """The file that a relative link leads to."""
    path = unquote(urlsplit(urljoin(f"/{page.relative_to(site).as_posix()}", link)).path)
    found = site / path.lstrip("/")
    return found / "index.html" if found.is_dir() else found


def test_no_link_is_broken_and_nothing_is_loaded_from_elsewhere(site):
    seen = {page: Links(page.read_text(encoding="utf-8")) for page in pages_of(site)}
    assert len(seen) > 25
    for page, found in seen.items():
        for link in [*found.links, *found.loads]:
            parts = urlsplit(link)
            if parts.scheme == "data" or (parts.scheme and link in found.links):
                continue  # a picture within the page, or a way out of the site
            assert not parts.netloc, f"{page} loads {link}"
            target = place(site, page, link)
            assert target.is_file(), f"{page} leads to {link}"
            if parts.fragment and target in seen:
                assert unquote(parts.fragment) in seen[target].names, f"{page} leads to {link}"


@needs_chromium
def test_a_browser_opens_every_page_and_asks_nobody_else(site, address):
    with visiting() as open_page:
        for page in pages_of(site):
            visit = open_page(urljoin(address, page.relative_to(site).as_posix()))
            foreign = [url for url in visit.requests if not url.startswith((address, "data:", "blob:"))]
            assert (foreign, visit.complaints) == ([], []), page
            widths = visit.page.eval_on_selector_all("article img", "all => all.map(one => one.naturalWidth)")
            assert 0 not in widths, f"{page} has a picture that does not show"
            visit.page.close()


@needs_chromium
def test_the_search_finds_something_without_asking_elsewhere(address):
    with visiting() as open_page:
        visit = open_page(address)
        visit.page.get_by_role("textbox", name="Search").press_sequentially("backtracking")
        visit.page.wait_for_selector(".md-search-result__item", timeout=20000)
        assert not [url for url in visit.requests if not url.startswith((address, "data:", "blob:"))]
