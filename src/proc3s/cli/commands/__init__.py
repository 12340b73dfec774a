"""The commands, one file each: their arguments and help."""
