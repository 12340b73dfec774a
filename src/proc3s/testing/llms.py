"""Conformance kit of LLM backends: inherit `BackendTests`, give it `make_llm`, and run pytest."""

from collections.abc import Callable

import pytest

from proc3s import LLM, Completion, LLMError, Message, Request, Sampling

MESSAGES = (
    Message(role="system", kind="system", text="You control a robot."),
    Message(role="user", kind="task", text="Draw a star."),
)


def request(candidates: int = 1, round_: int = 0, seed: int = 0) -> Request:
    """A question as the loop asks it."""
    return Request(
        messages=MESSAGES,
        sampling=Sampling(n=candidates),
        task="domain/task",
        method="proc3s",
        template="proc3s",
        seed=seed,
        round=round_,
    )


class BackendTests:
    """A backend answers with a completion, or raises LLMError. Override `make_llm`, a callable without
    arguments that gives a backend which can answer `request()` right away."""

    def test_it_answers_with_text(self, make_llm: Callable[[], LLM]) -> None:
        """At least one candidate that is not empty, and the model's name."""
        completion = make_llm().complete(request())
        assert isinstance(completion, Completion)
        assert completion.text.strip()
        assert completion.model

    def test_it_says_where_answers_are_from(self, make_llm: Callable[[], LLM]) -> None:
        """`live` answers come from a backend that says that it is live."""
        llm = make_llm()
        assert (llm.complete(request()).source == "live") <= llm.live

    def test_unknown_figures_are_not_free(self, make_llm: Callable[[], LLM]) -> None:
        """A live answer has a cost that is known, or None; tokens are not negative."""
        completion = make_llm().complete(request())
        usage = completion.usage
        assert completion.cost is None or completion.cost >= 0
        assert all(count is None or count >= 0 for count in (usage.prompt_tokens, usage.completion_tokens))

    def test_the_same_question_may_be_asked_again(self, make_llm: Callable[[], LLM]) -> None:
        """By another backend of the same options, as a run that is resumed does."""
        assert make_llm().complete(request()).text.strip()
        assert make_llm().complete(request()).text.strip()

    def test_what_cannot_be_answered_is_an_llm_error(self, unable_llm: LLM) -> None:
        """`unable_llm` is a backend that cannot answer; it says why without a traceback or a key."""
        with pytest.raises(LLMError) as caught:
            unable_llm.complete(request())
        assert str(caught.value).strip()

    @pytest.fixture
    def unable_llm(self) -> LLM:
        """A backend that cannot answer; override it, or its test is skipped."""
        pytest.skip("the author gave no backend that cannot answer (fixture `unable_llm`)")
