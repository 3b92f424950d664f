"""``linkwright topic``: the topics of the running graph."""

from linkwright.cli.topic.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
