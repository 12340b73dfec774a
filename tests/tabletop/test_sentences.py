"""What the toolbox says of a failure is written in one place."""

import ast
from collections import defaultdict
from pathlib import Path

import proc3s_tabletop

TOOLBOX = Path(proc3s_tabletop.__file__).parent
LONG = 12
"""Shorter texts are names, units and joints of sentences."""


def texts(tree):
    """(line, text) of all strings of a module but docstrings; what an f-string fills in is `{}`."""
    notes = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    filled = [node for node in ast.walk(tree) if isinstance(node, ast.JoinedStr)]
    pieces = {id(piece) for node in filled for piece in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            yield node.lineno, "".join(p.value if isinstance(p, ast.Constant) else "{}" for p in node.values)
        elif isinstance(node, ast.Constant) and id(node) not in notes | pieces:
            yield node.lineno, str(node.value)


def test_no_sentence_stands_twice():
    places = defaultdict(list)
    for path in sorted(TOOLBOX.rglob("*.py")):
        for line, text in texts(ast.parse(path.read_text(encoding="utf-8"))):
            words = text.strip().strip("{} ")
            if " " in words and len(words) >= LONG:
                places[words].append(f"{path.relative_to(TOOLBOX)}:{line}")
    assert len(places) > 100
    assert {words: where for words, where in places.items() if len(where) > 1} == {}
