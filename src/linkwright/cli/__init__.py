"""The command line: one file a verb, each importing its room only when it runs."""

from linkwright.cli.command import main

__all__ = ["main"]
