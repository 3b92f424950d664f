"""Single event handlers, constructed as in users' programs and in the tests of ROS."""

from __future__ import annotations

from unittest.mock import Mock, NonCallableMock

import pytest
from launch.actions import ExecuteProcess, LogInfo
from launch.event_handler import BaseEventHandler, EventHandler
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown
from launch.events import ExecutionComplete
from launch.events.process import ProcessExited, ProcessIO, ProcessStarted

from launch import Action, LaunchContext

PROCESS_FIELDS = {"name": "p", "cmd": ["ls"], "cwd": None, "env": None, "pid": 1}


def make_exit_event(action: object) -> ProcessExited:
    return ProcessExited(action=action, returncode=0, **PROCESS_FIELDS)  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", [OnProcessExit, OnProcessStart, OnProcessIO])
def test_target_action_must_be_a_process(kind: type) -> None:
    words = {"on_exit": LogInfo(msg="")} if kind is OnProcessExit else {}
    words = {"on_start": LogInfo(msg="")} if kind is OnProcessStart else words
    with pytest.raises(TypeError):
        kind(target_action=LogInfo(msg=""), **words)
    with pytest.raises(TypeError):
        kind(target_action=NonCallableMock(), **words)


def test_handler_matches_event_type_and_target() -> None:
    process = NonCallableMock(spec=ExecuteProcess)
    handler = OnProcessExit(target_action=process, on_exit=Mock())
    assert handler.matches(make_exit_event(process))
    assert not handler.matches(make_exit_event(NonCallableMock(spec=ExecuteProcess)))
    assert not handler.matches(ProcessStarted(action=process, **PROCESS_FIELDS))  # type: ignore[arg-type]
    by_function = OnProcessExit(target_action=lambda action: action is process, on_exit=Mock())
    assert by_function.matches(make_exit_event(process))
    log_action = LogInfo(msg="")
    handler_of_action = OnExecutionComplete(target_action=log_action, on_completion=lambda *_: None)
    assert handler_of_action.matches(ExecutionComplete(action=log_action))
    assert not handler_of_action.matches(ExecutionComplete(action=LogInfo(msg="")))


def test_functions_and_actions_are_handled() -> None:
    context = Mock(spec=LaunchContext)
    function = Mock()
    event = make_exit_event(None)
    OnProcessExit(on_exit=function).handle(event, context)
    function.assert_called_once_with(event, context)
    context.extend_locals.assert_called_once_with({"event": event})
    context.unregister_event_handler.assert_not_called()
    action = NonCallableMock(spec=Action)
    assert OnProcessExit(on_exit=action).handle(event, context) == [action]
    assert OnProcessExit(on_exit=[action, action]).handle(event, context) == [action, action]
    with pytest.raises(TypeError):
        OnProcessExit(on_exit="no action")  # type: ignore[arg-type]


def test_handle_once_unregisters_handler() -> None:
    context = Mock(spec=LaunchContext)
    handler = OnShutdown(on_shutdown=Mock(), handle_once=True)
    handler.handle(make_exit_event(None), context)
    context.unregister_event_handler.assert_called_once_with(handler)


@pytest.mark.parametrize(("number", "name"), [(0, "on_stdin"), (1, "on_stdout"), (2, "on_stderr")])
def test_process_io_is_dispatched_by_stream(number: int, name: str) -> None:
    functions = {name: Mock() for name in ("on_stdin", "on_stdout", "on_stderr")}
    event = ProcessIO(action=None, text=b"x", fd=number, **PROCESS_FIELDS)  # type: ignore[arg-type]
    handler = OnProcessIO(**functions)
    assert handler.matches(event)
    handler.handle(event, Mock(spec=LaunchContext))
    functions.pop(name).assert_called_once_with(event)
    for function in functions.values():
        function.assert_not_called()


def test_custom_handler_runs_in_plain_context() -> None:
    class Mine(BaseEventHandler):
        def handle(self, event: object, context: LaunchContext) -> object:
            super().handle(event, context)
            return "mine"

    context = LaunchContext()
    handler = Mine(matcher=lambda event: True, handle_once=True)
    context.register_event_handler(handler)
    last = EventHandler(matcher=lambda event: event == 2)
    context.register_event_handler(last, append=True)
    assert list(context._event_handlers) == [handler, last]
    assert context.would_handle_event(1)  # type: ignore[arg-type]
    assert handler.handle(1, context) == "mine"
    assert context.locals.event == 1
    assert not context.would_handle_event(1)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="deque"):
        context.unregister_event_handler(handler)
