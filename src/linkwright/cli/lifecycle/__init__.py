"""``linkwright lifecycle``: the managed nodes of the running graph."""

from linkwright.cli.lifecycle.verb import HELP, NAME, VERBS, configure, run

__all__ = ["HELP", "NAME", "VERBS", "configure", "run"]
