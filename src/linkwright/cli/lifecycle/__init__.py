"""``linkwright lifecycle``: the managed nodes of the running graph."""

from linkwright.cli.lifecycle.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
