"""``linkwright service``: the services of the running graph."""

from linkwright.cli.service.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
