"""The command line, with one module per command, which imports other packages only when it runs."""

from linkwright.cli.entry import main

__all__ = ["main"]
