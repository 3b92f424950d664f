"""Which changes of controllers' parameters and of bridges are breaking, and what they are called."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "a/config/c.yaml"
CONTROLLERS = """controller_manager:
  ros__parameters:
    arm:
      type: joint_trajectory_controller/JointTrajectoryController
    base:
      type: diff_drive_controller/DiffDriveController
arm:
  ros__parameters:
    joints: [upper, lower]
    command_interfaces: [position]
base:
  ros__parameters:
    wheel_separation: 0.4
    wheel_radius: 0.1
    base_frame_id: base_link
    use_stamped_vel: false
executor:
  ros__parameters:
    joint_names: [upper, lower]
"""
BRIDGES = """- ros_topic_name: /scan
  gz_topic_name: /lidar
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
- topic_name: /clock
  ros_type_name: rosgraph_msgs/msg/Clock
  gz_type_name: gz.msgs.Clock
"""


@pytest.fixture
def changes_of(repository, compare):
    def run(text: str, changed: str):
        assert text != changed
        repository.commit({"a/package.xml": PACKAGE_XML, PATH: text})
        repository.write({PATH: changed})
        result = compare(repository)
        return sentences(subject(result, PATH)), breaking(result)

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("joint_trajectory_controller/JointTrajectoryController", "a/B",
         "controller_manager.ros__parameters.arm.type joint_trajectory_controller/JointTrajectoryController -> a/B",
         True),
        ("[position]", "[velocity]", "arm.ros__parameters.command_interfaces [position] -> [velocity]", False),
        ("    joints: [upper, lower]", "    joints: [upper, tool]",
         "arm.ros__parameters.joints [upper, lower] -> [upper, tool]", True),
        ("joint_names: [upper, lower]", "joint_names: [upper]",
         "executor.ros__parameters.joint_names [upper, lower] -> [upper]", False),
    ],
)  # fmt: skip
def test_names_that_controllers_offer_are_breaking(changes_of, old, new, expected, is_breaking):
    changes, found_breaking = changes_of(CONTROLLERS, CONTROLLERS.replace(old, new))
    assert changes == [expected]
    assert bool(found_breaking) is is_breaking


def test_renamed_controller_is_compared_with_the_old_one(changes_of):
    text = CONTROLLERS.replace("    base:\n", "    drive:\n").replace("\nbase:\n", "\ndrive:\n").replace("0.4", "0.5")
    changes, found_breaking = changes_of(CONTROLLERS, text)
    assert changes == [
        "base renamed to drive",
        "drive.ros__parameters.wheel_separation 0.4 -> 0.5",
        "controller_manager.ros__parameters.drive.type diff_drive_controller/DiffDriveController added",
        "controller_manager.ros__parameters.base.type diff_drive_controller/DiffDriveController removed",
    ]
    assert found_breaking == changes[3:]


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("ros_topic_name: /scan", "ros_topic_name: /laser/scan", "bridge '/scan' renamed to '/laser/scan'", True),
        ("msg/LaserScan", "msg/PointCloud2",
         "bridge '/scan': ros_type_name sensor_msgs/msg/LaserScan -> sensor_msgs/msg/PointCloud2", True),
        ("/msg/LaserScan", "/LaserScan",
         "bridge '/scan': ros_type_name sensor_msgs/msg/LaserScan -> sensor_msgs/LaserScan", False),
        ("GZ_TO_ROS", "BIDIRECTIONAL", "bridge '/scan': direction GZ_TO_ROS -> BIDIRECTIONAL", False),
        ("GZ_TO_ROS", "ROS_TO_GZ", "bridge '/scan': direction GZ_TO_ROS -> ROS_TO_GZ", True),
        ("/lidar", "/lidar2", "bridge '/scan': gz_topic_name /lidar -> /lidar2", False),
        (BRIDGES[BRIDGES.index("- topic_name") :], "", "bridge '/clock' removed", True),
        ("- topic_name", "- topic_name: /tf\n- topic_name", "bridge '/tf' added", False),
    ],
)  # fmt: skip
def test_bridges_are_compared_by_topic(changes_of, old, new, expected, is_breaking):
    changes, found_breaking = changes_of(BRIDGES, BRIDGES.replace(old, new))
    assert changes == [expected]
    assert bool(found_breaking) is is_breaking
