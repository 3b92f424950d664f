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
    amount,
    fill_template,
    format_value,
)
from linkwright.speech.commands.command_set import ANY, CommandSet, Understood, choose_text
from linkwright.speech.nodes.driving import Driver, Ending
from linkwright.speech.nodes.requests import Requests


class Conversation:
    """Executes commands and answers them.

    Args:
        node: the node.
        commands: the commands.
        language: the language of answers until the user speaks another language.
        driver: moves the robot.
        requests: calls services and actions of other nodes.
        patience: the timeout of a question, in s.
        report_command: called with each command that is executed: its intent, and ``slot=value`` for each filled slot,
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
        patience: float,
        report_command: Callable[[str], None],
        respond: Callable[[str], None],
    ) -> None:
        self._commands, self._language = commands, language
        self._driver, self._requests = driver, requests
        self._report_command, self._respond = report_command, respond
        self._asked: tuple[Understood, str] | None = None
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self._patience = node.create_timer(patience, self._unanswered, clock=clock, autostart=False)
        for command in commands.commands:
            requests.prepare(command.action)
            for publication in command.action.publishes if isinstance(command.action, Stop) else ():
                requests.prepare(publication)

    @property
    def is_busy(self) -> bool:
        """Whether there is an activity that a stop would end."""
        return self._driver.is_moving or self._requests.is_active

    def handle(self, text: str) -> bool:
        """Execute the command in a text, or ask for confirmation; return whether the text was understood."""
        answer = self._commands.answer(text) if self._asked is not None else None
        if self._asked is not None and answer is not None:
            understood, asked_for = self._asked
            self._forget()
            if answer:
                self._carry_out(understood, asked_for)
            else:
                self.answer(phrase("I will not do it"))
            return True
        found = self._commands.understand(text)
        if found is None:
            return False
        self._forget()
        self._answer_in(found.language)
        if found.command.question:
            self._asked = found, text
            self._respond(str(fill_template(choose_text(found.command.question, self._language), found.values)))
            self._patience.reset()
        else:
            self._carry_out(found, text)
        return True

    def stop(self, text: str = "") -> None:
        """Stop everything.

        Args:
            text: the spoken text to answer; empty if there was none.
        """
        self._forget()
        self._driver.stop()
        self._requests.cancel_all()
        self._notify_others()
        if text:
            stop = self._commands.stops[0]
            found = self._commands.understand(text)
            if found is not None:
                self._answer_in(found.language)
            self._report_command(stop.intent)
            self._respond(choose_text(stop.response, self._language) or text)

    def rest(self, why: Phrase) -> None:
        """Stop driving because the source of the commands is lost, and say why."""
        self._driver.stop()
        self.answer(why)

    def answer(self, text: Phrase) -> None:
        """Answer in the language that the user spoke last."""
        self._respond(localized(text, language_of(self._language) or ENGLISH))

    def drive_ended(self, ending: Ending) -> None:
        """Handle the end of a drive, which has finished or timed out."""
        if ending == "stuck":
            self.answer(phrase("I am stuck, so I stop"))

    def goal_ended(self, reached: bool, reason: str) -> None:
        """Handle the end of a goal, which was reached or has failed."""
        if reached:
            self.answer(phrase("I am done"))
        elif reason:
            self.answer(phrase("I could not do it: {reason}", reason=reason))
        else:
            self.answer(phrase("I could not do it"))

    def _answer_in(self, language: str) -> None:
        """Answer in a given language."""
        if language != ANY:
            self._language = language

    def _carry_out(self, found: Understood, text: str) -> None:
        if isinstance(found.command.action, Stop):
            self.stop(text)
            return
        values = found.values
        self._report_command(
            " ".join([found.command.intent, *(f"{name}={format_value(value)}" for name, value in values.items())])
        )
        problem = self._done(found)
        if problem is not None:
            self.answer(problem)
        else:
            self._respond(str(fill_template(choose_text(found.command.response, self._language) or text, values)))

    def _done(self, found: Understood) -> Phrase | None:
        """Execute an action; return None, or the reason why it cannot be executed."""
        action, values = found.command.action, found.values
        if found.command.moves:
            self._make_way(found)
        if isinstance(action, Drive):
            self._driver.begin(action, values)
        elif isinstance(action, ScaleSpeed):
            self._driver.scale(action.factor)
        elif isinstance(action, SetSpeed):
            self._driver.set_speed(amount(action.speed, values) or 0.0)
        elif isinstance(action, Publish):
            self._requests.publish(action, values)
        elif isinstance(action, Launch):
            self._requests.launch(action, values)
        elif isinstance(action, GoTo):
            name = str(values[action.place.name]) if isinstance(action.place, Slot) else action.place
            if not self._requests.send_pose(action.action, self._commands.places[name]):
                return phrase("I cannot: no node serves '{name}'", name=action.action)
        elif isinstance(action, SendGoal):
            if not self._requests.send_goal(action, values):
                return phrase("I cannot: no node serves '{name}'", name=action.action)
        elif isinstance(action, CallService) and not self._requests.call(action, values):
            return phrase("I cannot: no node serves '{name}'", name=action.name)
        return None

    def _make_way(self, found: Understood) -> None:
        """End the motion that another one replaces, and notify other nodes."""
        action = found.command.action
        self._requests.leave(but=action.action if isinstance(action, GoTo) else "")
        if not isinstance(action, Drive) and self._driver.is_moving:
            self._driver.stop()
        if not isinstance(action, Publish):  # the subscriber of the message may start a motion
            self._notify_others()

    def _notify_others(self) -> None:
        for stop in self._commands.stops:
            for publication in stop.action.publishes if isinstance(stop.action, Stop) else ():
                self._requests.publish(publication, {})

    def _forget(self) -> None:
        self._asked = None
        self._patience.cancel()

    def _unanswered(self) -> None:
        self._forget()
        self.answer(phrase("I received no answer, so I will not do it"))
