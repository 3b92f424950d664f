"""voice_commander of my_robot_voice: turns spoken commands into velocities and requests.

Requests are action goals, service calls and messages.

An engine of `linkwright.speech` recognizes the sound on ``audio/audio_stamped``, and the command file defines the
meaning of the words. The node listens while ``voice/listen`` reports that a button is held, or always with
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
from linkwright.graph.endpoints.command_guard import CommandGuard
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, invalid_value_error, log_unknown_parameters
from linkwright.nodes.velocity_topic import VelocityTopic
from linkwright.speech.commands.command_file import DEFAULT_FILE, read_command_file
from linkwright.speech.engine import EngineOptions, Heard, make_engine
from linkwright.speech.nodes.audio_messages import (
    AUDIO_INFO_TYPE,
    AUDIO_QUEUE_DEPTH,
    AUDIO_STAMPED_TYPE,
    AudioFormat,
    AudioReader,
)
from linkwright.speech.nodes.conversation import Conversation
from linkwright.speech.nodes.driver import Driver, Ending
from linkwright.speech.nodes.listener import Listener
from linkwright.speech.nodes.presses import PLEASE_REPEAT, ButtonPresses
from linkwright.speech.nodes.requests import Requests
from linkwright.speech.nodes.sound_gaps import SoundGaps

_QUEUE_DEPTH = 10
_SOURCE_CHECK_S = 0.5
_STRING = "std_msgs/msg/String"
_BOOL = "std_msgs/msg/Bool"
_TEXT_TOPICS = ("text", "partial_text", "command", "response")
_MAX_MISSING_S = 0.15
"""The maximum of missing sound, in seconds, in a command that is executed.

Of 480 synthetic enrolled words with gaps of up to this length, none was taken for another word. With gaps of 0.25 s,
5 of 60 were.
"""
_REPEAT_FRACTION = 0.5
"""The fraction of the required confidence above which the node asks to repeat a command. Noise has less."""


class VoiceCommander(SingleNode):
    """The node that recognizes spoken commands, and executes them.

    Parameters:

    - ``engine``: the engine; if empty, only texts are accepted.
    - ``language``, ``model``: the language and the model of the engine.
    - ``words_file``: the file of the engine ``enrolled``.
    - ``commands_file``: the command file.
    - ``confidence``: 0 to 1; less certain commands are not executed.
    - ``open_listening``: whether to listen even if no button is held.
    - ``speed`` in m/s, ``turn_speed`` in rad/s.
    - ``silence_timeout``: the seconds without a command after which a drive without a limit stops.
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
        self._is_button_held = False
        self._is_voice_command = False
        self._has_stopped_early = False
        self._proposed = False
        with handle_start_errors(self._node):
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
        self._min_confidence: float = node.declare_parameter("confidence", 0.5).value
        if not 0.0 <= self._min_confidence <= 1.0:
            raise invalid_value_error("confidence", self._min_confidence, node.get_name())
        self._create_interfaces: bool = node.declare_parameter("open_listening", False).value
        speed, turn_speed = self._declare_positive("speed", 0.2), self._declare_positive("turn_speed", 0.6)
        silence_timeout, confirmation_timeout = (
            self._declare_positive("silence_timeout", 10.0),
            self._declare_positive("confirmation_timeout", 10.0),
        )
        stamped: bool | None = node.declare_parameter("stamped", ParameterType.BOOL).value
        frame_id: str = node.declare_parameter("frame_id", "").value
        log_unknown_parameters(node)

        commands = read_command_file(Path(file) if file else DEFAULT_FILE)
        publishers: dict[str, Publisher[Any]] = {
            name: node.create_publisher(_STRING, f"voice/{name}", _QUEUE_DEPTH) for name in _TEXT_TOPICS
        }
        self._publish_text = {
            name: lambda text, target=publisher: target.publish(target.msg_type(data=text))
            for name, publisher in publishers.items()
        }
        self._topic = VelocityTopic(node, "cmd_vel", stamped, frame_id)
        self._driver = Driver(node, self._topic, speed, turn_speed, self._on_drive_end)
        self._requests = Requests(node, self._on_goal_end, self._publish_text["response"])
        self._conversation = Conversation(
            node,
            commands,
            language_of(language) or ENGLISH,
            self._driver,
            self._requests,
            confirmation_timeout,
            self._publish_text["command"],
            self._publish_text["response"],
        )
        self._commands = commands
        self._subscribe_to_texts()
        # Use the steady clock: a pause of simulated time must not delay the silence check.
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self._silence_timer = node.create_timer(silence_timeout, self._on_silence, clock=clock, autostart=False)
        # Pages write enrolled words to the default file only. A node that always listens does not answer speech that
        # is not a command.
        self._presses = ButtonPresses(can_enroll=engine == "enrolled" and not words and not self._create_interfaces)
        self._proposal_publisher: Publisher[Any] = node.create_publisher(_BOOL, "voice/propose_enrolling", _QUEUE_DEPTH)
        if engine:
            model_path = words if engine == "enrolled" and words else model
            # Enrolled words may be in any language.
            languages = [language, *commands.languages] if engine == "enrolled" else [language]
            phrases = tuple(dict.fromkeys(text for language in languages for text in commands.phrases(language)))
            engine_options = EngineOptions(phrases, language, Path(model_path) if model_path else None)
            self._start_listening(lambda: make_engine(engine, engine_options), clock)

    def _declare_positive(self, name: str, default: float) -> float:
        value: float = self._node.declare_parameter(name, default).value
        if not isfinite(value):
            raise invalid_value_error(name, value, self._node.get_name())
        return check_positive(self._node, name, value)

    def _subscribe_to_texts(self) -> None:
        command_guard = CommandGuard(self._on_commander_lost)
        callback = command_guard.tracking_callback(lambda message: self._execute(message.data, by_voice=False))
        command_guard.watch(self._node.create_subscription(_STRING, "voice/text_input", callback, _QUEUE_DEPTH))

    # --- listening -----------------------------------------------------------------------------------------------

    def _start_listening(self, make_engine: Any, clock: Clock) -> None:
        node = self._node
        self._listener = Listener(
            node, make_engine, self._handle_result, self._end_press, self._log_problem, self._fail
        )
        self._reader = AudioReader()
        self._gaps = SoundGaps()
        node.create_subscription(AUDIO_INFO_TYPE, "audio/audio_info", self._on_info, LATCHED_QOS)
        self._audio_subscription: Subscription[Any] = node.create_subscription(
            AUDIO_STAMPED_TYPE, "audio/audio_stamped", self._on_audio, AUDIO_QUEUE_DEPTH
        )
        self._audio_subscription.watch_lost(lambda _: self._stop_without_sound())
        button: Subscription[Any] = node.create_subscription(
            _BOOL, "voice/listen", lambda message: self._on_listen(message.data), _QUEUE_DEPTH
        )
        button.watch_lost(lambda _: self._on_listen(False))
        node.create_timer(_SOURCE_CHECK_S, self._check_audio_source, clock=clock)

    def _on_info(self, info: Any) -> None:
        try:
            audio_format = AudioFormat.of(info)
        except LinkwrightError as error:
            self._node.get_logger().error(error.diagnostics[0].message)
            return
        if audio_format != self._reader.audio_format:
            self._reader = AudioReader(audio_format)

    def _on_audio(self, message: Any) -> None:
        if not (self._is_button_held or self._create_interfaces) or self._listener is None:
            return
        samples = self._reader.read(message.audio.data)
        stamp = message.header.stamp
        missing = self._gaps.measure_gap(stamp.nanoseconds, samples.size)
        if missing:
            self._listener.record_gap(missing)
            self._presses.record_gap()
            self._node.get_logger().warning(
                phrase("{seconds} s of sound were lost in transmission", seconds=f"{missing:.1f}"),
                throttle_duration_sec=5.0,
            )
        if not self._listener.add_sound(samples):
            self._presses.record_gap()
            self._node.get_logger().warning(
                phrase("this machine is too slow for the speech engine, so sound is dropped"), throttle_duration_sec=5.0
            )

    def _on_listen(self, is_held: bool) -> None:
        if self._is_button_held and not is_held and self._listener is not None:
            self._listener.finish()
        if is_held:
            self._gaps.restart()  # there is no sound while no button is held
        if is_held and not self._is_button_held:
            self._presses.begin()
            self._publish_proposal()
        self._has_stopped_early = False
        self._is_button_held = is_held

    def _handle_result(self, result: Heard) -> None:
        if not result.final:
            self._publish_text["partial_text"](result.text)
            self._stop_early(result.text)
            return
        self._publish_text["text"](result.text)
        has_stopped, self._has_stopped_early = self._has_stopped_early, False
        # After a stop, this utterance can only execute a command with the stop word in it, as "go to the stop sign".
        if has_stopped and not (self._commands.is_stop(result.text) and self._commands.is_other_command(result.text)):
            return
        if self._handle_final_result(result):
            self._presses.record_command()
        else:
            self._presses.record_unknown_speech(result)

    def _handle_final_result(self, result: Heard) -> bool:
        """Execute a recognized text, or ask the user to repeat it.

        Returns:
            False if neither was done.
        """
        missing = 0.0 if self._listener is None else self._listener.missing_seconds(result)
        is_certain = result.confidence >= self._min_confidence
        if is_certain and missing <= _MAX_MISSING_S and self._execute(result.text, by_voice=True):
            return True
        if self._commands.is_stop(result.text) and (self._is_button_held or self._conversation.is_busy):
            self._conversation.stop(result.text)
        elif missing and (self._is_addressed or (result.text and is_certain)):
            self._conversation.answer(PLEASE_REPEAT)
        elif (
            result.text
            and not is_certain
            and self._is_addressed
            and result.confidence >= _REPEAT_FRACTION * self._min_confidence
        ):
            self._conversation.answer(
                phrase("I am not sure that I heard '{phrase}', please repeat", phrase=result.text)
            )
        else:
            return bool(result.text) and is_certain  # speech was not understood, and this was answered
        return True

    def _end_press(self) -> None:
        """Answer a button press after its sound was processed."""
        answer = self._presses.end()
        self._publish_proposal()
        if answer is not None and not self._create_interfaces:
            self._conversation.answer(answer)

    def _publish_proposal(self) -> None:
        """Publish whether enrolling is proposed, if it has changed."""
        if self._presses.proposes_enrolling != self._proposed:
            self._proposed = self._presses.proposes_enrolling
            self._proposal_publisher.publish(self._proposal_publisher.msg_type(data=self._proposed))

    @property
    def _is_addressed(self) -> bool:
        """Whether a result is meant for the robot, even if it arrives after the button's release."""
        return self._is_button_held or not self._create_interfaces

    def _stop_early(self, text: str) -> None:
        """Stop on a partial result, unless the stop word is part of another command."""
        if not self._commands.is_stop(text) or self._commands.is_other_command(text):
            return
        if self._conversation.is_busy or (self._is_button_held and not self._has_stopped_early):
            self._has_stopped_early = True
            self._presses.record_command()
            self._conversation.stop(text)

    def _log_problem(self, problem: Diagnostic) -> None:
        logger = self._node.get_logger()
        logger.warning(localized(problem.message))
        if problem.hint:
            logger.warning(localized(problem.hint))

    def _fail(self, error: LinkwrightError) -> None:
        diagnostic = error.diagnostics[0]
        logger = self._node.get_logger()
        logger.fatal(diagnostic.message)
        if diagnostic.hint:
            logger.fatal(diagnostic.hint)
        self._conversation.stop()
        if not self.finished.done():
            self.finished.set_result(1)

    def _on_drive_end(self, ending: Ending) -> None:
        self._conversation.on_drive_end(ending)

    def _on_goal_end(self, is_reached: bool, reason: str) -> None:
        self._conversation.on_goal_end(is_reached, reason)

    # --- recognized text -----------------------------------------------------------------------------------------

    def _execute(self, text: str, *, by_voice: bool) -> bool:
        """Execute the command in a text, and return whether it was understood."""
        if not by_voice:
            self._publish_text["text"](text)
        understood = self._conversation.handle(text)
        if understood:
            self._is_voice_command = by_voice
            self._silence_timer.reset()
        elif text and (self._is_addressed or not by_voice):
            self._conversation.answer(phrase("I did not understand '{text}'", text=text))
        return understood

    def _on_silence(self) -> None:
        self._silence_timer.cancel()
        if self._driver.is_endless:
            self._conversation.stop_driving(phrase("I hear nothing, so I am stopping"))

    def _check_audio_source(self) -> None:
        """Stop an endless drive that was commanded by voice if the audio source is lost."""
        if self._is_voice_command and self._driver.is_endless and not self._audio_subscription.get_publisher_count():
            self._stop_without_sound()

    def _stop_without_sound(self) -> None:
        if self._is_voice_command and self._conversation.is_busy:
            self._conversation.stop()
            self._conversation.answer(phrase("the audio source is gone, so I am stopping"))

    def _on_commander_lost(self, publisher: EndpointInfo) -> None:
        if not self._is_voice_command and self._conversation.is_busy:
            self._conversation.stop()
            self._node.get_logger().warning(
                localized(
                    phrase("the publisher of commands on '{topic}' was lost, so the robot stops", topic=publisher.name)
                )
            )
