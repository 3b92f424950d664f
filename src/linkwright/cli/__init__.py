"""The command line, with one module per command; each module imports other packages only when it runs."""

from linkwright.cli.entry import main

__all__ = ["main"]
