"""``linkwright component``: component containers and what they hold."""

from linkwright.cli.component.verb import HELP, NAME, VERBS, configure, run

__all__ = ["HELP", "NAME", "VERBS", "configure", "run"]
