"""What YAML files and plugins declare, as pydantic models."""

from proc3s.specs.base import Spec as Spec
from proc3s.specs.base import Target as Target
from proc3s.specs.domain import ConstantSpec as ConstantSpec
from proc3s.specs.domain import ConstraintSpec as ConstraintSpec
from proc3s.specs.domain import DomainSpec as DomainSpec
from proc3s.specs.domain import ExampleSpec as ExampleSpec
from proc3s.specs.domain import FieldSpec as FieldSpec
from proc3s.specs.domain import FieldType as FieldType
from proc3s.specs.domain import Named as Named
from proc3s.specs.domain import ParamSpec as ParamSpec
from proc3s.specs.domain import SamplerSpec as SamplerSpec
from proc3s.specs.domain import ScreenSpec as ScreenSpec
from proc3s.specs.domain import SkillSpec as SkillSpec
from proc3s.specs.domain import TaskName as TaskName
from proc3s.specs.domain import TaskSpec as TaskSpec
from proc3s.specs.domain import TypeSpec as TypeSpec
from proc3s.specs.parts import ExecutorSpec as ExecutorSpec
from proc3s.specs.parts import LLMSpec as LLMSpec
from proc3s.specs.parts import MethodSpec as MethodSpec
from proc3s.specs.parts import PresetSpec as PresetSpec
from proc3s.specs.parts import SolverSpec as SolverSpec
from proc3s.specs.parts import TemplatesSpec as TemplatesSpec
