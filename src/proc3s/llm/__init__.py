"""Language models: typed messages, and one way to ask."""
