"""relay, throttle, drop and delay of topic_tools, which forward all or some messages."""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from typing import Any, ClassVar

from linkwright.graph import Clock, ParameterType, Timer
from linkwright.messages import serialize
from linkwright.nodes.options import NodeOptions
from linkwright.nodes.settings import check_positive, declare_required, invalid_value_error, options_from_arguments
from linkwright.nodes.topic_tools.tool import TopicTool


class _InputToOutput(TopicTool):
    """The base class of tools with one input and one output.

    By default, the name of the output is derived from the name of the input.
    """

    SUFFIX: ClassVar[str]

    def _declare(self) -> None:
        node = self._node
        self._input = declare_required(node, "input_topic", ParameterType.STRING, self.USAGE)
        self._output = node.declare_parameter("output_topic", self._input + self.SUFFIX).value
        self._lazy = node.declare_parameter("lazy", False).value
        self._declare_parameters()

    @abstractmethod
    def _declare_parameters(self) -> None: ...

    def _declare_clock(self) -> None:
        use_wall_clock: bool = self._node.declare_parameter("use_wall_clock", False).value
        node_clock = self._node.get_clock()
        self._clock = Clock(timebase=node_clock.timebase) if use_wall_clock else node_clock


class Relay(_InputToOutput):
    """The running relay node, which forwards every message.

    Raises:
        LinkwrightError: the parameter ``input_topic`` is missing (NODE431), or an argument is invalid (NODE432).
    """

    DEFAULT_NAME = "relay"
    USAGE = "relay INPUT_TOPIC [OUTPUT_TOPIC]"
    WORDS: ClassVar = {"input_topic": str, "output_topic": str}
    SUFFIX = "_relay"

    def _declare_parameters(self) -> None: ...

    def _receive(self, message: Any) -> None:
        self._send(message)


class Throttle(_InputToOutput):
    """The running throttle node, which limits messages or bytes per second and drops the rest.

    Raises:
        LinkwrightError: a parameter is missing (NODE431) or invalid (NODE433), or an argument is invalid (NODE432).
    """

    DEFAULT_NAME = "throttle"
    USAGE = (
        "throttle messages INPUT_TOPIC MESSAGES_PER_SECOND [OUTPUT_TOPIC], or "
        "throttle bytes INPUT_TOPIC BYTES_PER_SECOND WINDOW [OUTPUT_TOPIC]"
    )
    SUFFIX = "_throttle"
    _MESSAGES: ClassVar = {"throttle_type": str, "input_topic": str, "msgs_per_sec": float, "output_topic": str}
    _BYTES: ClassVar = {
        "throttle_type": str,
        "input_topic": str,
        "bytes_per_sec": int,
        "window": float,
        "output_topic": str,
    }

    def _parse_options(self, options: NodeOptions, arguments: list[str]) -> NodeOptions:
        names = self._BYTES if arguments[:1] == ["bytes"] else self._MESSAGES
        return options_from_arguments(options, arguments, names, self.USAGE)

    def _declare_parameters(self) -> None:
        node = self._node
        throttle_type = declare_required(node, "throttle_type", ParameterType.STRING, self.USAGE)
        self._period_ns = 0
        if throttle_type == "messages":
            rate = declare_required(node, "msgs_per_sec", ParameterType.DOUBLE, self.USAGE)
            self._period_ns = int(1e9 / check_positive(node, "msgs_per_sec", rate))
        elif throttle_type == "bytes":
            self._max_bytes: int = declare_required(node, "bytes_per_sec", ParameterType.INTEGER, self.USAGE)
            self._window_ns = int(declare_required(node, "window", ParameterType.DOUBLE, self.USAGE) * 1e9)
            self._sent: deque[tuple[int, int]] = deque()
        else:
            raise invalid_value_error("throttle_type", throttle_type, node.get_name(), ("messages", "bytes"))
        self._declare_clock()
        self._last_sent_ns = self._clock.now_ns()

    def _receive(self, message: Any) -> None:
        now_ns = self._clock.now_ns()
        if self._period_ns:
            self._count(message, now_ns)
        else:
            self._throttle_bytes(message, now_ns)

    def _count(self, message: Any, now_ns: int) -> None:
        if now_ns < self._last_sent_ns:
            self._node.get_logger().warning("Detected jump back in time, resetting throttle period to now for.")
            self._last_sent_ns = now_ns
        if now_ns - self._last_sent_ns >= self._period_ns:
            self._send(message)
            self._last_sent_ns = now_ns

    def _throttle_bytes(self, message: Any, now_ns: int) -> None:
        while self._sent and not now_ns - self._window_ns <= self._sent[0][0] <= now_ns:
            self._sent.popleft()
        if sum(size for _, size in self._sent) < self._max_bytes:
            self._send(message)
            self._sent.append((now_ns, len(serialize(message))))


class Drop(_InputToOutput):
    """The running drop node, which drops the first X of every Y messages.

    Raises:
        LinkwrightError: a parameter is missing (NODE431), or an argument is invalid (NODE432).
    """

    DEFAULT_NAME = "drop"
    USAGE = "drop INPUT_TOPIC X Y [OUTPUT_TOPIC]"
    WORDS: ClassVar = {"input_topic": str, "X": int, "Y": int, "output_topic": str}
    SUFFIX = "_drop"

    def _declare_parameters(self) -> None:
        self._drop_count: int = declare_required(self._node, "X", ParameterType.INTEGER, self.USAGE)
        self._cycle_length: int = declare_required(self._node, "Y", ParameterType.INTEGER, self.USAGE)
        self._count = 0

    def _receive(self, message: Any) -> None:
        if self._count >= self._drop_count:
            self._send(message)
        self._count += 1
        if self._count >= self._cycle_length:
            self._count = 0


class Delay(_InputToOutput):
    """The running delay node, which forwards every message with a delay.

    Raises:
        LinkwrightError: the parameter ``input_topic`` is missing (NODE431), a delay is negative (NODE433), or an
            argument is invalid (NODE432).
    """

    DEFAULT_NAME = "delay"
    USAGE = "delay INPUT_TOPIC SECONDS [OUTPUT_TOPIC]"
    WORDS: ClassVar = {"input_topic": str, "delay": float, "output_topic": str}
    SUFFIX = "_delay"

    def _declare_parameters(self) -> None:
        self._delay: float = self._node.declare_parameter("delay", 0.0).value
        if not self._delay >= 0.0:
            raise invalid_value_error("delay", self._delay, self._node.get_name())
        self._declare_clock()

    def _receive(self, message: Any) -> None:
        if not self._delay:
            self._send(message)
            return

        def release() -> None:
            self._node.destroy_timer(timer)
            self._send(message)

        timer: Timer = self._node.create_timer(self._delay, release, clock=self._clock)
