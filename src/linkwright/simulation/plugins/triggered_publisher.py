"""Messages that other messages trigger: ``gz-sim-triggered-publisher-system``.

Each message on the input topic is compared with the ``<match>`` elements. If all of them match, the plugin publishes
the messages of the ``<output>`` elements, after the delay.

Source: gz-sim (parameters, matching). Messages are in the text format of protobuf. Calls of services are left out,
because services of gz have no counterpart of the same type in ROS.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import isclose
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.messages.message import Message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.gz_messages import find_ros_type, read_message, read_topic
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.protobuf_text import is_sequence
from linkwright.xmltree import Element

_DEFAULT_TOLERANCE = 1e-8
_FLOAT32_TOLERANCE = 1e-7
"""The relative tolerance for numbers, which a field of 32 bits rounds."""

Matcher = Callable[[Any], bool]


@dataclass(frozen=True, kw_only=True)
class TriggeredPublisherParameters:
    """Parameters of ``gz-sim-triggered-publisher-system``."""

    delay_ms: int = 0


class GzTriggeredPublisher(SimulatedPlugin[TriggeredPublisherParameters]):
    """The substitute for ``gz-sim-triggered-publisher-system``."""

    PARAMETERS = TriggeredPublisherParameters
    IGNORED = ("input", "output", "service")  # read by start

    def start(self) -> None:
        """Read the matches and the outputs, and subscribe to the input.

        Raises:
            LinkwrightError: SIM160, there is no input, or a type, a match or an output is not valid.
        """
        element = self.context.element
        source = None if element is None else element.first("input")
        if element is None or source is None:
            raise self.parameter_error(phrase("plugin '{plugin}': <input> is missing", plugin=self.context.name))
        self._due_times: deque[int] = deque()
        self._matchers = [self._read_match(source, match) for match in source.elements("match")]
        self._outputs = [
            (
                self.node.publisher(find_ros_type(self, output), read_topic(self, output)),
                read_message(self, output, output.text()),
            )
            for output in element.elements("output")
        ]
        if element.first("service") is not None:
            self.node.logger.warning(
                phrase("plugin '{plugin}': calls of a <service> are not simulated", plugin=self.context.name)
            )
        self.node.subscribe(find_ros_type(self, source), read_topic(self, source), self._on_message)
        if self.parameters.delay_ms > 0:
            self.every(0.0, self._publish_delayed)

    def reset(self) -> None:
        """Drop delayed messages."""
        self._due_times.clear()

    def _read_match(self, source: Element, match: Element) -> Matcher:
        """Return a function that returns whether a message matches."""
        tolerance = float(match.attributes.get("tol", _DEFAULT_TOLERANCE))
        is_expected = match.attributes.get("logic_type", "positive") != "negative"
        path = tuple(filter(None, match.attributes.get("field", "").split(".")))
        text = match.text().strip()
        if not text:
            return lambda _: True
        expected = read_message(self, source, text, path)
        return partial(_matches, path, expected, tolerance, is_expected)

    def _on_message(self, message: Any) -> None:
        if all(matches(message) for matches in self._matchers):
            if self.parameters.delay_ms > 0:
                delay = self.parameters.delay_ms * NANOSECONDS_PER_SECOND // 1000
                self._due_times.append(self.simulation.time + delay)
            else:
                self._publish()

    def _publish_delayed(self) -> None:
        while self._due_times and self._due_times[0] <= self.simulation.time:
            self._due_times.popleft()
            self._publish()

    def _publish(self) -> None:
        for output, message in self._outputs:
            output.publish(message)


def _matches(path: tuple[str, ...], expected: Any, tolerance: float, is_expected: bool, message: Any) -> bool:
    """Return whether a message, or the field at a path, matches the expected one.

    It must be equal, or differ if `is_expected` is false.
    """
    for name in path:
        expected, message = getattr(expected, name), getattr(message, name)
    if path and is_sequence(expected):
        is_equal = all(any(_is_equal(item, other, tolerance) for other in message) for item in expected)
    else:
        is_equal = _is_equal(expected, message, tolerance)
    return is_equal is is_expected


def _is_equal(one: Any, other: Any, tolerance: float) -> bool:
    if isinstance(one, Message):
        names = one.get_fields_and_field_types()
        return all(_is_equal(getattr(one, name), getattr(other, name), tolerance) for name in names)
    if is_sequence(one):
        return len(one) == len(other) and all(
            _is_equal(item, other_item, tolerance) for item, other_item in zip(one, other, strict=True)
        )
    if isinstance(one, float):
        return isclose(one, other, rel_tol=_FLOAT32_TOLERANCE, abs_tol=tolerance)
    return bool(one == other)
