"""Answers without a key: replayed, given by hand, or scripted."""

from collections.abc import Callable

from proc3s import LLMSpec, hookimpl


@hookimpl
def register_llms(register: Callable[[LLMSpec], None]) -> None:
    """`replay`, `recorded`, `manual` and `stub`."""
    register(
        LLMSpec(
            name="replay",
            summary="Answers that are there already: bundled with the domain, recorded, or those of a run.",
            usage="replay, or replay:PATH (a cassette, or a folder of cassettes, of answers, or of a run)",
            target="proc3s_replay.replay:Replay",
            options="proc3s_replay.replay:Options",
        )
    )
    register(
        LLMSpec(
            name="recorded",
            summary="Answers of a model that come with proc3s: Claude, by hand, on 2026-11-30.",
            usage="recorded",
            target="proc3s_replay.recorded:recorded",
            options="proc3s_replay.replay:Options",
        )
    )
    register(
        LLMSpec(
            name="manual",
            summary="Writes each prompt to a file and waits for a person to write the answer beside it.",
            usage="manual:DIR",
            target="proc3s_replay.manual:Manual",
            options="proc3s_replay.manual:Options",
        )
    )
    register(
        LLMSpec(
            name="stub",
            summary="Scripted answers in order, for tests.",
            usage="stub:FILE (JSON list of texts, one a round, or of lists of candidates)",
            target="proc3s_replay.stub:Stub",
        )
    )
