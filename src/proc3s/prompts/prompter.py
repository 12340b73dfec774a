"""Prompts: Jinja templates rendered into messages, byte for byte the same every time."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import jinja2
from jinja2.sandbox import ImmutableSandboxedEnvironment

from proc3s.domain.prelude import setup_code
from proc3s.errors import Issue, SpecError, UsageError, blame, did_you_mean
from proc3s.feedback.parameters import BoundHit, Separation
from proc3s.feedback.report import ConstraintReport, Diagnosis, Failure
from proc3s.llm.types import Message, Role
from proc3s.prompts.examples import example_turns
from proc3s.prompts.template_files import FEEDBACK, TASK, method_template
from proc3s.prompts.variables import (
    FILTERS,
    FeedbackVariables,
    SharedVariables,
    TaskVariables,
    plain_data,
)
from proc3s.sandbox.process import PYTHON
from proc3s.search.problem import Problem
from proc3s.specs.parts import MethodSpec, PresetSpec


@dataclass(frozen=True)
class Prompter:
    """Renders the messages of one method.

    `folders` are searched for templates in order. Raises UsageError for a template that does not exist
    and SpecError, with file and line, for one that does not render.
    """

    method: MethodSpec
    preset: PresetSpec
    folders: Sequence[Path]
    context: Mapping[str, Any] = field(default_factory=dict)

    def rehearse(self, problem: Problem) -> None:
        """Render every template once, so that a mistake in one shows before an LLM is asked."""
        failure = Failure(kind="rehearsal", text="", step=0, skill="", line=1, source="", share=100)
        error = failure.model_copy(update={"step": None})
        report = ConstraintReport(
            constraint="", share=100, steps=(0,), texts=("",), best_margin=-1.0, room=" "
        )
        failed = Diagnosis(
            samples=1,
            failures=(failure, error),
            constraints=(report,),
            never_violated=tuple(problem.domain.spec.constraints),
            separations=(Separation(parameter="", low=0.0, high=1.0),),
            bound_hits=(BoundHit(parameter="", bound=1.0, side="upper"),),
        )
        self.system(problem)
        self.task(problem)
        tuple(self.examples(problem))
        self.feedback(problem, failed, [failed])
        self.feedback(problem, Diagnosis(samples=0, program_errors=(error,)))

    def system(self, problem: Problem) -> Message:
        """What is the same for every task of the domain."""
        text = self._render(method_template(self.method), problem)
        return Message(role="system", kind="system", text=text)

    def task(self, problem: Problem) -> Message:
        """The initial state and the goal."""
        text = self._render(TASK, problem, TaskVariables(problem.initial, problem.goal))
        return Message(role="user", kind="task", text=text)

    def examples(self, problem: Problem) -> Iterator[Message]:
        """The worked examples, each as a conversation of its own."""
        for example in problem.domain.spec.examples.values():
            state = problem.domain.scene(example, example.seed)
            text = self._render(TASK, problem, TaskVariables(state, example.instruction))
            yield Message(role="user", kind="example", text=text)
            for kind, turn in example_turns(problem, example, self.method.answer):
                role: Role = "assistant" if kind == "answer" else "user"
                yield Message(role=role, kind="example", text=turn)

    def feedback(self, problem: Problem, diagnosis: Diagnosis, tried: Sequence[Diagnosis] = ()) -> Message:
        """What the LLM is told about a round that failed, and about later tries that got no further."""
        text = self._render(FEEDBACK, problem, FeedbackVariables(diagnosis, tuple(tried)))
        return Message(role="user", kind="feedback", text=text)

    def _render(
        self, name: str, problem: Problem, further: TaskVariables | FeedbackVariables | None = None
    ) -> str:
        variables = plain_data(self._shared(problem)) | (plain_data(further) if further else {})
        try:
            template = self._environment.get_template(name)
            with blame("template", Exception):  # a function of `prompt_context` may end the process
                return template.render(**self.context, **variables)
        except jinja2.TemplateNotFound as error:
            raise UsageError(self._not_found(str(error.name or name))) from error
        except jinja2.TemplateSyntaxError as error:
            where = f"{error.filename or name}:{error.lineno}"
            raise SpecError([Issue(where, "", str(error.message))]) from error
        except Exception as error:  # a template may raise whatever its expressions raise
            raised = error.__cause__ if isinstance(error, SpecError) else error
            raise SpecError([Issue(_template_line(raised or error, name), "", str(error))]) from error

    @cached_property
    def _environment(self) -> ImmutableSandboxedEnvironment:
        environment = ImmutableSandboxedEnvironment(
            loader=jinja2.FileSystemLoader(self.folders, encoding="utf-8-sig"),
            undefined=jinja2.StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
            keep_trailing_newline=True,
            autoescape=False,
        )
        environment.filters |= FILTERS
        return environment

    def _shared(self, problem: Problem) -> SharedVariables:
        with_samplers = self.method.answer == "sketch"
        return SharedVariables(
            domain=problem.domain.spec,
            method=self.method,
            preset=self.preset,
            samplers=problem.domain.samplers if with_samplers else (),
            setup_code=setup_code(problem.domain, with_samplers),
            python=PYTHON,
        )

    def _not_found(self, name: str) -> str:
        known = {str(p.relative_to(f)) for f in self.folders for p in f.rglob("*.j2")}
        where = ", ".join(map(str, self.folders))
        return f"there is no template {name!r} in {where}{did_you_mean(name, known)}"


def _template_line(error: BaseException, name: str) -> str:
    """`file:line` of the innermost template frame of an error raised while rendering."""
    where, traceback = name, error.__traceback__
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename.endswith(".j2"):
            where = f"{traceback.tb_frame.f_code.co_filename}:{traceback.tb_lineno}"
        traceback = traceback.tb_next
    return where
