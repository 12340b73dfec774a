"""The second stage measured without an LLM."""
