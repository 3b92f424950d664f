"""Stands in for ``launch.substitutions.anon_name``."""

from linkwright.launch.substitutions import AnonName

__all__ = ["AnonName"]
