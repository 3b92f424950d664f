"""``linkwright completion``: completion of command lines in shells."""

from linkwright.cli.completion.verb import configure, run

__all__ = ["configure", "run"]
