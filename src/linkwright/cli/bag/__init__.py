"""``linkwright bag``: record topics, play recordings, tell what is in them."""

from linkwright.cli.bag.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
