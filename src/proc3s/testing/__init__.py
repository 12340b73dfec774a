"""Conformance kits: pytest classes that a plugin author inherits and gives a fixture.

`domains.DomainTests`, `constraints.ConstraintTests` and `ScreenTests`, `samplers.SamplerTests`,
`solvers.SolverTests`, `llms.BackendTests`, `executors.ExecutorTests`.
"""
