"""Hints on the source of a missing Python module or name: a ROS package, PyPI, a module, or its successor in ROS 2."""

from __future__ import annotations

import re
import sys

from linkwright.diagnostics import Phrase, package_hint, phrase, quoted_names

_ROS_PACKAGES = {
    "as2_core": "Aerostack2",
    "clearpath_config": "clearpath_config",
    "clearpath_generator_common": "clearpath_common",
    "crazyflie_py": "Crazyswarm2",
    "interbotix_xs_modules": "interbotix_ros_toolboxes",
    "irobot_create_common_bringup": "create3_sim",
    "isaac_ros_launch_utils": "isaac_ros_common",
    "launch_pal": "launch_pal",
    "launch_testing_ros": "ros2/launch_ros",
    "nav2_simple_commander": "navigation2",
    "lbr_bringup": "lbr_fri_ros2_stack",
    "ros2_benchmark": "ros2_benchmark",
    "scripts": "gazebo_ros_pkgs",
    "py_trees_ros": "py_trees_ros",
    "simple_launch": "simple_launch",
    "spot_wrapper": "spot_ros2",
    "tracetools_launch": "ros2_tracing",
    "uf_ros_lib": "xarm_ros2",
    "webots_ros2_core": "webots_ros2",
    "webots_ros2_driver": "webots_ros2",
}
"""Module -> the repository of its ROS package."""

_COMPILED_PACKAGES = {
    "PyKDL": "orocos_kdl",
    "image_geometry": "vision_opencv",
    "laser_geometry": "laser_geometry",
    "pcl_ros": "perception_pcl",
    "python_qt_binding": "rqt",
    "rqt_gui_py": "rqt",
}
"""Module -> the repository of its ROS package, for packages with parts in C++."""

_ROS_1_MODULES = {
    "actionlib": "rclpy.action",
    "moveit_commander": "moveit.planning",
    "rosbag": "rosbag2_py",
    "roslib": "rclpy",
    "rospy": "rclpy",
    "tf": "tf2_ros",
}
"""Module of ROS 1 -> its successor in ROS 2."""

ROS_MODULES = (*_ROS_PACKAGES, *_COMPILED_PACKAGES)
"""The modules of ROS packages with a known origin that are not available here."""

_DISTRIBUTIONS = {
    "bosdyn": "bosdyn-client",
    "cv2": "opencv-python",
    "dotenv": "python-dotenv",
    "em": "empy",
    "git": "GitPython",
    "pyrealsense2": "pyrealsense2",
    "ruamel": "ruamel.yaml",
    "serial": "pyserial",
    "skimage": "scikit-image",
    "usb": "pyusb",
}
"""Module -> the name of its PyPI distribution, if it differs."""

_PYPI_MODULES = frozenset(
    {"flatten_dict", "jinja2", "numpy", "pandas", "psutil", "pydantic", "requests", "scipy", "toml"}
)

_ROS_SUFFIXES = (
    "_bringup",
    "_common",
    "_config",
    "_description",
    "_driver",
    "_interfaces",
    "_launch",
    "_msgs",
    "_ros",
    "_utils",
)

_CANNOT_IMPORT = re.compile(r"cannot import name '([^']+)' from '([^']+)'")


def find_missing_name(error: ImportError) -> tuple[str, str] | None:
    """Return the name that cannot be imported and its module.

    The result is None if the module itself is missing.
    """
    match = _CANNOT_IMPORT.search(str(error))
    return None if match is None else (match[1], match[2])


def make_other_module_hint(error: ImportError) -> Phrase | None:
    """Return a hint on other modules that define a missing name, or None.

    Only Linkwright's stand-ins provide this information.
    """
    missing = find_missing_name(error)
    if missing is None:
        return None
    name, module = missing
    find_providers = getattr(getattr(sys.modules.get(module), "__loader__", None), "find_providers", None)
    modules = find_providers(name) if find_providers else []
    return phrase("import it from {modules}", modules=quoted_names(modules, " or ")) if modules else None


def make_ros_1_hint(module: str) -> Phrase | None:
    """Return a hint with the successor of a module of ROS 1, or None for another module."""
    top_module = module.partition(".")[0]
    successor = _ROS_1_MODULES.get(top_module)
    if successor is None:
        return None
    return phrase("'{module}' is part of ROS 1; in ROS 2 it is '{successor}'", module=top_module, successor=successor)


def make_provider_hint(module: str) -> Phrase:
    """Return a hint for installing a module that cannot be imported."""
    return make_known_provider_hint(module) or phrase(
        "install the Python package that provides '{module}', or add its ROS package to the workspace",
        module=module,
    )


def make_known_provider_hint(module: str) -> Phrase | None:
    """Return the hint of `provider_hint` for a known module, or None for an unknown module."""
    if hint := make_ros_1_hint(module):
        return hint
    top_module = module.partition(".")[0]
    project = _ROS_PACKAGES.get(top_module)
    if project is not None:
        return phrase(
            "it is part of {project}: put the sources into the workspace's src folder; no build is needed",
            project=project,
        )
    project = _COMPILED_PACKAGES.get(top_module)
    if project is not None:
        return phrase(
            "it is part of {project}, which must be compiled: source a ROS 2 installation that contains it",
            project=project,
        )
    if top_module in _DISTRIBUTIONS or top_module in _PYPI_MODULES:
        return package_hint(_DISTRIBUTIONS.get(top_module, top_module))
    if top_module.endswith(_ROS_SUFFIXES) or top_module.startswith(("ros_", "ros2_")):
        return phrase("put the ROS package '{top}' into the workspace's src folder; no build is needed", top=top_module)
    return None
