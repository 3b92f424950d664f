"""Robots as files for others: one HTML page that needs no server, and glTF."""

from linkwright.viewer.features.export.formats import FORMATS, export_snapshot, format_of
from linkwright.viewer.features.export.snapshot import Snapshot

__all__ = ["FORMATS", "Snapshot", "export_snapshot", "format_of"]
