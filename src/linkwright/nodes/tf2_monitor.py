"""tf2_monitor of tf2_ros: reports the publishers of transforms with their rates and delays."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Iterable

from linkwright.graph import STATIC_TF_SUBSCRIPTION_QOS, TF_QOS, Graph, TransformException
from linkwright.graph.time.values import Time
from linkwright.graph.transforms.core import BufferCore, to_nanoseconds
from linkwright.messages import TFMessage
from linkwright.nodes.options import NodeOptions, SingleNode, create_node

AUTHORITY = "<no authority available>"
USAGE = "TF_Monitor: usage: tf2_monitor framea frameb"

_MAX_DELAYS = 1000
_UPDATE_PERIOD_S = 0.5
_UPDATES_PER_REPORT = 21
_FILTER_WEIGHT = 0.01
"""The weight of a new delay in the average."""
_LATEST = Time()
_MIN_SPAN_S = 1e-8


class Tf2Monitor(SingleNode):
    """The running tf2_monitor node, which prints a report about every ten seconds.

    The report covers all frames, or the chain between two frames.
    """

    DEFAULT_NAME = "tf2_monitor_main"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        self._clock = self._node.get_clock()
        self._output = options.output
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        if len(arguments) not in (0, 2):
            self._output(USAGE)
            self.finished.set_result(255)
            return
        self._frames = (arguments[0], arguments[1]) if arguments else None
        self._chain: list[str] = []
        self._is_gathering = False
        self._update_count = 0
        self._average_delay = self._max_delay = 0.0
        self._delays: dict[str, deque[float]] = {}
        self._message_delays: deque[float] = deque(maxlen=_MAX_DELAYS)
        self._message_times: deque[float] = deque(maxlen=_MAX_DELAYS)
        self._buffer = BufferCore(logger=self._node.get_logger().get_child("tf2"))
        self._node.create_subscription(TFMessage, "/tf", lambda message: self._receive(message, static=False), TF_QOS)
        self._node.create_subscription(
            TFMessage, "/tf_static", lambda message: self._receive(message, static=True), STATIC_TF_SUBSCRIPTION_QOS
        )
        if self._frames is not None:
            self._output(f"Waiting for transform chain to become available between {' and '.join(self._frames)} ")
        self._node.create_timer(_UPDATE_PERIOD_S, self._measure_and_print)

    def _receive(self, message: TFMessage, *, static: bool) -> None:
        now_ns = self._clock.now().nanoseconds
        self._buffer.update(message, static=static)
        total = 0.0
        for transform in message.transforms:
            delay = (now_ns - to_nanoseconds(transform.header.stamp)) / 1e9
            total += delay
            self._delays.setdefault(transform.child_frame_id, deque(maxlen=_MAX_DELAYS)).append(delay)
        self._message_delays.append(total / max(1, len(message.transforms)))
        self._message_times.append(now_ns / 1e9)

    def _measure_and_print(self) -> None:
        if not self._is_gathering and not self._begin():
            return
        if self._frames is not None:
            self._measure(*self._frames)
        self._update_count += 1
        if self._update_count >= _UPDATES_PER_REPORT:
            self._update_count = 0
            self._report()

    def _begin(self) -> bool:
        """Start gathering data if the chain between the two frames is available.

        Return whether gathering started.
        """
        subject = "all frames"
        if self._frames is not None:
            first, second = self._frames
            try:
                self._chain = self._buffer.chain(second, _LATEST, first, _LATEST, second)
            except TransformException:
                return False
            subject = f"{first} -> {second}"
        self._output(f"Gathering data on {subject} for 10 seconds...")
        self._is_gathering = True
        return True

    def _measure(self, first: str, second: str) -> None:
        try:
            _, stamp_ns = self._buffer.lookup(first, second, 0)
        except TransformException:
            return
        delay = (self._clock.now().nanoseconds - stamp_ns) / 1e9
        self._average_delay = _FILTER_WEIGHT * delay + (1.0 - _FILTER_WEIGHT) * self._average_delay
        self._max_delay = max(self._max_delay, delay)

    def _report(self) -> None:
        lines = ["", "", ""]
        if self._frames is not None:
            lines += [
                f"RESULTS: for {' to '.join(self._frames)}",
                f"Chain is: {' -> '.join(self._chain)}",
                f"Net delay     avg = {self._average_delay:g}: max = {self._max_delay:g}",
            ]
        else:
            lines.append("RESULTS: for all Frames")
        lines += ["", "Frames:"]
        for frame, delays in sorted(self._delays.items()):
            if self._frames is None or frame in self._chain:
                lines.append(f"Frame: {frame}, published by {AUTHORITY}, {_format_delays(delays, ', ')}")
        lines += ["", "All Broadcasters:"]
        if self._message_times:
            span = max(_MIN_SPAN_S, self._message_times[-1] - self._message_times[0])
            frequency = len(self._message_times) / span
            lines.append(f"Node: {AUTHORITY} {frequency:g} Hz, {_format_delays(self._message_delays, ' ')}")
        self._output("\n".join(lines))


def _format_delays(delays: Iterable[float], separator: str) -> str:
    values = list(delays)
    return f"Average Delay: {sum(values) / len(values):g}{separator}Max Delay: {max(0.0, *values):g}"
