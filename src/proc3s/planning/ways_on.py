"""What to type where there is no answer to a goal: commands that repeat a run and get one elsewhere."""

import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from proc3s.errors import UsageError
from proc3s.planning.options import RunOptions, all_options
from proc3s.plugins.registry import Registry
from proc3s.specs.parts import LLMSpec, MethodSpec

_GOAL = "Say here what is to be done."


def no_bundled_answer(registry: Registry, options: RunOptions) -> UsageError:
    """The error of a run whose goal is the user's own, and whose LLM has bundled answers only."""
    instruction = registry.task(options.task)[1].instruction
    why = "fit the task's own sentence only" if instruction else "fit tasks with a sentence of their own only"
    return UsageError(
        f"no answer is bundled for {options.task} with a --goal of your own:\n"
        f"bundled answers {why}. Go on in one of these ways:\n{_listed(registry, options)}"
    )


def goal_missing(registry: Registry, options: RunOptions) -> UsageError:
    """The error of a task that has no instruction, where no goal is given."""
    example = options.model_copy(update={"goal": _GOAL})
    return UsageError(
        f"{options.task} has no instruction of its own; give one with --goal,\n"
        f"in one of these ways:\n{_listed(registry, example)}"
    )


def _listed(registry: Registry, options: RunOptions) -> str:
    ways = _ways(registry, options)
    return "\n".join("\n    ".join([f"- {way}:", *commands]) for way, commands in ways)


def _ways(registry: Registry, options: RunOptions) -> Iterator[tuple[str, list[str]]]:
    """In words, and as commands that run as they are printed."""
    for spec in registry.all(LLMSpec).values():
        if spec.example:
            yield "ask a model, with its key in the environment", [command("run", options, spec.example)]
    yield "be the model: read prompts and write answers", [command("run", options, "manual:answers")]
    answer, example = _bundled(registry, options)
    begun = answer or example
    copied = [shlex.join(["cp", str(begun), "program.md"])] if begun else []
    solve = f"{command('solve', options)} --sketch program.md"
    yield (
        "write the program, beginning with one that is there" if begun else "write program.md",
        [*copied, solve],
    )
    if answer:
        yield "leave --goal away", [command("run", options.model_copy(update={"goal": None}))]


def _bundled(registry: Registry, options: RunOptions) -> tuple[Path | None, Path | None]:
    """The bundled answer to the task, and a program that answers an example of the domain, if there are."""
    domain, task = registry.task(options.task)
    method, folder = registry.get(MethodSpec, options.method), domain.spec.folder or Path()
    answers = [f"{task.name}.{method.template}{seed}.md" for seed in (f".seed{options.seed}", "")]
    examples = [f"{name}.{method.answer}.md" for name in domain.spec.examples]
    return _first(folder / "answers", answers), _first(folder / "examples", examples)


def _first(folder: Path, names: Sequence[str]) -> Path | None:
    return next((folder / name for name in names if (folder / name).is_file()), None)


def command(verb: str, options: RunOptions, llm: str | None = None) -> str:
    """`proc3s VERB TASK` with the options that were given, and another LLM."""
    changed = options.model_copy(update={"llm": llm, "llm_options": {}, "goal": None})
    words = ["proc3s", verb, options.task, *(["--goal", options.goal] if options.goal else [])]
    for name, option in all_options().items():
        owner: Any = changed if name in RunOptions.model_fields else changed.budget
        value = getattr(owner, name)
        if value != option.field.get_default(call_default_factory=True) and not (
            verb == "solve" and option.shown.asks
        ):
            words += _words(option.flag, value)
    return shlex.join(words)


def _words(flag: str, value: Any) -> Iterator[str]:
    if isinstance(value, bool):
        yield flag if value else f"--no-{flag.removeprefix('--')}"
        return
    pairs = [f"{key}={each}" for key, each in value.items()] if isinstance(value, dict) else None
    for each in pairs or (value if isinstance(value, tuple) else [value]):
        yield from (flag, str(near(each) if isinstance(each, Path) else each))


def near(path: Path) -> Path:
    """A path as one types it: from the working directory, if it is below that."""
    return path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path
