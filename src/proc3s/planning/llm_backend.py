"""From `--llm NAME -L key=value` to something that can be asked."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel

from proc3s.errors import Issue, SpecError, UsageError, blame, did_you_mean
from proc3s.llm.budget import Account, Budget, Ledger
from proc3s.llm.call_options import CallOptions
from proc3s.llm.errors import LLMError
from proc3s.llm.recorder import Recorder
from proc3s.llm.retry import RetryingLLM
from proc3s.llm.types import LLM, Price, Request
from proc3s.planning.resume import ResumedLLM, RunHistory
from proc3s.plugins.part_options import options_model, part_options
from proc3s.plugins.registry import Registry
from proc3s.specs.parts import LLMSpec
from proc3s.specs.yaml_files import validate


@dataclass(frozen=True)
class Chosen:
    """A backend that was chosen: by which name, its spec, the model after its name, both kinds of options."""

    name: str
    spec: LLMSpec
    model: str
    call: CallOptions
    own: BaseModel | None

    def make(self) -> LLM:
        """The backend itself. Raises LLMError, e.g. if its key is missing."""
        with blame(f"llm {self.spec.name}"):
            llm = self.spec.load()(self.model, self.own)
        if not isinstance(llm, LLM):
            message = f"makes a {type(llm).__name__}, which does not inherit proc3s.LLM"
            raise SpecError([Issue(self.spec.target, f"llm {self.spec.name}", message)])
        return llm


def find_llm(registry: Registry, name: str, options: Mapping[str, str]) -> Chosen:
    """The backend of `NAME`, `NAME:ARGUMENT`, `NAME/MODEL`, or what a plugin resolves.

    Raises UsageError for an unknown name, SpecError for options that are wrong.
    """
    spec, model = _find(registry, name)
    refuse_keys(options)
    own = {k: v for k, v in options.items() if k not in CallOptions.model_fields}
    call = {k: v for k, v in options.items() if k in CallOptions.model_fields}
    return Chosen(name, spec, model, validate(CallOptions, call, f"llm {spec.name}"), _own(spec, own))


def _own(spec: LLMSpec, given: Mapping[str, str]) -> BaseModel | None:
    model = options_model(spec)
    known = {*CallOptions.model_fields, *(model.model_fields if model else ())}
    for name in given:
        if name not in known:
            raise UsageError(f"llm {spec.name} takes no option {name!r}{did_you_mean(name, known)}")
    return part_options(spec, given)


def refuse_keys(options: Iterable[str]) -> None:
    """Raises UsageError if an option looks like a secret: options are logged."""
    for name in options:
        if any(part in name.lower() for part in ("key", "secret", "password")):
            raise UsageError(
                f"keys are never given as an option ({name}): they would be logged; set the provider's "
                "environment variable instead"
            )


def _find(registry: Registry, name: str) -> tuple[LLMSpec, str]:
    known = registry.all(LLMSpec)
    for separator in (":", "/"):
        head, _, rest = name.partition(separator)
        if head in known:
            return known[head], rest
    found = registry.plugins.resolve_llm(name)
    if not isinstance(found, LLMSpec):
        raise UsageError(f"there is no LLM {name!r}{did_you_mean(name, known)} or PROVIDER/MODEL")
    return found, name


def open_llm(
    chosen: Chosen,
    budget: Budget | None = None,
    past: RunHistory | None = None,
    record: Path | None = None,
    charged: Callable[[Ledger], None] = lambda ledger: None,
    failed: Callable[[Request, LLMError, float], None] = lambda request, error, wait: None,
) -> LLM:
    """The backend as a run asks it: with retries and a budget, recorded in `record`, after what was answered
    and spent in the past.

    `charged` hears what calls cost, `failed` of attempts that another one follows. Raises LLMError if the
    backend cannot be made, UsageError if a limit in dollars cannot be kept or `record` not be written.
    """
    budget, past = budget or Budget(), past or RunHistory()
    llm, price = chosen.make(), chosen.call.price
    if llm.live and budget.max_cost is not None:
        price = price or _known_price(chosen, llm)
        if past.ledger.cost is None:
            raise UsageError("nobody knows what the calls so far have cost, so --max-cost cannot be kept")
    account = Account(budget, price, past.ledger, charged)
    llm = RetryingLLM(llm, chosen.name, account, chosen.call, failed)
    if record is not None:
        llm = Recorder(llm, record, past.id)
    return ResumedLLM(llm, past.answers)


def price_of(chosen: Chosen) -> Price | None:
    """What tokens cost, if anybody knows; asked only where answers have a bound, since finding out may take
    seconds."""
    if chosen.call.price is not None or chosen.call.max_tokens is None:
        return chosen.call.price
    try:
        return chosen.make().price
    except LLMError:  # a call says it better
        return None


def _known_price(chosen: Chosen, llm: LLM) -> Price:
    with blame(f"llm {chosen.spec.name}"):
        price: Price | None = llm.price
    if price is None:
        raise UsageError(
            f"nobody knows what a call of {chosen.name} costs, so --max-cost cannot be kept; declare it "
            "with -L prompt_price=… -L completion_price=… (US dollars for a million tokens)"
        )
    return price
