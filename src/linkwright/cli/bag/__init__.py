"""``linkwright bag``: record topics, play recordings, tell what is in them."""

from linkwright.cli.bag.verb import VERBS, configure, run

__all__ = ["VERBS", "configure", "run"]
