"""Robots as files for others: one HTML page that needs no server, and glTF."""

from linkwright.viewer.export.formats import FORMATS, export_snapshot, format_of
from linkwright.viewer.export.snapshot import Snapshot

__all__ = ["FORMATS", "Snapshot", "export_snapshot", "format_of"]
