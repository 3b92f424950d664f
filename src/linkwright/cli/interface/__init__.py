"""``linkwright interface``: the types of messages, services and actions."""

from linkwright.cli.interface.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
