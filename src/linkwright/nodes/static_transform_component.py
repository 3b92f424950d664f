"""The component ``StaticTransformBroadcasterNode`` of tf2_ros.

It is static_transform_publisher for containers.
"""

from __future__ import annotations

from typing import Any

from linkwright.graph import Graph
from linkwright.nodes.options import NodeOptions, RunningNode
from linkwright.nodes.static_transform_publisher import StaticTransformPublisher

_TRANSFORM_PARAMETERS = {"translation": ("x", "y", "z"), "rotation": ("x", "y", "z", "w")}


def start(graph: Graph, options: NodeOptions) -> RunningNode:
    """Start a static transform publisher that is configured by parameters instead of arguments."""
    parameters: dict[str, Any] = options.parameters
    arguments: list[str] = []
    for group, axes in _TRANSFORM_PARAMETERS.items():
        for axis in axes:
            name = f"{group}.{axis}"
            if name in parameters:
                arguments += [f"--{'q' if group == 'rotation' else ''}{axis}", str(parameters.pop(name))]
    arguments += [
        "--frame-id",
        str(parameters.pop("frame_id", "/frame")),
        "--child-frame-id",
        str(parameters.pop("child_frame_id", "/child")),
    ]
    options.arguments = [*arguments, *options.arguments]
    return StaticTransformPublisher(graph, options)
