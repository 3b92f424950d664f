"""``linkwright topic``: the topics of the running graph."""

from linkwright.cli.topic.verb import HELP, NAME, VERBS, configure, run

__all__ = ["HELP", "NAME", "VERBS", "configure", "run"]
