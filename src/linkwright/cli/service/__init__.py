"""``linkwright service``: the services of the running graph."""

from linkwright.cli.service.verb import HELP, NAME, VERBS, configure, run

__all__ = ["HELP", "NAME", "VERBS", "configure", "run"]
