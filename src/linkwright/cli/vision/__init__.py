"""``linkwright vision``: try detectors on images."""

from linkwright.cli.vision.verb import VERBS, configure, run

__all__ = ["VERBS", "configure", "run"]
