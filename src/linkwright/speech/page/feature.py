"""The page feature for voice: microphones, recognized commands and answers."""

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
_PROPOSAL_TOPIC = "/voice/propose_enrolling"
_LISTEN_TOPIC = "/voice/listen"
_TEXT_INPUT_TOPIC = "/voice/text_input"
_QUEUE_DEPTH = 10
_MAX_TEXT_LENGTH = 500
"""The maximum length of a text in characters. Longer texts are truncated."""


class VoiceFeature(PageFeature):
    """The feature that publishes the sound of one page at a time, and sends results to pages.

    The results are recognized commands and answers. The sound topics exist while any page has its microphone open, and
    the other topics while any page watches.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._node = self.context.node
        self._watchers: dict[Page, VoiceState | None] = {}
        """The last state that was sent to each watching page."""
        self._subscriptions: list[Subscription[Any]] = []
        self._text_input: Publisher[Any] | None = None
        self._floor = Floor()
        self._budgets: dict[Page, SoundBudget] = {}
        self._muted_pages: set[Page] = set()
        self._audio_topics: AudioTopics | None = None
        self._listen_publisher: Publisher[Any] | None = None
        self._holder: Page | None = None
        self._informed_subscribers = 0
        """The number of subscribers that have received the state of the button."""
        self._text_count = 0
        self._is_enrolling_proposed = False
        self._word_book = WordBook()

    def opening_messages(self) -> list[ServerMessage]:
        """Return a message that states whether a node executes commands.

        Other nodes, such as an object seeker, may answer as well.
        """
        return [VoiceNode(self._node.count_publishers(_TOPICS["command"]) > 0)]

    def receive(self, page: Page, message: Any) -> None:
        """Handle a page's sound, text, microphone mode, or request to start or stop watching."""
        if isinstance(message, SoundBlock):
            self._receive_sound(page, message)
        elif isinstance(message, Talk):
            self._muted_pages.discard(page)
            self._set_mode(page, message)
        elif isinstance(message, WatchVoice):
            self._watch(page, watched=message.watched)
        elif not isinstance(message, SayCommand):
            self._word_book.receive(page, message)
        elif self._text_input is not None:
            self._text_input.publish(self._text_input.msg_type(data=message.text[:_MAX_TEXT_LENGTH]))

    def remove_page(self, page: Page) -> None:
        """End the microphone mode, the recording and the watching of a page."""
        self._muted_pages.discard(page)
        self._word_book.remove_page(page)
        self._set_mode(page, Talk("off"))
        self._watch(page, watched=False)

    def close(self) -> None:
        """Treat all pages as closed, so that the publishers and subscriptions are destroyed."""
        for page in {*self._watchers, *self._budgets}:
            self.remove_page(page)

    # --- sound -------------------------------------------------------------------------------------------------

    def _set_mode(self, page: Page, message: Talk) -> None:
        self._floor.set(page, message.mode)
        if message.mode == "off":
            self._budgets.pop(page, None)
        elif page not in self._budgets:
            self._budgets[page] = SoundBudget(asyncio.get_running_loop().time)
        if self._floor and self._audio_topics is None:
            self._audio_topics = AudioTopics(self._node)
            self._listen_publisher = self._node.create_publisher(
                "std_msgs/msg/Bool",
                _LISTEN_TOPIC,
                _QUEUE_DEPTH,
                event_callbacks=PublisherEventCallbacks(matched=self._on_listeners_changed),
            )
        if self._audio_topics is not None:
            self._audio_topics.restart()
        self._update_button()
        if not self._floor and self._audio_topics is not None:
            self._audio_topics.close()
            self._audio_topics = None
            if self._listen_publisher is not None:
                self._node.destroy_publisher(self._listen_publisher)
                self._listen_publisher = None
        self._send_state()

    def _update_button(self) -> None:
        """Publish whether a button is held.

        If another page takes over, publish a release and a new press.
        """
        holder = self._floor.holder
        if holder is self._holder or self._listen_publisher is None:
            return
        if self._holder is not None:
            self._publish_button(self._listen_publisher, is_held=False)
        if holder is not None:
            self._publish_button(self._listen_publisher, is_held=True)
        self._holder = holder

    def _publish_button(self, publisher: Publisher[Any], *, is_held: bool) -> None:
        self._informed_subscribers = publisher.get_subscription_count()
        publisher.publish(publisher.msg_type(data=is_held))

    def _on_listeners_changed(self, event: QoSPublisherMatchedInfo) -> None:
        """Publish the button state again for a subscriber that appears while the button is held.

        Other processes match with some delay. The topic is not latched, because other publishers on it do not latch it
        either.
        """
        if (
            event.current_count > self._informed_subscribers
            and self._holder is not None
            and self._listen_publisher is not None
        ):
            self._publish_button(self._listen_publisher, is_held=True)
        self._informed_subscribers = min(self._informed_subscribers, event.current_count)

    def _receive_sound(self, page: Page, block: SoundBlock) -> None:
        budget = self._budgets.get(page)
        if budget is None:
            return
        if not budget.spend(block.samples.size / RATE, block.lost):
            self._muted_pages.add(page)
            self._set_mode(page, Talk("off"))
        elif self._word_book.record_sound(page, block.samples):  # the sound is an example of a word
            if self._audio_topics is not None:
                self._audio_topics.restart()
        elif page is self._floor.talker and self._audio_topics is not None:
            self._audio_topics.publish(block.samples, block.lost)

    # --- messages to pages -------------------------------------------------------------------------------------

    def _watch(self, page: Page, *, watched: bool) -> None:
        if not watched:
            self._watchers.pop(page, None)
        elif page not in self._watchers:
            self._watchers[page] = None
        if self._watchers and not self._subscriptions:
            self._subscriptions = [
                self._node.create_subscription(
                    "std_msgs/msg/String", topic, partial(self._send_text, part), _QUEUE_DEPTH
                )
                for part, topic in _TOPICS.items()
            ]
            self._subscriptions.append(
                self._node.create_subscription(
                    "std_msgs/msg/Bool", _PROPOSAL_TOPIC, self._handle_proposal, _QUEUE_DEPTH
                )
            )
            self._text_input = self._node.create_publisher("std_msgs/msg/String", _TEXT_INPUT_TOPIC, _QUEUE_DEPTH)
            self.context.graph_changes.watch(self._send_state)
        elif not self._watchers and self._subscriptions:
            self.context.graph_changes.unwatch(self._send_state)
            for subscription in self._subscriptions:
                self._node.destroy_subscription(subscription)
            self._subscriptions.clear()
            self._is_enrolling_proposed = False
            if self._text_input is not None:
                self._node.destroy_publisher(self._text_input)
                self._text_input = None
        self._send_state()

    def _send_text(self, part: ConversationPart, message: Any) -> None:
        self._text_count += 1
        for page in self._watchers:
            page.send(ConversationText(self._text_count, part, message.data[:_MAX_TEXT_LENGTH]))

    def _handle_proposal(self, message: Any) -> None:
        self._is_enrolling_proposed = message.data
        self._send_state()

    def _send_state(self) -> None:
        """Send the state to each watching page if it has changed."""
        if not self._watchers:
            return
        graph = self._node.graph
        sound_subscribers = graph.count_subscribers(f"{NAMESPACE}/audio_stamped") + graph.count_subscribers(
            f"{NAMESPACE}/audio"
        )
        text_subscribers = graph.count_subscribers(_TEXT_INPUT_TOPIC)
        proposes = self._is_enrolling_proposed and graph.count_publishers(_PROPOSAL_TOPIC) > 0
        talker = self._floor.talker
        for page, sent_state in self._watchers.items():
            talking: Talking = "nobody" if talker is None else "you" if talker is page else "another"
            state = VoiceState(talking, sound_subscribers, text_subscribers, page in self._muted_pages, proposes)
            if state != sent_state:
                self._watchers[page] = state
                page.send(state)
