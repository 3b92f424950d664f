"""Stands in for ``launch_yaml.parser``."""

from linkwright.launch.frontend.yaml import Parser

__all__ = ["Parser"]
