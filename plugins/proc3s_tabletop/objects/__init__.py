"""Shapes as numbers, without an engine."""
