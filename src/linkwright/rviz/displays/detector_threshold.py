"""Sets the minimum score of detections at the node that publishes them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from linkwright.graph import Node, Parameter
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.parameters.parameter import ParameterType
from linkwright.page.protocol.configuration import StatusLevel
from linkwright.rviz.parameter_answers import NoAnswerError, answer, services_ready

_NAMES = ["threshold", "confidence_threshold", "detection.threshold"]
"""The names of the parameter in our detector and yolo_ros, yolov5_ros, and openrobotics_darknet_ros."""

StatusReport = Callable[[StatusLevel, str], None]
"""Called with a status of the display: the node that drops weaker detections, or a warning if it refuses."""


class DetectorThreshold:
    """Sets the parameter of a detector node for the minimum score.

    Requests are sent one at a time; a newer value replaces values that were not sent yet.

    Args:
        node: the node that sends requests.
        report: called with the status level and text for the outcome of a request.
    """

    def __init__(self, node: Node, report: StatusReport) -> None:
        self._node, self._report = node, report
        self._wish: tuple[str, float] | None = None
        self._task: asyncio.Task[None] | None = None

    def set(self, topic: str, value: float) -> None:
        """Set the minimum score at the node that publishes a topic, if that node has such a parameter."""
        self._wish = topic, value
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._send_requests())

    def close(self) -> None:
        """Cancel pending requests."""
        self._wish = None
        if self._task is not None:
            self._task.cancel()
            self._task = None

    async def _send_requests(self) -> None:
        while self._wish is not None:
            (topic, value), self._wish = self._wish, None
            outcome = await self._set(topic, value)
            if self._wish is None:
                self._report(*outcome)

    async def _set(self, topic: str, value: float) -> tuple[StatusLevel, str]:
        full = self._node.resolve_topic_name(topic)
        publishers = {
            f"{info.node_namespace.rstrip('/')}/{info.node_name}"
            for info in self._node.get_publishers_info_by_topic(full)
        }
        if len(publishers) != 1:
            return "ok", f"Filtered here: {len(publishers)} nodes publish {full}"
        (name,) = publishers
        client = AsyncParameterClient(self._node, name)
        try:
            await services_ready(client)
            names = (await answer(client, client.list_parameters())).result.names
            known = next((name for name in _NAMES if name in names), None)
            if known is None:
                return "ok", f"Filtered here: {name} has no parameter 'threshold'"
            parameter = Parameter(known, ParameterType.DOUBLE, value)
            result = (await answer(client, client.set_parameters([parameter]))).results[0]
        except NoAnswerError as error:
            return "warn", f"Filtered here: {error}"
        finally:
            with suppress(ValueError):  # the node may already have been destroyed
                client.destroy()
        if not result.successful:
            return "warn", f"Filtered here: {name} refuses '{known}': {result.reason}"
        return "ok", f"Parameter '{known}' of {name}"
