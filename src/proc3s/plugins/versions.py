"""Versions of everything that a result may depend on."""

import contextlib
import platform
import re
from importlib.metadata import PackageNotFoundError, entry_points, version

from proc3s.redaction import platform_name

GROUP = "proc3s"


def versions() -> dict[str, str]:
    """Versions of everything a result may depend on: Python, and all that plugins come with and require."""
    plugins = {e.dist.name: e.dist for e in entry_points(group=GROUP) if e.dist}
    texts = (text.partition(";") for plugin in plugins.values() for text in plugin.requires or ())
    required = {re.split(r"[^\w.-]", need, maxsplit=1)[0] for need, _, when in texts if "dev" not in when}
    found = {"python": platform.python_version(), "platform": platform_name()}
    for name in sorted({*plugins, *required}):
        with contextlib.suppress(PackageNotFoundError):
            found[name] = version(name)
    return found
