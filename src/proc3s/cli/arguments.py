"""Arguments and options that several commands share."""

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

Task: TypeAlias = Annotated[str, typer.Argument(metavar="TASK", help="domain/task, e.g. drawing/star")]
Llm: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--llm",
        help="PROVIDER/MODEL, replay[:PATH], manual:DIR or stub:FILE  "
        "[default: PROC3S_LLM, proc3s.toml, replay]",
    ),
]
Candidates: TypeAlias = Annotated[
    int | None, typer.Option("--candidates", min=1, help="programs asked for at once; they race")
]
LlmJobs: TypeAlias = Annotated[
    int | None, typer.Option("--llm-jobs", min=1, help="calls to the LLM in flight  [default: --candidates]")
]
Record: TypeAlias = Annotated[
    Path | None, typer.Option("--record", help="cassette (.jsonl or folder) that keeps every answer")
]
MaxCost: TypeAlias = Annotated[
    float | None, typer.Option("--max-cost", help="US dollars that live answers may cost")
]
MaxTokens: TypeAlias = Annotated[
    int | None, typer.Option("--max-tokens", min=1, help="tokens that live prompts and answers may take")
]
MaxCalls: TypeAlias = Annotated[
    int | None, typer.Option("--max-calls", min=1, help="live calls that may be made")
]
Resume: TypeAlias = Annotated[
    Path | None,
    typer.Option("--resume", metavar="RUN", help="go on with a run that was broken off"),
]
Method: TypeAlias = Annotated[str | None, typer.Option("--method", help="see `proc3s list methods`")]
Solver: TypeAlias = Annotated[str | None, typer.Option("--solver", help="see `proc3s list solvers`")]
Preset: TypeAlias = Annotated[
    str | None, typer.Option("--preset", help="what method and command line leave open  [default: best]")
]
ExecutorName: TypeAlias = Annotated[
    str | None, typer.Option("--executor", help="see `proc3s list executors`")
]
Seed: TypeAlias = Annotated[int | None, typer.Option("--seed", min=0, help="scene and random draws")]
Goal: TypeAlias = Annotated[
    str | None, typer.Option("--goal", help="an instruction of your own (nobody judges it)")
]
Samples: TypeAlias = Annotated[int | None, typer.Option("--samples", min=1, help="samples per round")]
Feedback: TypeAlias = Annotated[int | None, typer.Option("--feedback", min=0, help="feedback rounds")]
Out: TypeAlias = Annotated[Path | None, typer.Option("--out", help="run folder  [default: runs/…]")]
Json: TypeAlias = Annotated[bool, typer.Option("--json", help="one JSON document on stdout, nothing else")]
TemplateDir: TypeAlias = Annotated[
    Path | None, typer.Option("--template-dir", help="folder of templates that go before all others")
]
Plugins: TypeAlias = Annotated[
    list[Path] | None,
    typer.Option("--plugin", help="a plugin in a loose file, Python or a domain.yaml (repeatable)"),
]
DomainOptions: TypeAlias = Annotated[
    list[str] | None, typer.Option("-D", metavar="KEY=VALUE", help="argument of the task's scene")
]
MethodOptions: TypeAlias = Annotated[
    list[str] | None, typer.Option("-M", metavar="KEY=VALUE", help="field of the method")
]
SolverOptions: TypeAlias = Annotated[
    list[str] | None, typer.Option("-S", metavar="KEY=VALUE", help="option of the solver")
]
Jobs: TypeAlias = Annotated[int | None, typer.Option("--jobs", min=1, help="worker processes")]
NoScreens: TypeAlias = Annotated[
    bool, typer.Option("--no-screens", help="test every plan in the world, even hopeless ones")
]
AuditOption: TypeAlias = Annotated[
    int | None, typer.Option("--audit", min=0, help="put N rejects of the screens to the world after all")
]
Robust: TypeAlias = Annotated[
    int | None,
    typer.Option("--robust", min=0, help="accept only plans that also pass K rehearsals with small errors"),
]
CheckGoal: TypeAlias = Annotated[
    bool | None,
    typer.Option("--check-goal/--no-check-goal", help="accept only plans that satisfy the judge"),
]
LimitOptions: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        "--limit", metavar="KEY=VALUE", help="limit of the box, e.g. call=2, or of the clock, e.g. round=60"
    ),
]
UnsafeExec: TypeAlias = Annotated[
    bool, typer.Option("--unsafe-exec", help="run programs WITHOUT the kernel's lock; warns each time")
]
LlmOptions: TypeAlias = Annotated[
    list[str] | None, typer.Option("-L", metavar="KEY=VALUE", help="option of the LLM")
]
