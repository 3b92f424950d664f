"""voice_commander of my_robot_voice: turns spoken commands into velocities, goals, service calls and messages.

An engine of `linkwright.speech` recognises the sound on ``audio/audio_stamped``, and the command file defines the
meaning of the words. Sound counts while ``voice/listen`` reports that a button is held, or always with
``open_listening``.
"""

from __future__ import annotations

import asyncio
from math import isfinite
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.translation import ENGLISH, language_of, localized
from linkwright.graph import LATCHED_QOS, Clock, ClockType, Graph, ParameterType, Publisher, Subscription
from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.endpoints.commander import Commander
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting
from linkwright.nodes.settings import bad_value, log_unknown, positive
from linkwright.nodes.velocity_topic import VelocityTopic
from linkwright.speech.commands.command_file import DEFAULT_FILE, read_command_file
from linkwright.speech.engine import EngineOptions, Heard, make_engine
from linkwright.speech.nodes.audio_messages import (
    AUDIO_DEPTH,
    AUDIO_INFO,
    AUDIO_STAMPED,
    AudioForm,
    AudioReader,
)
from linkwright.speech.nodes.conversation import Conversation
from linkwright.speech.nodes.driving import Driver, Ending
from linkwright.speech.nodes.listening import Listener
from linkwright.speech.nodes.presses import SAY_IT_AGAIN, Presses
from linkwright.speech.nodes.requests import Requests
from linkwright.speech.nodes.sound_gaps import SoundGaps

_DEPTH = 10
_LOOK_SECONDS = 0.5
_STRING = "std_msgs/msg/String"
_BOOL = "std_msgs/msg/Bool"
_TEXT_TOPICS = ("text", "partial_text", "command", "response")
_MOST_LOST = 0.15
"""Seconds of sound that may be missing in what is done. Of synthetic enrolled words with such holes and smaller ones
none was taken for another one (0 of 480); of those from which 0.25 s were cut 5 of 60 were.
"""
_NEARLY = 0.5
"""The part of the confidence asked for from which a result is worth telling. Noise has less."""


class VoiceCommander(SingleNode):
    """The running node.

    Parameters:

    - ``engine``: the engine; if empty, only texts are accepted.
    - ``language``, ``model``: the language and the model of the engine.
    - ``words_file``: the file of the engine ``enrolled``.
    - ``commands_file``: the command file.
    - ``confidence``: 0 to 1; less certain commands are not executed.
    - ``open_listening``: whether to listen without a held button.
    - ``speed`` in m/s, ``turn_speed`` in rad/s.
    - ``silence_timeout``: seconds of silence after which an endless drive stops.
    - ``confirmation_timeout``: seconds to wait for a confirmation.
    - ``stamped``: whether velocities are stamped; if not set, this follows the subscribers of ``cmd_vel``.
    - ``frame_id``: the frame of stamped velocities.

    A stop is executed immediately, even on a partial and uncertain result, while a button is held or the robot moves.

    Raises:
        LinkwrightError: VOICE301 to VOICE306, the command file is invalid; NODE433, a parameter has an invalid value.
    """

    DEFAULT_NAME = "voice_commander"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._listener: Listener | None = None
        self._held = False
        self._spoken = False
        self._stopped = False
        self._proposed = False
        with starting(self._node):
            self._start()

    def close(self) -> None:
        """Stop the robot, and close the node."""
        if self._listener is not None:
            self._listener.close()
        if self._conversation.is_busy:
            self._driver.stop()
        self._requests.close()
        self._topic.close()
        super().close()

    def _start(self) -> None:
        node = self._node
        engine: str = node.declare_parameter("engine", "enrolled").value
        language: str = node.declare_parameter("language", "en").value
        model: str = node.declare_parameter("model", "").value
        words: str = node.declare_parameter("words_file", "").value
        file: str = node.declare_parameter("commands_file", "").value
        self._confidence: float = node.declare_parameter("confidence", 0.5).value
        if not 0.0 <= self._confidence <= 1.0:
            raise bad_value("confidence", self._confidence, node.get_name())
        self._open: bool = node.declare_parameter("open_listening", False).value
        speed, turn_speed = self._positive("speed", 0.2), self._positive("turn_speed", 0.6)
        silence, patience = self._positive("silence_timeout", 10.0), self._positive("confirmation_timeout", 10.0)
        stamped: bool | None = node.declare_parameter("stamped", ParameterType.BOOL).value
        frame_id: str = node.declare_parameter("frame_id", "").value
        log_unknown(node)

        commands = read_command_file(Path(file) if file else DEFAULT_FILE)
        publishers: dict[str, Publisher[Any]] = {
            name: node.create_publisher(_STRING, f"voice/{name}", _DEPTH) for name in _TEXT_TOPICS
        }
        self._publish_text = {
            name: lambda text, to=publisher: to.publish(to.msg_type(data=text))
            for name, publisher in publishers.items()
        }
        self._topic = VelocityTopic(node, "cmd_vel", stamped, frame_id)
        self._driver = Driver(node, self._topic, speed, turn_speed, self._drive_ended)
        self._requests = Requests(node, self._goal_ended, self._publish_text["response"])
        self._conversation = Conversation(
            node,
            commands,
            language_of(language) or ENGLISH,
            self._driver,
            self._requests,
            patience,
            self._publish_text["command"],
            self._publish_text["response"],
        )
        self._commands = commands
        self._listen_to_texts()
        # Use the steady clock: simulated time may be paused, and a pause must not hold back the silence check.
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self._silence = node.create_timer(silence, self._silent, clock=clock, autostart=False)
        # Pages write enrolled words to the default file. A node that always listens ignores speech that is not a
        # command.
        self._presses = Presses(can_enrol=engine == "enrolled" and not words and not self._open)
        self._proposal: Publisher[Any] = node.create_publisher(_BOOL, "voice/propose_enrolling", _DEPTH)
        if engine:
            where = words if engine == "enrolled" and words else model
            # Enrolled words may be in any language.
            languages = [language, *commands.languages] if engine == "enrolled" else [language]
            phrases = tuple(dict.fromkeys(text for language in languages for text in commands.phrases(language)))
            given = EngineOptions(phrases, language, Path(where) if where else None)
            self._listen(lambda: make_engine(engine, given), clock)

    def _positive(self, name: str, default: float) -> float:
        value: float = self._node.declare_parameter(name, default).value
        if not isfinite(value):
            raise bad_value(name, value, self._node.get_name())
        return positive(self._node, name, value)

    def _listen_to_texts(self) -> None:
        commander = Commander(self._lost)
        callback = commander.tracking_callback(lambda message: self._execute(message.data, by_voice=False))
        commander.watch(self._node.create_subscription(_STRING, "voice/text_input", callback, _DEPTH))

    # --- listening -----------------------------------------------------------------------------------------------

    def _listen(self, make: Any, clock: Clock) -> None:
        node = self._node
        self._listener = Listener(node, make, self._handle, self._press_heard, self._warn, self._failed)
        self._reader = AudioReader()
        self._gaps = SoundGaps()
        node.create_subscription(AUDIO_INFO, "audio/audio_info", self._on_info, LATCHED_QOS)
        self._audio: Subscription[Any] = node.create_subscription(
            AUDIO_STAMPED, "audio/audio_stamped", self._on_audio, AUDIO_DEPTH
        )
        self._audio.watch_lost(lambda _: self._deaf())
        button: Subscription[Any] = node.create_subscription(
            _BOOL, "voice/listen", lambda message: self._on_listen(message.data), _DEPTH
        )
        button.watch_lost(lambda _: self._on_listen(False))
        node.create_timer(_LOOK_SECONDS, self._look, clock=clock)

    def _on_info(self, info: Any) -> None:
        try:
            form = AudioForm.of(info)
        except LinkwrightError as error:
            self._node.get_logger().error(error.diagnostics[0].message)
            return
        if form != self._reader.form:
            self._reader = AudioReader(form)

    def _on_audio(self, message: Any) -> None:
        if not (self._held or self._open) or self._listener is None:
            return
        samples = self._reader.read(message.audio.data)
        stamp = message.header.stamp
        missing = self._gaps.missing(stamp.nanoseconds, samples.size)
        if missing:
            self._listener.note_gap(missing)
            self._presses.note_gap()
            self._node.get_logger().warning(
                phrase("{seconds} s of sound were lost during transmission", seconds=f"{missing:.1f}"),
                throttle_duration_sec=5.0,
            )
        if not self._listener.hear(samples):
            self._presses.note_gap()
            self._node.get_logger().warning(
                phrase("this machine is too slow for the speech engine: sound is dropped"), throttle_duration_sec=5.0
            )

    def _on_listen(self, held: bool) -> None:
        if self._held and not held and self._listener is not None:
            self._listener.finish()
        if held:
            self._gaps.restart()  # the source does not publish while no button is held
        if held and not self._held:
            self._presses.begin()
            self._publish_proposal()
        self._stopped = False
        self._held = held

    def _handle(self, heard: Heard) -> None:
        if not heard.final:
            self._publish_text["partial_text"](heard.text)
            self._stop_early(heard.text)
            return
        self._publish_text["text"](heard.text)
        stopped, self._stopped = self._stopped, False
        # After a stop, only a command that contains the stop word is executed in this utterance: "go to the stop sign".
        if stopped and not (self._commands.is_stop(heard.text) and self._commands.is_other(heard.text)):
            return
        if self._is_done_or_answered(heard):
            self._presses.settle()
        else:
            self._presses.note_unknown(heard)

    def _is_done_or_answered(self, heard: Heard) -> bool:
        """Execute a recognised text, or ask to repeat it; return False if neither applies."""
        lost = 0.0 if self._listener is None else self._listener.lost_in(heard)
        is_certain = heard.confidence >= self._confidence
        if is_certain and lost <= _MOST_LOST and self._execute(heard.text, by_voice=True):
            return True
        if self._commands.is_stop(heard.text) and (self._held or self._conversation.is_busy):
            self._conversation.stop(heard.text)
        elif lost and (self._is_addressed or (heard.text and is_certain)):
            self._conversation.answer(SAY_IT_AGAIN)
        elif heard.text and not is_certain and self._is_addressed and heard.confidence >= _NEARLY * self._confidence:
            self._conversation.answer(phrase("I am not sure that I heard '{text}': please repeat", text=heard.text))
        else:
            return bool(heard.text) and is_certain  # speech was not understood, and this was answered
        return True

    def _press_heard(self) -> None:
        """Handle the end of a button press whose sound was processed."""
        answer = self._presses.end()
        self._publish_proposal()
        if answer is not None and not self._open:
            self._conversation.answer(answer)

    def _publish_proposal(self) -> None:
        """Publish whether enrolling is proposed, if this has changed."""
        if self._presses.proposes_enrolling != self._proposed:
            self._proposed = self._presses.proposes_enrolling
            self._proposal.publish(self._proposal.msg_type(data=self._proposed))

    @property
    def _is_addressed(self) -> bool:
        """Whether a result was addressed to the robot; results may arrive after the button was released."""
        return self._held or not self._open

    def _stop_early(self, text: str) -> None:
        """Stop on a partial result, unless the stop word belongs to another command."""
        if not self._commands.is_stop(text) or self._commands.is_other(text):
            return
        if self._conversation.is_busy or (self._held and not self._stopped):
            self._stopped = True
            self._presses.settle()
            self._conversation.stop(text)

    def _warn(self, problem: Diagnostic) -> None:
        logger = self._node.get_logger()
        logger.warning(localized(problem.message))
        if problem.hint:
            logger.warning(localized(problem.hint))

    def _failed(self, error: LinkwrightError) -> None:
        finding = error.diagnostics[0]
        logger = self._node.get_logger()
        logger.fatal(finding.message)
        if finding.hint:
            logger.fatal(finding.hint)
        self._conversation.stop()
        if not self.finished.done():
            self.finished.set_result(1)

    def _drive_ended(self, ending: Ending) -> None:
        self._conversation.drive_ended(ending)

    def _goal_ended(self, reached: bool, reason: str) -> None:
        self._conversation.goal_ended(reached, reason)

    # --- recognized text -----------------------------------------------------------------------------------------

    def _execute(self, text: str, *, by_voice: bool) -> bool:
        """Execute the command in a text; return whether it was understood."""
        if not by_voice:
            self._publish_text["text"](text)
        understood = self._conversation.handle(text)
        if understood:
            self._spoken = by_voice
            self._silence.reset()
        elif text and (self._is_addressed or not by_voice):
            self._conversation.answer(phrase("I did not understand '{text}'", text=text))
        return understood

    def _silent(self) -> None:
        self._silence.cancel()
        if self._driver.is_endless:
            self._conversation.rest(phrase("I hear nothing, so I stop"))

    def _look(self) -> None:
        """Stop when the audio source is lost while the robot executes its commands."""
        if self._spoken and self._driver.is_endless and not self._audio.get_publisher_count():
            self._deaf()

    def _deaf(self) -> None:
        if self._spoken and self._conversation.is_busy:
            self._conversation.stop()
            self._conversation.answer(phrase("the audio source stopped, so I stop"))

    def _lost(self, publisher: EndpointInfo) -> None:
        if not self._spoken and self._conversation.is_busy:
            self._conversation.stop()
            self._node.get_logger().warning(
                localized(
                    phrase("the publisher of commands on '{topic}' was lost, so the robot stops", topic=publisher.name)
                )
            )
