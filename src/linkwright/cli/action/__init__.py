"""``linkwright action``: the actions of the running graph."""

from linkwright.cli.action.verb import HELP, NAME, VERBS, configure, run

__all__ = ["HELP", "NAME", "VERBS", "configure", "run"]
