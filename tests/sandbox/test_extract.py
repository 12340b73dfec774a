import time

import pytest

from proc3s.prompts.extract import extract_program
from proc3s.sandbox import SketchContractError


def test_python_fences_are_joined_and_others_ignored():
    answer = "First\n```python\na = 1\n```\nthen\n```\nshell\n```\nand\n~~~py\nb = 2\n~~~\nDone."
    assert extract_program(answer) == "a = 1\n\nb = 2"


def test_any_fence_will_do_when_none_says_python():
    assert extract_program("Here:\n```\na = 1\n```\n```text\nb = 2\n```") == "a = 1\n\nb = 2"


@pytest.mark.parametrize(
    "answer",
    ["def gen_plan(state):\n    return []", "x = 1\ngen_plan = [Action('go', [])]", "gen_plan: list = []"],
)
def test_a_bare_program_is_taken_whole(answer):
    assert extract_program(answer) == answer


def test_a_fence_that_is_never_closed_reaches_to_the_end():
    assert extract_program("```python\na = 1\nb = 2") == "a = 1\nb = 2"


def test_indented_and_longer_fences():
    assert (
        extract_program("1. do\n   ````Python title=x\n   a = '''\n   ```\n   '''\n   ````\n")
        == "a = '''\n```\n'''"
    )


def test_inline_code_is_no_fence():
    with pytest.raises(SketchContractError, match="python block that defines gen_plan"):
        extract_program("Use ```gen_plan``` please.")


@pytest.mark.parametrize("answer", ["", "I cannot do that.", "```python\n```", "call gen_plan == 3"])
def test_no_program(answer):
    with pytest.raises(SketchContractError, match="contains no program"):
        extract_program(answer)


@pytest.mark.parametrize(
    "answer", ["```" + "x" * 10**6 + "`", "\n" * 10**6, "``` " + " " * 10**6 + "`", "`" * 10**6]
)
def test_no_answer_takes_long_to_search(answer):
    started = time.process_time()
    with pytest.raises(SketchContractError):
        extract_program(answer)
    assert time.process_time() - started < 2
