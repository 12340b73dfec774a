"""Suites: many runs side by side, what is kept of them, and the tables made of that."""
