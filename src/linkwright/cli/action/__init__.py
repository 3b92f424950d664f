"""``linkwright action``: the actions of the running graph."""

from linkwright.cli.action.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
