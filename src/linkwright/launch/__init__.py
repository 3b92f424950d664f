"""Launch descriptions: actions, substitutions, conditions, events, and running what they describe."""

from linkwright.launch.run import LaunchOptions, run_launch, show_arguments
from linkwright.launch.target import LaunchTarget, parse_launch_words
from linkwright.launch.view import run_view

__all__ = [
    "LaunchOptions",
    "LaunchTarget",
    "parse_launch_words",
    "run_launch",
    "run_view",
    "show_arguments",
]
