"""``linkwright vision``: try detectors on pictures."""

from linkwright.cli.vision.verb import VERBS, configure, run

__all__ = ["VERBS", "configure", "run"]
