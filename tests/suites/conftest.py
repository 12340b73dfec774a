from pathlib import Path

import pytest

import proc3s_drawing


@pytest.fixture
def answers_of_star():
    """The bundled answer to drawing/star, without its head."""
    path = Path(proc3s_drawing.__file__).parent / "answers/star.proc3s.md"
    return path.read_text(encoding="utf-8").split("---", 2)[2]
