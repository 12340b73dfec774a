"""Our own domains, samplers, screens, backends and executors pass the kits that a third party's pass."""

from importlib.util import find_spec

import pytest

from proc3s.domain.samplers import ContinuousSampler, DiscreteSampler
from proc3s.plugins.registry import open_registry
from proc3s.specs.parts import ExecutorSpec
from proc3s.testing.constraints import ConstraintTests, ScreenTests
from proc3s.testing.domains import DomainTests
from proc3s.testing.executors import ExecutorTests
from proc3s.testing.llms import BackendTests
from proc3s.testing.samplers import SamplerTests

needs_tabletop = pytest.mark.skipif(find_spec("pybullet") is None, reason="needs the extra `tabletop`")


@pytest.mark.slow
class TestDrawing(DomainTests):
    @pytest.fixture
    def domain_name(self):
        return "drawing"


@pytest.mark.slow
@needs_tabletop
class TestBlocks(DomainTests):
    @pytest.fixture
    def domain_name(self):
        return "blocks"


@pytest.mark.slow
@needs_tabletop
class TestYcb(DomainTests):
    @pytest.fixture
    def domain_name(self):
        return "ycb"


class TestCollision(ConstraintTests):
    @pytest.fixture
    def domain_name(self):
        return "drawing"

    @pytest.fixture
    def constraint_name(self):
        return "collision"


class TestSegments(ScreenTests):
    @pytest.fixture
    def registry(self):
        return open_registry()

    @pytest.fixture
    def domain_name(self):
        return "drawing"


class TestContinuous(SamplerTests):
    @pytest.fixture
    def sampler(self):
        return ContinuousSampler(-2.0, 3.0)


class TestDiscrete(SamplerTests):
    @pytest.fixture
    def sampler(self):
        return DiscreteSampler([1, 2, 5])


@needs_tabletop
class TestGrasp(SamplerTests):
    @pytest.fixture
    def sampler(self):
        from proc3s_tabletop.tasks.grasp_sampler import GraspSampler

        return GraspSampler()


@pytest.mark.slow
class TestSerial(ExecutorTests):
    @pytest.fixture
    def domain_name(self):
        return "drawing"

    @pytest.fixture
    def make_executor(self):
        return lambda: open_registry().get(ExecutorSpec, "serial").load()(jobs=1)


@pytest.mark.slow
class TestProcesses(ExecutorTests):
    @pytest.fixture
    def domain_name(self):
        return "drawing"

    @pytest.fixture
    def make_executor(self):
        return lambda: open_registry().get(ExecutorSpec, "processes").load()(jobs=2)


class TestStub(BackendTests):
    @pytest.fixture
    def make_llm(self, stub):
        from proc3s.planning.llm_backend import find_llm

        name = stub("```python\nx = 1\n```")
        return lambda: find_llm(open_registry(), name, {}).make()

    @pytest.fixture
    def unable_llm(self, stub):
        from proc3s.planning.llm_backend import find_llm

        return find_llm(open_registry(), stub(), {}).make()
