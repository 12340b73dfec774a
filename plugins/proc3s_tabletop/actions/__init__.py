"""What a pick and a place are, independent of the engine."""
