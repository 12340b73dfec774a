"""The command line. Each command is a file; what it needs is imported when it runs."""

from proc3s.cli.app import app, main

__all__ = ["app", "main"]
