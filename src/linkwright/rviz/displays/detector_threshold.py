"""Sets the minimum score of detections at the node that publishes them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from linkwright.graph import Node, Parameter
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.parameters.parameter import ParameterType
from linkwright.page.protocol.configuration import StatusLevel
from linkwright.rviz.parameter_responses import NoParameterResponseError, wait_for_response, wait_for_services

_PARAMETER_NAMES = ["threshold", "confidence_threshold", "detection.threshold"]
"""The parameter names in Linkwright's detector and yolo_ros, in yolov5_ros, and in openrobotics_darknet_ros."""

StatusReport = Callable[[StatusLevel, str], None]
"""Called with the level and the text of the status: where weak detections are dropped, or a warning."""


class DetectorThreshold:
    """A client that sets the minimum score, a parameter of a detector node.

    Requests are sent one at a time. A new value replaces a value that was not sent yet.

    Args:
        node: the node that sends requests.
        report: called with the status level and text for the outcome of a request.
    """

    def __init__(self, node: Node, report: StatusReport) -> None:
        self._node, self._report = node, report
        self._pending_request: tuple[str, float] | None = None
        self._task: asyncio.Task[None] | None = None

    def set(self, topic: str, value: float) -> None:
        """Set the minimum score at the node that publishes a topic.

        Nothing is set if several nodes publish the topic, or if the node has no such parameter.
        """
        self._pending_request = topic, value
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._send_requests())

    def close(self) -> None:
        """Cancel pending requests."""
        self._pending_request = None
        if self._task is not None:
            self._task.cancel()
            self._task = None

    async def _send_requests(self) -> None:
        while self._pending_request is not None:
            (topic, value), self._pending_request = self._pending_request, None
            outcome = await self._set(topic, value)
            if self._pending_request is None:
                self._report(*outcome)

    async def _set(self, topic: str, value: float) -> tuple[StatusLevel, str]:
        resolved_topic = self._node.resolve_topic_name(topic)
        publishers = {
            f"{info.node_namespace.rstrip('/')}/{info.node_name}"
            for info in self._node.get_publishers_info_by_topic(resolved_topic)
        }
        if len(publishers) != 1:
            return "ok", f"The display filters: {len(publishers)} nodes publish {resolved_topic}"
        (name,) = publishers
        client = AsyncParameterClient(self._node, name)
        try:
            await wait_for_services(client)
            names = (await wait_for_response(client, client.list_parameters())).result.names
            parameter_name = next((name for name in _PARAMETER_NAMES if name in names), None)
            if parameter_name is None:
                return "ok", f"The display filters: {name} has no parameter 'threshold'"
            parameter = Parameter(parameter_name, ParameterType.DOUBLE, value)
            result = (await wait_for_response(client, client.set_parameters([parameter]))).results[0]
        except NoParameterResponseError as error:
            return "warn", f"The display filters: {error}"
        finally:
            with suppress(ValueError):  # the node may already have been destroyed
                client.destroy()
        if not result.successful:
            return "warn", f"The display filters: {name} rejects '{parameter_name}': {result.reason}"
        return "ok", f"Parameter '{parameter_name}' of {name}"
