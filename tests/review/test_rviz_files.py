"""Changes of RViz configurations in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

RVIZ = """Panels:
  - Class: rviz_common/Displays
    Name: Displays
    Splitter Ratio: 0.5
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/LaserScan
      Enabled: true
      Name: Scan
      Max Intensity: 10
      Topic:
        Depth: 5
        Value: /scan
      Value: true
    - Class: rviz_common/Group
      Enabled: true
      Name: Plans
      Displays:
        - Class: rviz_default_plugins/Path
          Name: Global
          Alpha: 1
          Topic:
            Value: /plan
  Global Options:
    Fixed Frame: map
    Frame Rate: 30
  Tools:
    - Class: rviz_default_plugins/MoveCamera
    - Class: rviz_default_plugins/SetGoal
      Topic:
        Value: /goal_pose
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 4
Window Geometry:
  Height: 800
"""
TOOL = "    - Class: rviz_default_plugins/MoveCamera\n"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("Value: /scan", "Value: /lidar/scan", ["display 'Scan': topic /scan -> /lidar/scan"]),
        ("        Depth: 5\n        Value: /scan\n", "        Value: /scan\n", []),
        ("Name: Scan", "Name: Lidar", ["display 'Scan' renamed to 'Lidar'"]),
        ("Alpha: 1", "Alpha: 0.5", ["display 'Plans/Global': Alpha 1 -> 0.5"]),
        ("rviz_default_plugins/Path", "nav/Path",
         ["display 'Plans/Global': class rviz_default_plugins/Path -> nav/Path"]),
        ("Fixed Frame: map", "Fixed Frame: odom", ["Fixed Frame map -> odom"]),
        (TOOL, "", ["tools removed: 'rviz_default_plugins/MoveCamera'"]),
        ("/goal_pose", "/goal", ["'rviz_default_plugins/SetGoal': topic /goal_pose -> /goal"]),
        ("Distance: 4", "Distance: 9", []),
        ("Distance: 4", "Target Frame: base_link", ["view: Target Frame base_link added"]),
        ("Alpha: 1", "Alpha: 0.99999999", []),
        ("    Frame Rate: 30\n", "", ["Frame Rate 30 removed"]),
        ("    Frame Rate: 30\n", "    Frame Rate: 30\n    Default Light: true\n", ["Default Light true added"]),
        ("Height: 800", "Height: 600", []),
        ("Max Intensity: 10", "Max Intensity: 99", []),
        ("Ratio: 0.5", "Ratio: 0.7", []),
        ("  - Class: rviz_common/Displays", "  - Class: arm/Panel\n  - Class: rviz_common/Displays",
         ["panels added: 'arm/Panel'"]),
        ("    - Class: rviz_common/Group", "    - Class: arm/Grid\n      Name: Grid\n    - Class: rviz_common/Group",
         ["display 'Grid' of class 'arm/Grid' added"]),
        ("    - Class: rviz_common/Group",
         "    - Class: arm/Image\n      Name: Eye\n      Image Topic: /eye\n    - Class: rviz_common/Group",
         ["display 'Eye' of class 'arm/Image' added: topic /eye"]),
    ],
)  # fmt: skip
def test_changes_of_rviz_configurations_are_reported(repository, compare, old, new, expected):
    repository.commit({"rviz/arm.rviz": RVIZ})
    repository.write({"rviz/arm.rviz": RVIZ.replace(old, new)})
    result = compare(repository)
    assert [sentence for found in result.subjects for sentence in sentences(found)] == expected
    assert breaking(result) == []


def test_removed_rviz_configuration_is_breaking(repository, compare):
    repository.commit({"rviz/arm.rviz": RVIZ})
    repository.write({"rviz/arm.rviz": None})
    assert breaking(compare(repository)) == ["RViz configuration removed"]


def test_rviz_configuration_without_manager_can_no_longer_be_read(repository, compare):
    repository.commit({"rviz/arm.rviz": RVIZ})
    repository.write({"rviz/arm.rviz": "- 1\n"})
    found = subject(compare(repository), "rviz/arm.rviz")
    assert sentences(found) == ["can no longer be read: it has no 'Visualization Manager'"]
