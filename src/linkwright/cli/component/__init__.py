"""``linkwright component``: component containers and what they hold."""

from linkwright.cli.component.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
