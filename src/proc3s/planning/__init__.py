"""The two-stage loop, and how the chosen plugins are wired into it."""
