"""A shell with the commands of ROS 2."""

from linkwright.shell.programs import PROGRAMS, write_programs
from linkwright.shell.session import run_shell, shell_environment

__all__ = ["PROGRAMS", "run_shell", "shell_environment", "write_programs"]
