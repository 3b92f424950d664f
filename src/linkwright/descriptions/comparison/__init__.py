"""Comparison of robot descriptions.

The changes of links, joints, origins and masses are given with their places in both.
"""

from linkwright.descriptions.comparison.compare import Comparison, Difference, Kind, Place, Side, Subject, compare
from linkwright.descriptions.comparison.report import as_data, as_text, sentence

__all__ = [
    "Comparison",
    "Difference",
    "Kind",
    "Place",
    "Side",
    "Subject",
    "as_data",
    "as_text",
    "compare",
    "sentence",
]
