"""Stands in for ``launch_yaml``."""

from linkwright.launch.frontend.yaml import Entity, Parser

__all__ = ["Entity", "Parser"]
