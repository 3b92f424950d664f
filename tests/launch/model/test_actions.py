"""Actions of launch: conditions, arguments, configurations, groups and includes."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    EmitEvent,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    OpaqueFunction,
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    RegisterEventHandler,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
    UnregisterEventHandler,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnShutdown
from launch.events import Shutdown as ShutdownEvent
from launch.launch_description_sources import AnyLaunchDescriptionSource, PythonLaunchDescriptionSource
from launch.substitutions import (
    EnvironmentVariable,
    LaunchConfiguration,
    LocalSubstitution,
    TextSubstitution,
    ThisLaunchFileDir,
)

from launch import Action, LaunchContext, LaunchDescription, LaunchDescriptionSource

Write = Callable[[str, str], Path]


def log_text(*parts: object) -> LogInfo:
    return LogInfo(msg=list(parts))


async def test_conditions_control_execution(launch) -> None:
    result = await launch(
        LogInfo(msg="a", condition=IfCondition("true")),
        LogInfo(msg="b", condition=UnlessCondition("true")),
    )
    assert result.messages == ["a"]
    assert result.succeeded


class TestDeclareLaunchArgument:
    async def test_default_value_is_used_unless_given(self, launch) -> None:
        entities = (DeclareLaunchArgument("x", default_value=["d", "1"]), log_text(LaunchConfiguration("x")))
        assert (await launch(*entities)).messages == ["d1"]
        assert (await launch(*entities, x="mine")).messages == ["mine"]

    async def test_required_argument_is_reported_if_missing(self, launch) -> None:
        result = await launch(DeclareLaunchArgument("x", description="the x"), log_text("after"))
        assert "error[LAUNCH114]: argument 'x' (the x) is required, but was not given" in result.err
        assert "test_actions.py" in result.err
        assert result.messages == []
        assert not result.succeeded

    async def test_value_must_be_one_of_choices(self, launch) -> None:
        result = await launch(DeclareLaunchArgument("x", default_value="a", choices=["a", "b"]), x="c")
        assert "error[LAUNCH112]: argument 'x' has the value 'c', which is not one of its choices" in result.err
        assert "hint: choose from 'a', 'b'" in result.err

    def test_description_lists_choices(self) -> None:
        assert DeclareLaunchArgument("x").description == "no description given"
        assert DeclareLaunchArgument("x", choices=["a"]).description == "One of: ['a']"
        argument = DeclareLaunchArgument("x", description="What.", choices=["a"])
        assert argument.description == "What. Valid choices are: ['a']"


async def test_launch_configurations_are_set_and_unset(launch) -> None:
    result = await launch(
        SetLaunchConfiguration("x", ["1", "2"]),
        log_text(LaunchConfiguration("x")),
        UnsetLaunchConfiguration("x"),
        UnsetLaunchConfiguration("never"),
        log_text(LaunchConfiguration("x", default="none")),
        SetLaunchConfiguration("x", "3"),
        PushLaunchConfigurations(),
        ResetLaunchConfigurations({"y": [LaunchConfiguration("x"), "y"]}),
        log_text(LaunchConfiguration("x", default="none"), LaunchConfiguration("y")),
        PopLaunchConfigurations(),
        log_text(LaunchConfiguration("x")),
    )
    assert result.messages == ["12", "none", "none3y", "3"]


async def test_environment_variables_are_set_appended_and_unset(launch, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LW_A", "a")
    result = await launch(
        SetEnvironmentVariable("LW_B", "b"),
        AppendEnvironmentVariable("LW_A", "c"),
        AppendEnvironmentVariable("LW_A", "0", prepend=True, separator=","),
        AppendEnvironmentVariable("LW_C", "new"),
        log_text(EnvironmentVariable("LW_A"), EnvironmentVariable("LW_B"), EnvironmentVariable("LW_C")),
        OpaqueFunction(function=lambda context: log_text(os.environ["LW_B"])),
        UnsetEnvironmentVariable("LW_B"),
        log_text(EnvironmentVariable("LW_B", default_value="gone")),
    )
    assert result.messages == [f"0,a{os.pathsep}cbnew", "b", "gone"]


class TestGroupAction:
    async def test_scoped_group_restores_configurations_and_environment(self, launch) -> None:
        result = await launch(
            SetLaunchConfiguration("x", "outer"),
            GroupAction(
                [
                    SetLaunchConfiguration("x", "inner"),
                    SetEnvironmentVariable("LW_G", "1"),
                    log_text(LaunchConfiguration("x")),
                ],
                launch_configurations={"y": "given"},
            ),
            log_text(
                LaunchConfiguration("x"),
                LaunchConfiguration("y", default="-"),
                EnvironmentVariable("LW_G", default_value="-"),
            ),
        )
        assert result.messages == ["inner", "outer--"]

    async def test_unscoped_group_keeps_changes(self, launch) -> None:
        result = await launch(
            GroupAction([SetLaunchConfiguration("x", "inner")], scoped=False), log_text(LaunchConfiguration("x"))
        )
        assert result.messages == ["inner"]

    async def test_group_without_forwarding_hides_outer_configurations(self, launch) -> None:
        result = await launch(
            SetLaunchConfiguration("x", "outer"),
            GroupAction(
                [log_text(LaunchConfiguration("x", default="none"), LaunchConfiguration("y"))],
                forwarding=False,
                launch_configurations={"y": LaunchConfiguration("x")},
            ),
            log_text(LaunchConfiguration("x")),
        )
        assert result.messages == ["noneouter", "outer"]


class TestOpaqueFunction:
    async def test_arguments_are_passed_and_returned_actions_run(self, launch) -> None:
        def function(context: LaunchContext, first: str, *, second: str) -> list[Action]:
            return [log_text(first, second, context.launch_configurations["x"])]

        result = await launch(OpaqueFunction(function=function, args=["1"], kwargs={"second": "2"}), x="3")
        assert result.messages == ["123"]

    async def test_exception_names_user_line(self, launch) -> None:
        def function(context: LaunchContext) -> None:
            raise ValueError("no such robot")  # the line

        result = await launch(OpaqueFunction(function=function))
        assert "error[LAUNCH104]: launch action OpaqueFunction raised ValueError: no such robot" in result.err
        assert 'raise ValueError("no such robot")  # the line' in result.err
        assert "Traceback" not in result.err
        assert not result.succeeded

    async def test_non_action_result_is_rejected(self, launch) -> None:
        result = await launch(OpaqueFunction(function=lambda _: [3]))
        assert "expected launch actions, got 3 of type int" in result.err


async def test_custom_action_returns_actions(launch) -> None:
    class Twice(Action):
        def execute(self, context: LaunchContext) -> list[Action]:
            return [log_text("again"), log_text("again")]

    assert (await launch(Twice())).messages == ["again", "again"]


class TestTimerAction:
    async def test_timers_run_in_order_of_period(self, launch) -> None:
        result = await launch(
            TimerAction(period=0.02, actions=[log_text("later")]),
            TimerAction(period=["0", ".01"], actions=[log_text("sooner")]),
            log_text("now"),
        )
        assert result.messages == ["now", "sooner", "later"]

    async def test_timer_can_be_canceled(self, launch) -> None:
        timer = TimerAction(period=10.0, actions=[log_text("never")])
        result = await launch(
            timer, TimerAction(period=0.01, actions=[OpaqueFunction(function=lambda _: timer.cancel())])
        )
        assert result.messages == []

    async def test_invalid_period_is_rejected(self, launch) -> None:
        with pytest.raises(ValueError, match="soon") as raised:
            TimerAction(period="soon", actions=[])
        assert raised.value.diagnostics[0].message == "the period 'soon' of a timer is not a number"
        result = await launch(TimerAction(period=TextSubstitution(text="later"), actions=[]))
        assert "the period 'later' of a timer is not a number" in result.err


class TestEvents:
    async def test_failing_shutdown_handler_is_reported_once(self, launch) -> None:
        def fail(_: LaunchContext) -> None:
            raise FileNotFoundError("gone")

        handler = RegisterEventHandler(OnShutdown(on_shutdown=[OpaqueFunction(function=fail)]))
        result = await launch(handler, Shutdown(reason="over"))
        assert result.err.count("raised FileNotFoundError: gone") == 1

    async def test_shutdown_handlers_receive_reason(self, launch) -> None:
        result = await launch(
            RegisterEventHandler(OnShutdown(on_shutdown=[log_text(LocalSubstitution("event.reason"))])),
            Shutdown(reason=["enough ", "of it"]),
            TimerAction(period=30.0, actions=[log_text("never")]),
        )
        assert result.messages == ["enough of it"]
        assert result.succeeded

    async def test_emit_event_triggers_handler(self, launch) -> None:
        handler = OnShutdown(on_shutdown=lambda event, context: log_text("function ", event.reason))
        result = await launch(
            RegisterEventHandler(handler),
            EmitEvent(event=ShutdownEvent(reason="r")),
            TimerAction(period=9.0, actions=[]),
        )
        assert result.messages == ["function r"]

    async def test_unregistered_handler_is_not_called(self, launch) -> None:
        handler = OnShutdown(on_shutdown=log_text("never"))
        result = await launch(RegisterEventHandler(handler), UnregisterEventHandler(handler))
        assert result.messages == []

    async def test_exception_in_handler_is_reported_without_traceback(self, launch) -> None:
        def fail(event: object, context: LaunchContext) -> None:
            raise KeyError("oh")

        result = await launch(RegisterEventHandler(OnShutdown(on_shutdown=fail)))
        assert "an event handler raised KeyError: oh" in result.err
        assert "Traceback" not in result.err
        assert not result.succeeded

    async def test_empty_launch_ends(self, launch) -> None:
        await asyncio.wait_for(launch(), 1.0)


INNER = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo, SetLaunchConfiguration
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('speed'{default}),
        LogInfo(msg=['inner ', LaunchConfiguration('speed'), ' ', ThisLaunchFileDir()]),
        SetLaunchConfiguration('leaks', 'yes'),
    ])
"""


class TestIncludeLaunchDescription:
    async def test_include_passes_arguments_and_shares_configurations(self, launch, write: Write) -> None:
        inner_file = write("sub/inner.launch.py", INNER.replace("{default}", ""))
        result = await launch(
            SetLaunchConfiguration("fast", "9"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource([str(inner_file.parent), "/inner.launch.py"]),
                launch_arguments={"speed": LaunchConfiguration("fast")}.items(),
            ),
            log_text(LaunchConfiguration("leaks"), LaunchConfiguration("speed")),
        )
        assert result.messages == [f"inner 9 {inner_file.parent}", "yes9"]

    @pytest.mark.parametrize("source", [AnyLaunchDescriptionSource, str])
    async def test_any_source_and_path_are_accepted(
        self, launch, write: Write, source: Callable[[str], object]
    ) -> None:
        inner_file = write("inner.launch.py", INNER.replace("{default}", ", default_value='1'"))
        assert (await launch(IncludeLaunchDescription(source(str(inner_file))))).messages[0].startswith("inner 1")

    async def test_non_text_argument_fails_only_when_include_runs(self, launch, write: Write) -> None:
        inner_file = write("inner.launch.py", INNER.replace("{default}", ""))
        pairs: Any = {"speed": None}.items()
        skipped_include = IncludeLaunchDescription(
            str(inner_file), launch_arguments=pairs, condition=IfCondition("false")
        )
        result = await launch(
            skipped_include, log_text("before"), IncludeLaunchDescription(str(inner_file), launch_arguments=pairs)
        )
        assert result.messages == ["before"]
        assert "error[LAUNCH114]: the value of argument 'speed' is None, which is not a string" in result.err
        assert not result.succeeded

    async def test_missing_argument_is_reported_before_actions_run(self, launch, write: Write) -> None:
        inner_file = write("inner.launch.py", INNER.replace("{default}", ""))
        result = await launch(IncludeLaunchDescription(str(inner_file), launch_arguments=[("sped", "1")]))
        text = f"the included launch file '{inner_file}' requires argument 'speed', which is not given"
        assert f"error[LAUNCH114]: {text}" in result.err
        assert "did you mean 'speed' instead of 'sped'?" in result.err
        assert result.messages == []

    @pytest.mark.parametrize(
        ("name", "text", "hint"),
        [
            (
                "outer.launch.xml",
                '<launch><include file="$(dirname)/inner.launch.py"/></launch>',
                'write <arg name="speed" value="VALUE"/> inside <include>',
            ),
            (
                "outer.launch.yaml",
                "launch:\n- include:\n    file: $(dirname)/inner.launch.py\n",
                "write 'arg: [{name: speed, value: VALUE}]' below 'include'",
            ),
        ],
    )
    async def test_missing_argument_hint_uses_language_of_file(
        self, launch, write: Write, name: str, text: str, hint: str
    ) -> None:
        write("inner.launch.py", INNER.replace("{default}", ""))
        result = await launch(IncludeLaunchDescription(str(write(name, text))))
        assert "inner.launch.py' requires argument 'speed'" in result.err
        assert f"hint: {hint}" in result.err
        assert f"--> {write(name, text)}" in result.err

    async def test_missing_argument_of_inline_description_is_reported(self, launch) -> None:
        inner_file = LaunchDescriptionSource(LaunchDescription([DeclareLaunchArgument("speed")]))
        result = await launch(IncludeLaunchDescription(inner_file))
        assert "the included launch description requires argument 'speed', which is not given" in result.err
        assert "add ('speed', VALUE) to launch_arguments" in result.err

    async def test_error_in_included_file_names_that_file(self, launch, write: Write) -> None:
        inner_file = write("inner.launch.py", "def generate_launch_description():\n    return nothing\n")
        result = await launch(IncludeLaunchDescription(str(inner_file)))
        assert "raised NameError: name 'nothing' is not defined" in result.err
        assert f"{inner_file.name}:2:" in result.err

    async def test_missing_included_file_names_including_line(self, launch, tmp_path: Path) -> None:
        result = await launch(IncludeLaunchDescription(str(tmp_path / "none.launch.py")))
        assert "error[LAUNCH101]" in result.err
        assert "test_actions.py" in result.err

    async def test_this_launch_file_dir_is_restored_after_include(self, launch, write: Write) -> None:
        write("sub/inner.launch.py", INNER.replace("{default}", ", default_value='1'"))
        outer_file = write(
            "outer.launch.py",
            """
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, LogInfo
from launch.substitutions import ThisLaunchFileDir

def generate_launch_description():
    return LaunchDescription([
        IncludeLaunchDescription([ThisLaunchFileDir(), '/sub/inner.launch.py']),
        LogInfo(msg=ThisLaunchFileDir()),
    ])
""",
        )
        result = await launch(IncludeLaunchDescription(str(outer_file)))
        assert result.messages == [f"inner 1 {outer_file.parent / 'sub'}", str(outer_file.parent)]


def test_launch_arguments_of_description_are_listed(write: Write) -> None:
    inner_file = write("inner.launch.py", INNER.replace("{default}", ""))
    description = LaunchDescription(
        [
            DeclareLaunchArgument("a", default_value="1"),
            GroupAction([DeclareLaunchArgument("b")], condition=IfCondition("true")),
            IncludeLaunchDescription(str(inner_file)),
            IncludeLaunchDescription([ThisLaunchFileDir(), "/unknown.launch.py"]),
        ]
    )
    inclusion = {argument.name: argument.conditionally_included for argument in description.get_launch_arguments()}
    assert inclusion == {"a": False, "b": True, "speed": False}


def test_argument_given_by_include_is_not_listed(write: Write) -> None:
    inner_file = write("inner.launch.py", INNER.replace("{default}", ""))
    description = LaunchDescription(
        [IncludeLaunchDescription(str(inner_file), launch_arguments={"speed": "1"}.items())]
    )
    assert description.get_launch_arguments() == []
