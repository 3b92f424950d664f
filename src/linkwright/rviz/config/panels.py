"""The panels of a .rviz file: RViz's open panels, and the settings of the Time panel.

RViz stores the open panels in three places. ``Panels`` lists the existing panels. The window state records which of
them the user closed. ``Window Geometry`` marks panels as ``collapsed`` if a whole side of the window was hidden. RViz
uses that mark only while ``Hide Left Dock`` or ``Hide Right Dock`` is on; otherwise it shows those panels again.

The window state is the output of Qt's ``QMainWindow::saveState``. For each dock it contains the byte 0xfb, the dock's
name (its length in bytes as four bytes, then UTF-16, both big endian) and a byte of flags: 1 shown, 2 floating. If a
name occurs several times, the first occurrence is the dock, and the others are its former positions. RViz stores the
window state as hexadecimal digits. All other bytes remain unchanged.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.page.protocol.configuration import PanelName
from linkwright.page.protocol.time import SyncMode
from linkwright.rviz.config.former_names import is_former
from linkwright.rviz.config.yaml_tree import Section, entries, insert_section, new_section, remove_section

_DOCK = b"\xfb"
_SHOWN = 1
_TIME = ("rviz_common/Time", "rviz/Time")
_MODES: tuple[SyncMode, ...] = ("Off", "Exact", "Approximate")

_PANELS = "Panels"
_GEOMETRY = "Window Geometry"
_STATE = (_GEOMETRY, "QMainWindow State")
_HIDDEN_SIDES = ((_GEOMETRY, "Hide Left Dock"), (_GEOMETRY, "Hide Right Dock"))

_NAMES: Mapping[PanelName, str] = MappingProxyType(
    {
        "displays": "Displays",
        "selection": "Selection",
        "tool-properties": "Tool Properties",
        "views": "Views",
        "time": "Time",
        "transformation": "Transformation",
        "navigation": "Navigation 2",
    }
)
_PRESENT, _FORMER = "rviz_common/", "rviz/"
_OF_NAV2 = "nav2_rviz_plugins/Navigation 2"
_CLASSES: Mapping[str, PanelName] = MappingProxyType(
    {prefix + name: panel for panel, name in _NAMES.items() for prefix in (_PRESENT, _FORMER) if panel != "navigation"}
    | {_OF_NAV2: "navigation"}
)
_NOT_OF_RVIZ_1 = frozenset({"transformation", "navigation"})


class PanelsConfig:
    """The ``Panels`` list of a file, and the visibility of the panels in its ``Window Geometry``.

    Panels of classes that the page does not have stay unchanged.

    Args:
        document: the file.
        report: called with a finding about the panels that cannot be shown (RVIZ204).
    """

    def __init__(self, document: Section, report: Callable[[Diagnostic], None]) -> None:
        self._document = document
        self._order = list(document.sections(_PANELS))
        self._added: list[Section] = []
        others = [section for section in self._order if section.scalar("Class") and _panel(section) is None]
        if others:
            names = ", ".join(f"'{section.text('Name') or section.text('Class')}'" for section in others)
            message = phrase("panels that the page does not have are kept in the file: {names}", names=names)
            report(Diagnostic("RVIZ204", message, others[0].span(), Severity.WARNING, source=document.source))

    @property
    def shown(self) -> list[PanelName] | None:
        """The panels that RViz would show, in the order of the file; None if the file has no ``Panels``."""
        if entries(self._document, _PANELS) is None:
            return None
        found = (_panel(section) for section in self._listed() if self._is_shown(section))
        return list(dict.fromkeys(panel for panel in found if panel is not None))

    def show(self, panels: Collection[PanelName]) -> bool:
        """Open these panels and close all others in the file, and return whether that changed the file.

        Closing a panel does what RViz does: its entry stays, and the window state marks the panel as hidden. The entry
        is removed, as with RViz's *Delete Panel*, if the file has no such state or if the entry was added by
        this program. When the panel is opened again, a removed entry is restored to its position.
        """
        before = self.shown
        for panel in _NAMES:
            if panel in panels:
                self._open(panel)
            else:
                self._close(panel)
        return self.shown != before

    def _open(self, panel: PanelName) -> None:
        listed = [section for section in self._listed() if _panel(section) == panel]
        if any(map(self._is_shown, listed)):
            return
        section = listed[0] if listed else self._add(panel)
        if section is not None:
            self._set_shown(section, shown=True)

    def _close(self, panel: PanelName) -> None:
        for section in list(self._listed()):
            if _panel(section) != panel or not self._is_shown(section):
                continue
            if section not in self._added:
                self._set_shown(section, shown=False)
            if self._is_shown(section):
                remove_section(self._document, _PANELS, section)

    def _listed(self) -> list[Section]:
        """Return the entries that RViz loads; RViz skips those without a class or a name."""
        return [
            section
            for section in self._document.sections(_PANELS)
            if section.scalar("Class") and section.scalar("Name")
        ]

    def _is_shown(self, section: Section) -> bool:
        name = section.text("Name") or ""
        if self._is_on(_GEOMETRY, name, "collapsed"):
            return not any(self._is_on(*path) for path in _HIDDEN_SIDES)
        return is_shown(self._document.text(*_STATE) or "", name) is not False

    def _set_shown(self, section: Section, *, shown: bool) -> None:
        """Mark a panel as shown or hidden in the window state, if there is one, and as not collapsed."""
        name = section.text("Name") or ""
        state = self._document.text(*_STATE) or ""
        if is_shown(state, name) not in (None, shown):
            self._document.put(_STATE, set_dock_shown(state, name, shown=shown))
        if self._is_on(_GEOMETRY, name, "collapsed"):
            self._document.put((_GEOMETRY, name, "collapsed"), "false")

    def _add(self, panel: PanelName) -> Section | None:
        """Insert an entry for a panel and return it; None if this panel does not exist in the file's RViz.

        An entry that was removed before is restored to its position.
        """
        there = list(self._document.sections(_PANELS))
        gone = next((section for section in self._order if _panel(section) == panel and section not in there), None)
        if gone is None:
            former = any(is_former(section.text("Class") or "") for section in self._order)
            if former and panel in _NOT_OF_RVIZ_1:
                return None
            gone = new_section(self._document.source)
            own = _OF_NAV2 if panel == "navigation" else (_FORMER if former else _PRESENT) + _NAMES[panel]
            gone.put(("Class",), own, string=True)
            gone.put(("Name",), _NAMES[panel], string=True)
            self._order.append(gone)
            self._added.append(gone)
        after = self._order[self._order.index(gone) + 1 :]
        insert_section(self._document, _PANELS, gone, next((section for section in after if section in there), None))
        return gone

    def _is_on(self, *path: str) -> bool:
        return (self._document.text(*path) or "").strip().lower() == "true"


def _panel(section: Section) -> PanelName | None:
    return _CLASSES.get(section.text("Class") or "")


def is_shown(state: str, name: str) -> bool | None:
    """Return whether a dock is shown; None if the state does not have it, or was not written by Qt.

    Args:
        state: the window state as hexadecimal digits.
        name: the name of the dock, which is also the name of its panel.
    """
    content = _bytes(state)
    at = _flags(content, name)
    return None if at is None else bool(content[at] & _SHOWN)


def set_dock_shown(state: str, name: str, *, shown: bool) -> str:
    """Return the window state with a dock shown or hidden; unchanged if it has no such dock."""
    content = _bytes(state)
    at = _flags(content, name)
    if at is None or bool(content[at] & _SHOWN) is shown:
        return state
    # Change only these digits, to preserve the case of the others.
    return f"{state[: 2 * at]}{content[at] ^ _SHOWN:02x}{state[2 * at + 2 :]}"


def _bytes(state: str) -> bytes:
    """Decode hexadecimal digits to bytes; return empty bytes for any other text."""
    try:
        content = bytes.fromhex(state)
    except ValueError:
        return b""
    return content if 2 * len(content) == len(state) else b""  # `fromhex` skips spaces


def _flags(content: bytes, name: str) -> int | None:
    """Return the index of the byte with a dock's flags, or None if there is no such dock."""
    text = name.encode("utf-16-be", "surrogatepass")
    mark = _DOCK + len(text).to_bytes(4, "big") + text
    at = content.find(mark) + len(mark)
    return at if len(mark) <= at < len(content) else None


@dataclass(frozen=True, slots=True)
class Synchronization:
    """The synchronization mode of the Time panel, and the name of the display that it follows."""

    mode: SyncMode = "Off"
    source: str = ""


def read_synchronization(document: Section) -> Synchronization:
    """Return the synchronization settings of the Time panel, or the defaults if RViz would ignore them.

    RViz uses them only if ``Experimental`` is on, except RViz 1 up to Noetic, which does not write that key.
    """
    panel = _time_panel(document)
    if panel is None or not (_text(panel, "Experimental").lower() == "true" or _is_always_on(panel)):
        return Synchronization()
    number = _text(panel, "SyncMode")
    if number not in ("1", "2"):
        return Synchronization()
    return Synchronization(_MODES[int(number)], _text(panel, "SyncSource"))


def write_synchronization(document: Section, synchronization: Synchronization) -> bool:
    """Write the settings to the Time panel, if the file has one; return whether the file changed."""
    panel = _time_panel(document)
    if panel is None or read_synchronization(document) == synchronization:
        return False
    panel.put(("SyncMode",), str(_MODES.index(synchronization.mode)))
    panel.put(("SyncSource",), synchronization.source, string=True)
    if synchronization.mode != "Off" and not _is_always_on(panel):
        panel.put(("Experimental",), "true")
    return True


def _is_always_on(panel: Section) -> bool:
    """Return whether RViz 1 up to Noetic wrote the panel, in which synchronization is always on."""
    return is_former(_text(panel, "Class")) and not _text(panel, "Experimental") and bool(_text(panel, "SyncSource"))


def _time_panel(document: Section) -> Section | None:
    for panel in document.sections(_PANELS):
        if _text(panel, "Class") in _TIME:
            return panel
    return None


def _text(section: Section, key: str) -> str:
    scalar = section.scalar(key)
    return scalar.text.strip() if scalar else ""
