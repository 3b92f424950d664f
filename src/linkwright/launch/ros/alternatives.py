"""Replacements for programs of packages that Linkwright does not replace."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, phrase

_MAPPING = phrase("slam_toolbox also makes maps: run `linkwright launch slam_toolbox online_async_launch.py`")
_HARDWARE = phrase(
    "it drives hardware, so build and start it on the robot; without the robot, a simulated sensor or"
    " `linkwright bag play` publishes its topics"
)
_DRIVERS = (
    *("depthai_ros_driver", "hls_lfcd_lds_driver", "ld08_driver", "ldlidar_stl_ros2", "livox_ros_driver2", "lms1xx"),
    *("micro_ros_agent", "ouster_ros", "phidgets_spatial", "realsense2_camera", "rplidar_ros", "sick_scan2"),
    *("sick_scan_xd", "sllidar_ros2", "urg_node", "velodyne_driver", "ydlidar_ros2_driver", "zed_wrapper"),
)
"""The packages of drivers that public launch files start most often."""
_ALTERNATIVES = {
    **dict.fromkeys(_DRIVERS, _HARDWARE),
    "slam_gmapping": _MAPPING,
    "moveit_setup_assistant": phrase("`linkwright arm init` writes the MoveIt configuration of an arm"),
}


def find_alternative(package: str) -> Phrase | None:
    """Return what to use instead of the programs of a package, or None if there is nothing."""
    return _ALTERNATIVES.get(package)
