"""The nodes that come with Linkwright: those of ROS 2 that show and move a robot description, and its demos.

Each is in a module of its own, which is imported when it is started.
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
