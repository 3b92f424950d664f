"""Services that control a recorder, such as ``/rosbag2_recorder/snapshot``, as in rosbag2."""

from __future__ import annotations

from typing import Any

from linkwright.bag.recorder import Recorder
from linkwright.bag.writing import BagWriter
from linkwright.graph import Node
from linkwright.messages import get_message


class RecorderServices:
    """The services that control a recorder, and the topic ``events/write_split``.

    They are below the name of the node. Names and types follow ``rosbag2_transport::Recorder``.

    Args:
        node: the node that offers the services.
        recorder: the recorder that the services control.
        writer: the writer of the recorder.
        snapshots: whether to offer the service ``snapshot``.
    """

    def __init__(self, node: Node, recorder: Recorder, writer: BagWriter, *, snapshots: bool) -> None:
        self._recorder = recorder
        self._writer = writer
        event_class = get_message("rosbag2_interfaces/msg/WriteSplitEvent")
        event_publisher = node.create_publisher(event_class, "events/write_split", 1)
        writer.on_split = lambda closed_file, opened_file: event_publisher.publish(
            event_class(closed_file=closed_file, opened_file=opened_file)
        )
        services = [
            ("split_bagfile", "SplitBagfile"),
            ("pause", "Pause"),
            ("resume", "Resume"),
            ("is_paused", "IsPaused"),
        ]
        for name, type_name in [*services, *([("snapshot", "Snapshot")] if snapshots else [])]:
            node.create_service(f"rosbag2_interfaces/srv/{type_name}", f"~/{name}", getattr(self, f"_{name}"))

    def _snapshot(self, _: Any, response: Any) -> Any:
        response.success = self._writer.take_snapshot()
        return response

    def _split_bagfile(self, _: Any, response: Any) -> Any:
        self._writer.split()
        return response

    def _pause(self, _: Any, response: Any) -> Any:
        if not self._recorder.paused:
            self._recorder.toggle_paused()
        return response

    def _resume(self, _: Any, response: Any) -> Any:
        if self._recorder.paused:
            self._recorder.toggle_paused()
        return response

    def _is_paused(self, _: Any, response: Any) -> Any:
        response.paused = self._recorder.paused
        return response
