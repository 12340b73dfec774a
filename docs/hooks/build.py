"""What mkdocs calls while it builds the site: generated pages, pictures, names of files over examples."""

import re
import sys
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

sys.path.insert(0, str(Path(__file__).parent))

import gallery
import reference

_TITLED = re.compile(r"^<!-- file: (\S+) -->\n(`{3,})(\w+)$", re.MULTILINE)
_ROOT = Path(__file__).parents[2]
_OF_ROOT = {"SECURITY.md": "security.md", "CHANGELOG.md": "changelog.md"}
"""Files beside the docs that are pages of the site, too."""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put what is generated besides, such as a page for each domain, at the end of the reference."""
    section = next(entry["Reference"] for entry in config.nav or [] if "Reference" in entry)
    section += [page for page in reference.pages() if page not in section]
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add what is made by the program: the reference, and a gallery of runs."""
    made: dict[str, str | bytes] = {**reference.pages(), **gallery.files()}
    made |= {page: (_ROOT / name).read_text(encoding="utf-8") for name, page in _OF_ROOT.items()}
    for name, content in made.items():
        files.append(File.generated(config, name, content=content))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Show the name of a file over its text, where examples write one; lead to pages instead of files."""
    for name, own in _OF_ROOT.items():
        markdown = markdown.replace(f"](../../{name})", f"](../{own})")
    if page.file.src_uri in _OF_ROOT.values():
        markdown = markdown.replace("](docs/", "](")
    return _TITLED.sub(r'\2\3 title="\1"', markdown)
