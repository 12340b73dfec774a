"""From samples to trials: solvers, screens, rollouts."""
