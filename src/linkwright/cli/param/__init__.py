"""``linkwright param``: the parameters of running nodes."""

from linkwright.cli.param.verb import HELP, NAME, VERBS, configure, run

__all__ = ["HELP", "NAME", "VERBS", "configure", "run"]
