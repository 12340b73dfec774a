"""Blocks of the docs that are no commands: they are part of an example that runs, or they are valid."""

import re
import shlex
import tomllib
from pathlib import Path

import pytest
import typer
import yaml
from pydantic import TypeAdapter

from proc3s.cli import app
from proc3s.specs.domain import ConstraintSpec, DomainSpec, SkillSpec
from proc3s_tabletop.catalogue.body_specs import SHAPES

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(
    r"(?:<!-- file: (?P<file>\S+) -->\n)?^(?P<fence>`{3,})(?P<language>\w*)\n(?P<body>.*?)^(?P=fence)$",
    re.MULTILINE | re.DOTALL,
)
LANGUAGES = {"console", "sh", "text", "python", "yaml", "toml", "json", "jinja", "markdown"}
_PART = {"skills": SkillSpec, "constraints": ConstraintSpec}


def blocks(page):
    return list(BLOCK.finditer(page.read_text(encoding="utf-8")))


def check_yaml(body):
    """A whole domain, or parts of one; bodies are what the table-top takes."""
    data = yaml.safe_load(body)
    if "spec_version" in data:
        DomainSpec.model_validate(data)
        return
    for key, value in data.items():
        if key == "bodies":
            for body_spec in value.values():
                SHAPES[body_spec["shape"]].model_validate(body_spec)
            continue
        assert key in DomainSpec.model_fields, f"{key} is no key of a domain.yaml"
        if key in _PART:
            TypeAdapter(dict[str, _PART[key]]).validate_python(value)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_block_is_of_a_language_that_is_checked(page):
    assert {block["language"] for block in blocks(page)} <= LANGUAGES


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_blocks_of_python_and_data_are_valid(page):
    for block in blocks(page):
        body = block["body"]
        if block["language"] == "python":
            compile(body, str(page), "exec")
            assert block["file"], "Python that no example writes to a file does not run"
        elif block["language"] == "yaml" and not block["file"]:  # a file is read by the commands of its page
            check_yaml(body)
        elif block["language"] == "toml":
            tomllib.loads(body)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_files_of_a_page_are_used_by_its_commands(page):
    found = blocks(page)
    for block in found:
        if block["file"] and Path(block["file"]).name != "proc3s.toml":
            name = Path(block["file"])
            others = "\n".join(other["body"] for other in found if other.start() != block.start())
            known = (name.name, name.stem, *(part for part in (name.parent.name,) if part))
            assert any(part in others for part in known), f"no command reads {name}"


def command_of(words):
    """The command that the first words name, and the words after them."""
    command = typer.main.get_command(app)
    while hasattr(command, "commands") and words:
        _, command, words = command.resolve_command(typer.Context(command), words)
    return command, words


def understood(words):
    """Whether the command line takes these words: its commands, options and how many arguments."""
    command, rest = command_of(words)
    command.make_context("", rest)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_that_need_a_model_are_understood(page):
    for block in blocks(page):
        if block["language"] == "sh":
            for command in re.findall(r"^(?:.* && )?proc3s (.*)$", block["body"], re.MULTILINE):
                understood(shlex.split(command, comments=True))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_and_options_in_the_text_exist(page):
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    for mention in re.findall(r"`proc3s ([a-z][^`]*)`", text):
        command, words = command_of(mention.split())
        options = {name for param in command.params for name in param.opts}
        assert {word for word in words if word.startswith("-")} <= options, mention
