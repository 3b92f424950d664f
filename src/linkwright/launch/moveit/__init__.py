"""The modules ``launch_param_builder`` and ``moveit_configs_utils`` of MoveIt.

Both modules collect parameters from the files of a package. With them, Linkwright can launch the
``robot_state_publisher`` and the viewer of such a package. MoveIt's own programs are compiled, and Linkwright does not
contain them.
"""

from linkwright.launch.moveit.builder import MoveItConfigsBuilder, ParameterBuilder
from linkwright.launch.moveit.configs import MoveItConfigs
from linkwright.launch.moveit.files import (
    ParameterBuilderFileNotFoundError,
    ParameterValueType,
    Xacro,
    get_path,
    load_file,
    load_xacro,
    load_yaml,
)
from linkwright.launch.moveit.launches import (
    DeclareBooleanLaunchArg,
    add_debuggable_node,
    generate_demo_launch,
    generate_move_group_launch,
    generate_moveit_rviz_launch,
    generate_rsp_launch,
    generate_setup_assistant_launch,
    generate_spawn_controllers_launch,
    generate_static_virtual_joint_tfs_launch,
    generate_warehouse_db_launch,
)

__all__ = [
    "DeclareBooleanLaunchArg",
    "MoveItConfigs",
    "MoveItConfigsBuilder",
    "ParameterBuilder",
    "ParameterBuilderFileNotFoundError",
    "ParameterValueType",
    "Xacro",
    "add_debuggable_node",
    "generate_demo_launch",
    "generate_move_group_launch",
    "generate_moveit_rviz_launch",
    "generate_rsp_launch",
    "generate_setup_assistant_launch",
    "generate_spawn_controllers_launch",
    "generate_static_virtual_joint_tfs_launch",
    "generate_warehouse_db_launch",
    "get_path",
    "load_file",
    "load_xacro",
    "load_yaml",
]
