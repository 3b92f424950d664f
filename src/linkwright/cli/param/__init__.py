"""``linkwright param``: the parameters of running nodes."""

from linkwright.cli.param.verb import HELP, VERBS, configure, run

__all__ = ["HELP", "VERBS", "configure", "run"]
