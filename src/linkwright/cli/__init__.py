"""The command line: one file a verb, each importing its room only when it runs."""

from linkwright.cli.entry import main

__all__ = ["main"]
