"""The ROS 2 nodes that come with Linkwright, such as nodes for descriptions and demos.

Each node has a module of its own, which is imported when the node is started.
"""

from linkwright.nodes.options import (
    COMPONENTS,
    EXECUTABLES,
    Factory,
    FinishingNode,
    NodeOptions,
    RunningNode,
)

__all__ = ["COMPONENTS", "EXECUTABLES", "Factory", "FinishingNode", "NodeOptions", "RunningNode"]
