"""``linkwright node``: the nodes of the running graph."""

from linkwright.cli.node.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
