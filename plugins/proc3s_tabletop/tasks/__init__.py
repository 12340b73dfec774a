"""What a task of a `domain.yaml` may name: scenes, judges, methods of the state, samplers."""
