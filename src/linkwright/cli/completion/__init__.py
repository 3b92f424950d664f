"""``linkwright completion``: what TAB completes in a shell."""

from linkwright.cli.completion.verb import HELP, configure, run

__all__ = ["HELP", "configure", "run"]
