"""The samplers that ship with proc3s, registered like a stranger's."""

from collections.abc import Callable

from proc3s.markers import hookimpl
from proc3s.specs.domain import SamplerSpec


@hookimpl
def register_samplers(register: Callable[[SamplerSpec], None]) -> None:
    """The two samplers of the paper."""
    register(
        SamplerSpec(
            name="ContinuousSampler",
            summary="A number, drawn uniformly between min and max.",
            params={"min": "float", "max": "float"},
            gives="float",
            target="proc3s.domain.samplers:ContinuousSampler",
        )
    )
    register(
        SamplerSpec(
            name="DiscreteSampler",
            summary="One of the given values, each equally likely.",
            params={"values": "list"},
            gives="choice",
            target="proc3s.domain.samplers:DiscreteSampler",
        )
    )
