"""The panels of a .rviz file: RViz's open panels, and the settings of the Time panel.

RViz stores the open panels in three places. ``Panels`` lists the existing panels. The window state records which of
them the user closed. ``Window Geometry`` marks panels as ``collapsed`` if a whole side of the window was hidden. RViz
uses that mark only while ``Hide Left Dock`` or ``Hide Right Dock`` is on; when both are off, it shows these panels.

The window state is the output of Qt's ``QMainWindow::saveState``. For each dock it contains the byte 0xfb, the dock's
name (its length in bytes as four bytes, then UTF-16, both big endian) and a byte of flags: 1 shown, 2 floating. If a
name occurs several times, the first occurrence is the dock, and the others are its former positions. RViz stores the
window state as hexadecimal digits. This module changes only the flags.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.page.protocol.configuration import PanelName
from linkwright.page.protocol.time import SyncMode
from linkwright.rviz.config.former_names import is_former
from linkwright.rviz.config.yaml_tree import Section, get_items, insert_section, new_section, remove_section

_DOCK_MARK = b"\xfb"
_SHOWN_FLAG = 1
_TIME_CLASSES = ("rviz_common/Time", "rviz/Time")
_MODES: tuple[SyncMode, ...] = ("Off", "Exact", "Approximate")

_PANELS = "Panels"
_WINDOW_GEOMETRY = "Window Geometry"
_WINDOW_STATE = (_WINDOW_GEOMETRY, "QMainWindow State")
_HIDE_DOCK_PATHS = ((_WINDOW_GEOMETRY, "Hide Left Dock"), (_WINDOW_GEOMETRY, "Hide Right Dock"))

_PANEL_TITLES: Mapping[PanelName, str] = MappingProxyType(
    {
        "displays": "Displays",
        "selection": "Selection",
        "tool-properties": "Tool Properties",
        "views": "Views",
        "time": "Time",
        "transformation": "Transformation",
        "help": "Help",
        "navigation": "Navigation 2",
        "visual-tools": "RvizVisualToolsGui",
    }
)
_RVIZ2_PREFIX, _RVIZ1_PREFIX = "rviz_common/", "rviz/"
_PACKAGE_CLASSES: Mapping[PanelName, str] = MappingProxyType(
    {"navigation": "nav2_rviz_plugins/Navigation 2", "visual-tools": "rviz_visual_tools/RvizVisualToolsGui"}
)
"""The classes of panels that RViz itself does not have."""
_PANEL_BY_CLASS: Mapping[str, PanelName] = MappingProxyType(
    {
        prefix + name: panel
        for panel, name in _PANEL_TITLES.items()
        for prefix in (_RVIZ2_PREFIX, _RVIZ1_PREFIX)
        if panel not in _PACKAGE_CLASSES
    }
    | {cls: panel for panel, cls in _PACKAGE_CLASSES.items()}
)
_MISSING_IN_RVIZ1 = frozenset({"transformation", "navigation"})


class PanelsConfig:
    """The ``Panels`` list of a file, and the panels' visibility in ``Window Geometry``.

    Entries of panels that the page does not have stay unchanged.

    Args:
        document: the file.
        report: called with a finding about panels that the page does not have (RVIZ204).
    """

    def __init__(self, document: Section, report: Callable[[Diagnostic], None]) -> None:
        self._document = document
        self._known_sections = list(document.sections(_PANELS))
        self._added_sections: list[Section] = []
        unknown_sections = [
            section for section in self._known_sections if section.scalar("Class") and _find_panel(section) is None
        ]
        if unknown_sections:
            names = ", ".join(f"'{section.text('Name') or section.text('Class')}'" for section in unknown_sections)
            message = phrase(
                "the page cannot show these panels, but they stay in the file: {names}",
                names=names,
            )
            report(Diagnostic("RVIZ204", message, unknown_sections[0].span(), Severity.WARNING, source=document.source))

    @property
    def shown(self) -> list[PanelName] | None:
        """The panels that RViz shows for this file, in file order.

        None if the file has no ``Panels``.
        """
        if get_items(self._document, _PANELS) is None:
            return None
        panels = (_find_panel(section) for section in self._find_loaded_sections() if self._is_shown(section))
        return list(dict.fromkeys(panel for panel in panels if panel is not None))

    def show(self, panels: Collection[PanelName]) -> bool:
        """Open exactly these panels in the file, and return whether the file changed.

        As in RViz, a closed panel keeps its entry, and the window state marks it as hidden. The entry
        is removed, as with RViz's *Delete Panel*, if the file has no such state or if the entry was added by
        this program. When the panel is opened again, a removed entry is restored to its position.
        """
        previous_panels = self.shown
        for panel in _PANEL_TITLES:
            if panel in panels:
                self._open(panel)
            else:
                self._close(panel)
        return self.shown != previous_panels

    def _open(self, panel: PanelName) -> None:
        sections = [section for section in self._find_loaded_sections() if _find_panel(section) == panel]
        if any(map(self._is_shown, sections)):
            return
        section = sections[0] if sections else self._add(panel)
        if section is not None:
            self._set_shown(section, is_visible=True)

    def _close(self, panel: PanelName) -> None:
        for section in list(self._find_loaded_sections()):
            if _find_panel(section) != panel or not self._is_shown(section):
                continue
            if section not in self._added_sections:
                self._set_shown(section, is_visible=False)
            if self._is_shown(section):
                remove_section(self._document, _PANELS, section)

    def _find_loaded_sections(self) -> list[Section]:
        """Return the entries that RViz loads: entries with a class and a name."""
        return [
            section
            for section in self._document.sections(_PANELS)
            if section.scalar("Class") and section.scalar("Name")
        ]

    def _is_shown(self, section: Section) -> bool:
        name = section.text("Name") or ""
        if self._is_true(_WINDOW_GEOMETRY, name, "collapsed"):
            return not any(self._is_true(*path) for path in _HIDE_DOCK_PATHS)
        return is_shown(self._document.text(*_WINDOW_STATE) or "", name) is not False

    def _set_shown(self, section: Section, *, is_visible: bool) -> None:
        """Mark a panel as shown or hidden in an existing window state, and as not collapsed."""
        name = section.text("Name") or ""
        state = self._document.text(*_WINDOW_STATE) or ""
        if is_shown(state, name) not in (None, is_visible):
            self._document.put(_WINDOW_STATE, set_dock_shown(state, name, is_visible=is_visible))
        if self._is_true(_WINDOW_GEOMETRY, name, "collapsed"):
            self._document.put((_WINDOW_GEOMETRY, name, "collapsed"), "false")

    def _add(self, panel: PanelName) -> Section | None:
        """Insert an entry for a panel and return it.

        Return None if the RViz version that wrote the file does not have this panel.

        An entry that was removed before is restored to its position.
        """
        present_sections = list(self._document.sections(_PANELS))
        panel_section = next(
            (
                section
                for section in self._known_sections
                if _find_panel(section) == panel and section not in present_sections
            ),
            None,
        )
        if panel_section is None:
            is_rviz1_file = any(is_former(section.text("Class") or "") for section in self._known_sections)
            if is_rviz1_file and panel in _MISSING_IN_RVIZ1:
                return None
            panel_section = new_section(self._document.source)
            prefix = _RVIZ1_PREFIX if is_rviz1_file else _RVIZ2_PREFIX
            class_name = _PACKAGE_CLASSES.get(panel, prefix + _PANEL_TITLES[panel])
            panel_section.put(("Class",), class_name, string=True)
            panel_section.put(("Name",), _PANEL_TITLES[panel], string=True)
            self._known_sections.append(panel_section)
            self._added_sections.append(panel_section)
        later_sections = self._known_sections[self._known_sections.index(panel_section) + 1 :]
        insert_section(
            self._document,
            _PANELS,
            panel_section,
            next((section for section in later_sections if section in present_sections), None),
        )
        return panel_section

    def _is_true(self, *path: str) -> bool:
        return (self._document.text(*path) or "").strip().lower() == "true"


def _find_panel(section: Section) -> PanelName | None:
    return _PANEL_BY_CLASS.get(section.text("Class") or "")


def is_shown(state: str, name: str) -> bool | None:
    """Return whether a dock is shown, or None if it is unknown.

    It is unknown if the state has no such dock or was not written by Qt.

    Args:
        state: the window state as hexadecimal digits.
        name: the name of the dock, which is also the name of its panel.
    """
    content = _decode_state(state)
    flags_index = _find_flags(content, name)
    return None if flags_index is None else bool(content[flags_index] & _SHOWN_FLAG)


def set_dock_shown(state: str, name: str, *, is_visible: bool) -> str:
    """Return the window state with a dock shown or hidden.

    The state is returned unchanged if it has no such dock.
    """
    content = _decode_state(state)
    flags_index = _find_flags(content, name)
    if flags_index is None or bool(content[flags_index] & _SHOWN_FLAG) is is_visible:
        return state
    # Replace only these two digits, to preserve the case of the other digits.
    return f"{state[: 2 * flags_index]}{content[flags_index] ^ _SHOWN_FLAG:02x}{state[2 * flags_index + 2 :]}"


def _decode_state(state: str) -> bytes:
    """Return the bytes that hexadecimal digits encode, or empty bytes for any other text."""
    try:
        content = bytes.fromhex(state)
    except ValueError:
        return b""
    return content if 2 * len(content) == len(state) else b""  # the length differs if the text has spaces,
    # because `fromhex` skips them


def _find_flags(content: bytes, name: str) -> int | None:
    """Return the index of the byte with a dock's flags, or None if there is no such dock."""
    text = name.encode("utf-16-be", "surrogatepass")
    dock_header = _DOCK_MARK + len(text).to_bytes(4, "big") + text
    flags_index = content.find(dock_header) + len(dock_header)
    return flags_index if len(dock_header) <= flags_index < len(content) else None


@dataclass(frozen=True, slots=True)
class Synchronization:
    """The synchronization mode of the Time panel, and the name of the display that it follows."""

    mode: SyncMode = "Off"
    source: str = ""


def read_synchronization(document: Section) -> Synchronization:
    """Return the synchronization of the Time panel, or the default if RViz ignores it.

    RViz uses them only if ``Experimental`` is on. RViz 1 up to Noetic always uses them and does not write that key.
    """
    panel = _find_time_panel(document)
    if panel is None or not (_get_text(panel, "Experimental").lower() == "true" or _is_always_on(panel)):
        return Synchronization()
    mode_number = _get_text(panel, "SyncMode")
    if mode_number not in ("1", "2"):
        return Synchronization()
    return Synchronization(_MODES[int(mode_number)], _get_text(panel, "SyncSource"))


def write_synchronization(document: Section, synchronization: Synchronization) -> bool:
    """Write the settings to the Time panel, and return whether the file changed.

    A file without a Time panel stays unchanged.
    """
    panel = _find_time_panel(document)
    if panel is None or read_synchronization(document) == synchronization:
        return False
    panel.put(("SyncMode",), str(_MODES.index(synchronization.mode)))
    panel.put(("SyncSource",), synchronization.source, string=True)
    if synchronization.mode != "Off" and not _is_always_on(panel):
        panel.put(("Experimental",), "true")
    return True


def _is_always_on(panel: Section) -> bool:
    """Return whether RViz 1 up to Noetic wrote the panel. Its synchronization is always on."""
    return (
        is_former(_get_text(panel, "Class"))
        and not _get_text(panel, "Experimental")
        and bool(_get_text(panel, "SyncSource"))
    )


def _find_time_panel(document: Section) -> Section | None:
    for panel in document.sections(_PANELS):
        if _get_text(panel, "Class") in _TIME_CLASSES:
            return panel
    return None


def _get_text(section: Section, key: str) -> str:
    scalar = section.scalar(key)
    return scalar.text.strip() if scalar else ""
