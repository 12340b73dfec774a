"""A backend: answers from a folder, `--llm shelf:DIR`, one file for each task and method."""

from pathlib import Path

from proc3s import LLM, LLMError, answer


class Shelf(LLM):
    """Reads `TASK.METHOD.md`."""

    def __init__(self, model, options):
        self.folder = Path(model)

    def complete(self, request):
        path = self.folder / f"{request.task.replace('/', '-')}.{request.method}.md"
        if not path.is_file():
            raise LLMError(f"there is no answer {path}", "no_answer")
        return answer(path.read_text(encoding="utf-8"), "shelf", "manual")
