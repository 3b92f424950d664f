"""The names of the targets, known without loading anything."""

from __future__ import annotations

SHARES = {
    "attribute": 10,
    "expression": 14,
    "expression-text": 16,
    "rviz": 3,
    "rviz-text": 8,
    "urdf": 6,
    "urdf-text": 8,
    "xacro": 4,
    "xacro-text": 5,
    "xml-text": 10,
    "yaml": 6,
    "yaml-text": 10,
}
"""Name -> its share of all inputs, in hundredths; see `fuzz.targets.TARGETS`."""
