"""view_frames of tf2_tools: records transforms for some seconds and draws their tree."""

from __future__ import annotations

import argparse
import asyncio
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.graph import Graph
from linkwright.graph.transforms.listener import DEFAULT_STATIC_TF_TOPIC, DEFAULT_TF_TOPIC, TransformListener
from linkwright.graph.transforms.waiting import Buffer
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors


class ViewFrames(SingleNode):
    """The running view_frames node.

    It writes ``frames_DATE.gv`` and ``frames_DATE.pdf`` to the current folder.

    Raises:
        LinkwrightError: NODE411 if an argument is invalid.
    """

    DEFAULT_NAME = "view_frames"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        self._logger = self._node.get_logger()
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        with handle_start_errors(self._node):
            self._settings = _parse_arguments(arguments)
        self._buffer = Buffer(node=self._node)
        TransformListener(
            self._buffer,
            self._node,
            tf_topic=self._settings.tf_topic,
            tf_static_topic=self._settings.tf_static_topic,
        )
        self._logger.info(f"Listening to tf data for {self._settings.wait_time} seconds...")
        self._timer = self._node.create_timer(max(0.001, self._settings.wait_time), self._finish)

    def _finish(self) -> None:
        self._timer.cancel()
        self._logger.info("Generating graph...")
        try:
            self._write()
        except LinkwrightError as error:
            self._node.get_logger().error(str(error))
            status = 1
        else:
            status = 0
        if not self.finished.done():
            self.finished.set_result(status)

    def _write(self) -> None:
        import yaml

        from linkwright.urdf.diagram import render

        text = self._buffer.all_frames_as_yaml()
        self._logger.info(f"Result:tf2_msgs.srv.FrameGraph_Response(frame_yaml={text!r})")
        stem = self._settings.output or f"frames_{time.strftime('%Y-%m-%d_%H.%M.%S')}"
        dot_path, image = Path(f"{stem}.gv"), Path(f"{stem}.pdf")
        self._logger.info(f"Exporting graph in {image} file...")
        seconds = self._node.get_clock().now().nanoseconds / 1e9
        dot = frames_as_dot(yaml.safe_load(text) or {}, seconds)
        try:
            write_whole_file(dot_path, dot)
        except OSError as error:
            raise LinkwrightError(
                Diagnostic(
                    "NODE412",
                    phrase(
                        "cannot write '{path}': {reason}",
                        path=dot_path,
                        reason=foreign(error.strerror or error),
                    ),
                )
            ) from error
        render(dot, image)


def frames_as_dot(frames: Mapping[str, Mapping[str, Any]], recorded_s: float) -> str:
    """Return the tree of frames as a graph in the DOT language of Graphviz.

    Args:
        frames: the data of the transform buffer for each frame, by frame name.
        recorded_s: the time of the recording, in seconds since the epoch.
    """
    if not frames:
        return 'digraph G { "No tf data received" }'
    lines = ["digraph G {"]
    for name, frame_data in frames.items():
        lines.append(
            f'"{frame_data["parent"]}" -> "{name}"[label=" Broadcaster: {frame_data["broadcaster"]}\\n'
            f"Average rate: {frame_data['rate']}\\nBuffer length: {frame_data['buffer_length']}\\n"
            f"Most recent transform: {frame_data['most_recent_transform']}\\n"
            f'Oldest transform: {frame_data["oldest_transform"]}\\n"];'
        )
    legend = f"Recorded at time: {recorded_s}"
    roots = dict.fromkeys(facts["parent"] for facts in frames.values() if facts["parent"] not in frames)
    lines += [
        "edge [style=invis];",
        ' subgraph cluster_legend { style=bold; color=black; label ="view_frames Result";',
        f'"{legend}"[ shape=plaintext ] ;',
        "}",
        *(f'"{legend}"->"{root}";' for root in roots),
        "}",
    ]
    return "\n".join(lines)


def _parse_arguments(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="view_frames",
        description="Create a diagram of the TF frames being broadcast over ROS",
        exit_on_error=False,
    )
    parser.add_argument(
        "--wait-time",
        "-t",
        type=float,
        default=5.0,
        help="Listen to the /tf topic for this many seconds before rendering the frame tree",
    )
    parser.add_argument("-o", "--output", help="Output filename")
    parser.add_argument("--tf_topic", default=DEFAULT_TF_TOPIC, help="Topic for dynamic transforms")
    parser.add_argument("--tf_static_topic", default=DEFAULT_STATIC_TF_TOPIC, help="Topic for static transforms")
    try:
        settings, unknown_arguments = parser.parse_known_args(arguments)
    except argparse.ArgumentError as problem:
        raise LinkwrightError(
            Diagnostic(
                "NODE411",
                phrase("view_frames: {problem}", problem=foreign(problem)),
                hint=foreign(parser.format_usage().strip()),
            )
        ) from problem
    if unknown_arguments:
        message = phrase("view_frames does not accept the arguments {unknown}", unknown=" ".join(unknown_arguments))
        raise LinkwrightError(Diagnostic("NODE411", message, hint=foreign(parser.format_usage().strip())))
    return settings
