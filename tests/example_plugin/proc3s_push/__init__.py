"""A domain, a solver and a language-model backend for proc3s."""

from pathlib import Path

from proc3s import LLMSpec, SolverSpec, hookimpl, load_domain


@hookimpl
def register_domains(register):
    register(load_domain(Path(__file__).parent / "domain.yaml"))


@hookimpl
def register_solvers(register):
    register(
        SolverSpec(
            name="annealed", summary="Samples around the best one.", target="proc3s_push.solver:Annealed"
        )
    )


@hookimpl
def register_llms(register):
    says = {"summary": "Reads answers from a folder.", "usage": "shelf:FOLDER (files TASK.METHOD.md)"}
    register(LLMSpec(name="shelf", target="proc3s_push.llm:Shelf", **says))
