import pickle

import pytest

from proc3s.sandbox import SandboxUnavailable, SketchContractError, SketchIssue, SketchTimeout
from proc3s.sandbox.text import Source, clean, message


@pytest.mark.parametrize(
    "bad",
    [
        "\x1b",
        "\x00",
        "\u202e",
        "\u200b",
        "\ufeff",
        "\u2066",
        "\U000e0041",
        "\ud800",
        "\r",
        "\u3164",
        "\ufe0f",
    ],
)
def test_what_could_mislead_a_reader_is_replaced(bad):
    assert clean(f"a{bad}b", 10) == "a?b"


def test_text_is_cut():
    assert clean("x" * 50, 10) == "x" * 9 + "…"
    assert len(message("word " * 1000)) == 600


def test_messages_are_one_line_and_logs_keep_theirs():
    assert message("a\n  b\tc") == "a b c"
    assert clean("a\nb", 10) == "a\nb"


def test_lines_are_counted_as_python_counts_them():
    source = Source("a = 1\r\nb = '\x0c\u2028'\rc = 3\n")
    assert source.quote(3) == (3, "c = 3")
    assert source.quote(2) == (2, "b = '??'")
    assert source.quote(0) == source.quote(99) == source.quote(None) == (None, None)


def test_errors_pickle_with_everything():
    issue = SketchIssue("the plan is empty", 3, "return []")
    error = pickle.loads(pickle.dumps(SketchContractError.of([issue, SketchIssue("and more")])))
    assert type(error) is SketchContractError
    assert error.issues == (issue, SketchIssue("and more"))
    assert str(error) == "line 3: the plan is empty\nand more"
    error = pickle.loads(pickle.dumps(SketchTimeout("too slow", 2, "while True: pass")))
    assert (error.kind, str(error), error.source) == ("SketchTimeout", "line 2: too slow", "while True: pass")
    assert "no seccomp" in str(pickle.loads(pickle.dumps(SandboxUnavailable("no seccomp"))))
