"""Launch descriptions, and the engine that runs them.

Descriptions consist of actions, substitutions, conditions and events.
"""

from linkwright.hosting.plans import opens_page
from linkwright.launch.program import find_program, run_viewer
from linkwright.launch.ros.executables import Executable, builtin_packages, find_executables
from linkwright.launch.run import LaunchOptions, print_description, run_launch, show_arguments
from linkwright.launch.target import LaunchTarget, parse_launch_words

__all__ = [
    "Executable",
    "LaunchOptions",
    "LaunchTarget",
    "builtin_packages",
    "find_executables",
    "find_program",
    "opens_page",
    "parse_launch_words",
    "print_description",
    "run_launch",
    "run_viewer",
    "show_arguments",
]
