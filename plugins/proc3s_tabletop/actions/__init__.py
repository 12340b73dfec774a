"""What a pick and a place are, whatever engine carries them out."""
