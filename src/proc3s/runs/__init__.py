"""Events of a run, and what lies on disk."""
