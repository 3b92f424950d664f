"""The entries of ``Displays`` in a configuration file, with groups inside of groups."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.viewer.config import yaml_tree
from linkwright.viewer.config.former_names import GROUP, modern_class
from linkwright.viewer.config.schema import is_on
from linkwright.viewer.config.yaml_tree import Memory, Section

_KEY = "Displays"
_BOX = ("Enabled", "Value")


class DisplayConfig:
    """One entry of ``Displays``.

    Args:
        section: its part of the file.
        group: the group it is in, or None.
        report: called with entries below it that cannot be used.

    Attributes:
        cls: RViz 2's name of its class, also where the file says it as RViz 1 did.
        displays: what a group holds.
        identity: its id in pages; empty until it has one.
    """

    def __init__(
        self, section: Section, group: DisplayConfig | None, report: Callable[[Diagnostic], None] = lambda _: None
    ) -> None:
        self.section = section
        self.group = group
        self.cls = modern_class(self.written_class)
        self.identity = ""
        self.displays: list[DisplayConfig] = read_displays(section, self, report) if self.is_group else []

    @property
    def written_class(self) -> str:
        """The name of its class as the file has it."""
        scalar = self.section.scalar("Class")
        return scalar.text if scalar else ""

    @property
    def is_group(self) -> bool:
        """Whether it holds displays instead of drawing something."""
        return self.cls == GROUP

    @property
    def name(self) -> str:
        """What it is called in the Displays panel; by default as its class."""
        scalar = self.section.scalar("Name")
        return scalar.text if scalar else self.cls.rpartition("/")[2]

    @name.setter
    def name(self, name: str) -> None:
        self.section.put(("Name",), name, string=True)

    @property
    def checked(self) -> bool:
        """Its own box: ``Enabled``, else ``Value``; without both it is off, as in RViz."""
        text = self.section.text("Enabled")
        if text is None:
            text = self.section.text("Value")
        return text is not None and is_on(text)

    @checked.setter
    def checked(self, value: bool) -> None:
        if value == self.checked:
            return
        present = [key for key in _BOX if self.section.scalar(key)]
        for key in present or _BOX[:1]:
            self.section.put((key,), "true" if value else "false")

    @property
    def box(self) -> list[Memory]:
        """What the file says of its own box."""
        return [self.section.memory(key) for key in _BOX]

    @box.setter
    def box(self, memories: list[Memory]) -> None:
        for memory in memories:
            self.section.recall(memory)

    @property
    def enabled(self) -> bool:
        """Whether it is drawn: its box and those of the groups around it are on."""
        return self.checked and (self.group is None or self.group.enabled)

    def walk(self) -> Iterator[DisplayConfig]:
        """It and all that it holds, each group before what is in it."""
        yield self
        for display in self.displays:
            yield from display.walk()


def read_displays(
    parent: Section, group: DisplayConfig | None, report: Callable[[Diagnostic], None]
) -> list[DisplayConfig]:
    """The entries of ``Displays`` in a section; those without a class are reported (RVIZ202) and left alone."""
    displays = []
    for section in parent.sections(_KEY):
        if section.scalar("Class") is None:
            message = phrase("a display without a 'Class' is left out")
            report(Diagnostic("RVIZ202", message, section.span(), Severity.WARNING, source=section.source))
        else:
            displays.append(DisplayConfig(section, group, report))
    return displays


def place(display: DisplayConfig, parent: Section, siblings: list[DisplayConfig], index: int) -> None:
    """Put an entry among those of a parent, in the file too."""
    before = siblings[index].section if index < len(siblings) else None
    yaml_tree.insert_section(parent, _KEY, display.section, before)
    siblings.insert(index, display)


def displace(display: DisplayConfig, parent: Section, siblings: list[DisplayConfig]) -> None:
    """Take an entry out from among those of a parent, in the file too."""
    yaml_tree.remove_section(parent, _KEY, display.section)
    siblings.remove(display)
