"""What the viewer received in the last minutes, and how it is shown again: to its own subscriptions."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from linkwright.bag.history import History
from linkwright.bag.moments import Recorded
from linkwright.bag.playback import Playback
from linkwright.bag.publishing import CLOCK_TOPIC
from linkwright.bag.saving import KeptTopic, in_simulated_time, last_reset_ns
from linkwright.graph import DurabilityPolicy, MessageInfo
from linkwright.graph.endpoints.subscription import Detailed
from linkwright.messages import serialize

if TYPE_CHECKING:
    from linkwright.diagnostics import LinkwrightError
    from linkwright.graph import Subscription
    from linkwright.viewer.context import ViewerContext


class LiveHistory:
    """Keeps what comes for the viewer's subscriptions, and shows them another time than the present.

    Nothing is subscribed to for it. While another time is shown, what comes is kept but shown to nobody.

    Args:
        context: of the viewer.
        most_bytes: how much is kept.
        failed: called with an error of the playback.

    Attributes:
        history: what is kept.
        playback: shows it; its output are the subscriptions.
        live: whether the present is shown.
        begin_anew: has whoever shows something forget it, because time has gone back.
        changed: called when `live` has changed.
    """

    def __init__(self, context: ViewerContext, most_bytes: int, failed: Callable[[LinkwrightError], object]) -> None:
        self._context = context
        self._handle = context.node.handle
        self._keepers: dict[str, Subscription[Any]] = {}
        self._known: set[Subscription[Any]] = set()
        self._went_back = False
        self.live = True
        self.begin_anew: Callable[[], object] = lambda: None
        self.changed: Callable[[], object] = lambda: None
        self.history = History(most_bytes, self._handle.timebase.now_ns)
        self.playback = Playback(self._handle, self.history, self, failed)
        self.playback.begin_anew = self._begin_anew
        self._handle.intake = self._intake

    def freeze(self) -> None:
        """Have everything stand as it is now, while messages go on being kept."""
        if not self.live:
            return
        with self.history.lock:
            self.live = False
            now = self.history.end_ns
        self._context.held_time.show(self._context.node.get_clock(), now)
        self._went_back = False
        self._known = set(self._subscriptions())
        self.playback.take_over(now)
        self._context.graph_changes.listen(self._review)
        self.changed()

    def go_live(self) -> None:
        """Show the present again."""
        if self.live:
            return
        self.playback.pause()
        self._context.graph_changes.ignore(self._review)
        self._context.held_time.release(self._context.node.get_clock())
        # A turn of the loop later: whoever is told of jumps of time forgets what was, then comes what is.
        asyncio.get_running_loop().call_soon(self._show_present)

    def topics(self) -> dict[str, KeptTopic]:
        """The topics whose messages are kept, with the profiles of those who publish them now."""
        graph = self._context.node.graph
        found = {}
        for name, keeper in list(self._keepers.items()):
            offered = [each.qos_profile for each in graph.get_publishers_info_by_topic(name)]
            found[name] = KeptTopic(keeper.type_name, tuple(offered or [keeper.qos_profile]))
        return found

    def part(self, topics: Mapping[str, KeptTopic], start_ns: int, end_ns: int, *, simulated: bool) -> list[Recorded]:
        """What is kept of some time, with what is needed to show its beginning, as a recording has it.

        Args:
            topics: see `topics`.
            start_ns: the earlier time, nanoseconds since the epoch.
            end_ns: the later time.
            simulated: whether messages get the times that ``/clock`` told; then those from before the last reset of
                the simulation are left out, because time begins anew there.
        """
        messages = self.history.part(max(start_ns, self.history.start_ns), end_ns)
        if not simulated:
            return messages
        reset = last_reset_ns(messages)
        if reset is not None:
            lasting = [name for name, each in topics.items() if _is_latched(each)]
            before = [(name, reset, data) for name, _, data in self.history.state_at(lasting, reset - 1)]
            messages = [*before, *(each for each in messages if each[1] >= reset)]
        return in_simulated_time(messages)

    def close(self) -> None:
        """Keep nothing more."""
        self._handle.intake = None
        self._context.graph_changes.ignore(self._review)
        self.playback.close()

    # --- the output of the playback ---------------------------------------------------------------------------

    def wanted(self) -> frozenset[str]:
        """The topics that the viewer is subscribed to; the clock is told by `tell_time`."""
        return frozenset(each.name for each in self._subscriptions()) - {CLOCK_TOPIC}

    def tell_time(self, stamp_ns: int) -> None:
        """Have the viewer's clock show a time, or the simulated one that was told then."""
        if self.live:
            return
        self._went_back = self._went_back or stamp_ns < self.playback.position_ns
        if not self._context.held_time.show(self._context.node.get_clock(), stamp_ns):
            for message in self.history.state_at([CLOCK_TOPIC], stamp_ns):
                self.publish(*message)

    def publish(self, topic: str, stamp_ns: int, data: bytes) -> None:
        """Give a message to the subscriptions of its topic."""
        if not self.live:
            self._give(self._subscriptions(), topic, stamp_ns, data)

    # ----------------------------------------------------------------------------------------------------------

    def _intake(self, subscription: Subscription[Any], message: Any) -> bool:
        """Keep a message, once for all subscriptions of its topic; whether it is to be shown. Called in any thread."""
        topic = subscription.name
        keeper = self._keepers.get(topic)
        if keeper is None or keeper.destroyed:
            keeper = self._keepers[topic] = subscription
        if keeper is not subscription:
            return self.live
        if type(message) is Detailed:
            message = message.message
        data = bytes(message) if isinstance(message, (bytes, bytearray, memoryview)) else serialize(message)
        with self.history.lock:  # so that what comes while the present is gone back to is shown once, and in its order
            self.history.add(topic, data)
            return self.live

    def _subscriptions(self) -> list[Subscription[Any]]:
        return list(self._context.node.subscriptions)

    @staticmethod
    def _give(subscriptions: list[Subscription[Any]], topic: str, stamp_ns: int, data: bytes) -> None:
        for each in subscriptions:
            if each.name == topic:
                each.enqueue(data, MessageInfo(stamp_ns, stamp_ns))

    def _review(self) -> None:
        """Show those who subscribe while time stands still what was then."""
        fresh = [each for each in self._subscriptions() if each not in self._known]
        if self.live or not fresh:
            return
        self._known = set(self._subscriptions())
        position = self.playback.position_ns
        self.playback.take_over(position)
        for message in self.history.state_at({each.name for each in fresh} - {CLOCK_TOPIC}, position):
            self._give(fresh, *message)

    def _begin_anew(self) -> None:
        if not self.live:
            self._known = set(self._subscriptions())
            self.begin_anew()

    def _show_present(self) -> None:
        if self.live:
            return
        if self._went_back:
            self.begin_anew()
        subscriptions = self._subscriptions()
        with self.history.lock:
            for message in self.history.state_at({each.name for each in subscriptions}, self.history.end_ns):
                self._give(subscriptions, *message)
            self.live = True
        self.changed()


def _is_latched(topic: KeptTopic) -> bool:
    return all(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in topic.offered)
