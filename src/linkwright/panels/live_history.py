"""Stores the messages of the last minutes, and delivers them to the viewer again."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Collection, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linkwright.graph import DurabilityPolicy, MessageInfo, log_failure
from linkwright.graph.endpoints.subscription import QueuedMessage
from linkwright.graph.simulated_time import CLOCK_TOPIC
from linkwright.messages import serialize

if TYPE_CHECKING:
    from linkwright.bag.history import History
    from linkwright.bag.names import Recorded
    from linkwright.bag.playback import Playback
    from linkwright.bag.saving import SavedTopic
    from linkwright.diagnostics import LinkwrightError
    from linkwright.graph import Subscription
    from linkwright.rviz.context import ViewerContext

_BYTES_TYPES = (bytes, bytearray, memoryview)

_MAX_NEW_MESSAGES = 16
"""The number of new messages that are stored before they are serialized. This delays the page less."""


class LiveHistory:
    """The latest messages of the viewer's subscriptions, which can be delivered again.

    The history creates no subscriptions. While a past time is shown, new messages are stored but not shown.

    Args:
        context: the context of the viewer.
        max_bytes: the maximum number of stored bytes.
        on_error: called with an error of the playback.

    Attributes:
        live: whether the current time is shown.
        on_reset: called when the displayed time jumps back. Displays must then discard their content.
        changed: called when `live` has changed.
    """

    def __init__(self, context: ViewerContext, max_bytes: int, on_error: Callable[[LinkwrightError], object]) -> None:
        self._context = context
        self._handle = context.node.handle
        self._storing_subscriptions: dict[str, Subscription[Any]] = {}
        self._known_subscriptions: set[Subscription[Any]] = set()
        self._has_gone_back = False
        self.live = True
        self.on_reset: Callable[[], object] = lambda: None
        self.changed: Callable[[], object] = lambda: None
        self.max_bytes = max_bytes
        self._failed = on_error
        self._now_ns = self._handle.timebase.now_ns
        self._lock = threading.RLock()
        self._new_messages: list[tuple[str, int, Any]] = []
        self._stored_history: History | None = None
        self._handle.message_filter = self._store_if_first

    @property
    def history(self) -> History:
        """The stored messages, including the newest one."""
        with self._lock:
            return self._flush()

    @cached_property
    def playback(self) -> Playback:
        """The playback to the subscriptions, created when an earlier time is first shown."""
        from linkwright.bag.playback import Playback

        playback = Playback(self._handle, self.history, self, self._failed)
        playback.on_reset = self._reset
        playback.changed.append(self.changed)
        return playback

    @property
    def has_playback(self) -> bool:
        """Whether a past time has been shown since the start."""
        return "playback" in self.__dict__

    @property
    def span_ns(self) -> tuple[int, int]:
        """The times of the oldest and the newest message in nanoseconds since the epoch.

        Without messages, both are the current time.
        """
        with self._lock:
            if self._stored_history is not None:
                return self._stored_history.start_ns, self._stored_history.end_ns
            now_ns = self._now_ns()
            return self._new_messages[0][1] if self._new_messages else now_ns, now_ns

    @property
    def size(self) -> int:
        """The size of the stored messages in bytes, without messages that are not serialized yet."""
        return 0 if self._stored_history is None else self._stored_history.size

    def freeze(self) -> None:
        """Stop showing new messages, but continue to store them."""
        if not self.live:
            return
        with self._lock:
            self.live = False
            now_ns = self.history.end_ns
        self._context.held_time.show(self._context.node.get_clock(), now_ns)
        self._has_gone_back = False
        self._known_subscriptions = set(self._find_subscriptions())
        self.playback.continue_from(now_ns)
        self._context.graph_changes.watch(self._update_new_subscriptions)
        self.changed()

    def go_live(self) -> None:
        """Return to the present, unless it is already shown."""
        if self.live:
            return
        self.playback.pause()
        self._context.graph_changes.unwatch(self._update_new_subscriptions)
        self._context.held_time.release(self._context.node.get_clock())
        # Listeners to the time jump must discard past data first. The present is therefore shown in the next iteration
        # of the loop.
        asyncio.get_running_loop().call_soon(self._show_present)

    def topics(self) -> dict[str, SavedTopic]:
        """Return the stored topics, with the QoS profiles of their current publishers."""
        from linkwright.bag.saving import SavedTopic

        graph = self._context.node.graph
        saved_topics = {}
        for name, storing_subscription in list(self._storing_subscriptions.items()):
            profiles = [endpoint.qos_profile for endpoint in graph.get_publishers_info_by_topic(name)]
            saved_topics[name] = SavedTopic(
                storing_subscription.type_name, tuple(profiles or [storing_subscription.qos_profile])
            )
        return saved_topics

    def messages_between(
        self, topics: Mapping[str, SavedTopic], start_ns: int, end_ns: int, *, simulated: bool
    ) -> list[Recorded]:
        """Return the messages between two times, and earlier messages for the state at the start.

        Args:
            topics: see `topics`.
            start_ns: the start of the range, in ns since the epoch.
            end_ns: the end of the range, in ns since the epoch.
            simulated: whether messages get the times of ``/clock``. Messages before the last reset of the simulation
                are then omitted, because time starts again at the reset.
        """
        from linkwright.bag.saving import find_last_reset_ns, to_simulated_time

        messages = self.history.messages_between(max(start_ns, self.history.start_ns), end_ns)
        if not simulated:
            return messages
        reset_ns = find_last_reset_ns(messages)
        if reset_ns is not None:
            latched_topics = [name for name, topic in topics.items() if _is_latched(topic)]
            latched_messages = [
                (name, reset_ns, data) for name, _, data in self.history.state_at(latched_topics, reset_ns - 1)
            ]
            messages = [*latched_messages, *(message for message in messages if message[1] >= reset_ns)]
        return to_simulated_time(messages)

    def messages_before(self, topics: Collection[str], length_ns: int, max_bytes: int) -> list[Recorded]:
        """Return the messages of topics for a duration in ns before the displayed time.

        The list is empty if the messages exceed `max_bytes`.
        """
        if not self.live:
            return self.playback.messages_before(topics, length_ns, max_bytes)
        history = self.history
        end_ns = history.end_ns
        messages, total_bytes = [], 0
        for message in history.messages(topics, end_ns - length_ns):
            total_bytes += len(message[2])
            if message[1] > end_ns:
                break
            if total_bytes > max_bytes:
                return []
            messages.append(message)
        return messages

    def close(self) -> None:
        """Stop storing messages, and close the history and its playback."""
        self._handle.message_filter = None
        self._context.graph_changes.unwatch(self._update_new_subscriptions)
        if self._stored_history is not None:
            self._stored_history.close()
        if self.has_playback:
            self.playback.close()

    # --- the output of the playback ---------------------------------------------------------------------------

    def subscribed_topics(self) -> frozenset[str]:
        """Return the topics of the viewer's subscriptions, except the clock.

        `publish_time` handles the clock.
        """
        return frozenset(subscription.name for subscription in self._find_subscriptions()) - {CLOCK_TOPIC}

    def publish_time(self, stamp_ns: int) -> None:
        """Hold the viewer's clock at a time.

        If it follows simulated time, deliver the simulated time at this time instead.
        """
        if self.live:
            return
        self._has_gone_back = self._has_gone_back or stamp_ns < self.playback.position_ns
        if not self._context.held_time.show(self._context.node.get_clock(), stamp_ns):
            for message in self.history.state_at([CLOCK_TOPIC], stamp_ns):
                self.publish(*message)

    def publish(self, topic: str, stamp_ns: int, data: bytes) -> None:
        """Deliver a message to the subscriptions of its topic."""
        if not self.live:
            self._deliver(self._find_subscriptions(), topic, stamp_ns, data)

    def _store_if_first(self, subscription: Subscription[Any], message: Any) -> bool:
        """Store a message, once per topic, and return whether to deliver it to the subscription.

        This method is thread-safe.
        """
        topic = subscription.name
        storing_subscription = self._storing_subscriptions.get(topic)
        if storing_subscription is None or storing_subscription.destroyed:
            storing_subscription = self._storing_subscriptions[topic] = subscription
        if storing_subscription is not subscription:
            return self.live
        if type(message) is QueuedMessage:
            message = message.message
        with self._lock:  # Otherwise messages could be duplicated or reordered when the present is shown again.
            self._new_messages.append((topic, self._now_ns(), message))
            if not self.live or len(self._new_messages) >= _MAX_NEW_MESSAGES:
                self._flush()
            return self.live

    def _flush(self) -> History:
        """Append the newest messages to the history, and return the history.

        Messages can be serialized later, because they never change after their arrival.
        """
        if self._stored_history is None:
            from linkwright.bag.history import History

            self._stored_history = History(self.max_bytes, self._now_ns)
        history, new_messages = self._stored_history, self._new_messages
        self._new_messages = []
        for topic, time_ns, message in new_messages:
            self._store(history, topic, time_ns, message, thins=self.live)
        return history

    def _store(self, history: History, topic: str, time_ns: int, message: Any, *, thins: bool) -> None:
        """Add a message to the history.

        A failure is logged, and does not affect other messages. If `thins` is true, some messages without a change of
        content are omitted. While a past time is shown, playback needs every message.
        """
        from linkwright.bag.stillness import extract_content

        try:
            data = bytes(message) if isinstance(message, _BYTES_TYPES) else serialize(message)
            history.add(
                topic,
                data,
                time_ns,
                extract_content(self._storing_subscriptions[topic].type_name, data) if thins else None,
            )
        except Exception as error:  # noqa: BLE001  # a publisher may send any bytes
            log_failure(self._handle.logger, f"keeping a message of '{topic}'", error)

    def _find_subscriptions(self) -> list[Subscription[Any]]:
        return list(self._context.node.subscriptions)

    @staticmethod
    def _deliver(subscriptions: list[Subscription[Any]], topic: str, stamp_ns: int, data: bytes) -> None:
        for subscription in subscriptions:
            if subscription.name == topic:
                subscription.enqueue(data, MessageInfo(stamp_ns, stamp_ns))

    def _update_new_subscriptions(self) -> None:
        """Deliver the last messages before the displayed time to new subscriptions."""
        new_subscriptions = [
            subscription for subscription in self._find_subscriptions() if subscription not in self._known_subscriptions
        ]
        if self.live or not new_subscriptions:
            return
        self._known_subscriptions = set(self._find_subscriptions())
        position = self.playback.position_ns
        self.playback.continue_from(position)
        for message in self.history.state_at(
            {subscription.name for subscription in new_subscriptions} - {CLOCK_TOPIC}, position
        ):
            self._deliver(new_subscriptions, *message)

    def _reset(self) -> None:
        if not self.live:
            self._known_subscriptions = set(self._find_subscriptions())
            self.on_reset()

    def _show_present(self) -> None:
        if self.live:
            return
        if self._has_gone_back:
            self.on_reset()
        subscriptions = self._find_subscriptions()
        with self._lock:
            for message in self.history.state_at(
                {subscription.name for subscription in subscriptions}, self.history.end_ns
            ):
                self._deliver(subscriptions, *message)
            self.live = True
        self.changed()


def _is_latched(topic: SavedTopic) -> bool:
    return all(profile.durability is DurabilityPolicy.TRANSIENT_LOCAL for profile in topic.offered)
