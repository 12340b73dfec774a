"""How many questions a run may still ask."""


class RoundBudget:
    """How many questions are left: the first, the feedback rounds, and repairs of unusable programs.

    A program that cannot be sampled costs a repair before it costs a round, as many in a row as the
    preset says.
    """

    def __init__(self, feedback: int, repairs: int) -> None:
        self._feedback = feedback
        self.left = feedback + 1
        self._repairs = repairs if feedback else 0
        self._repaired = 0

    @property
    def used(self) -> int:
        """Feedback rounds so far; the first question is none."""
        return min(self._feedback + 1 - self.left, self._feedback)

    def spend(self, repair: bool) -> None:
        """Count a question that brought no accepted plan; `repair`: its program could not be used at all."""
        if repair and self._repaired < self._repairs:
            self._repaired += 1
        else:
            self.left -= 1
            self._repaired = 0
