"""Two suites side by side: what the same tasks and seeds came to in both."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import TypeAlias

from proc3s.errors import UsageError
from proc3s.suites.outcomes import ALWAYS, FINISHED, UNFINISHED
from proc3s.suites.results import Result, Results
from proc3s.suites.statistics import Estimate, paired_means, paired_proportions
from proc3s.suites.tables import SuiteTable

Pair: TypeAlias = tuple[Result, Result]
Key: TypeAlias = tuple[str, ...]

FIGURES: tuple[tuple[str, Callable[[Result], float | None]], ...] = (
    ("samples", lambda r: r.episode.samples),
    ("search, s", lambda r: r.episode.seconds.get("solve")),
    ("total, s", lambda r: r.episode.seconds.get("total")),
    ("rounds", lambda r: r.episode.rounds),
)
"""What is compared beside success, and where it stands in a result."""


def comparison(first: Results, second: Results) -> SuiteTable:
    """The second less the first, paired by task, method and seed, for every task and for all together.

    Where each suite has one method or one preset, and another one, these are what is compared, and do not
    count for the pairs. Raises UsageError if the two have no episode in common.
    """
    apart = tuple(name for name in ("method", "preset") if _compared(first, second, name))
    known = {_key(r, apart): r for r in first.all}
    pairs = [(known[_key(r, apart)], r) for r in second.all if _key(r, apart) in known]
    if not pairs:
        raise UsageError("these suites have no task, method and seed in common that both have finished")
    lines = [_line(task, some) for task, some in _by_task(pairs)]
    lines += [_line("all", pairs)] if len(lines) > 1 else []
    head = ("task", "pairs", "success, points", *(name for name, _ in FIGURES))
    note = (
        "The second less the first, with 95 % intervals: "
        "Bonett and Price's for success, in points of a percent; "
        "of a bootstrap for means. Pairs with answers written by hand, or given to earlier prompts, say "
        "nothing of success."
    )
    return SuiteTable("Differences", head, tuple(lines), note)


def outcomes(first: Results, second: Results) -> SuiteTable:
    """How many episodes of each suite ended how, whether the other has them or not."""
    counts = [Counter(word for line in r.lines for word in r.words(line)) for r in (first, second)]
    words = [word for word in (*FINISHED, *UNFINISHED) if word in ALWAYS or any(c[word] for c in counts)]
    lines = tuple((word, *(str(c[word]) for c in counts)) for word in words)
    note = f"Of these, {', '.join(UNFINISHED)} could not be carried out, and are in no pair."
    return SuiteTable("Outcomes", ("outcome", "A", "B"), lines, note)


def _compared(first: Results, second: Results, name: str) -> bool:
    """Whether the two suites differ in this, one value each."""
    own = [{getattr(r.episode, name) for r in results.all} for results in (first, second)]
    return all(len(values) == 1 for values in own) and own[0] != own[1]


def _key(result: Result, apart: Sequence[str]) -> Key:
    cell = result.episode.cell._asdict()
    return tuple(str(value) for name, value in cell.items() if name not in apart)


def _by_task(pairs: Sequence[Pair]) -> Iterator[tuple[str, list[Pair]]]:
    for task in dict.fromkeys(pair[1].episode.task for pair in pairs):
        yield task, [pair for pair in pairs if pair[1].episode.task == task]


def _line(name: str, pairs: Sequence[Pair]) -> tuple[str, ...]:
    cells = [name, str(len(pairs)), _success(pairs)]
    for _, read in FIGURES:
        values = [(read(a), read(b)) for a, b in pairs]
        differences = [b - a for a, b in values if a is not None and b is not None]
        cells.append(_shown(paired_means(differences), "{:+.2f}") if differences else "")
    return tuple(cells)


def _success(pairs: Sequence[Pair]) -> str:
    judged = [
        (a.success, b.success)
        for a, b in pairs
        if a.success is not None and b.success is not None and not (_silent(a) or _silent(b))
    ]
    if not judged:
        results = [result for pair in pairs for result in pair]
        if any(r.episode.stale for r in results):
            return "to earlier prompts"
        return "by hand" if any(r.authored for r in results) else "not judged"
    share = paired_proportions(judged)
    return _shown(Estimate(*(100 * value for value in share)), "{:+.0f}")


def _silent(result: Result) -> bool:
    """Whether a success says nothing of a model that is asked today's prompts."""
    return result.authored or result.episode.stale


def _shown(estimate: Estimate, form: str) -> str:
    return f"{form.format(estimate.value)} [{form.format(estimate.low)}, {form.format(estimate.high)}]"
