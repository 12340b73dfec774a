"""The program in answers of every shape that models give them."""

import json
import textwrap
import time
from itertools import product

import pytest

from proc3s.llm.types import Candidate, Completion
from proc3s.planning.proposals import proposals_of
from proc3s.prompts.extract import extract, extract_program, without_thinking

PLAN = '''\
def gen_plan(initial, x):
    """Draws a line.

    ```
    gen_plan(initial, 3)
    ```
    """
    return [Action("draw_line", [x, 1.0, x, ring(2.0)])]'''
DOMAIN = 'def gen_domain(initial):\n    return {"x": ContinuousSampler(0, 100)}'
HELPER = "import math\n\n\ndef ring(r):\n    return math.hypot(r, r)"
PROGRAM = f"{HELPER}\n\n\n{PLAN}\n\n\n{DOMAIN}"
OLD = PROGRAM.replace("2.0", "7.0")


def indented(text, by):
    return textwrap.indent(text, by, lambda line: True)


def fenced(code, language="python", fence="```"):
    return f"{fence}{language}\n{code}\n{fence}"


FENCES = ["```", "`````", "~~~", "~~~~~"]
LANGUAGES = ["python", "Python", "py", "python3", "", "python title=plan.py", " python "]
FRAMES = {
    "alone": lambda block: block,
    "prose": lambda block: f"Here it is:\n\n{block}\n\nIt works since rings are round.",
    "windows": lambda block: f"Here it is:\n{block}\nDone.".replace("\n", "\r\n"),
    "numbered": lambda block: "1. " + indented(block, "   ")[3:] + "\n2. Done.",
    "bullet": lambda block: "- first\n- " + indented(block, "    ")[4:] + "\n- done",
    "indented": lambda block: "Here:\n\n" + indented(block, "    ") + "\n\nDone.",
    "quote": lambda block: "As said:\n" + indented(block, "> ") + "\n\nDone.",
    "quotes": lambda block: "As said:\n" + indented(block, "> > "),
    "bold": lambda block: f"**{block}**",
    "unclosed": lambda block: f"Here:\n{block.rstrip('`~')}",
}


@pytest.mark.parametrize(("fence", "language", "frame"), [*product(FENCES, LANGUAGES, FRAMES)])
def test_a_fence_is_found_in_any_frame(fence, language, frame):
    assert extract_program(FRAMES[frame](fenced(PROGRAM, language, fence))) == PROGRAM


@pytest.mark.parametrize("before", ["Sure! ", "Here is the `gen_plan`: ", "**Program:** ", "> Sure: "])
@pytest.mark.parametrize("language", ["python", ""])
def test_text_may_stand_before_a_fence_on_its_line(before, language):
    block = fenced(PROGRAM, language)
    if before.startswith(">"):
        block = indented(block, "> ")[2:]
    assert extract_program(f"{before}{block}\nDone.") == PROGRAM


SHAPES = {
    "code on the fence's line": (f"```{PROGRAM}\n```", PROGRAM),
    "a language and code on the fence's line": (f"```python {PROGRAM}\n```", PROGRAM),
    "closed on the last line": (f"```python\n{PROGRAM}```\nDone.", PROGRAM),
    "one line": ('So: ```gen_plan = [Action("a", [1])]``` as asked', 'gen_plan = [Action("a", [1])]'),
    "code elements": (f"<pre><code class='language-python'>\n{PROGRAM}\n</code></pre>", PROGRAM),
    "escaped": (
        f"<code>{PROGRAM.replace('[x, 1.0', '[x < 3 and x, 1.0').replace('<', '&lt;')}</code>",
        PROGRAM.replace("[x, 1.0", "[x < 3 and x, 1.0"),
    ),
    "a fence within code elements": (f"<code>\n{fenced(PROGRAM)}\n</code>", PROGRAM),
    "prose and no fence": (f"Sure, this draws a line.\n\n{PROGRAM}\n\nI hope this helps!", PROGRAM),
    "prose in between": (
        f"First the plan.\n\n{PLAN}\n\nThen its domain.\n\n{DOMAIN}",
        f"{PLAN}\n\n\n{DOMAIN}",
    ),
    "indented and no fence": (f"Sure, this is it:\n\n{indented(PROGRAM, '    ')}\n\nDone.", PROGRAM),
    "a literal list": (
        "The plan is this.\ngen_plan = [\nAction('a', [1]),\n]",
        "gen_plan = [\nAction('a', [1]),\n]",
    ),
    "never closed before the next": (f"```python\nprint('no\n```python\n{PROGRAM}\n```", PROGRAM),
    "a string never closed": (f"```python\n{PROGRAM}\nx = '''oops\n```\nDone.", f"{PROGRAM}\nx = '''oops"),
    "in a block of markdown": (f"````markdown\n# Plan\n{fenced(PROGRAM)}\n````", PROGRAM),
}  # fmt: skip


@pytest.mark.parametrize("shape", SHAPES)
def test_unusual_shapes(shape):
    answer, program = SHAPES[shape]
    assert extract_program(answer) == program


STUB = "def gen_plan(initial, x):\n    # as above\n    ...\n\nprint(3)"
SEVERAL = {
    "usage after it": ([PROGRAM, "plan = gen_plan(initial, 30)\nprint(plan)"], [0]),
    "usage before it": (["x = 3\nplan = gen_plan(initial, x)", PROGRAM], [1]),
    "a draft that is no Python": (["def gen_plan(initial, x):\n    return [Action(", PROGRAM], [1]),
    "a correction": ([OLD, PROGRAM], [1]),
    "a correction of one function": ([OLD, PLAN], [0, 1]),
    "one block a function": ([HELPER, PLAN, DOMAIN], [0, 1, 2]),
    "helpers after it": ([PLAN, DOMAIN, HELPER], [0, 1, 2]),
    "the last of two helpers": ([HELPER.replace("hypot", "dist"), HELPER, PLAN, DOMAIN], [1, 2, 3]),
    "a helper of a helper": (["TWO = 2", HELPER.replace("r, r)", "r, TWO)"), PLAN, DOMAIN], [0, 1, 2, 3]),
    "values of parameters": (["x = 30", PROGRAM], [1]),
    "a stub that repeats it": ([PROGRAM, STUB], [0]),
    "something else": ([PROGRAM, "for each point:\n    draw a line"], [0]),
}


@pytest.mark.parametrize("case", SEVERAL)
@pytest.mark.parametrize("language", ["python", ""])
def test_of_several_blocks_those_that_make_the_program_are_taken(case, language):
    blocks, taken = SEVERAL[case]
    found = extract("\n\nThen:\n\n".join(fenced(code, language) for code in blocks))
    assert found.program == "\n\n".join(blocks[i] for i in taken)
    assert bool(found.blocks) is (len(taken) < len(blocks))


@pytest.mark.parametrize("language", ["bash", "json", "text", "output", ""])
def test_blocks_of_other_languages_are_left(language):
    other = "pip install numpy\nring = 3" if language else "Action(name='draw_line')"
    found = extract(f"{fenced(other, language)}\n{fenced(PROGRAM, '')}\n{fenced(other, language)}")
    assert (found.program, found.blocks) == (PROGRAM, "block 2 of 3")


def test_which_blocks_were_taken_is_told():
    answer = "\n".join(map(fenced, [HELPER, OLD.replace("7.0", "9"), PLAN, DOMAIN, "print(gen_plan(1, 2))"]))
    assert extract(answer).blocks == "blocks 2, 3 and 4 of 5"


@pytest.mark.parametrize("character", ["\u2028", "\u2029", "\x0b", "\x0c", "\x1c", "\x1e", "\x85"])
def test_only_what_breaks_lines_for_python_breaks_them_here(character):
    program = PROGRAM.replace('"""Draws', f'text = "a{character}b"\n    """Draws')
    assert extract_program(fenced(program)) == program
    assert extract_program(program) == program


THOUGHTS = {
    "closed": f"<think>\nPerhaps\n{fenced(OLD)}\n</think>\n\n",
    "other tag": f"<thinking>{fenced(OLD)}</thinking>",
    "never opened": f"Perhaps\n{fenced(OLD)}\n</think>\n",
    "never closed": "<think>\nPerhaps so:\n",
}


@pytest.mark.parametrize("thought", THOUGHTS)
def test_what_a_model_thought_aloud_is_no_part_of_its_answer(thought):
    answer = THOUGHTS[thought] + "Here:\n" + fenced(PROGRAM)
    completion = Completion(candidates=(Candidate(text=answer),), model="m")
    (proposal,) = proposals_of(completion, 0)
    assert proposal.program().program == PROGRAM
    assert "<" not in proposal.answer


def test_a_tag_within_an_answer_is_left():
    answer = f"I would use <think> here.\n{fenced(PROGRAM)}"
    assert without_thinking(answer) == answer


AT_ONCE = "def gen_plan(initial, cx):\n    return [Action('a', [{}])]"
NO_DOMAIN = 'def gen_domain(initial):\n    return {"cx": ContinuousSampler(0, 1)}'


def using(expression, domain=NO_DOMAIN):
    return f"{AT_ONCE.format(expression)}\n\n\n{domain}"


def begun_with(line, function):
    return function.replace("    return", f"    {line}\n    return", 1)


PT = "def pt(a):\n    return a"
HELPED = {
    "an import of several lines": ["from math import (\n    cos,\n    sin,\n)", using("cos(cx), sin(cx)")],
    "several names at once": ["ONE, TWO = 1, 2", using("ONE, TWO")],
    "an import of all": ["from math import *", using("cos(cx)")],
    "a docstring that names the plan": [
        'def helper(a):\n    """Used by gen_plan(initial)."""\n    return a + 1',
        using("helper(cx)"),
    ],
    "a default": ["ONE = 1", using("one").replace("cx)", "cx, one=ONE)", 1)],
    "a local name elsewhere": ["scale = 1", using("scale * cx", begun_with("scale = 2", NO_DOMAIN))],
    "a parameter elsewhere": ["ONE = 1", using("ONE", f"def twice(ONE):\n    return 2\n\n\n{NO_DOMAIN}")],
    "a comprehension elsewhere": [PT, using("pt(cx)", begun_with("q = [pt for pt in range(3)]", NO_DOMAIN))],
    "a comprehension nearby": [PT, using("pt(cx), *[pt for pt in range(3)]")],
    "a trial": ["try:\n    ONE = 1\nexcept Exception:\n    ONE = 2", using("ONE")],
    "a loop": ["for ONE in [1]: pass", using("ONE")],
    "a clause and its statement on a line": ["if True: ONE = 1", using("ONE")],
    "a value changed in another block": ["D = {}", "D['a'] = 1", using("D['a']")],
    "a value changed before the plan": ["D = {}", "D['a'] = 1\n\n\n" + using("D['a']")],
    "a keyword of the same name": [PT, begun_with("pt(a=cx)", using("cx"))],
    "an f-string": ["ONE = 1", using("f'{ONE}'")],
    "a global name": ["ONE = 1", begun_with("global ONE; ONE = ONE + 1", using("cx"))],
    "a method of its name": [
        PT,
        using("P().pt()", f"class P:\n    def pt(self):\n        return pt(1)\n\n\n{NO_DOMAIN}"),
    ],
}


@pytest.mark.parametrize("case", HELPED)
def test_a_name_bound_in_one_function_says_nothing_about_its_use_in_another(case):
    assert extract_program("\n".join(map(fenced, HELPED[case]))) == "\n\n".join(HELPED[case])


def test_a_draft_is_taken_only_for_what_nothing_else_binds():
    draft = f"{PT}\n\n\ndef gen_plan(initial):\n    return [Action("
    program = using("cx", begun_with("q = [pt for pt in range(3)]", NO_DOMAIN))
    assert extract_program(f"{fenced(draft)}\n{fenced(program)}") == program


SKELETON = """\
def gen_plan(initial, x):
    '''Draws
    a line.'''
    BODY


def gen_domain(initial):
    "As above."
    BODY"""
NO_VERSION = {
    "a skeleton": fenced(SKELETON.replace("BODY", "...")),
    "a skeleton that raises": fenced(SKELETON.replace("BODY", "raise NotImplementedError('later')")),
    "no label": fenced(OLD, ""),
    "text": fenced(OLD, "text"),
    "a diff": fenced(OLD, "diff"),
    "usage": fenced("gen_domain = None\nplan = gen_plan(initial, 3)"),
}


@pytest.mark.parametrize("case", NO_VERSION)
def test_what_follows_the_program_and_is_no_new_version(case):
    assert extract_program(f"{fenced(PROGRAM)}\nThat is:\n{NO_VERSION[case]}") == PROGRAM


@pytest.mark.parametrize("thought", ["closed", "other tag", "never opened"])
def test_a_thought_after_the_program_hides_nothing(thought):
    answer = f"{THOUGHTS[thought]}{fenced(PROGRAM)}\n<think>Right?</think>\nDone."
    assert extract_program(without_thinking(answer)) == PROGRAM


@pytest.mark.slow
@pytest.mark.parametrize(
    "unit",
    [
        "```\n'''\n",
        "def f(\n",
        "def gen_plan(\n",
        "for for ",
        "<code>",
        "`` ",
        "x = (",
        "> ",
        "<think>",
        "1. ",
        "x = ",
        "x=",
        "f(x=",
        '\\"""',
        "\"\"\"'''",
        "class A:\n def f():\n",
        "{",
        "if a: ",
        "x: ",
        "def f():\n ''' a\n",
        "```python\nx = y\n```\n",
    ],
)
def test_no_answer_of_any_length_takes_long(unit):
    started = time.process_time()  # whatever else the machine does
    extract(f"{unit * 50_000}\ndef gen_plan(s):\n    return 1\n```\n")
    assert time.process_time() - started < 10


def test_what_was_taken_is_said(tmp_path, cli):
    program = PROGRAM.replace("ring(2.0)", "2.0").replace("0, 100", "1, 99")
    answer = f"{fenced(program)}\nUse it:\n{fenced('print(gen_plan(initial, 3))')}"
    (tmp_path / "stub.json").write_text(json.dumps([answer]))
    run = tmp_path / "run"
    goal = ["--goal", "a line", "--llm", f"stub:{tmp_path / 'stub.json'}"]
    done = cli("run", "drawing/free", *goal, "--out", run)
    assert "the program is block 1 of 2 in the answer" in done.stderr
    assert "The program is block 1 of 2 in the answer." in cli("explain", run).stdout
