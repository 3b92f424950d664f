"""Displays of the messages of a topic: subscription, waiting for transforms, and status."""

from __future__ import annotations

import asyncio
import time
import traceback
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, joined, phrase
from linkwright.graph import ExtrapolationException, QoSProfile, Subscription, TransformException
from linkwright.page.protocol.message import DataContent
from linkwright.rviz.config.property_store import qos_from_properties
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import FILTER_SIZE, Path, Schema, topic_spec
from linkwright.rviz.displays.base.display import DataDisplay, DisplayHost, Pose


class SideTopic:
    """An additional subscription of a display.

    Messages are queued while time is paused.

    Args:
        host: the display's host.
        message_type: the type of the topic's messages.
        on_message: called with each message.
    """

    def __init__(self, host: DisplayHost, message_type: str, on_message: Callable[[Any], None]) -> None:
        self._host = host
        self._type = message_type
        self._on_message = on_message
        self._subscription: Subscription[Any] | None = None
        self._paused_messages: deque[Any] = deque()

    def listen(self, topic: str, qos: QoSProfile) -> Phrase | None:
        """Subscribe to a topic instead of the previous one.

        Return None, or RViz's error text if that fails.
        """
        self.close()
        self._paused_messages = deque(maxlen=max(1, qos.depth))
        try:
            self._subscription = self._host.context.node.create_subscription(self._type, topic, self._on_received, qos)
        except LinkwrightError as error:
            return phrase("Error subscribing: {message}", message=error.diagnostics[0].message)
        return None

    def close(self) -> None:
        """Unsubscribe, and discard the queued messages."""
        if self._subscription is not None:
            with suppress(ValueError):  # the node may already have been destroyed
                self._host.context.node.destroy_subscription(self._subscription)
            self._subscription = None
        self._paused_messages.clear()

    def resume(self) -> None:
        """Handle the messages that were queued while time was paused."""
        while self._paused_messages and not self._host.time.paused:
            self._on_message(self._paused_messages.popleft())

    def _on_received(self, message: Any) -> None:
        if self._host.time.paused:
            self._paused_messages.append(message)
        else:
            self._on_message(message)


def camera_info_topic(image_topic: str) -> str:
    """Return the CameraInfo topic for an image topic, by convention in the same namespace."""
    for transport in ("/compressed", "/compressedDepth", "/theora"):
        image_topic = image_topic.removesuffix(transport)
    return image_topic.rpartition("/")[0] + "/camera_info"


TOPIC = "Topic"
TRANSFORM = "Transform"

_FAILURE_ROW = "Failure"
"""The status row for a message that the display cannot process. RViz has no such row."""

_LATE_TIMEOUT_S = 1.0
"""Seconds to wait for the transforms of a message, which often arrive later, before an error is reported."""

_COUNT_PERIOD_S = 1.0
"""Seconds between two updates of the row with the number of messages or the reason why there are none."""

_WEAKEST_POLICIES = {
    "RELIABILITY": ("Reliability Policy", "Best Effort"),
    "DURABILITY": ("Durability Policy", "Volatile"),
}
"""The QoS rows of a topic, and the value in each row that matches every publisher, by policy."""

_MIN_CLOCK_DIFFERENCE_S = 5.0
"""The difference in s of a stamp and the local time above which the clocks probably differ."""

_MAX_SUGGESTED_TOPICS = 3
"""The largest number of other topics of the same type in a message about a topic without a publisher."""


class TopicDisplay(DataDisplay, ABC):
    """A display of messages of one type on one topic.

    A subclass sets `CLASS`, `MESSAGE` and its properties, which include a `topic_spec`, and overrides
    `process_message`. The display subscribes only while it is enabled, as in RViz.

    Attributes:
        last_message: the message that is currently shown, or None; `show_again` processes this message again.
    """

    MESSAGE: ClassVar[str] = ""
    """The message type of the topic, such as ``sensor_msgs/msg/LaserScan``."""

    SCHEMA: ClassVar[Schema] = (topic_spec(),)

    TOPIC_ROW: ClassVar[str] = TOPIC
    """The status row about the arrival of messages."""

    TRANSFORMED: ClassVar[bool] = True
    """Whether messages wait until the frame in their header can be placed in the Fixed Frame at their time."""

    OCCASIONAL: ClassVar[bool] = False
    """Whether messages are rare, such as plans, so that there is no warning before the first message."""

    FOLLOWS_TRANSFORMS: ClassVar[bool] = False
    """Whether `on_transforms_received` is also called without queued messages, for displays that place content."""

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self.last_message: Any = None
        self._subscription: Subscription[Any] | None = None
        self._release: Callable[[], None] | None = None
        self._waiting: deque[Any] = deque()
        self._paused_messages: deque[Any] = deque()
        self._fixed_frame = ""
        self._has_failed = False
        self._count = 0
        self._subscription_time = 0.0
        self._report_timer: asyncio.TimerHandle | None = None
        self._incompatibility: Phrase | None = None
        self._late_timer: asyncio.TimerHandle | None = None
        self._late_reason = ""

    # --- methods to override -----------------------------------------------------------------------------------

    @abstractmethod
    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show a message.

        Args:
            message: a message of the type `MESSAGE`; it must not be changed.
            pose: the pose of the message's frame in the Fixed Frame at the message's time; None if the display is not
                `TRANSFORMED`.
        """

    def reset(self) -> None:
        """Discard all content, because the topic or the Fixed Frame has changed or time was reset."""
        self.remove_content()

    def on_transforms_received(self) -> None:
        """Handle new transforms.

        By default, show the queued messages that can be placed now.
        """
        self._show_placeable()

    def frame_of(self, message: Any) -> tuple[str, int]:
        """Return the frame and the stamp, in ns, of a message's header.

        A stamp of 0 means the latest transform.
        """
        stamp = message.header.stamp
        return message.header.frame_id, stamp.nanoseconds

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """Return the message type, topic and QoS to subscribe with.

        The topic is empty if none is set.
        """
        return self.MESSAGE, self.properties.text(TOPIC).strip(), qos_from_properties(self.properties)

    def max_waiting_messages(self) -> int:
        """Return the maximum number of messages that wait for their transforms."""
        return int(self.properties.number(TOPIC, FILTER_SIZE))

    # --- methods for subclasses --------------------------------------------------------------------------------

    def show_again(self) -> None:
        """Process the last message again, for example after a property has changed."""
        if self.last_message is not None:
            self._offer(self.last_message)

    # --- lifecycle ---------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Subscribe, if the display is enabled."""
        self._fixed_frame = self.host.frames.fixed_frame
        if self.enabled:
            self._subscribe()

    def stop(self) -> None:
        """Unsubscribe."""
        self._unsubscribe()

    def on_property_changed(self, path: Path) -> None:
        """Subscribe again if the topic or its QoS has changed."""
        if path[0] == TOPIC and path != (TOPIC, FILTER_SIZE):
            self._restart()

    def on_enabled_changed(self) -> None:
        """Subscribe if the display is enabled, otherwise unsubscribe."""
        self._restart()

    def on_frames_changed(self) -> None:
        """Show the last message in the new Fixed Frame, and queued messages with a known pose."""
        if self._check_fixed_frame_change():
            self._waiting.clear()
            self.reset()
            self.show_again()
        self._show_placeable()

    def on_time_changed(self) -> None:
        """Show the messages that were queued while time was paused."""
        self._show_placeable()
        while self._paused_messages and not self.host.time.paused:
            self._offer(self._paused_messages.popleft())

    def on_time_reset(self) -> None:
        """Discard all messages and the content.

        The display stays empty until a new message arrives.
        """
        self.last_message = None
        self._waiting.clear()
        self._paused_messages.clear()
        self.reset()

    def _check_fixed_frame_change(self) -> bool:
        """Return whether the Fixed Frame has changed since the last call."""
        previous_frame, self._fixed_frame = self._fixed_frame, self.host.frames.fixed_frame
        return previous_frame != self._fixed_frame

    def _restart(self) -> None:
        self._unsubscribe()
        self.last_message = None
        self._has_failed = False
        self.reset()
        self.delete_status_row()
        if self.enabled:
            self._subscribe()

    def _subscribe(self) -> None:
        message, topic, qos = self.subscription()
        self._count, self._subscription_time, self._incompatibility = 0, time.monotonic(), None
        if not topic:
            self.set_status_row(self.TOPIC_ROW, "error", phrase("Error subscribing: Empty topic name"))
            return
        from linkwright.graph import SubscriptionEventCallbacks  # imported late: a page with only a robot does not
        # need it

        try:
            self._subscription = self.context.node.create_subscription(
                message,
                topic,
                self._on_received,
                qos,
                event_callbacks=SubscriptionEventCallbacks(incompatible_qos=self._on_incompatible_qos),
            )
        except LinkwrightError as error:
            self.set_status_row(
                self.TOPIC_ROW, "error", phrase("Error subscribing: {message}", message=error.diagnostics[0].message)
            )
            return
        if self.TRANSFORMED or self.FOLLOWS_TRANSFORMS:
            self._release = self.context.transforms.add_listener(self.on_transforms_received)
        self._report_count()

    def _unsubscribe(self) -> None:
        if self._report_timer is not None:
            self._report_timer.cancel()
            self._report_timer = None
        if self._subscription is not None:
            with suppress(ValueError):  # the node may already have been destroyed
                self.context.node.destroy_subscription(self._subscription)
            self._subscription = None
        if self._release is not None:
            self._release()
            self._release = None
        self._cancel_late_report()
        self._waiting.clear()
        self._paused_messages.clear()

    def _on_incompatible_qos(self, info: Any) -> None:
        policy = getattr(info.last_policy_kind, "name", str(info.last_policy_kind))
        self._incompatibility = phrase(
            "A publisher offers incompatible QoS. Last incompatible policy: {policy}", policy=policy
        )
        row, weakest_value = _WEAKEST_POLICIES.get(policy, ("", ""))
        if row:
            self._incompatibility = phrase(
                "{problem}. Choose {offered} for {row} below {topic}",
                problem=self._incompatibility,
                offered=weakest_value,
                row=row,
                topic=TOPIC,
            )
        if self._count == 0:
            self._report_count()

    def _report_count(self) -> None:
        """Show the number of messages and their rate, or the reason why there are none.

        The reason is updated until a message arrives.
        """
        if self._count > 0:
            seconds = time.monotonic() - self._subscription_time
            text = phrase("{count} messages received", count=self._count)
            if self._count > 1 and seconds > 0:
                rate = self._count / seconds
                text = phrase("{count} messages received at {rate:.0f} hz.", count=self._count, rate=rate)
            self.set_status_row(self.TOPIC_ROW, "ok", text)
            return
        self.set_status_row(
            self.TOPIC_ROW,
            "ok" if self._may_be_silent() else "warn",
            self._incompatibility or phrase("No messages received: {reason}", reason=self._explain_silence()),
        )
        self._report_count_later()

    def _may_be_silent(self) -> bool:
        """Return whether the display is `OCCASIONAL` and has a publisher of the right type."""
        message, topic, _ = self.subscription()
        publishers = self.context.published.publishers(topic)
        return self.OCCASIONAL and self._incompatibility is None and any(kind == message for _, kind in publishers)

    def _report_count_later(self) -> None:
        def report() -> None:
            self._report_timer = None
            self._report_count()

        if self._report_timer is None:
            self._report_timer = asyncio.get_running_loop().call_later(_COUNT_PERIOD_S, report)

    def _explain_silence(self) -> Phrase:
        """Return the reason why no messages arrive.

        If the topic has no publisher, the reason names published topics of the same type.
        """
        message, topic, _ = self.subscription()
        publishers = self.context.published.publishers(topic)
        types = {topic_type for _, topic_type in publishers}
        if types and message not in types:
            return phrase("the topic carries {types}, not {message}", types=joined(sorted(types)), message=message)
        if publishers:
            return phrase("no message arrived yet from {nodes}", nodes=joined(sorted({name for name, _ in publishers})))
        topics = self.context.published.topics_of_type(message)
        if topics:
            from difflib import SequenceMatcher  # imported late, because most topics have a publisher

            topics = sorted(topics, key=lambda name: -SequenceMatcher(None, topic, name).ratio())[
                :_MAX_SUGGESTED_TOPICS
            ]
            return phrase(
                "the topic has no publisher, but {message} is published on {topics}",
                message=message,
                topics=joined(topics),
            )
        return phrase("the topic has no publisher")

    # --- messages ----------------------------------------------------------------------------------------------

    def _on_received(self, message: Any) -> None:
        self._count += 1
        if self._count == 1:
            self._report_count()
        else:
            self._report_count_later()
        if self.TRANSFORMED:
            self.host.time.record_stamp(self.config.name, self.frame_of(message)[1])
        if self.host.time.paused:
            self._paused_messages.append(message)
            while len(self._paused_messages) > max(1, self.subscription()[2].depth):
                self._paused_messages.popleft()
        else:
            self._offer(message)

    def _offer(self, message: Any) -> None:
        if not self.TRANSFORMED:
            self._process(message, None)
            return
        if self._waiting or not self._show_if_placed(message):
            self._waiting.append(message)
            while len(self._waiting) > self.max_waiting_messages():
                self._waiting.popleft()

    def _show_placeable(self) -> None:
        while self._waiting and not self.host.time.paused and self._show_if_placed(self._waiting[0]):
            self._waiting.popleft()

    def _show_if_placed(self, message: Any) -> bool:
        frame, stamp_ns = self.frame_of(message)
        frame = frame.removeprefix("/")
        try:
            pose = self.context.transforms.pose(self._fixed_frame, frame, stamp_ns)
        except TransformException as error:
            reason = phrase(
                "Could not transform from [{frame}] to [{fixed_frame}]: {reason}",
                frame=frame,
                fixed_frame=self._fixed_frame,
                reason=error.diagnostics[0].message,
            )
            self._report_unplaced(reason, stamp_ns, is_late=isinstance(error, ExtrapolationException))
            return False
        self._cancel_late_report()
        self.set_status_row(TRANSFORM, "ok", phrase("Transform OK"))
        self._process(message, pose)
        return True

    def _report_unplaced(self, reason: Phrase, stamp_ns: int, *, is_late: bool) -> None:
        """Report a message whose transform is not available.

        A late transform is reported only if no message can be placed for a second.
        """
        if not is_late:
            self.set_status_row(TRANSFORM, "error", reason)
            return
        self._late_reason = self._add_clock_advice(reason, stamp_ns)
        if self._late_timer is None:
            self._late_timer = asyncio.get_running_loop().call_later(_LATE_TIMEOUT_S, self._report_late)

    def _add_clock_advice(self, reason: Phrase, stamp_ns: int) -> Phrase:
        """Return the reason, preceded by advice on clocks if the stamp is far from the local time."""
        seconds_ahead = (stamp_ns - self.context.node.get_clock().now().nanoseconds) * 1e-9
        if abs(seconds_ahead) < _MIN_CLOCK_DIFFERENCE_S:
            return reason
        if seconds_ahead > 0:
            return phrase(
                "The message's stamp is {seconds:.0f} s after the local time: check the clocks of both "
                "computers and use_sim_time of their nodes. {reason}",
                seconds=seconds_ahead,
                reason=reason,
            )
        return phrase(
            "The message's stamp is {seconds:.0f} s before the local time: check the clocks of both computers "
            "and use_sim_time of their nodes. {reason}",
            seconds=-seconds_ahead,
            reason=reason,
        )

    def _report_late(self) -> None:
        self._late_timer = None
        if self._waiting:
            self.set_status_row(TRANSFORM, "error", self._late_reason)

    def _cancel_late_report(self) -> None:
        if self._late_timer is not None:
            self._late_timer.cancel()
            self._late_timer = None

    def _process(self, message: Any, pose: Pose | None) -> None:
        """Show a message.

        An exception is logged, and does not prevent later messages.
        """
        self.last_message = message
        try:
            self.process_message(message, pose)
        except Exception as error:  # noqa: BLE001  # a message may have any content
            if not self._has_failed:
                self.context.node.get_logger().error(f"'{self.config.name}' failed:\n{traceback.format_exc().rstrip()}")
            self._has_failed = True
            self.set_status_row(
                _FAILURE_ROW,
                "error",
                phrase("The message could not be shown: {reason}", reason=foreign(error or type(error).__name__)),
            )
            return
        if self._has_failed:
            self._has_failed = False
            self.delete_status_row(_FAILURE_ROW)


_MESSAGE_ROW = "Message"
_INVALID_TEXT = phrase("Message contained invalid floating point values (nans or infs)")


@dataclass(slots=True)
class _ShownContent:
    content: DataContent
    frame: str
    pose: Pose | None
    stamp_ns: int


class RecentDisplay(TopicDisplay):
    """A display of the most recent messages, each at the pose that its frame had at its stamp.

    A subclass sets `LENGTH` to the property with the number of messages, where 0 means all messages. Without
    `LENGTH` the display shows one message.
    """

    LENGTH: ClassVar[Path | None] = None

    IN_FIXED_FRAME: ClassVar[bool] = False
    """Whether the contents are already in the Fixed Frame."""

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._shown_contents: deque[_ShownContent] = deque()
        self._number = 0

    @abstractmethod
    def content(self, message: Any) -> DataContent | None:
        """Return the content of a message, or None to ignore it.

        The content is in the frame that `frame_of` returns.
        """

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Show a message, and remove the oldest message if there are more than `LENGTH` allows."""
        assert pose is not None
        content = self.content(message)
        if content is None:
            return
        frame, stamp_ns = self.frame_of(message)
        if self.IN_FIXED_FRAME:
            frame, pose = "", None
        self._shown_contents.append(_ShownContent(content, frame, pose, stamp_ns))
        length = self._get_length()
        if length and len(self._shown_contents) > length:
            self._shown_contents.popleft()
        self._send(self._shown_contents[-1])

    def on_property_changed(self, path: Path) -> None:
        """Subscribe again if necessary, or apply a new number of messages to show."""
        super().on_property_changed(path)
        if path == self.LENGTH:
            length = self._get_length()
            recent_contents = list(self._shown_contents)[-length:]
            self.reset()
            for recent_content in recent_contents:
                self._shown_contents.append(recent_content)
                self._send(recent_content)

    def reset(self) -> None:
        """Discard all messages."""
        self._shown_contents.clear()
        self._number = 0
        super().reset()

    def refuse(self, text: str) -> None:
        """Show a text in the status that explains why the last message cannot be drawn."""
        self.set_status_row(_MESSAGE_ROW, "error", text)

    def accept(self) -> None:
        """Clear the error of the previous message from the status."""
        self.delete_status_row(_MESSAGE_ROW)

    def is_finite(self, *numbers: ArrayLike) -> bool:
        """Return whether all numbers are finite, and show an error in the status if not."""
        if all(np.isfinite(number).all() for number in numbers):
            self.accept()
            return True
        self.refuse(_INVALID_TEXT)
        return False

    def _send(self, shown_content: _ShownContent) -> None:
        length = self._get_length()
        key = str(self._number % length if length else self._number)
        self._number += 1
        self.send(
            shown_content.content,
            key=key,
            frame=shown_content.frame,
            pose=shown_content.pose,
            stamp_ns=shown_content.stamp_ns,
        )

    def _get_length(self) -> int:
        return 1 if self.LENGTH is None else int(self.properties.number(*self.LENGTH))
