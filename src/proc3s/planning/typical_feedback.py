"""Feedback prompts of typical failures: what would be asked if a program failed so."""

from proc3s.llm.types import Message
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_problem, make_prompter
from proc3s.plugins.registry import Registry
from proc3s.prompts.conversation import conversation
from proc3s.prompts.typical_failures import typical_failure, typical_failures


def messages_after(registry: Registry, options: RunOptions, failure: str) -> tuple[Message, ...]:
    """The messages of the round after a typical failure. Raises UsageError if there is none of that name."""
    problem = make_problem(registry, options)
    prompter = make_prompter(registry, options, problem)
    return conversation(prompter, problem, [typical_failure(problem, prompter.method, failure)])


def typical_feedback(registry: Registry, options: RunOptions) -> dict[str, Message]:
    """The feedback on each typical failure of a task, by its name."""
    problem = make_problem(registry, options)
    prompter = make_prompter(registry, options, problem)
    made = typical_failures(problem, prompter.method)
    return {name: prompter.feedback(problem, make().diagnosis) for name, make in made.items()}
