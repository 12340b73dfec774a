"""A domain at work: states, plans, worlds, margins and samplers."""
