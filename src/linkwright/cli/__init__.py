"""The command line, with one module for each command.

A module imports other packages only when its command runs.
"""

from linkwright.cli.entry import main

__all__ = ["main"]
