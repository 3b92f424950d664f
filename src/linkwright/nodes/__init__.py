"""Nodes that come with Linkwright.

They include the ROS 2 nodes that show and move a robot description, and the ROS 2 demos.

Each node is in its own module, which is imported when the node is started.
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
