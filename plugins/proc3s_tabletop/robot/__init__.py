"""The arm and the hand as numbers."""
