"""``linkwright bag``: record topics, play recordings and describe them."""

from linkwright.cli.bag.verb import VERBS, configure, run

__all__ = ["VERBS", "configure", "run"]
