"""One small question to the chosen LLM, asked as a run asks: what works, and what it cost."""

import reprlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from proc3s.checks.finding import Finding
from proc3s.errors import Proc3sError, UsageError
from proc3s.llm.budget import Budget, Ledger, Spent
from proc3s.llm.config import ChosenLLM
from proc3s.llm.errors import LLMError
from proc3s.llm.types import Completion, Message, Request, Sampling
from proc3s.planning.llm_backend import find_llm, open_llm
from proc3s.plugins.registry import Registry
from proc3s.redaction import redacted
from proc3s.sandbox.text import clean
from proc3s.wording import count, plain

_MODEL = 200
"""Characters of a model's name that are shown."""
_PROMPT = (
    Message(role="system", kind="system", text="Answer with one word and nothing else."),
    Message(role="user", kind="task", text="Say: ready"),
)


@dataclass(frozen=True)
class Asked:
    """What came of the question, and the exit code that goes with it."""

    findings: tuple[Finding, ...] = ()
    exit_code: int = 0


@dataclass
class _Meter:
    """What the calls cost so far, and which attempts failed."""

    spent: Spent = field(default_factory=Spent)
    failures: list[LLMError] = field(default_factory=list)

    def charged(self, ledger: Ledger) -> None:
        self.spent = ledger.spent

    def failed(self, request: Request, error: LLMError, wait: float) -> None:
        self.failures.append(error)


def ask(registry: Registry, llm: ChosenLLM, budget: Budget) -> Asked:
    """Ask with the options of the call, retries and the budget. Whatever fails is a finding.

    An LLM that cannot be opened has been reported by `examine`, and is not again.
    """
    try:
        chosen = find_llm(registry, llm.name, llm.options)
        live = open_llm(chosen).live
    except Proc3sError as error:
        return Asked(exit_code=error.exit_code)
    if not live:
        return Asked((_not_live(llm.name),), UsageError.exit_code)
    meter, request = _Meter(), _request(chosen.call.sampling(seed=0, candidates=1))
    try:
        opened = open_llm(chosen, budget, charged=meter.charged, failed=meter.failed)
        opened.prepare()
        completion = opened.complete(request)
    except Proc3sError as error:
        failure = _question("error", redacted(str(error)))
        return Asked((*_attempts(meter), failure, *_cost(meter.spent)), error.exit_code)
    answered = (*_attempts(meter), *_answer(completion), *_parameters(request.sampling, completion))
    return Asked((*answered, *_cost(meter.spent)))


def _request(sampling: Sampling) -> Request:
    return Request(messages=_PROMPT, task="doctor/ask", method="", template="", seed=0, sampling=sampling)


def _question(level: str, text: str, advice: str = "") -> Finding:
    return Finding.model_validate({"level": level, "subject": "question", "text": text, "advice": advice})


def _not_live(name: str) -> Finding:
    text = f"{name} was not asked: no provider is behind it, so there is no key, model or price to test"
    return _question("error", text, "name a model: --llm PROVIDER/MODEL")


def _attempts(meter: _Meter) -> Iterator[Finding]:
    for text, times in Counter(redacted(str(error)) for error in meter.failures).items():
        failed = "an attempt" if times == 1 else f"{times} attempts"
        yield _question("note", f"{failed} failed, and another one followed: {text}")


def _answer(completion: Completion) -> Iterator[Finding]:
    said = reprlib.repr(redacted(completion.text.strip()))  # no control character reaches a terminal
    asked = completion.model_asked or completion.model
    model = clean(completion.model, _MODEL)  # as the server has it
    also = "" if asked.endswith(completion.model) else f" (it calls itself {model})"
    after = "" if completion.latency is None else f" after {completion.latency:.1f} s"
    yield _question("ok", f"{asked}{also} answered {said}{after}")
    for note in completion.notes:
        yield _question("note", note)


def _parameters(asked: Sampling, completion: Completion) -> Iterator[Finding]:
    """Which parameters of a call the provider takes, and which runs go without."""
    sent = asked.without(completion.dropped).model_dump(exclude_none=True, exclude_defaults=True)
    if sent:
        listed = ", ".join(f"{name}={value}" for name, value in sent.items())
        yield Finding(level="ok", subject="parameters", text=f"{listed} taken")
    for name in completion.dropped:
        text = f"{clean(completion.model, _MODEL)} does not support {name}: runs go without it"
        yield Finding(level="note", subject="parameters", text=text)


def _cost(spent: Spent) -> Iterator[Finding]:
    if not spent.calls:
        return
    calls = f"{count(spent.calls, 'call')}, "
    if spent.prompt_tokens is None or spent.completion_tokens is None:
        tokens = "an unknown number of tokens"
    else:
        tokens = f"{spent.prompt_tokens:,} + {spent.completion_tokens:,} tokens"
    if spent.cost is not None:
        yield Finding(level="ok", subject="cost", text=f"{calls}{tokens}, ${plain(spent.cost)}")
        return
    advice = (
        "where the price is not listed, declare it (US dollars for a million tokens): "
        "-L prompt_price=… -L completion_price=…"
    )
    yield Finding(level="note", subject="cost", text=f"{calls}{tokens}, cost unknown", advice=advice)
