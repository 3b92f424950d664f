"""The sections of ROS 2 parameter files, with their nodes and possible parameters."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

from linkwright.language.parameter_catalog import (
    CONTROLLER_MANAGER,
    ParameterInfo,
    controller_parameters,
    find_owners,
    node_names,
    node_parameters,
    plugins,
)
from linkwright.language.yaml_outline import YamlEntry, YamlOutline

PARAMETERS_KEY = "ros__parameters"
_COMMON_PARAMETER = ParameterInfo(
    "use_sim_time", "bool", False, "whether the node uses the simulated time of the topic `/clock`"
)
_TYPE_PARAMETER = ParameterInfo("type", "string", None, "the type of the controller, if the node is one")


@dataclass(frozen=True, slots=True)
class Section:
    """The ``ros__parameters`` section of a node, and a position inside it.

    Attributes:
        entry: the YAML entry with the key ``ros__parameters``.
        node: the name of the node, or empty for a pattern such as ``/**``.
        prefix: the keys between ``ros__parameters`` and the position, joined by dots.
        controllers: the types of the controllers that the file declares, by name.
    """

    entry: YamlEntry
    node: str
    prefix: str
    controllers: Mapping[str, str]

    @property
    def is_manager(self) -> bool:
        """Whether the node is a controller manager."""
        return self.node == CONTROLLER_MANAGER or _declares_controllers(self.entry)

    @property
    def may_be_controller(self) -> bool:
        """Whether the node may be a controller: neither a manager nor a known node."""
        return bool(self.node) and not self.is_manager and not node_parameters(self.node)

    def name(self, key: str) -> str:
        """Return the full name of the parameter with a key at the position."""
        return f"{self.prefix}.{key}" if self.prefix else key

    def entries(self) -> dict[str, YamlEntry]:
        """Return the entries of the section, by full parameter name."""
        return {".".join(_find_keys_below(self.entry, entry)): entry for entry in self.entry.all() if entry.key}

    def parameters(self) -> list[ParameterInfo]:
        """Return the possible parameters of the section's node and its plugins."""
        entries = self.entries()
        if self.node in self.controllers:
            parameters = list(controller_parameters(self.controllers[self.node], entries.keys()))
        else:
            owners = [self.node] if node_parameters(self.node) else find_owners(entries)[:1]
            parameters = [parameter for owner in owners for parameter in node_parameters(owner)]
            if not self.node:
                parameters += [_COMMON_PARAMETER, *_common_parameters()]
        if self.may_be_controller:
            parameters.append(_TYPE_PARAMETER)
        return [*parameters, *self._plugin_parameters(entries), _COMMON_PARAMETER]

    def find(self, name: str) -> ParameterInfo | None:
        """Return the parameter with a full name, or None if it is unknown."""
        return next((parameter for parameter in self.parameters() if parameter.matches(name)), None)

    def _plugin_parameters(self, entries: Mapping[str, YamlEntry]) -> Iterator[ParameterInfo]:
        for name, entry in entries.items():
            prefix, _, last = name.rpartition(".")
            plugin = (
                plugins().get(entry.scalar.replace("::", "/")) if last in ("plugin", "primary_controller") else None
            )
            if plugin is not None and prefix:
                yield from (parameter.with_prefix(prefix, plugin.type) for parameter in plugin.parameters)


def section_at(outline: YamlOutline, entry: YamlEntry) -> Section | None:
    """Return the section that contains an entry, or None if the entry is outside sections.

    Args:
        outline: the file.
        entry: an entry of the file, which may be ``ros__parameters`` itself.
    """
    keys: list[str] = []
    current: YamlEntry | None = entry
    while current is not None and current.key != PARAMETERS_KEY:
        keys = [current.key, *keys] if current.key else keys
        current = current.parent
    if current is None or current.parent is None:
        return None
    return Section(current, node_of(current), ".".join(keys), declared_controllers(outline))


def node_of(entry: YamlEntry) -> str:
    """Return the node name for a ``ros__parameters`` entry, or empty for a pattern."""
    parts = [part for key in entry.path[:-1] for part in key.split("/") if part]
    return parts[-1] if parts and "*" not in parts[-1] else ""


def sections(outline: YamlOutline) -> Iterator[YamlEntry]:
    """Yield the ``ros__parameters`` entries of a file."""
    return (entry for entry in outline.root.all() if entry.key == PARAMETERS_KEY)


def declared_controllers(outline: YamlOutline) -> dict[str, str]:
    """Return the types of the controllers that a file declares, by controller name."""
    return {name: entry.scalar for name, entry in controller_declarations(outline).items()}


def controller_declarations(outline: YamlOutline) -> dict[str, YamlEntry]:
    """Return the entries that declare the types of controllers, by controller name.

    A declaration is ``NAME: type: PACKAGE/CLASS`` in the manager's section, or a parameter ``type`` of the controller.
    """
    declarations: dict[str, YamlEntry] = {}
    for section in sections(outline):
        kind_of_node, node = section.child("type"), node_of(section)
        if kind_of_node is not None and node and "/" in kind_of_node.scalar:
            declarations[node] = kind_of_node
        for child in section.children:
            name, dot, last = child.key.rpartition(".")
            kind = child if dot and last == "type" else child.child("type")
            if kind is not None and "/" in kind.scalar:
                declarations[name if kind is child else child.key] = kind
    return declarations


def _declares_controllers(entry: YamlEntry) -> bool:
    kinds = (child.child("type") for child in entry.children)
    return any(kind is not None and "/" in kind.scalar for kind in kinds)


@cache
def _common_parameters() -> tuple[ParameterInfo, ...]:
    """Return the parameters of all nodes, the most common first."""
    parameters = [parameter for node in node_names() for parameter in node_parameters(node)]
    counts = Counter(parameter.name for parameter in parameters)
    return tuple(sorted(parameters, key=lambda parameter: -counts[parameter.name]))


def _find_keys_below(section: YamlEntry, entry: YamlEntry) -> list[str]:
    keys: list[str] = []
    current: YamlEntry | None = entry
    while current is not None and current is not section:
        keys = [current.key, *keys] if current.key else keys
        current = current.parent
    return keys
