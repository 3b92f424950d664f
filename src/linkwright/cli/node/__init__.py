"""``linkwright node``: the nodes of the running graph."""

from linkwright.cli.node.verb import HELP, NAME, VERBS, configure, run

__all__ = ["HELP", "NAME", "VERBS", "configure", "run"]
