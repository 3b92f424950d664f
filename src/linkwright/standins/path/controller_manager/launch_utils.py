"""Stands in for ``controller_manager.launch_utils``."""

from linkwright.launch.ros.controllers import (
    generate_controllers_spawner_launch_description,
    generate_controllers_spawner_launch_description_from_dict,
    generate_load_controller_launch_description,
)

__all__ = [
    "generate_controllers_spawner_launch_description",
    "generate_controllers_spawner_launch_description_from_dict",
    "generate_load_controller_launch_description",
]
