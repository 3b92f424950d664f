"""Stands in for ``nav2_common.launch.has_node_params``."""

from linkwright.launch.rewriting import HasNodeParams

__all__ = ["HasNodeParams"]
