"""Tell which environment variables other programs than those of the repository read."""

from __future__ import annotations

_PREFIXES = (
    *("ROS_", "RMW_", "RCUTILS_", "AMENT_", "CMAKE_", "COLCON_", "CYCLONEDDS_", "FASTDDS_", "FASTRTPS_"),
    *("GAZEBO_", "GZ_", "IGN_", "SDF_", "LD_"),
)
_NAMES = frozenset({"CC", "CXX", "DISPLAY", "HOME", "PATH", "PWD", "PYTHONPATH", "SHELL", "USER"})


def is_read_by_others(name: str) -> bool:
    """Return whether ROS, Gazebo, a build tool or the system read an environment variable.

    A value of the variable then has an effect even if nothing in the repository reads the variable.
    """
    return name in _NAMES or name.startswith(_PREFIXES)
