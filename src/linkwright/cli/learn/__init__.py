"""``linkwright learn``: courses whose steps are checked."""

from linkwright.cli.learn.verb import DEFAULT_VERB, VERBS, configure, run

__all__ = ["DEFAULT_VERB", "VERBS", "configure", "run"]
