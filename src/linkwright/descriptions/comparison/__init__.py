"""The comparison of robot descriptions.

Changes to links, joints, origins, masses and other parts are reported with their locations in both descriptions.
"""

from linkwright.descriptions.comparison.compare import Comparison, Side, compare
from linkwright.descriptions.comparison.difference import Difference, DifferenceLocation, Kind, Subject
from linkwright.descriptions.comparison.elements import SAME_TAGS, ElementComparison, find_remapped_name
from linkwright.descriptions.comparison.file_contents import has_same_contents
from linkwright.descriptions.comparison.gazebo_blocks import GAZEBO, joined_block
from linkwright.descriptions.comparison.hardware import ROS2_CONTROL, find_lost_interfaces
from linkwright.descriptions.comparison.numbers import round_numbers
from linkwright.descriptions.comparison.report import as_data, as_text, sentence

__all__ = [
    "GAZEBO",
    "ROS2_CONTROL",
    "SAME_TAGS",
    "Comparison",
    "Difference",
    "DifferenceLocation",
    "ElementComparison",
    "Kind",
    "Side",
    "Subject",
    "as_data",
    "as_text",
    "compare",
    "find_lost_interfaces",
    "find_remapped_name",
    "has_same_contents",
    "joined_block",
    "round_numbers",
    "sentence",
]
