"""Finds options that were given and have no effect, so that the user is told."""

from collections.abc import Iterator

from proc3s.llm.budget import Budget
from proc3s.planning.options import RunOptions
from proc3s.planning.parts import Setup


def unused(options: RunOptions, setup: Setup) -> Iterator[str]:
    """A sentence for every option that has no effect with the others of a run."""
    method, problem = setup.method, setup.problem
    search = {
        "--solver": options.solver,
        "-S": options.solver_options,
        "--samples": options.samples,
    }
    if method.samples == "none":
        search |= {"--audit": options.audit, "--robust": options.robust, "--no-screens": options.no_screens}
        search |= {"--check-goal": options.check_goal}
        search |= {"--improve": options.improve, "--improver": options.improver}
    given = [name for name, value in search.items() if value]
    if method.samples != "budget" and given:
        drawn = "no samples" if method.samples == "none" else "one sample of a program"
        changes = "changes" if len(given) == 1 else "change"
        yield f"{method.name} draws {drawn}, so {', '.join(given)} {changes} nothing"
    if options.improver and not setup.improve and method.samples != "none":
        yield f"--improver changes nothing: --improve is 0 with preset {options.preset}"
    if options.audit and problem.screens == "none":
        yield "--audit changes nothing: no screen rejects anything"
    if options.check_goal and not (problem.task.judge and problem.goal == problem.task.instruction):
        yield "--check-goal changes nothing: this instruction has no judge"
    if (options.llm_jobs or 1) > 1 and options.candidates == 1:
        yield "--llm-jobs changes nothing: one candidate is asked for"


def unused_budget(budget: Budget, llm: str) -> Iterator[str]:
    """The same of the limits on what live answers may cost, for an LLM that is not live."""
    names = [f"--{name.replace('_', '-')}" for name, value in budget if value is not None]
    if names:
        yield f"{', '.join(names)} changes nothing: asking {llm} costs nothing"
