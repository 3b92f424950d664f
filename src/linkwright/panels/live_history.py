"""The messages of the last minutes, stored so that they can be delivered to the viewer again."""

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

_BYTES = (bytes, bytearray, memoryview)

_MOST_FRESH = 16
"""Messages that wait to be serialized: while one is on its way to the page, it only costs its place."""


class LiveHistory:
    """Stores the messages of the viewer's subscriptions, and delivers those of a past time again.

    No further subscriptions are created for this. While a past time is shown, new messages are stored but not shown.

    Args:
        context: the context of the viewer.
        most_bytes: the maximum number of stored bytes.
        failed: called with an error of the playback.

    Attributes:
        live: whether the present is shown.
        on_reset: called when the displayed time jumps back, so that displays discard their content.
        changed: called when `live` has changed.
    """

    def __init__(self, context: ViewerContext, most_bytes: int, failed: Callable[[LinkwrightError], object]) -> None:
        self._context = context
        self._handle = context.node.handle
        self._recorded: dict[str, Subscription[Any]] = {}
        self._known: set[Subscription[Any]] = set()
        self._went_back = False
        self.live = True
        self.on_reset: Callable[[], object] = lambda: None
        self.changed: Callable[[], object] = lambda: None
        self.most_bytes = most_bytes
        self._failed = failed
        self._now_ns = self._handle.timebase.now_ns
        self._lock = threading.RLock()
        self._fresh: list[tuple[str, int, Any]] = []
        self._stored: History | None = None
        self._handle.message_filter = self._store_if_first

    @property
    def history(self) -> History:
        """The stored messages, including the newest one."""
        with self._lock:
            return self._written()

    @cached_property
    def playback(self) -> Playback:
        """The playback that delivers messages to the subscriptions, created when a past time is first shown."""
        from linkwright.bag.playback import Playback

        made = Playback(self._handle, self.history, self, self._failed)
        made.on_reset = self._reset
        made.changed.append(self.changed)
        return made

    @property
    def has_playback(self) -> bool:
        """Whether a past time was ever shown."""
        return "playback" in self.__dict__

    @property
    def span_ns(self) -> tuple[int, int]:
        """The times of the oldest and the newest message in nanoseconds since the epoch.

        Without messages, both are the current time.
        """
        with self._lock:
            if self._stored is not None:
                return self._stored.start_ns, self._stored.end_ns
            now = self._now_ns()
            return self._fresh[0][1] if self._fresh else now, now

    @property
    def size(self) -> int:
        """The size of the stored messages in bytes, except the newest ones, which are not serialized yet."""
        return 0 if self._stored is None else self._stored.size

    def freeze(self) -> None:
        """Stop showing new messages, while they are still stored."""
        if not self.live:
            return
        with self._lock:
            self.live = False
            now = self.history.end_ns
        self._context.held_time.show(self._context.node.get_clock(), now)
        self._went_back = False
        self._known = set(self._subscriptions())
        self.playback.take_over(now)
        self._context.graph_changes.watch(self._review)
        self.changed()

    def go_live(self) -> None:
        """Return to the present, unless it is already shown."""
        if self.live:
            return
        self.playback.pause()
        self._context.graph_changes.unwatch(self._review)
        self._context.held_time.release(self._context.node.get_clock())
        # Show the present in the next iteration of the loop: listeners to the time jump must discard past data first.
        asyncio.get_running_loop().call_soon(self._show_present)

    def topics(self) -> dict[str, SavedTopic]:
        """Return the topics whose messages are stored, with the QoS profiles of their current publishers."""
        from linkwright.bag.saving import SavedTopic

        graph = self._context.node.graph
        found = {}
        for name, keeper in list(self._recorded.items()):
            offered = [endpoint.qos_profile for endpoint in graph.get_publishers_info_by_topic(name)]
            found[name] = SavedTopic(keeper.type_name, tuple(offered or [keeper.qos_profile]))
        return found

    def part(self, topics: Mapping[str, SavedTopic], start_ns: int, end_ns: int, *, simulated: bool) -> list[Recorded]:
        """Return the stored messages between two times, and earlier ones that the start state requires.

        Args:
            topics: see `topics`.
            start_ns: the earlier time, nanoseconds since the epoch.
            end_ns: the later time, nanoseconds since the epoch.
            simulated: whether messages get the times of ``/clock``. Messages from before the simulation's last reset
                are then omitted, because time starts again at the reset.
        """
        from linkwright.bag.saving import in_simulated_time, last_reset_ns

        messages = self.history.part(max(start_ns, self.history.start_ns), end_ns)
        if not simulated:
            return messages
        reset = last_reset_ns(messages)
        if reset is not None:
            lasting = [name for name, topic in topics.items() if _is_latched(topic)]
            before = [(name, reset, data) for name, _, data in self.history.state_at(lasting, reset - 1)]
            messages = [*before, *(message for message in messages if message[1] >= reset)]
        return in_simulated_time(messages)

    def before(self, topics: Collection[str], length_ns: int, most_bytes: int) -> list[Recorded]:
        """Return the messages of some topics in the `length_ns` nanoseconds before the displayed time.

        The list is empty if the messages exceed `most_bytes`.
        """
        if not self.live:
            return self.playback.before(topics, length_ns, most_bytes)
        history = self.history
        end_ns = history.end_ns
        found, size = [], 0
        for message in history.messages(topics, end_ns - length_ns):
            size += len(message[2])
            if message[1] > end_ns:
                break
            if size > most_bytes:
                return []
            found.append(message)
        return found

    def close(self) -> None:
        """Stop storing messages."""
        self._handle.message_filter = None
        self._context.graph_changes.unwatch(self._review)
        if self._stored is not None:
            self._stored.close()
        if self.has_playback:
            self.playback.close()

    # --- the output of the playback ---------------------------------------------------------------------------

    def wanted(self) -> frozenset[str]:
        """Return the topics that the viewer is subscribed to, except the clock, which `publish_time` sets."""
        return frozenset(subscription.name for subscription in self._subscriptions()) - {CLOCK_TOPIC}

    def publish_time(self, stamp_ns: int) -> None:
        """Hold the viewer's clock at a time, or deliver the simulated time that was current then."""
        if self.live:
            return
        self._went_back = self._went_back or stamp_ns < self.playback.position_ns
        if not self._context.held_time.show(self._context.node.get_clock(), stamp_ns):
            for message in self.history.state_at([CLOCK_TOPIC], stamp_ns):
                self.publish(*message)

    def publish(self, topic: str, stamp_ns: int, data: bytes) -> None:
        """Deliver a message to the subscriptions of its topic."""
        if not self.live:
            self._give(self._subscriptions(), topic, stamp_ns, data)

    def _store_if_first(self, subscription: Subscription[Any], message: Any) -> bool:
        """Store a message, once per topic, and return whether to deliver it to the subscription.

        Thread-safe.
        """
        topic = subscription.name
        keeper = self._recorded.get(topic)
        if keeper is None or keeper.destroyed:
            keeper = self._recorded[topic] = subscription
        if keeper is not subscription:
            return self.live
        if type(message) is QueuedMessage:
            message = message.message
        with self._lock:  # a return to the present must not duplicate or reorder messages
            self._fresh.append((topic, self._now_ns(), message))
            if not self.live or len(self._fresh) >= _MOST_FRESH:
                self._written()
            return self.live

    def _written(self) -> History:
        """Append the newest messages to the history, and return the history.

        A message never changes after its arrival, so serializing it can be deferred.
        """
        if self._stored is None:
            from linkwright.bag.history import History

            self._stored = History(self.most_bytes, self._now_ns)
        history, fresh = self._stored, self._fresh
        self._fresh = []
        for topic, at_ns, message in fresh:
            self._store(history, topic, at_ns, message, thins=self.live)
        return history

    def _store(self, history: History, topic: str, at_ns: int, message: Any, *, thins: bool) -> None:
        """Add a message to the history; a failure is logged, so that other messages are not affected.

        With `thins`, messages whose content does not change are thinned out. While a past time is shown, playback needs
        every message.
        """
        from linkwright.bag.stillness import content_of

        try:
            data = bytes(message) if isinstance(message, _BYTES) else serialize(message)
            history.add(topic, data, at_ns, content_of(self._recorded[topic].type_name, data) if thins else None)
        except Exception as error:  # noqa: BLE001  # a publisher may send anything
            log_failure(self._handle.logger, f"keeping a message of '{topic}'", error)

    def _subscriptions(self) -> list[Subscription[Any]]:
        return list(self._context.node.subscriptions)

    @staticmethod
    def _give(subscriptions: list[Subscription[Any]], topic: str, stamp_ns: int, data: bytes) -> None:
        for subscription in subscriptions:
            if subscription.name == topic:
                subscription.enqueue(data, MessageInfo(stamp_ns, stamp_ns))

    def _review(self) -> None:
        """Deliver the messages that are current at the displayed time to new subscriptions."""
        fresh = [subscription for subscription in self._subscriptions() if subscription not in self._known]
        if self.live or not fresh:
            return
        self._known = set(self._subscriptions())
        position = self.playback.position_ns
        self.playback.take_over(position)
        for message in self.history.state_at({subscription.name for subscription in fresh} - {CLOCK_TOPIC}, position):
            self._give(fresh, *message)

    def _reset(self) -> None:
        if not self.live:
            self._known = set(self._subscriptions())
            self.on_reset()

    def _show_present(self) -> None:
        if self.live:
            return
        if self._went_back:
            self.on_reset()
        subscriptions = self._subscriptions()
        with self._lock:
            for message in self.history.state_at(
                {subscription.name for subscription in subscriptions}, self.history.end_ns
            ):
                self._give(subscriptions, *message)
            self.live = True
        self.changed()


def _is_latched(topic: SavedTopic) -> bool:
    return all(profile.durability is DurabilityPolicy.TRANSIENT_LOCAL for profile in topic.offered)
