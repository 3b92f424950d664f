"""The dialogue: understand commands, ask for confirmation, execute them, and answer."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.diagnostics import Phrase, phrase
from linkwright.diagnostics.translation import ENGLISH, language_of, localized
from linkwright.graph import Clock, ClockType, Node
from linkwright.speech.commands.actions import (
    CallService,
    Drive,
    GoTo,
    Launch,
    Publish,
    ScaleSpeed,
    SendGoal,
    SetSpeed,
    Slot,
    Stop,
    fill_template,
    format_value,
    resolve_amount,
)
from linkwright.speech.commands.command_set import ANY, CommandSet, Match, choose_text
from linkwright.speech.nodes.driver import Driver, Ending
from linkwright.speech.nodes.requests import Requests


class Conversation:
    """The dialogue with the user, which executes commands and answers.

    Args:
        node: the node that owns the timer of questions.
        commands: the commands of the robot.
        language: the language of answers, until the user speaks another one.
        driver: moves the robot.
        requests: calls services and actions of other nodes.
        confirmation_timeout: the timeout for the answer to a question, in s.
        report_command: called with each executed command: its intent, and ``slot=value`` for each filled slot,
            in m, rad, s and m/s.
        respond: called with each answer of the robot.
    """

    def __init__(
        self,
        node: Node,
        commands: CommandSet,
        language: str,
        driver: Driver,
        requests: Requests,
        confirmation_timeout: float,
        report_command: Callable[[str], None],
        respond: Callable[[str], None],
    ) -> None:
        self._commands, self._language = commands, language
        self._driver, self._requests = driver, requests
        self._report_command, self._respond = report_command, respond
        self._pending: tuple[Match, str] | None = None
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self._question_timer = node.create_timer(
            confirmation_timeout, self._on_question_timeout, clock=clock, autostart=False
        )
        for command in commands.commands:
            requests.prepare(command.action)
            for publication in command.action.publishes if isinstance(command.action, Stop) else ():
                requests.prepare(publication)

    @property
    def is_busy(self) -> bool:
        """Whether the robot moves, or a request is active, so that a stop would end something."""
        return self._driver.is_moving or self._requests.is_active

    def handle(self, text: str) -> bool:
        """Execute the command in a text, or ask for confirmation.

        Returns:
            Whether the text was understood.
        """
        answer = self._commands.parse_answer(text) if self._pending is not None else None
        if self._pending is not None and answer is not None:
            confirmed, spoken_text = self._pending
            self._drop_question()
            if answer:
                self._execute_and_respond(confirmed, spoken_text)
            else:
                self.answer(phrase("I will not do it"))
            return True
        match = self._commands.match_command(text)
        if match is None:
            return False
        self._drop_question()
        self._set_language(match.language)
        if match.command.question:
            self._pending = match, text
            self._respond(str(fill_template(choose_text(match.command.question, self._language), match.values)))
            self._question_timer.reset()
        else:
            self._execute_and_respond(match, text)
        return True

    def stop(self, text: str = "") -> None:
        """Stop the robot, cancel all requests, and notify other nodes.

        Args:
            text: the text that was understood as a stop, to be answered; empty for no answer.
        """
        self._drop_question()
        self._driver.stop()
        self._requests.cancel_all()
        self._notify_others()
        if text:
            stop = self._commands.stop_commands[0]
            match = self._commands.match_command(text)
            if match is not None:
                self._set_language(match.language)
            self._report_command(stop.intent)
            self._respond(choose_text(stop.response, self._language) or text)

    def stop_driving(self, reason: Phrase) -> None:
        """Stop driving, and answer with the reason."""
        self._driver.stop()
        self.answer(reason)

    def answer(self, text: Phrase) -> None:
        """Answer in the language that the user spoke last."""
        self._respond(localized(text, language_of(self._language) or ENGLISH))

    def on_drive_end(self, ending: Ending) -> None:
        """Answer the user if a drive has ended because the robot is stuck."""
        if ending == "stuck":
            self.answer(phrase("I am stuck, so I am stopping"))

    def on_goal_end(self, is_reached: bool, reason: str) -> None:
        """Report to the user whether a goal was reached, or why it failed."""
        if is_reached:
            self.answer(phrase("I am done"))
        elif reason:
            self.answer(phrase("I could not do it: {reason}", reason=reason))
        else:
            self.answer(phrase("I could not do it"))

    def _set_language(self, language: str) -> None:
        """Use a language for further answers, unless the phrase is valid in all languages."""
        if language != ANY:
            self._language = language

    def _execute_and_respond(self, match: Match, text: str) -> None:
        if isinstance(match.command.action, Stop):
            self.stop(text)
            return
        values = match.values
        self._report_command(
            " ".join([match.command.intent, *(f"{name}={format_value(value)}" for name, value in values.items())])
        )
        problem = self._execute(match)
        if problem is not None:
            self.answer(problem)
        else:
            self._respond(str(fill_template(choose_text(match.command.response, self._language) or text, values)))

    def _execute(self, match: Match) -> Phrase | None:
        """Execute an action, and return the reason if it cannot be executed, or None."""
        action, values = match.command.action, match.values
        if match.command.is_motion:
            self._end_other_motion(match)
        if isinstance(action, Drive):
            self._driver.begin(action, values)
        elif isinstance(action, ScaleSpeed):
            self._driver.scale_speed(action.factor)
        elif isinstance(action, SetSpeed):
            self._driver.set_speed(resolve_amount(action.speed, values) or 0.0)
        elif isinstance(action, Publish):
            self._requests.publish(action, values)
        elif isinstance(action, Launch):
            self._requests.launch(action, values)
        elif isinstance(action, GoTo):
            name = str(values[action.place.name]) if isinstance(action.place, Slot) else action.place
            if not self._requests.send_pose(action.action, self._commands.places[name]):
                return phrase("I cannot do it: no node serves '{name}'", name=action.action)
        elif isinstance(action, SendGoal):
            if not self._requests.send_goal(action, values):
                return phrase("I cannot do it: no node serves '{name}'", name=action.action)
        elif isinstance(action, CallService) and not self._requests.call(action, values):
            return phrase("I cannot do it: no node serves '{name}'", name=action.name)
        return None

    def _end_other_motion(self, match: Match) -> None:
        """End the motion that a command replaces, and notify other nodes."""
        action = match.command.action
        self._requests.cancel(except_action=action.action if isinstance(action, GoTo) else "")
        if not isinstance(action, Drive) and self._driver.is_moving:
            self._driver.stop()
        if not isinstance(action, Publish):  # the subscriber of this message may start a motion itself
            self._notify_others()

    def _notify_others(self) -> None:
        for stop in self._commands.stop_commands:
            for publication in stop.action.publishes if isinstance(stop.action, Stop) else ():
                self._requests.publish(publication, {})

    def _drop_question(self) -> None:
        self._pending = None
        self._question_timer.cancel()

    def _on_question_timeout(self) -> None:
        self._drop_question()
        self.answer(phrase("I received no answer, so I will not do it"))
