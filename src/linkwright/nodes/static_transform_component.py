"""The component ``StaticTransformBroadcasterNode`` of tf2_ros: static_transform_publisher for containers."""

from __future__ import annotations

from typing import Any

from linkwright.graph import Graph
from linkwright.nodes.options import NodeOptions, RunningNode
from linkwright.nodes.static_transform_publisher import StaticTransformPublisher

_PLACE = {"translation": ("x", "y", "z"), "rotation": ("x", "y", "z", "w")}


def start(graph: Graph, options: NodeOptions) -> RunningNode:
    """Start a static transform publisher that is configured by parameters instead of arguments."""
    given: dict[str, Any] = options.parameters
    words: list[str] = []
    for group, axes in _PLACE.items():
        for axis in axes:
            name = f"{group}.{axis}"
            if name in given:
                words += [f"--{'q' if group == 'rotation' else ''}{axis}", str(given.pop(name))]
    words += [
        "--frame-id",
        str(given.pop("frame_id", "/frame")),
        "--child-frame-id",
        str(given.pop("child_frame_id", "/child")),
    ]
    options.arguments = [*words, *options.arguments]
    return StaticTransformPublisher(graph, options)
