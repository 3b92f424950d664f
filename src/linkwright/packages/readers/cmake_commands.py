"""The commands of CMake and ROS's build tools with known installed files.

A package may define other commands, such as ``pal_register_modules`` of pal_module_cmake. Their definitions cannot be
read here, so the files that they install are not known.
"""

from __future__ import annotations

from linkwright.loading.deferred import lazy_pattern

_CMAKE_COMMANDS = frozenset(
    {
        *("add_compile_definitions", "add_compile_options", "add_custom_command", "add_custom_target"),
        *("add_definitions", "add_dependencies", "add_executable", "add_library", "add_link_options"),
        *("add_subdirectory", "add_test", "aux_source_directory", "block", "break", "build_command", "build_name"),
        *("configure_file", "continue", "create_test_sourcelist", "define_property", "enable_language"),
        *("enable_testing", "endblock", "exec_program", "execute_process", "export", "file", "fltk_wrap_ui"),
        *("get_cmake_property", "get_directory_property", "get_filename_component", "get_property"),
        *("get_source_file_property", "get_target_property", "get_test_property", "include", "include_directories"),
        *("include_external_msproject", "include_guard", "include_regular_expression", "install", "link_directories"),
        *("link_libraries", "list", "load_cache", "mark_as_advanced", "math", "message", "option", "project"),
        *("remove_definitions", "return", "separate_arguments", "set", "site_name", "source_group", "string"),
        *("try_compile", "try_run", "unset", "variable_watch"),
    }
)
_COMMAND_FAMILIES = lazy_pattern(
    r"(cmake|ctest|check|find|fetchcontent|externalproject|pkg|set|get|target|qt[56]?|pybind11|protobuf|gz_find|export"
    r"|ament|rosidl|catkin|rclcpp|pluginlib|roslint|roslaunch|generate)_\w+"
    r"|python3?_add_\w+|moveit_package|xacro_add_files|add_(message|service|action)_files"
    r"|add_\w*(test|gmock)\w*"
)
"""Commands by prefix. Those that install files, such as ``ament_python_install_package``, are evaluated."""


def has_known_effect(command: str) -> bool:
    """Return whether the installed files of a command are known.

    Args:
        command: the name of the command in lower case.
    """
    return command in _CMAKE_COMMANDS or bool(_COMMAND_FAMILIES.fullmatch(command))
