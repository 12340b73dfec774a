"""Conformance kits: pytest classes that a plugin author inherits and gives a fixture."""
