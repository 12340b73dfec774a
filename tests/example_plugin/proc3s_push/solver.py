"""A solver: samples ever closer around the best one so far."""

import numpy as np


class Annealed:
    """Half of every batch is drawn anywhere, half around the best sample, nearer with every batch."""

    def __init__(self, space, budget, rng, options):
        self.dim, self.rng = space.dim, rng
        self.best, self.score, self.spread = None, -np.inf, 0.5

    def ask(self, limit):
        u = self.rng.random((min(limit, 32), self.dim))
        if self.best is not None:
            near = self.best + self.rng.normal(0.0, self.spread, u[::2].shape)
            u[::2] = near % 1.0
        return np.clip(u, 0.0, 1.0 - 1e-12)

    def tell(self, trials):
        for trial in trials:
            if trial.progress > self.score:
                self.best, self.score = np.array(trial.u), trial.progress
        self.spread = max(0.02, 0.8 * self.spread)
