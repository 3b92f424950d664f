"""Publish the sound of pages' microphones as audio_common_msgs, and send them recognized commands and answers."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Any

from linkwright.graph import Publisher, PublisherEventCallbacks, Subscription
from linkwright.graph.endpoints.event_types import QoSPublisherMatchedInfo
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.voice import (
    ConversationPart,
    ConversationText,
    SayCommand,
    SoundBlock,
    Talk,
    Talking,
    VoiceNode,
    VoiceState,
    WatchVoice,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.speech.nodes.audio_topics import NAMESPACE, AudioTopics
from linkwright.speech.page.floor import Floor, SoundBudget
from linkwright.speech.page.words import WordBook
from linkwright.speech.sound.samples import RATE

_TOPICS: dict[ConversationPart, str] = {
    "partial": "/voice/partial_text",
    "text": "/voice/text",
    "command": "/voice/command",
    "response": "/voice/response",
}
_PROPOSE = "/voice/propose_enrolling"
_LISTEN = "/voice/listen"
_TEXT_INPUT = "/voice/text_input"
_DEPTH = 10
_LONGEST_TEXT = 500
"""Characters of a command; longer ones are truncated."""


class VoiceFeature(PageFeature):
    """Publishes the speech of one page at a time, and sends recognized commands to the pages that watch.

    The sound topics exist while a page has its microphone open, the other topics while a page watches.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._node = self.context.node
        self._watchers: dict[Page, VoiceState | None] = {}
        """With the last state sent to each."""
        self._subscriptions: list[Subscription[Any]] = []
        self._text_input: Publisher[Any] | None = None
        self._floor = Floor()
        self._budgets: dict[Page, SoundBudget] = {}
        self._cut: set[Page] = set()
        self._audio: AudioTopics | None = None
        self._listen: Publisher[Any] | None = None
        self._holder: Page | None = None
        self._receivers = 0
        """The number of subscribers that have received the button's state."""
        self._text_count = 0
        self._proposes = False
        self._words = WordBook()

    def opening(self) -> list[ServerMessage]:
        """Return whether there is a node to talk to.

        Other nodes may answer, too, such as an object search node.
        """
        return [VoiceNode(self._node.count_publishers(_TOPICS["command"]) > 0)]

    def receive(self, page: Page, message: Any) -> None:
        """Publish sound or a text, set the talking page, or start or stop sending messages to a page."""
        if isinstance(message, SoundBlock):
            self._hear(page, message)
        elif isinstance(message, Talk):
            self._cut.discard(page)
            self._talk(page, message)
        elif isinstance(message, WatchVoice):
            self._watch(page, watched=message.watched)
        elif not isinstance(message, SayCommand):
            self._words.receive(page, message)
        elif self._text_input is not None:
            self._text_input.publish(self._text_input.msg_type(data=message.text[:_LONGEST_TEXT]))

    def page_closed(self, page: Page) -> None:
        """End the speech of a page."""
        self._cut.discard(page)
        self._words.page_closed(page)
        self._talk(page, Talk("off"))
        self._watch(page, watched=False)

    def close(self) -> None:
        """Destroy the publishers and subscriptions."""
        for page in {*self._watchers, *self._budgets}:
            self.page_closed(page)

    # --- sound -------------------------------------------------------------------------------------------------

    def _talk(self, page: Page, message: Talk) -> None:
        self._floor.set(page, message.mode)
        if message.mode == "off":
            self._budgets.pop(page, None)
        elif page not in self._budgets:
            self._budgets[page] = SoundBudget(asyncio.get_running_loop().time)
        if self._floor and self._audio is None:
            self._audio = AudioTopics(self._node)
            self._listen = self._node.create_publisher(
                "std_msgs/msg/Bool",
                _LISTEN,
                _DEPTH,
                event_callbacks=PublisherEventCallbacks(matched=self._listeners_changed),
            )
        if self._audio is not None:
            self._audio.restart()
        self._pass_on()
        if not self._floor and self._audio is not None:
            self._audio.close()
            self._audio = None
            if self._listen is not None:
                self._node.destroy_publisher(self._listen)
                self._listen = None
        self._review()

    def _pass_on(self) -> None:
        """Publish whether a button is held; a press in another page starts a new command."""
        holder = self._floor.holder
        if holder is self._holder or self._listen is None:
            return
        if self._holder is not None:
            self._publish_held(self._listen, held=False)
        if holder is not None:
            self._publish_held(self._listen, held=True)
        self._holder = holder

    def _publish_held(self, publisher: Publisher[Any], *, held: bool) -> None:
        self._receivers = publisher.get_subscription_count()
        publisher.publish(publisher.msg_type(data=held))

    def _listeners_changed(self, event: QoSPublisherMatchedInfo) -> None:
        """Publish the button state again for subscribers that appear after the button was pressed.

        Other processes match with some delay. The topic is not latched, because manual publishers do not latch it
        either.
        """
        if event.current_count > self._receivers and self._holder is not None and self._listen is not None:
            self._publish_held(self._listen, held=True)
        self._receivers = min(self._receivers, event.current_count)

    def _hear(self, page: Page, block: SoundBlock) -> None:
        budget = self._budgets.get(page)
        if budget is None:
            return
        if not budget.spend(block.samples.size / RATE, block.lost):
            self._cut.add(page)
            self._talk(page, Talk("off"))
        elif self._words.hear(page, block.samples):  # the sound is an example of a word
            if self._audio is not None:
                self._audio.restart()
        elif page is self._floor.talker and self._audio is not None:
            self._audio.publish(block.samples, block.lost)

    # --- messages to pages -------------------------------------------------------------------------------------

    def _watch(self, page: Page, *, watched: bool) -> None:
        if not watched:
            self._watchers.pop(page, None)
        elif page not in self._watchers:
            self._watchers[page] = None
        if self._watchers and not self._subscriptions:
            self._subscriptions = [
                self._node.create_subscription("std_msgs/msg/String", topic, partial(self._send_text, part), _DEPTH)
                for part, topic in _TOPICS.items()
            ]
            self._subscriptions.append(
                self._node.create_subscription("std_msgs/msg/Bool", _PROPOSE, self._handle_proposal, _DEPTH)
            )
            self._text_input = self._node.create_publisher("std_msgs/msg/String", _TEXT_INPUT, _DEPTH)
            self.context.graph_changes.watch(self._review)
        elif not self._watchers and self._subscriptions:
            self.context.graph_changes.unwatch(self._review)
            for subscription in self._subscriptions:
                self._node.destroy_subscription(subscription)
            self._subscriptions.clear()
            self._proposes = False
            if self._text_input is not None:
                self._node.destroy_publisher(self._text_input)
                self._text_input = None
        self._review()

    def _send_text(self, part: ConversationPart, message: Any) -> None:
        self._text_count += 1
        for page in self._watchers:
            page.send(ConversationText(self._text_count, part, message.data[:_LONGEST_TEXT]))

    def _handle_proposal(self, message: Any) -> None:
        self._proposes = message.data
        self._review()

    def _review(self) -> None:
        """Send the changed state to the pages that watch."""
        if not self._watchers:
            return
        graph = self._node.graph
        sound = graph.count_subscribers(f"{NAMESPACE}/audio_stamped") + graph.count_subscribers(f"{NAMESPACE}/audio")
        texts = graph.count_subscribers(_TEXT_INPUT)
        proposes = self._proposes and graph.count_publishers(_PROPOSE) > 0
        talker = self._floor.talker
        for page, sent in self._watchers.items():
            talking: Talking = "nobody" if talker is None else "you" if talker is page else "another"
            state = VoiceState(talking, sound, texts, page in self._cut, proposes)
            if state != sent:
                self._watchers[page] = state
                page.send(state)
