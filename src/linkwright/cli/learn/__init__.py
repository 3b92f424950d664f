"""``linkwright learn``: courses whose steps are checked."""

from linkwright.cli.learn.verb import VERBS, configure, run

__all__ = ["VERBS", "configure", "run"]
