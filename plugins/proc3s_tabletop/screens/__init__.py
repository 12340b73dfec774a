"""Cheap tests of many plans, before a world is asked."""
