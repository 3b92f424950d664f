"""The Time panel of a .rviz file: synchronization mode and source."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.viewer.config.former_names import is_former
from linkwright.viewer.config.yaml_tree import Section
from linkwright.viewer.protocol.time import SyncMode

_PANELS = "Panels"
_TIME = ("rviz_common/Time", "rviz/Time")
_MODES: tuple[SyncMode, ...] = ("Off", "Exact", "Approximate")


@dataclass(frozen=True, slots=True)
class Synchronization:
    """Which display's messages drive time, and how."""

    mode: SyncMode = "Off"
    source: str = ""


def read_synchronization(document: Section) -> Synchronization:
    """What the Time panel says; RViz looks at it only where ``Experimental`` is on, which RViz 1 at last left out."""
    panel = _panel(document)
    if panel is None or not (_text(panel, "Experimental").lower() == "true" or _is_always_on(panel)):
        return Synchronization()
    number = _text(panel, "SyncMode")
    if number not in ("1", "2"):
        return Synchronization()
    return Synchronization(_MODES[int(number)], _text(panel, "SyncSource"))


def write_synchronization(document: Section, wanted: Synchronization) -> bool:
    """Make the Time panel say it, in a file that has one; whether anything was another."""
    panel = _panel(document)
    if panel is None or read_synchronization(document) == wanted:
        return False
    panel.put(("SyncMode",), str(_MODES.index(wanted.mode)))
    panel.put(("SyncSource",), wanted.source, string=True)
    if wanted.mode != "Off" and not _is_always_on(panel):
        panel.put(("Experimental",), "true")
    return True


def _is_always_on(panel: Section) -> bool:
    """Whether the panel is one of RViz 1 as of Noetic. Without a source its mode is none that could lead time."""
    return is_former(_text(panel, "Class")) and not _text(panel, "Experimental") and bool(_text(panel, "SyncSource"))


def _panel(document: Section) -> Section | None:
    for panel in document.sections(_PANELS):
        if _text(panel, "Class") in _TIME:
            return panel
    return None


def _text(section: Section, key: str) -> str:
    scalar = section.scalar(key)
    return scalar.text.strip() if scalar else ""
