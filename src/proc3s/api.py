"""proc3s from Python: `run`, `solve`, `load_run`, `render_prompt`, `tasks`, `get_domain`.

Nothing is printed and nothing exits; mistakes raise the errors of `proc3s` (UsageError, SpecError, LLMError),
and what was given but changes nothing is a warning of Python's.
Where the command line takes a name, an object of your own may stand.
"""

import tempfile
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

from proc3s.domain.domain import Domain
from proc3s.errors import UsageError
from proc3s.llm.config import choose_llm
from proc3s.llm.function import AskFunction, FunctionLLM
from proc3s.llm.types import LLM, Message
from proc3s.planning.options import DEFAULT_PRESET, RunOptions, run_options
from proc3s.planning.own_templates import unused_templates
from proc3s.planning.session import Given, Job, Session
from proc3s.planning.setup import first_messages
from proc3s.plugins.given_parts import GivenParts
from proc3s.plugins.registry import Registry, open_registry
from proc3s.reporting.progress import SearchProgress
from proc3s.result import Result
from proc3s.runs.events import Emit
from proc3s.runs.newest import newest_run
from proc3s.search.solver import Solver
from proc3s.specs.base import Spec
from proc3s.specs.domain import DomainSpec
from proc3s.specs.parts import LLMSpec, SolverSpec

AnyLLM: TypeAlias = str | LLM | AskFunction
AnySolver: TypeAlias = str | Callable[..., Solver]
Plugins: TypeAlias = Sequence[Path | str]


def run(
    task: str,
    *,
    llm: AnyLLM | None = None,
    method: str = "proc3s",
    solver: AnySolver | None = None,
    improver: AnySolver | None = None,
    preset: str = DEFAULT_PRESET,
    seed: int = 0,
    goal: str | None = None,
    jobs: int = 1,
    domain: DomainSpec | None = None,
    plugins: Plugins = (),
    out: Path | str | None = None,
    on_event: Emit | None = None,
    progress: bool = False,
    **options: Any,
) -> Result:
    """Both stages: ask the LLM for a program, search its numbers, execute the plan, judge the result.

    `options` are the further fields of `RunOptions`, e.g. `samples=500`, `llm_options={"temperature": 0.2}`.
    The run folder is `out`, else a temporary one that goes with the result. Raises UsageError, SpecError or
    LLMError for what is wrong before the run begins; what ends it later is the result's `error`.
    """
    given = dict(task=task, method=method, preset=preset, seed=seed, goal=goal, jobs=jobs, **options)
    registry = _registry(plugins, domain, llm, solver, improver)
    chosen = choose_llm(_name(llm), given.get("llm_options", {}))
    given |= {"llm": chosen.name, "llm_options": dict(chosen.options)}
    given |= {"solver": _name(solver), "improver": _name(improver)}
    return _carry_out(Job(_options(given, plugins)), registry, out, on_event, progress)


def solve(
    task: str,
    program: str,
    *,
    method: str = "proc3s",
    solver: AnySolver | None = None,
    improver: AnySolver | None = None,
    preset: str = DEFAULT_PRESET,
    seed: int = 0,
    goal: str | None = None,
    jobs: int = 1,
    domain: DomainSpec | None = None,
    plugins: Plugins = (),
    out: Path | str | None = None,
    on_event: Emit | None = None,
    progress: bool = False,
    **options: Any,
) -> Result:
    """The second stage only: search the numbers of a program (its text). Asks no LLM; else as `run`."""
    if "\n" not in program.strip() and "gen_plan" not in program:
        raise UsageError(f"a program is given as its text, not as {program!r}; read the file first")
    given = dict(task=task, method=method, preset=preset, seed=seed, goal=goal, jobs=jobs, **options)
    registry = _registry(plugins, domain, None, solver, improver)
    given |= {"solver": _name(solver), "improver": _name(improver)}
    job = Job(_options(given, plugins), given=Given(program))
    return _carry_out(job, registry, out, on_event, progress)


def load_run(
    path: Path | str | None = None, *, domain: DomainSpec | None = None, plugins: Plugins | None = None
) -> Result:
    """The result that a run folder tells, by default the newest in `runs`. Raises UsageError if it is none.

    Its states are computed anew: give the `domain` if it was an object, `plugins` if they lie elsewhere now.
    """
    given = domain is not None or plugins is not None
    return Result(
        newest_run() if path is None else Path(path),
        _registry(plugins or (), domain, None, None) if given else None,
    )


def render_prompt(
    task: str,
    *,
    method: str = "proc3s",
    preset: str = DEFAULT_PRESET,
    seed: int = 0,
    goal: str | None = None,
    domain: DomainSpec | None = None,
    plugins: Plugins = (),
    **options: Any,
) -> tuple[Message, ...]:
    """The messages that an LLM would be asked first. Asks nobody."""
    given = dict(task=task, method=method, preset=preset, seed=seed, goal=goal, **options)
    registry, wanted = _registry(plugins, domain, None, None), _options(given, plugins)
    messages = first_messages(registry, wanted)
    _warn(unused_templates(registry, wanted.template_dir))
    return messages


def tasks(plugins: Plugins = ()) -> list[str]:
    """The names `domain/task` of all tasks that are installed."""
    domains = open_registry(_paths(plugins)).all(DomainSpec).values()
    return [f"{domain.name}/{task}" for domain in domains for task in domain.tasks]


def get_domain(name: str, plugins: Plugins = ()) -> Domain:
    """A domain with everything that plugins attach to it; its `spec` is what `domain.yaml` says."""
    return open_registry(_paths(plugins)).domain(name)


def _paths(plugins: Plugins) -> list[Path]:
    return [Path(path).absolute() for path in plugins]


def _options(given: dict[str, Any], plugins: Plugins) -> RunOptions:
    return run_options(**{**given, "plugins": _paths(plugins)})


def _name(part: object) -> str | None:
    """What the options of a run call a part: objects have a name, too."""
    if part is None or isinstance(part, str):
        return part
    name = getattr(part, "__name__", type(part).__name__)
    return name if name.isidentifier() else "given"


def _registry(
    plugins: Plugins,
    domain: DomainSpec | None,
    llm: AnyLLM | None,
    solver: AnySolver | None,
    improver: AnySolver | None = None,
) -> Registry:
    """The registry of what is installed, and of the objects that were given."""
    given: list[Spec] = [domain] if domain else []
    for part, what in ((solver, "a solver"), (improver, "an improver"), (llm, "a language model")):
        if part is not None and not isinstance(part, str | LLM) and not callable(part):
            raise UsageError(f"{what} is given by name, as a class or as a function, not as {part!r}")
    for make, objective in ((solver, "progress"), (improver, "room")):
        if make is not None and not isinstance(make, str):
            spec = {"name": _name(make), "target": make, "objective": objective}
            given.append(SolverSpec.model_validate({**spec, "summary": "given in Python"}))
    if llm is not None and not isinstance(llm, str):
        name = _name(llm) or ""
        asked = llm if isinstance(llm, LLM) else FunctionLLM(llm, name)
        given.append(
            LLMSpec(name=name, target=lambda model, options: asked, summary="given in Python", usage=name)
        )
    return open_registry(_paths(plugins), [GivenParts(given)] if given else [])


def _carry_out(
    job: Job, registry: Registry, out: Path | str | None, on_event: Emit | None, progress: bool
) -> Result:
    folder = tempfile.TemporaryDirectory(prefix="proc3s_run_") if out is None else None
    path = Path(folder.name) / "run" if folder else Path(out or "")
    session = Session(Job(job.options, path, job.given), [on_event] if on_event else [], registry)
    _warn(session.notices, above=1)
    with _shown(session, progress):
        ended = session.run()
    return Result(path, registry, ended.summary, folder)


def _warn(notices: Iterable[str], above: int = 0) -> None:
    """Python's warning for each, at the line that called the public function, so many calls further up."""
    for notice in notices:
        warnings.warn(notice, stacklevel=3 + above)


@contextmanager
def _shown(session: Session, progress: bool) -> Iterator[None]:
    if not progress:
        yield
        return
    with SearchProgress(session.samples) as bar:
        session.listen(bar.update)
        yield
