"""A loose plugin file: the walker, executed in a world where every hop carries a little further."""

import dataclasses
from pathlib import Path

from walk import Walk

from proc3s import Score, hookimpl, load_domain


@hookimpl
def register_domains(register):
    register(load_domain(Path(__file__).with_name("slip.yaml")))


class Slippery(Walk):
    def work(self, place):
        self.state = dataclasses.replace(self.state, place=self.state.place)

    def observe(self):
        return dataclasses.replace(self.state, place=self.state.place * 1.5)


def arrived(state, plan, place):
    return Score(state.place == place, f"the walker is at {state.place:g} m")
