"""Versions of everything that a result may depend on."""

import contextlib
import platform
import re
from email import message_from_string
from email.message import Message
from importlib.metadata import Distribution, PackageNotFoundError, distribution, entry_points

from proc3s.redaction import platform_name

GROUP = "proc3s"


def versions() -> dict[str, str]:
    """Versions of everything a result may depend on: Python, and all that plugins come with and require."""
    dists = {point.dist for point in entry_points(group=GROUP)}
    plugins = {head["Name"]: head for head in (headers(dist) for dist in dists if dist)}
    texts = (
        text.partition(";") for plugin in plugins.values() for text in plugin.get_all("Requires-Dist", ())
    )
    required = {re.split(r"[^\w.-]", need, maxsplit=1)[0] for need, _, when in texts if "dev" not in when}
    found = {"python": platform.python_version(), "platform": platform_name()}
    for name in sorted({*plugins, *required}):
        with contextlib.suppress(PackageNotFoundError):
            found[name] = headers(distribution(name))["Version"]
    return found


def headers(dist: Distribution) -> Message:
    """Name, version and requirements of a distribution. Its description, most of the file, is not parsed."""
    text = dist.read_text("METADATA") or dist.read_text("PKG-INFO") or ""
    return message_from_string(text.partition("\n\n")[0])
