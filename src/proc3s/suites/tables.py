"""The tables of a suite as texts: what a person compares with the paper, and what the paper leaves out."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from proc3s.suites.outcomes import ALWAYS, FINISHED, UNFINISHED, Word, reasons
from proc3s.suites.results import Figures, Result, Results
from proc3s.suites.statistics import ALPHA, mean_std, wilson, worse
from proc3s.wording import count, total

Line: TypeAlias = tuple[str, str]
Read: TypeAlias = Callable[[Result], float | None]


NOT_FINISHED = "not finished"
"""Stands for a rate where no episode has come to its end."""

STALE = "Success with answers to earlier prompts, %"
"""Title of the table of episodes that count in no other one."""


@dataclass(frozen=True)
class SuiteTable:
    """A title, the heads of the columns, the lines, and what to know about them."""

    title: str
    head: tuple[str, ...]
    lines: tuple[tuple[str, ...], ...]
    note: str = ""

    @property
    def empty(self) -> bool:
        """Whether there is nothing in it yet."""
        return not any(cell not in ("", NOT_FINISHED) for line in self.lines for cell in line[1:])


MEANS: tuple[tuple[str, str, str, Read], ...] = (
    ("ccsp_samples", "Samples", "{:.0f}", lambda r: r.episode.samples),
    ("ccsp_seconds", "Search, s", "{:.2f}", lambda r: r.episode.seconds.get("solve")),
    ("total_seconds", "Total, s", "{:.2f}", lambda r: r.episode.seconds.get("total")),
    ("feedback_rounds", "Feedback rounds", "{:.1f}", lambda r: r.episode.rounds),
    ("llm_seconds", "LLM, s", "{:.2f}", lambda r: r.episode.llm_seconds),
)
"""Quantity in the published figures, title, format, and where it stands in a result."""


def tables(results: Results, figures: Figures) -> Iterator[SuiteTable]:
    """All tables in which there is something, that of success first."""
    yield from (table for table in _all_tables(results, figures) if not table.empty)


def _all_tables(results: Results, figures: Figures) -> Iterator[SuiteTable]:
    yield success_table(results, figures)
    yield outcome_table(results)
    if results.stale.all:
        yield replace(success_table(results.stale, {}), title=STALE)
    for quantity, title, form, read in MEANS:
        yield _means(results, figures, quantity, title, form, read)
    yield _left_out(results)
    yield _violations(results)


def success_table(results: Results, figures: Figures) -> SuiteTable:
    """Success rates with Wilson intervals; none is made of authored answers."""
    lines = []
    for line in results.lines:
        cells = [_success(results, line, task) for task in results.spec.tasks]
        lines.append((results.label(line), *cells))
        lines += _published(results, figures, "success_percent", line, "{:.0f}")
    note = (
        "Percent of episodes in which the instruction was fulfilled, with Wilson's 95 % interval. Bold: not "
        f"significantly worse than the best of its column (one-tailed z-test at {ALPHA}, as in the paper). "
        "From answers written by hand no rate is computed. Where a person has judged, the person counts."
    )
    return SuiteTable("Success, %", ("method", *results.spec.tasks), tuple(lines), note)


def outcome_table(results: Results) -> SuiteTable:
    """How many episodes ended how; a kind that is not usual has a column where there is one."""
    counts = {line: Counter(results.words(line)) for line in results.lines}
    there = sum(counts.values(), Counter[Word]())
    words = [word for word in (*FINISHED, *UNFINISHED) if word in ALWAYS or there[word]]
    lines = tuple((results.label(line), *(str(counts[line][word]) for word in words)) for line in counts)
    note = (
        "Goal missed and no plan are failures, and count in the rates. What could not be carried out "
        f"({', '.join(word for word in words if word in UNFINISHED)}) is in no rate, and is tried again by "
        "--resume."
    )
    return SuiteTable("Outcomes", ("method", *words), lines, note)


def _success(results: Results, line: Line, task: str) -> str:
    """One rate, bold where it is among the best of its task."""
    counted = rate_of(results.of(line, task))
    if not counted and results.words(line, task):
        return NOT_FINISHED
    if isinstance(counted, str):
        return counted
    good, of = counted
    share = wilson(good, of)
    text = f"{100 * share.value:.0f} [{100 * share.low:.0f}, {100 * share.high:.0f}]"
    rivals = (rate_of(results.of(other, task)) for other in results.lines)
    rates = [rate for rate in rivals if not isinstance(rate, str)]
    best = max(rates, key=lambda rate: rate[0] / rate[1])
    return f"**{text}**" if worse(good, of, *best) > ALPHA else text


def rate_of(results: Sequence[Result]) -> tuple[int, int] | str:
    """Successes and how many there are; or in a few words why there is no rate."""
    judged = [r for r in results if r.success is not None]
    if not results:
        return ""
    if any(r.authored for r in results):
        return f"{sum(bool(r.success) for r in judged)}/{len(results)} by hand"
    return (sum(bool(r.success) for r in judged), len(judged)) if judged else "not judged"


def _published(
    results: Results, figures: Figures, quantity: str, line: Line, form: str
) -> list[tuple[str, ...]]:
    """The published figures of a method, if there are any."""
    found = [figures.get((quantity, line[0], task)) for task in results.spec.tasks]
    if not any(found):
        return []
    return [("· published", *(_mean(form, *figure) if figure else "" for figure in found))]


def _mean(form: str, mean: float, std: float | None) -> str:
    return form.format(mean) + (f" ± {form.format(std)}" if std is not None else "")


def _means(
    results: Results, figures: Figures, quantity: str, title: str, form: str, read: Read
) -> SuiteTable:
    """Mean and standard deviation of a figure that every episode has."""
    lines: list[tuple[str, ...]] = []
    for line in results.lines:
        values = [_values(results.of(line, task), read) for task in results.spec.tasks]
        cells = [_mean(form, *mean_std(some)) if some else "" for some in values]
        lines.append((results.label(line), *cells))
        lines += _published(results, figures, quantity, line, form)
    note = "Mean ± standard deviation (of the sample) over seeds, successful or not."
    return SuiteTable(title, ("method", *results.spec.tasks), tuple(lines), note)


def _values(results: Sequence[Result], read: Read) -> list[float]:
    return [value for value in map(read, results) if value is not None]


def _left_out(results: Results) -> SuiteTable:
    """What the paper's tables do not say."""
    lines = []
    for line in results.lines:
        if not (some := results.of(line)):
            continue
        lines.append(
            (
                results.label(line),
                str(len(some)),
                str(sum(r.episode.solved for r in some)),
                str(sum(r.wrong for r in some)),
                str(sum(r.verdict is not None for r in some)),
                _mean_of(some, "{:,.0f}", lambda r: r.episode.prompt_tokens),
                _mean_of(some, "{:,.0f}", lambda r: r.episode.completion_tokens),
                total([r.episode.cost for r in some], "{:.4f}"),
            )
        )
    head = ("method", "episodes", "solved", "solved but wrong", "judged by a person")
    note = (
        "Solved: the world accepted a plan. Tokens and cost are of all calls of an episode that is finished, "
        "tokens as a mean, cost as a sum; what nobody said is `?`, and a sum with such a part is `at least`."
    )
    return SuiteTable(
        "Beside that", (*head, "tokens asked", "tokens answered", "cost, $"), tuple(lines), note
    )


def _mean_of(results: Sequence[Result], form: str, read: Read) -> str:
    """A mean, and of how many it is where that is not all."""
    values = _values(results, read)
    if not values:
        return "?" if results else ""
    text = form.format(mean_std(values)[0])
    return text if len(values) == len(results) else f"{text} (of {len(values)} known)"


def _violations(results: Results) -> SuiteTable:
    """How many samples failed first by what."""
    counts = {line: Counter[str]() for line in results.lines}
    for line in results.lines:
        for result in results.of(line):
            counts[line].update(result.episode.violations)
    kinds = [kind for kind, _ in sum(counts.values(), Counter[str]()).most_common()]
    lines = tuple((results.label(line), *(str(counts[line][kind]) for kind in kinds)) for line in counts)
    return SuiteTable("First violations of samples", ("method", *kinds), lines)


def provenance(results: Results) -> list[str]:
    """Where the answers are from, and what was not as asked: a sentence each."""
    kinds: dict[tuple[str, str, bool], list[Result]] = {}
    for result in results.all:
        one = result.episode
        kinds.setdefault((one.source, one.model or "no model", one.stale), []).append(result)
    told = [_origin(source, model, some) for (source, model, _), some in kinds.items()]
    if stale := len(results.stale.all):
        told.append(f"{_using(stale)} answers to earlier prompts: they have a table of their own.")
    lost = Counter(name for r in results.all for name in r.episode.dropped)
    told += [
        f"In {count(times, 'episode')} the provider did not take the parameter `{name}`: "
        f"{'it' if times == 1 else 'they'} cannot be repeated."
        for name, times in lost.items()
    ]
    if not results.unfinished:
        return told
    left, why = count(len(results.unfinished), "episode"), "; ".join(reasons(results.unfinished))
    return [*told, f"{left} could not be carried out and count in no rate: {why}."]


def _origin(source: str, model: str, some: Sequence[Result]) -> str:
    if source == "authored":
        return f"{_using(len(some))} answers that were written by hand: no success rate is made of them."
    dates = sorted({r.episode.answered[:10] for r in some if r.episode.answered})
    when = f", answered {dates[0]}" + (f" to {dates[-1]}" if len(dates) > 1 else "") if dates else ""
    hashes = sorted({r.episode.prompt_sha256[:12] for r in some if r.episode.prompt_sha256})
    shown = ", ".join(hashes[:3]) + (f" and {len(hashes) - 3} more" if len(hashes) > 3 else "")
    number = count(len(some), "episode")
    return f"{number}: {source} answers of {model}{when}; SHA-256 of first prompts: {shown}."


def _using(episodes: int) -> str:
    return f"{count(episodes, 'episode')} {'uses' if episodes == 1 else 'use'}"
