"""Commands in typer's terms, with help that fits 80 columns, and names of two words."""

from typing import Any

from typer.core import TyperCommand, TyperGroup


class Command(TyperCommand):
    """A command whose flags have no type in its help: each takes nothing."""

    def get_params(self, ctx: Any) -> list[Any]:
        """The parameters, with `--help`."""
        return _for_help(super().get_params(ctx))


class CommandGroup(TyperGroup):
    """A group in which `bench ccsp`, say, is a command beside `bench`."""

    def get_params(self, ctx: Any) -> list[Any]:
        """The parameters, with `--help`."""
        return _for_help(super().get_params(ctx))

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[Any, Any, list[str]]:
        """The command that the first one or two words name, and what is left for it."""
        name = " ".join(args[:2])
        return super().resolve_command(ctx, [name, *args[2:]] if name in self.commands else args)


def _for_help(params: list[Any]) -> list[Any]:
    """Flags without a type; in a help of panels, what has none of its own is about the output."""
    panels = {param.rich_help_panel for param in params if param.rich_help_panel}
    for param in params:
        if param.param_type_name == "option" and panels:
            param.rich_help_panel = param.rich_help_panel or "Output"
        if getattr(param, "is_flag", False):
            param.metavar = ""
    return sorted(params, key=lambda param: param.rich_help_panel == "Output")  # which comes last
