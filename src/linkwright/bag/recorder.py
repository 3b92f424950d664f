"""Record messages: subscribe to topics as they appear, and write their messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from linkwright.bag.qos import choose_recording_profile
from linkwright.bag.robot_description import (
    DESCRIPTION_TOPIC,
    DESCRIPTION_TYPE,
    HASH_ENTRY,
    description_from_message,
    hash_description,
)
from linkwright.bag.selection import TopicSelection
from linkwright.bag.writing import BagWriter
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Node, QoSProfile
from linkwright.graph.endpoints.base import MessageInfo
from linkwright.messages import get_message

_FLUSH_PERIOD_S = 1.0
_POLL_PERIOD_S = 0.1


class Recorder:
    """A recorder that subscribes to topics and writes their messages to a recording.

    The recorder passes the received messages to the operating system every second, so that at most one second is
    missing if the process is killed. The metadata get the hash of the robot description, even if its topic is not
    recorded, so that a reader can tell whether another description belongs to the recording.

    Args:
        node: the node that subscribes to the topics and logs events.
        selection: the topics to record.
        writer: the writer of the recording; it is closed with the recorder.
        overrides: the QoS profiles to subscribe with, by topic; other profiles are derived from the publishers.
        discover: whether topics that appear later are recorded too.
        polling_seconds: the interval between two searches for new topics.
        without_publishers: whether topics without a publisher are recorded too.
        without_subscriptions: whether topics without a subscription are recorded too.
        paused: whether recording begins paused, so that messages are dropped until `toggle_paused` is called.
        wrap_callback: wraps the node's callbacks, so that the caller can handle an error such as a full disk; by
            default the node logs the error.
    """

    def __init__(
        self,
        node: Node,
        selection: TopicSelection,
        writer: BagWriter,
        *,
        overrides: Mapping[str, QoSProfile] | None = None,
        discover: bool = True,
        polling_seconds: float = _POLL_PERIOD_S,
        without_publishers: bool = False,
        without_subscriptions: bool = True,
        paused: bool = False,
        wrap_callback: Callable[[Callable[..., object]], Callable[..., object]] = lambda callback: callback,
    ) -> None:
        self._node = node
        self._selection = selection
        self._writer = writer
        self._overrides = dict(overrides or {})
        self._without_publishers = without_publishers
        self._without_subscriptions = without_subscriptions
        self._uses_sim_time = bool(node.get_parameter("use_sim_time").value)
        self._logger = node.get_logger()
        self._receive = wrap_callback(self._write)
        self._rejected: set[str] = set()
        self._count = 0
        self._watches_description = False
        self.paused = paused
        self._logger.info("Listening for topics...")
        self._discovery_timer = (
            node.create_timer(polling_seconds, wrap_callback(self._subscribe_to_new_topics)) if discover else None
        )
        self._flush_timer = node.create_timer(_FLUSH_PERIOD_S, wrap_callback(writer.flush))
        self._subscribe_to_new_topics()

    @property
    def message_count(self) -> int:
        """The number of messages written so far."""
        return self._count

    def toggle_paused(self) -> None:
        """Pause or resume recording."""
        self.paused = not self.paused
        self._logger.info("Pausing recording." if self.paused else "Resuming recording.")

    def close(self) -> None:
        """Close the recording after writing the queued messages.

        Requested topics that were not recorded are reported.
        """
        self._flush_timer.cancel()
        if self._discovery_timer is not None:
            self._discovery_timer.cancel()
        self._writer.close()
        self._logger.info("Recording stopped")
        missing = sorted(self._rejected | (self._selection.selected_names - set(self._writer.topics)))
        if missing:
            self._logger.warning(f"Not in the recording: {', '.join(missing)}")

    def _subscribe_to_new_topics(self) -> None:
        if self._uses_sim_time and self._discovery_timer is not None and self._now() == 0:
            return  # simulated time is still unknown; a later subscription also receives latched messages
        for name, types in self._node.get_topic_names_and_types():
            if name == DESCRIPTION_TOPIC and types == [DESCRIPTION_TYPE] and not self._watches_description:
                self._watch_description()
            if name in self._writer.topics or name in self._rejected:
                continue
            if len(types) > 1:
                self._reject(name, f"Topic '{name}' has several types: {', '.join(types)}. It is not recorded.")
            elif self._selection.selects(name, types[0]):
                self._subscribe(name, types[0])
        requested = self._selection.required_topics
        if self._discovery_timer is not None and requested is not None and requested <= set(self._writer.topics):
            self._discovery_timer.cancel()
            self._discovery_timer = None
            self._logger.info("All requested topics are subscribed. Stopping discovery...")

    def _subscribe(self, name: str, type_name: str) -> None:
        offered = [info.qos_profile for info in self._node.get_publishers_info_by_topic(name)]
        if not offered and not self._without_publishers:
            return
        if not self._without_subscriptions and not self._node.count_subscribers(name):
            return
        try:
            message_class = get_message(type_name)
        except LinkwrightError as error:
            self._reject(name, f"Topic '{name}' is not recorded: {error}")
            return
        self._writer.add_topic(name, type_name, offered)
        self._node.create_subscription(
            message_class,
            name,
            lambda data, info: self._receive(name, data, info),
            self._overrides.get(name) or choose_recording_profile(offered),
            raw=True,
        )
        self._logger.info(f"Subscribed to topic '{name}'")

    def _watch_description(self) -> None:
        """Subscribe to the robot description, whose hash belongs into the metadata."""
        offered = [info.qos_profile for info in self._node.get_publishers_info_by_topic(DESCRIPTION_TOPIC)]
        if not offered:
            return
        self._watches_description = True
        profile = choose_recording_profile(offered)
        self._node.create_subscription(
            get_message(DESCRIPTION_TYPE), DESCRIPTION_TOPIC, self._note_description, profile, raw=True
        )

    def _note_description(self, data: bytes | memoryview) -> None:
        self._writer.set_custom_data(HASH_ENTRY, hash_description(description_from_message(data)))

    def _reject(self, name: str, reason: str) -> None:
        self._rejected.add(name)
        self._logger.warning(reason)

    def _write(self, name: str, data: Any, info: MessageInfo) -> None:
        if self.paused:
            return
        stamp = self._now() if self._uses_sim_time else info.received_timestamp
        if self._uses_sim_time and stamp == 0:
            return  # simulated time is not known yet
        self._writer.write(name, stamp, data)
        self._count += 1

    def _now(self) -> int:
        return self._node.get_clock().now().nanoseconds
