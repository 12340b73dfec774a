"""Bodies that a `domain.yaml` may name."""
