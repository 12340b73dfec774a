"""Replays: every answer is given to its own request again, and to exactly its own prompt."""

import itertools
import shlex
from datetime import UTC, datetime

import pytest

from proc3s import LLM, Candidate, Completion, LLMError, Message, Request, Sampling, Usage, digest
from proc3s import answer as plain_answer
from proc3s.llm.recorder import Recorder
from proc3s.runs.events import AnswerReceived, PromptRendered, RunStarted
from proc3s.runs.folder import RunFolder
from proc3s_replay.replay import Options, Replay

SYSTEM = Message(role="system", kind="system", text="You plan.\nIn Python.\n")


def task(text="Draw a star."):
    return Message(role="user", kind="task", text=text)


def reply(text):
    return Message(role="assistant", kind="reply", text=text)


def feedback(text):
    return Message(role="user", kind="feedback", text=text)


def request(*messages, n=1, **changes):
    usual = {"task": "drawing/star", "method": "proc3s", "template": "proc3s", "seed": 0}
    whole = (SYSTEM, *(messages or (task(),)))
    return Request(messages=whole, sampling=Sampling(n=n), **(usual | changes))


class Model(LLM):
    """Gives its answers in order."""

    def __init__(self, *answers):
        self._answers = iter(answers)

    def complete(self, request):
        found = next(self._answers)
        return found if isinstance(found, Completion) else plain_answer(found, "gpt-x")


def record(path, *pairs):
    """Records one run of requests and answers."""
    recorder = Recorder(Model(*(answer for _, answer in pairs)), path)
    for asked, _ in pairs:
        recorder.complete(asked)


def run_folder(path, *pairs, method="proc3s", seed=0):
    folder = RunFolder(path)
    options = {"task": "drawing/star", "method": method, "seed": seed, "llm": "openai/gpt-x"}
    folder.emit(RunStarted(options=options, versions={}, samples=1, scene="{}"))
    for asked, found in pairs:
        sha256 = digest(asked.messages)
        folder.emit(PromptRendered(round=asked.round, sha256=sha256, messages=asked.messages))
        completion = found if isinstance(found, Completion) else plain_answer(found, "gpt-x")
        folder.emit(AnswerReceived(round=asked.round, candidate=asked.candidate, completion=completion))
    folder.close()


def replay(path, **options):
    return Replay(str(path), Options(**options))


def refusal(path, asked, **options):
    with pytest.raises(LLMError) as caught:
        replay(path, **options).complete(asked)
    assert caught.value.fault == "no_answer"
    return str(caught.value)


@pytest.fixture(params=["cassette", "folder", "run"])
def keep(request, tmp_path):
    """Keeps pairs of requests and answers of one run in one of three forms; gives the path back."""

    def write(*pairs):
        path = tmp_path / {"cassette": "kept.jsonl", "folder": "kept", "run": "kept"}[request.param]
        (run_folder if request.param == "run" else record)(path, *pairs)
        return path

    return write


def test_an_answer_comes_back_with_its_figures_of_then(keep):
    live = Completion(
        candidates=(Candidate(text="x", finish_reason="end_turn"),),
        model="gpt-x-2026",
        model_asked="openai/gpt-x",
        usage=Usage(prompt_tokens=5),
        cost=0.25,
        latency=12.5,
        attempts=3,
        dropped=("seed",),
        notes=("seed not supported",),
    )
    found = replay(keep((request(), live))).complete(request())
    assert found.answered is not None
    assert datetime.fromisoformat(found.answered) <= datetime.now(UTC)
    assert found == live.model_copy(update={"source": "recorded", "answered": found.answered})


@pytest.mark.parametrize("source", ["authored", "manual"])
def test_an_answer_that_no_model_gave_says_so(keep, source):
    assert replay(keep((request(), plain_answer("x", "m", source)))).complete(request()).source == source


def test_a_replay_costs_nothing():
    assert not replay("").live


def test_every_round_and_candidate_gets_its_own_answer(keep):
    asked = [request(round=r, candidate=c) for r, c in itertools.product(range(3), range(3))]
    path = keep(*((each, f"round {each.round} candidate {each.candidate}") for each in asked))
    for each in reversed(asked):
        assert replay(path).complete(each).text == f"round {each.round} candidate {each.candidate}"


def test_every_task_method_and_seed_gets_its_own_answer(tmp_path):
    keys = list(itertools.product(["drawing/star", "drawing/arrow"], ["proc3s", "cap"], [0, 1]))
    asked = [request(task=t, method=m, seed=s) for t, m, s in keys]
    for name in ("one.jsonl", "folder"):
        record(tmp_path / name, *((each, str(key)) for each, key in zip(asked, keys, strict=True)))
        for each, key in zip(reversed(asked), reversed(keys), strict=True):
            assert replay(tmp_path / name).complete(each).text == str(key)


@pytest.mark.parametrize("change", [{"seed": 1}, {"round": 1}, {"candidate": 1}, {"method": "cap"}])
def test_the_same_prompt_of_another_request_is_not_answered(keep, change):
    path = keep((request(), "x"))
    assert "no answer" in refusal(path, request(**change))


def test_candidates_of_one_answer_are_told_apart(keep):
    several = Completion(candidates=tuple(Candidate(text=t) for t in "abc"), model="m", cost=1.0, latency=2.0)
    path = keep((request(n=3), several), (request(candidate=3), "d"))

    def texts(asked):
        return "".join(c.text for c in replay(path).complete(asked).candidates)

    assert texts(request(n=4)) == "abc"
    assert texts(request(n=2)) == "ab"
    assert texts(request(candidate=1, n=1)) == "b"
    assert texts(request(candidate=2, n=9)) == "c"
    assert texts(request(candidate=3)) == "d"
    assert replay(path).complete(request(n=2)).cost == 1.0
    later = replay(path).complete(request(candidate=1))
    assert (later.cost, later.latency) == (None, None)


def test_repeats_are_told_apart(tmp_path):
    for text in "abc":
        record(tmp_path / "c.jsonl", (request(), text))
    assert [replay(tmp_path / "c.jsonl", repeat=n).complete(request()).text for n in range(3)] == list("abc")
    assert replay(tmp_path / "c.jsonl").complete(request()).text == "a"
    told = refusal(tmp_path / "c.jsonl", request(), repeat=3)
    assert "3 answers" in told
    assert "repeat=3" in told


def test_repeats_by_one_recorder_are_told_apart(tmp_path):
    record(tmp_path / "c.jsonl", (request(), "a"), (request(), "b"))
    record(tmp_path / "c.jsonl", (request(), "c"))
    assert [replay(tmp_path / "c.jsonl", repeat=n).complete(request()).text for n in range(3)] == list("abc")


def test_a_repeat_is_the_same_run_in_every_round(tmp_path):
    """Runs differ in how they went: two begin with the same answer, one needs no second round."""
    runs = [("same", "one"), ("solved",), ("same", "two"), ("other", "three")]
    for first, *later in runs:
        asked = [request(), request(task(), reply(first), feedback("no"), round=1)]
        record(tmp_path / "c.jsonl", *zip(asked, (first, *later), strict=False))
    for repeat, (first, *later) in enumerate(runs):
        llm = replay(tmp_path / "c.jsonl", repeat=repeat)
        assert llm.complete(request()).text == first
        if later:
            second = request(task(), reply(first), feedback("no"), round=1)
            found = llm.complete(second)
            assert (found.text, found.notes) == (later[0], ())


def test_a_run_recorded_by_two_recorders_can_be_replayed(tmp_path):
    second = request(task(), reply("a"), feedback("no"), round=1)
    record(tmp_path / "c.jsonl", (request(), "a"))
    record(tmp_path / "c.jsonl", (second, "b"))
    llm = replay(tmp_path / "c.jsonl")
    assert (llm.complete(request()).text, llm.complete(second).text) == ("a", "b")


def test_an_answer_of_another_run_than_the_wanted_one_is_said(tmp_path):
    record(tmp_path / "c.jsonl", (request(), "a"))
    record(tmp_path / "c.jsonl", (request(), "b"), (request(candidate=1), "c"))
    llm = replay(tmp_path / "c.jsonl")
    assert llm.complete(request()).notes == ()
    found = llm.complete(request(candidate=1))
    assert found.text == "c"
    assert "another run" in found.notes[0]


def test_what_was_recorded_anew_replaces_what_is_stale(tmp_path):
    record(tmp_path / "c.jsonl", (request(task("Draw an old star.")), "old"))
    record(tmp_path / "c.jsonl", (request(), "new"))
    assert replay(tmp_path / "c.jsonl").complete(request()).text == "new"
    assert replay(tmp_path / "c.jsonl").complete(request(task("Draw an old star."))).text == "old"


def test_a_resumed_run_counts_each_answer_once(tmp_path):
    run_folder(tmp_path / "run", (request(), "a"), (request(), "a"))
    assert replay(tmp_path / "run").complete(request()).text == "a"
    assert "one answer" in refusal(tmp_path / "run", request(), repeat=1)


def test_a_stale_answer_stops_with_the_difference_and_the_way_out(keep):
    live = plain_answer("x", "gpt-x-2026").model_copy(update={"model_asked": "openai/gpt-x"})
    path = keep((request(task("Draw a star.\nBig.\nFive lines.\n")), live))
    told = refusal(path, request(task("Draw a star.\nSmall.\nFive lines.\n"))).split("\n")
    assert "drawing/star, method proc3s, seed 0, round 0" in told[0]
    assert "another prompt" in told[0]
    assert ".jsonl:" in told[0]
    assert told[1:3] == ["--- recorded", "+++ now"]
    assert "message 2 (user, task)" in told[3]
    assert told[5:10] == [" Draw a star.", "-Big.", "+Small.", " Five lines.", " "]
    command = shlex.split(told[-1])
    assert command[:9] == [
        "proc3s",
        "run",
        "drawing/star",
        "--method",
        "proc3s",
        "--seed",
        "0",
        "--llm",
        "openai/gpt-x",
    ]
    assert command[9:] == ([] if (path / "events.jsonl").exists() else ["--record", str(path)])
    assert not any("You plan" in line for line in told)


def test_a_difference_names_messages_that_are_new_or_gone(keep):
    path = keep((request(task(), reply("a"), feedback("no"), round=1), "x"))
    example = Message(role="user", kind="example", text="Draw a square.")
    told = refusal(path, request(example, task(), reply("a"), round=1)).split("\n")
    assert [line for line in told if line.startswith("==")] == [
        "== message 2 (user, example): only now ==",
        "== message 5 (user, feedback): only recorded ==",
    ]
    assert "+Draw a square." in told
    assert "-no" in told


def test_a_difference_that_cannot_be_seen_is_written_out(keep):
    path = keep((request(task("Draw\na star.\n")), "x"))
    assert "+Draw\\u000d" in refusal(path, request(task("Draw\r\na star.\n"))).split("\n")
    assert "-" in refusal(path, request(task("Draw\na star."))).split("\n")
    assert "\x1b" not in refusal(path, request(task("Draw\n\x1b[2Ja star.\n")))


def test_a_long_difference_is_cut(keep):
    path = keep((request(task("\n".join(f"old {n}" for n in range(100)))), "x"))
    told = refusal(path, request(task("\n".join(f"new {n}" for n in range(100))))).split("\n")
    shown = [line for line in told if line.startswith(("-old", "+new"))]
    assert 50 < len(shown) < 60
    (rest,) = [line for line in told if line.startswith("…")]
    assert rest == f"… {200 - len(shown)} more lines"


@pytest.mark.parametrize(
    ("change", "hint"),
    [
        ({"task": "drawing/stat"}, "did you mean 'drawing/star'?"),
        ({"method": "cap-gaussian"}, "there is proc3s"),
        ({"seed": 7}, "there is seed 0, 1"),
        ({"round": 5}, "there is round 0, 1"),
        ({"round": 1, "candidate": 2}, "there is candidate 0, 1"),
    ],
)
def test_what_is_there_instead_is_named(tmp_path, change, hint):
    live = plain_answer("x", "gpt-x").model_copy(update={"model_asked": "openai/gpt-x"})
    two = Completion(candidates=(Candidate(text="a"), Candidate(text="b")), model="openai/gpt-x")
    record(tmp_path / "c.jsonl", (request(), live), (request(round=1), two), (request(seed=1), live))
    told = refusal(tmp_path / "c.jsonl", request(**change))
    assert hint in told
    asked = request(**change)
    assert f"{asked.task}, method {asked.method}, seed {asked.seed}, round {asked.round}" in told
    many = f"--candidates {asked.candidate + 1} " if asked.candidate else ""
    assert told.split("\n")[-1].strip() == (
        f"proc3s run {asked.task} --method {asked.method} --seed {asked.seed} {many}--llm openai/gpt-x "
        f"--record {tmp_path / 'c.jsonl'}"
    )


def test_only_the_nearest_of_many_are_named(tmp_path):
    record(tmp_path / "c.jsonl", *((request(seed=seed), "x") for seed in range(40)))
    assert "; there is seed 30, 31, 32, 33, 34, 35, 36, 37, 38, 39 and others\n" in refusal(
        tmp_path / "c.jsonl", request(seed=100)
    )


def test_an_empty_cassette_answers_nothing(tmp_path):
    (tmp_path / "c.jsonl").write_text("")
    told = refusal(tmp_path / "c.jsonl", request())
    assert "nothing in it" in told
    assert "PROVIDER/MODEL" in told


FEEDBACK = "95 % broke the rule at step 3. The nearest miss was off by -0.5 (1e-3), see object_1."


def asked_again(text, goal="Draw 5 lines.", answer="x = 1"):
    return request(task(goal), reply(answer), feedback(text), round=1)


def test_lenient_takes_other_numbers_in_feedback_and_says_so(keep):
    path = keep((asked_again(FEEDBACK), "y"))
    other = FEEDBACK.replace("95", "100").replace("-0.5", "12.25").replace("1e-3", ".5")
    assert "another prompt" in refusal(path, asked_again(other))
    found = replay(path, lenient=True).complete(asked_again(other))
    assert found.text == "y"
    assert "other numbers" in found.notes[0]
    exact = replay(path, lenient=True).complete(asked_again(FEEDBACK))
    assert exact.notes == ()


@pytest.mark.parametrize(
    "other",
    [
        asked_again(FEEDBACK.replace("rule", "law")),
        asked_again(FEEDBACK.replace("object_1", "object_2")),
        asked_again(FEEDBACK, goal="Draw 6 lines."),
        asked_again(FEEDBACK, answer="x = 2"),
    ],
)
def test_lenient_takes_nothing_else(keep, other):
    path = keep((asked_again(FEEDBACK), "y"))
    assert "another prompt" in refusal(path, other, lenient=True)


def on_python(version, **changes):
    system = Message(role="system", kind="system", text=f"Your program runs in Python {version} alone.\n")
    return request(task(), **changes).model_copy(update={"messages": (system, task())})


def test_an_answer_holds_whatever_python_the_prompt_names(keep):
    path = keep((on_python("3.11"), "x"))
    found = replay(path).complete(on_python("3.12"))
    assert found.text == "x"
    assert "another Python" in found.notes[0]
    assert not found.stale
    assert replay(path).complete(on_python("3.11")).notes == ()
    assert "another prompt" in refusal(path, on_python("of today"))


def test_lenient_prefers_the_very_prompt(tmp_path):
    record(tmp_path / "c.jsonl", (asked_again("off by 1"), "one"))
    record(tmp_path / "c.jsonl", (asked_again("off by 2"), "two"))
    assert replay(tmp_path / "c.jsonl", lenient=True).complete(asked_again("off by 2")).text == "two"


def test_a_damaged_or_missing_recording_is_said_at_once(tmp_path):
    record(tmp_path / "c.jsonl", (request(), "x"))
    with (tmp_path / "c.jsonl").open("a") as file:
        file.write("spoilt\n")
    for path in (tmp_path / "c.jsonl", tmp_path):
        with pytest.raises(LLMError, match=r"c\.jsonl:11: "):
            replay(path)
    with pytest.raises(LLMError, match="nowhere"):
        replay(tmp_path / "nowhere")


def test_a_run_whose_prompts_were_changed_is_refused(tmp_path):
    run_folder(tmp_path / "run", (request(), "x"))
    log = tmp_path / "run/events.jsonl"
    log.write_text(log.read_text().replace("Draw a star.", "Draw a fish."))
    with pytest.raises(LLMError, match=r"events\.jsonl:3: damaged"):
        replay(tmp_path / "run")


AUTHORED = "---\norigin: authored\n---\n{}\n"


def test_authored_answers_go_by_template_and_may_be_for_a_seed_round_or_candidate(tmp_path):
    names = ["star.proc3s", "star.proc3s.seed2", "star.proc3s.round1", "star.proc3s.candidate1"]
    for name in names:
        (tmp_path / f"{name}.md").write_text(AUTHORED.format(name))

    def found(**changes):
        for llm, bundled in ((replay(tmp_path), None), (replay(""), tmp_path)):
            completion = llm.complete(request(bundled=bundled, **changes))
            assert completion.source == "authored"
        return completion.text.strip()

    assert found(seed=9, method="other") == "star.proc3s"
    assert found(seed=2) == "star.proc3s.seed2"
    assert found(seed=2, round=1) == "star.proc3s.round1"
    assert found(candidate=1) == "star.proc3s.candidate1"
    assert "candidate2" in refusal(tmp_path, request(candidate=2))
    assert "repeat=1" in refusal(tmp_path, request(), repeat=1)


def test_an_answer_file_that_is_no_text(tmp_path):
    (tmp_path / "star.proc3s.md").write_bytes(b"\xff\xfe")
    with pytest.raises(LLMError, match=r"star\.proc3s\.md"):
        replay(tmp_path).complete(request())


def test_replaying_a_recorded_replay_gives_the_same(tmp_path):
    record(tmp_path / "one.jsonl", (request(), "a"))
    again = Recorder(replay(tmp_path / "one.jsonl"), tmp_path / "two.jsonl")
    again.complete(request())
    assert not again.live
    found = [replay(tmp_path / name).complete(request()) for name in ("one.jsonl", "two.jsonl")]
    assert found[0] == found[1]
    assert found[0].source == "recorded"


OTHER = request(task("Draw a fish."))


def test_a_stale_answer_is_taken_when_that_is_wanted_and_marked(keep):
    path = keep((request(), "x"))
    assert "-L stale=accept" in refusal(path, OTHER)
    found = replay(path, stale="accept").complete(OTHER)
    assert (found.text, found.stale) == ("x", True)
    assert "another prompt" in found.notes[-1]
    fresh = replay(path, stale="accept").complete(request())
    assert (fresh.stale, fresh.notes) == (False, ())


def test_of_stale_answers_the_latest_prompt_counts(tmp_path):
    record(tmp_path / "c.jsonl", (request(task("one")), "first"))
    record(tmp_path / "c.jsonl", (request(task("two")), "second"))
    assert replay(tmp_path / "c.jsonl", stale="accept").complete(OTHER).text == "second"


def test_a_stale_answer_to_another_question_is_none(keep):
    path = keep((request(), "x"))
    assert "no answer" in refusal(path, request(seed=1), stale="accept")


def test_a_stale_answer_stays_stale_when_it_is_recorded_again(tmp_path):
    record(tmp_path / "c.jsonl", (request(), "x"))
    Recorder(replay(tmp_path / "c.jsonl", stale="accept"), tmp_path / "d.jsonl").complete(OTHER)
    assert replay(tmp_path / "d.jsonl").complete(OTHER).stale


def drawn(**sampling):
    one = request()
    return one.model_copy(update={"sampling": Sampling(**sampling)})


@pytest.mark.parametrize(
    ("then", "now", "told"),
    [
        ({"temperature": 0.7}, {"temperature": 0.0}, "temperature 0.7, not 0.0"),
        ({"max_tokens": 100}, {}, "max_tokens 100, not as the provider has it"),
        ({}, {"reasoning_effort": "high"}, "reasoning_effort as the provider has it, not high"),
        ({"n": 2}, {"n": 1}, "candidates 2, not 1"),
        ({"temperature": 0.7, "n": 3}, {"temperature": 0.0, "n": 1}, "temperature 0.7, not 0.0; candidates"),
    ],
)
def test_call_options_other_than_those_of_the_recording_are_said(tmp_path, then, now, told):
    record(tmp_path / "c.jsonl", (drawn(**then), "x"))
    (note,) = replay(tmp_path / "c.jsonl").complete(drawn(**now)).notes
    assert told in note
    assert replay(tmp_path / "c.jsonl").complete(drawn(**then)).notes == ()


def test_an_option_that_the_provider_did_not_take_is_no_difference(tmp_path):
    live = plain_answer("x", "gpt-x").model_copy(update={"dropped": ("temperature",)})
    record(tmp_path / "c.jsonl", (drawn(temperature=0.7), live))
    assert replay(tmp_path / "c.jsonl").complete(drawn(temperature=0.0)).notes == ()


def test_nobody_knows_how_a_person_answered(tmp_path):
    record(tmp_path / "c.jsonl", (drawn(temperature=0.0), plain_answer("x", "a person", "manual")))
    assert replay(tmp_path / "c.jsonl").complete(drawn(temperature=1.0)).notes == ()


def test_the_log_of_a_run_says_how_its_answers_were_drawn(tmp_path):
    live = plain_answer("x", "gpt-x").model_copy(update={"sampling": Sampling(temperature=0.7)})
    run_folder(tmp_path / "run", (request(), live))
    (note,) = replay(tmp_path / "run").complete(drawn(temperature=0.0)).notes
    assert "temperature 0.7, not 0.0" in note
    assert replay(tmp_path / "run").complete(drawn(temperature=0.7)).notes == ()
