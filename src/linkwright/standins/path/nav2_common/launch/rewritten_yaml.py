"""Stands in for ``nav2_common.launch.rewritten_yaml``."""

from linkwright.launch.rewriting import RewrittenYaml

__all__ = ["RewrittenYaml"]
