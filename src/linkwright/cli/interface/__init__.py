"""``linkwright interface``: the types of messages, services and actions."""

from linkwright.cli.interface.verb import HELP, NAME, VERBS, configure, run

__all__ = ["HELP", "NAME", "VERBS", "configure", "run"]
