"""The command line: a module for each command with its verbs, importing rooms only when it runs."""

from linkwright.cli.entry import main

__all__ = ["main"]
