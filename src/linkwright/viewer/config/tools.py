"""The tools of a .rviz file: which there are, in which order, and their properties."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from linkwright.diagnostics import Diagnostic
from linkwright.viewer.config.former_names import former_keys, modern_class
from linkwright.viewer.config.property_store import PropertyStore, Schema
from linkwright.viewer.config.tool_classes import TOOL_KINDS
from linkwright.viewer.config.yaml_tree import Section, ensure_section, insert_section, new_section, remove_section

_MANAGER = "Visualization Manager"
_TOOLS = "Tools"

MAXIMUM_TOOLS = 100
"""Most tools; each may have a publisher, and a page may add no more."""


@dataclass(frozen=True, slots=True)
class ToolEntry:
    """One tool of the file.

    Attributes:
        id: stable while the file is open.
        cls: RViz 2's name of its class, also where the file says it as RViz 1 did.
        section: its part of the file; of a class that is not known it is kept as it is.
        properties: its values.
    """

    id: str
    cls: str
    section: Section
    properties: PropertyStore


class ToolsConfig:
    """``Tools`` of a file. Where it lists none there are RViz's usual ones, and the file lists none until one changes.

    Args:
        document: the file.
        report: called with values that cannot be used.
    """

    def __init__(self, document: Section, report: Callable[[Diagnostic], None]) -> None:
        self._document = document
        self._report = report
        self._count = 0
        self._entries: dict[str, ToolEntry] = {}
        for section in document.sections(_MANAGER, _TOOLS):
            scalar = section.scalar("Class")
            if scalar is not None:
                self._remember(scalar.text, section)
        self._are_listed = bool(self._entries)
        if not self._entries:
            for cls in TOOL_KINDS:
                self._remember(cls, self._new(cls))

    @property
    def entries(self) -> list[ToolEntry]:
        """The tools, in their order."""
        return list(self._entries.values())

    def find(self, identity: str) -> ToolEntry | None:
        """The tool with an id, or None."""
        return self._entries.get(identity)

    def add(self, cls: str) -> ToolEntry:
        """Add a tool at the end.

        Raises:
            ValueError: there is no such class, or there are too many tools.
        """
        if len(self._entries) >= MAXIMUM_TOOLS:
            raise ValueError(f"there are {MAXIMUM_TOOLS} tools already")
        if cls not in TOOL_KINDS:
            raise ValueError(f"no tool is of the class {cls!r}")
        self.list_all()
        section = self._new(cls)
        insert_section(self._manager(), _TOOLS, section)
        return self._remember(cls, section)

    def remove(self, identity: str) -> ToolEntry:
        """Take a tool away, and return it.

        Raises:
            KeyError: there is no such tool.
        """
        entry = self._entries[identity]
        self.list_all()
        del self._entries[identity]
        remove_section(self._manager(), _TOOLS, entry.section)
        return entry

    def list_all(self) -> None:
        """Write the usual tools into a file that lists none, before one of them is changed."""
        if not self._are_listed:
            for entry in self._entries.values():
                insert_section(self._manager(), _TOOLS, entry.section)
        self._are_listed = True

    def _manager(self) -> Section:
        return ensure_section(self._document, _MANAGER)

    def _new(self, cls: str) -> Section:
        section = new_section(self._document.source)
        section.put(("Class",), cls, string=True)
        return section

    def _remember(self, written: str, section: Section) -> ToolEntry:
        """List a tool whose class is written as RViz 2 or RViz 1 does."""
        cls = modern_class(written)
        self._count += 1
        identity = f"tool-{self._count}"
        schema: Schema = TOOL_KINDS[cls].schema if cls in TOOL_KINDS else ()
        store = PropertyStore(identity, section, lambda: schema, self._report, former=former_keys(written))
        entry = ToolEntry(identity, cls, section, store)
        self._entries[identity] = entry
        return entry
