"""Why a round failed: the diagnosis that a model, the console and the log get."""
