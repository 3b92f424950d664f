"""``linkwright topic``: list, print, publish and measure the topics of the running graph."""

from linkwright.cli.topic.verb import VERBS, configure, run

__all__ = ["VERBS", "configure", "run"]
