"""``linkwright completion``: what TAB completes in a shell."""

from linkwright.cli.completion.verb import configure, run

__all__ = ["configure", "run"]
