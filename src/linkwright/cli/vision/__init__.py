"""``linkwright vision``: run, train and evaluate detectors."""

from linkwright.cli.vision.verb import VERBS, configure, run

__all__ = ["VERBS", "configure", "run"]
