"""The nodes that can be started in this process, found by entry points.

They are found through the entry points ``linkwright.nodes`` and ``linkwright.components``, whose names are
``PACKAGE/EXECUTABLE``, or ``PACKAGE/PLUGIN`` for nodes that containers load. Each points to a `Factory`. Ours are
declared in ``pyproject.toml``, those of others in their packages. A module is imported when its first node is started.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.loading.extensions import extensions
from linkwright.nodes.options import Factory

if TYPE_CHECKING:
    from linkwright.loading.extensions import EntryPoint


class NodeRegistry(Mapping[tuple[str, str], Factory]):
    """Finds the function or class that starts a node, by package and executable.

    Args:
        group: of the entry points.
    """

    def __init__(self, group: str) -> None:
        self._group = group

    @cached_property
    def entry_points(self) -> dict[tuple[str, str], EntryPoint]:
        """The entry points, by package and name."""
        found: dict[tuple[str, str], EntryPoint] = {}
        for name, entry in extensions(self._group).items():
            package, _, node = name.partition("/")
            found[package, node] = entry
        return found

    def __getitem__(self, key: tuple[str, str]) -> Factory:
        """The function or class that starts a node.

        Raises:
            KeyError: there is no such node.
            LinkwrightError: the package that brings it cannot be imported (NODE002).
        """
        entry = self.entry_points[key]
        try:
            factory: Factory = entry.load()
        except Exception as error:
            package, name = key
            message = phrase("the node '{package}/{name}' cannot be imported", package=package, name=name)
            hint = phrase("'{place}' brings it: {problem}", place=entry.distribution, problem=foreign(error))
            raise LinkwrightError(Diagnostic("NODE002", message, hint=hint)) from error
        return factory

    def __contains__(self, key: object) -> bool:
        return key in self.entry_points

    def __iter__(self) -> Iterator[tuple[str, str]]:
        return iter(self.entry_points)

    def __len__(self) -> int:
        return len(self.entry_points)


def default_name(package: str, executable: str) -> str | None:
    """Return the default name of a node; None if only the node itself knows it."""
    with suppress(LinkwrightError, KeyError):
        name: str | None = getattr(EXECUTABLES[package, executable], "DEFAULT_NAME", None)
        return name
    return None


EXECUTABLES = NodeRegistry("linkwright.nodes")
"""The nodes that a launch file or a command can name."""

COMPONENTS = NodeRegistry("linkwright.components")
"""The nodes that can be composed."""
