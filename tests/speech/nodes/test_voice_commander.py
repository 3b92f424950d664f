"""voice_commander: spoken commands become motions of the robot."""

from __future__ import annotations

from math import pi
from typing import ClassVar

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import ActionServer
from linkwright.graph.actions.goal import CancelResponse, GoalEvent
from linkwright.graph.endpoints.base import EndpointKind
from linkwright.messages import get_action, get_message, get_service
from linkwright.speech.nodes.audio_messages import make_audio_stamped
from tests.speech.nodes.fakes import STRING, final_result, partial_result
from tests.waiting import eventually

ODOMETRY = get_message("nav_msgs/msg/Odometry")


def write_command_file(tmp_path, text):
    file = tmp_path / "commands.yaml"
    file.write_text(text, encoding="utf-8")
    return str(file)


# --- driving -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "speed"),
    [
        ("forward", (0.2, 0.0, 0.0)),
        ("后退", (-0.2, 0.0, 0.0)),
        ("左转", (0.0, 0.0, 0.6)),
        ("turn right", (0.0, 0.0, -0.6)),
    ],
)
async def test_command_drives_robot(harness, start_commander, text, speed):
    robot = start_commander()
    assert await robot.send_text(text) == text
    assert robot.speed == speed
    await harness.clock.advance(1.0)
    assert robot.speed == speed
    assert len(robot.velocities) > 10, "commands are published repeatedly"
    assert robot.texts_by_topic["text"] == [text]


async def test_new_command_replaces_previous_and_stop_ends_it(harness, start_commander):
    robot = start_commander()
    await robot.send_text("forward")
    await robot.send_text("left")
    assert robot.speed == (0.0, 0.0, 0.6)
    await robot.send_text("停")
    assert robot.speed == (0.0, 0.0, 0.0)
    robot.velocities.clear()
    await harness.clock.advance(2.0)
    assert robot.velocities == []
    assert robot.texts_by_topic["command"] == ["forward", "left", "stop"]


async def test_silence_timeout_stops_robot(harness, start_commander):
    robot = start_commander(silence_timeout=3.0)
    await robot.send_text("forward")
    await harness.clock.advance(2.9)
    assert robot.speed == (0.2, 0.0, 0.0)
    await harness.clock.advance(0.2)
    assert robot.speed == (0.0, 0.0, 0.0)
    assert robot.texts_by_topic["response"][-1] == "I hear nothing, so I am stopping"


def travelled_distance(robot):
    """Return the meters and radians of the published velocities, each for 50 ms."""
    return sum(velocity.linear.x for velocity in robot.velocities) * 0.05, sum(
        velocity.angular.z for velocity in robot.velocities
    ) * 0.05


@pytest.mark.parametrize(
    ("text", "distance", "angle"),
    [
        ("drive forward half a meter", 0.5, 0.0),
        ("后退 一米", -1.0, 0.0),
        ("左转九十度", 0.0, pi / 2),
        ("转两圈", 0.0, 4 * pi),
    ],
)
async def test_distance_without_odometry_is_speed_times_time(harness, start_commander, text, distance, angle):
    robot = start_commander()
    await robot.send_text(text)
    await harness.clock.advance(40.0)
    assert robot.speed == (0.0, 0.0, 0.0)
    assert travelled_distance(robot) == pytest.approx((distance, angle), abs=0.02)


class SlippingRobot:
    """A robot with slipping wheels: it moves a part of the commanded distance."""

    def __init__(self, harness, robot, share=0.5):
        self.publisher = harness.node.create_publisher(ODOMETRY, "/odom", 10)
        self.robot, self.share, self.x = robot, share, 0.0
        harness.node.create_timer(0.02, self.move)

    def move(self):
        self.x += (self.robot.speed[0] if self.robot.velocities else 0.0) * 0.02 * self.share
        message = ODOMETRY()
        message.pose.pose.position.x = self.x
        message.pose.pose.orientation.w = 1.0
        self.publisher.publish(message)


async def test_distance_is_measured_by_odometry(harness, start_commander):
    robot = start_commander()
    body = SlippingRobot(harness, robot)
    await harness.clock.advance(0.1)
    await robot.send_text("前进一点五米")
    await harness.clock.advance(30.0)
    assert robot.speed == (0.0, 0.0, 0.0)
    assert body.x == pytest.approx(1.5, abs=0.02)


async def test_stuck_robot_stops_and_reports(harness, start_commander):
    robot = start_commander()
    SlippingRobot(harness, robot, share=0.0)
    await harness.clock.advance(0.1)
    await robot.send_text("forward one meter")
    await harness.clock.advance(30.0)
    assert robot.speed == (0.0, 0.0, 0.0)
    assert robot.texts_by_topic["response"][-1] == "I am stuck, so I am stopping"


async def test_speed_commands_change_speed(start_commander):
    robot = start_commander()
    await robot.send_text("加速")
    await robot.send_text("forward")
    assert robot.speed[0] == pytest.approx(0.25)
    await robot.send_text("slower")
    await robot.send_text("forward")
    assert robot.speed[0] == pytest.approx(0.2)
    await robot.send_text("drive at half a meter per second")
    await robot.send_text("forward")
    assert robot.speed[0] == pytest.approx(0.5)
    for _ in range(20):
        await robot.send_text("faster")
    await robot.send_text("forward")
    assert robot.speed[0] == pytest.approx(0.8), "the speed is limited to four times the default"


async def test_closing_node_stops_robot(harness, start_commander):
    robot = start_commander()
    await robot.send_text("forward")
    robot.commander.close()
    await harness.graph.settle()
    assert robot.speed == (0.0, 0.0, 0.0)


# --- sound -----------------------------------------------------------------------------------------------------------


async def test_engine_gets_phrases_and_options(engine, start_commander, tmp_path):
    robot = start_commander(engine="told", language="zh", words_file="/words.json", model=str(tmp_path))
    await eventually(lambda: engine.used_options)
    (options,) = engine.used_options
    assert (options.language, options.model) == ("zh", tmp_path)
    assert "左转九十度" in options.phrases
    assert robot.texts_by_topic["text"] == []


async def test_sound_is_used_only_while_button_is_held(engine, start_commander):
    robot = start_commander(engine="told")
    await robot.process()
    await robot.hold(True)
    await robot.process(partial_result("for"), final_result("forward"))
    assert robot.texts_by_topic["partial_text"] == ["for"]
    assert robot.texts_by_topic["command"] == ["forward"]
    assert robot.speed == (0.2, 0.0, 0.0)
    await robot.hold(False)
    await eventually(lambda: engine.finished)


async def test_open_listening_needs_no_button(engine, start_commander):
    robot = start_commander(engine="told", open_listening=True)
    await robot.process(final_result("forward"))
    assert robot.texts_by_topic["command"] == ["forward"]


async def test_uncertain_command_is_not_executed(engine, start_commander):
    robot = start_commander(engine="told", open_listening=True, confidence=0.7)
    await robot.process(final_result("forward", 0.6))
    await robot.process(final_result("", 0.9))
    assert robot.texts_by_topic["command"] == []
    assert robot.velocities == []


@pytest.mark.parametrize("asked_for", [0.5, 0.8])
async def test_uncertain_command_during_press_is_answered(engine, start_commander, asked_for):
    robot = start_commander(engine="told", confidence=asked_for, language="zh")
    await robot.hold(True)
    engine.results_at_end.append(final_result("前进", 0.6 * asked_for))
    await robot.hold(False)
    await eventually(lambda: robot.texts_by_topic["response"])
    assert robot.texts_by_topic["response"] == ["我不确定听到的是“前进”，请再说一遍"]
    assert robot.texts_by_topic["text"] == ["前进"]
    assert robot.texts_by_topic["command"] == []


async def test_very_uncertain_result_is_not_answered(engine, start_commander):
    robot = start_commander(engine="told")
    await robot.hold(True)
    await robot.process(final_result("forward", 0.2), final_result("", 0.4))
    assert robot.texts_by_topic["response"] == []


async def test_open_listening_answers_uncertain_command_only_with_button(engine, start_commander):
    robot = start_commander(engine="told", open_listening=True)
    await robot.process(final_result("forward", 0.4))
    assert robot.texts_by_topic["response"] == []
    await robot.hold(True)
    await robot.process(final_result("forward", 0.4, start=2.0))
    assert robot.texts_by_topic["response"] == ["I am not sure that I heard 'forward', please repeat"]


async def test_command_with_gap_is_asked_again_but_stop_is_executed(engine, start_commander):
    robot = start_commander(engine="told")
    await robot.hold(True)
    for index in range(5):
        await robot.process(stamp=10.0 + 0.1 * index)
    await robot.process(final_result("forward", start=-0.5), stamp=11.0)  # half a second is missing
    assert robot.texts_by_topic["text"] == ["forward"]
    assert robot.texts_by_topic["command"] == []
    assert robot.texts_by_topic["response"] == ["I did not hear all of that, please repeat"]
    await robot.process(final_result("forward", start=0.8), stamp=11.1)
    assert robot.texts_by_topic["command"] == ["forward"]
    for index in range(3):
        await robot.process(stamp=11.2 + 0.1 * index)
    await robot.process(final_result("stop", start=0.5), stamp=13.0)
    assert robot.texts_by_topic["command"] == ["forward", "stop"]
    assert robot.speed == (0.0, 0.0, 0.0)


async def test_certain_command_with_small_gap_is_executed(engine, start_commander):
    robot = start_commander(engine="told")
    await robot.hold(True)
    for index in range(5):
        await robot.process(stamp=10.0 + 0.1 * index)
    await robot.process(final_result("forward"), final_result(""), stamp=10.6)  # a tenth of a second is missing
    assert robot.texts_by_topic["command"] == ["forward"]
    assert robot.texts_by_topic["response"][-1] == "I did not hear all of that, please repeat"


async def test_next_press_has_no_gap(engine, start_commander):
    robot = start_commander(engine="told")
    await robot.hold(True)
    for index in range(5):
        await robot.process(stamp=10.0 + 0.1 * index)
    await robot.hold(False)
    await robot.hold(True)
    await robot.process(final_result("forward", start=0.0), stamp=15.0)
    assert robot.texts_by_topic["command"] == ["forward"]


async def test_partial_stop_is_executed_once(engine, start_commander):
    robot = start_commander(engine="told", open_listening=True)
    await robot.process(final_result("forward"))
    await robot.process(partial_result("[unk] stop", start=2.0))
    assert robot.speed == (0.0, 0.0, 0.0)
    await robot.process(partial_result("stop", start=2.0), final_result("stop", start=2.0))
    assert robot.texts_by_topic["command"] == ["forward", "stop"]


async def test_stop_is_executed_again_after_new_motion(engine, start_commander):
    robot = start_commander(engine="told", open_listening=True)
    for _ in range(2):
        await robot.send_text("forward")
        await robot.process(partial_result("stop"))
        assert robot.speed == (0.0, 0.0, 0.0)


async def test_rest_of_utterance_after_stop_is_ignored(engine, start_commander):
    robot = start_commander(engine="told", open_listening=True)
    await robot.process(final_result("left"))
    await robot.process(partial_result("stop"), final_result("forward"))
    assert robot.texts_by_topic["command"] == ["left", "stop"]
    await robot.hold(True)
    await robot.process(partial_result("go to the stop"), final_result("go to the stop sign"))
    assert robot.texts_by_topic["command"] == ["left", "stop", "stop", "go_to_object object=stop_sign"]


async def test_engine_problem_is_logged(engine, start_commander, logged):
    engine.problems.append(Diagnostic("VOICE201", phrase("nothing is enrolled"), hint=phrase("enroll something")))
    robot = start_commander(engine="told")
    await eventually(lambda: logged("WARN"))
    assert logged("WARN") == ["nothing is enrolled", "enroll something"]
    assert not robot.commander.finished.done()


async def test_uncertain_stop_stops_moving_robot(engine, start_commander):
    robot = start_commander(engine="told", open_listening=True)
    await robot.process(final_result("stop", 0.1))
    assert robot.texts_by_topic["command"] == []
    await robot.process(final_result("forward", start=2.0))
    await robot.process(final_result("stop", 0.1, start=4.0))
    assert robot.speed == (0.0, 0.0, 0.0)


async def test_lost_audio_source_stops_robot(engine, harness, start_commander):
    robot = start_commander(engine="told", open_listening=True)
    await robot.process(final_result("forward"))
    robot.microphone_node.destroy_node()
    await harness.clock.advance(1.0)
    assert robot.speed == (0.0, 0.0, 0.0)
    assert robot.texts_by_topic["response"][-1] == "the audio source is gone, so I am stopping"


async def test_unknown_engine_ends_node(engine, start_commander, logged):
    robot = start_commander(engine="tolt")
    await eventually(robot.commander.finished.done)
    assert robot.commander.finished.result() == 1
    assert logged("FATAL") == ["there is no speech engine 'tolt'", "did you mean 'told'?"]


async def test_failing_engine_stops_robot_and_ends_node(engine, start_commander, logged):
    robot = start_commander(engine="told", open_listening=True)
    await robot.process(final_result("forward"))
    robot.sound.publish(make_audio_stamped(b"\xff\x7f", robot.harness.node.get_clock().now().to_msg()))
    await eventually(robot.commander.finished.done)
    await robot.harness.graph.settle()
    assert robot.speed == (0.0, 0.0, 0.0)
    assert logged("FATAL") == ["the speech engine failed: KeyError: 32767"]


# --- others ----------------------------------------------------------------------------------------------------------

QUESTION = """
commands:
  reset: {phrases: {en: reset, zh: 复位}, confirm: true,
          publish: {topic: /reset, type: std_msgs/msg/String, message: {data: now}}}
  forward: {phrases: forward, drive: {x: 1}}
"yes": "yes"
"no": "no"
"""


@pytest.mark.parametrize(("answer", "count"), [("yes", 1), ("no", 0), ("forward", 0), (None, 0)])
async def test_confirmation_is_required_before_command(harness, start_commander, tmp_path, answer, count):
    robot = start_commander(commands_file=write_command_file(tmp_path, QUESTION))
    reset = []
    harness.node.create_subscription(STRING, "/reset", reset.append, 10)
    assert await robot.send_text("reset") == "are you sure?"
    if answer:
        await robot.send_text(answer)
    else:
        await harness.clock.advance(11.0)
        assert robot.texts_by_topic["response"][-1] == "I received no answer, so I will not do it"
    assert len(reset) == count
    await robot.send_text("yes")
    assert len(reset) == count


async def test_first_response_is_in_node_language(start_commander):
    robot = start_commander(language="zh")
    assert await robot.send_text("唱歌") == "我没听懂“唱歌”"


async def test_response_is_in_language_of_last_command(start_commander, tmp_path):
    text = """
commands:
  stop: {phrases: {en: stop, zh: 停}, stop: true, response: {en: stopped, zh: 停下了}}
  forward: {phrases: {en: [forward], zh: [前进]}, drive: {x: 1}, response: {en: I drive, zh: 我走}}
"""
    robot = start_commander(commands_file=write_command_file(tmp_path, text))
    assert await robot.send_text("前进") == "我走"
    assert await robot.send_text("sing") == "我没听懂“sing”"
    assert await robot.send_text("停") == "停下了"
    assert await robot.send_text("forward") == "I drive"
    assert await robot.send_text("stop") == "stopped"


PLACE_FILE = """
places: {kitchen: {x: 1.5, y: -2, yaw: 3.14159, names: {en: kitchen, zh: 厨房}}}
commands:
  go: {phrases: {en: "go to the {place}", zh: "去{place}"}, go_to: "{place}"}
  stop: {phrases: [stop, 停], stop: true}
  forward: {phrases: forward, drive: {x: 1}}
"""


class Navigator:
    """A server of NavigateToPose whose goals run until the test ends them."""

    def __init__(self, harness):
        self.goals, self.cancel_count = [], 0
        kind = get_action("nav2_msgs/action/NavigateToPose")
        self.result = kind.Result
        self.server = ActionServer(
            harness.node,
            kind,
            "navigate_to_pose",
            lambda goal: None,
            handle_accepted_callback=self.accept,
            cancel_callback=self.cancel,
        )

    def accept(self, goal):
        goal.update(GoalEvent.EXECUTE)
        self.goals.append(goal)

    def cancel(self, goal):
        self.cancel_count += 1
        return CancelResponse.ACCEPT


async def test_go_to_place_sends_goal_and_reports_arrival(harness, start_commander, tmp_path):
    navigator = Navigator(harness)
    robot = start_commander(commands_file=write_command_file(tmp_path, PLACE_FILE))
    await harness.graph.settle()
    assert await robot.send_text("去厨房") == "去厨房"
    (goal,) = navigator.goals
    pose = goal.request.pose
    assert (pose.header.frame_id, pose.pose.position.x, pose.pose.position.y) == ("map", 1.5, -2.0)
    assert pose.pose.orientation.z == pytest.approx(1.0)
    assert robot.texts_by_topic["command"] == ["go place=kitchen"]
    goal.succeed(navigator.result())
    await harness.graph.settle()
    assert robot.texts_by_topic["response"][-1] == "完成了"


@pytest.mark.parametrize("text", ["stop", "forward"])
async def test_stop_or_other_command_cancels_goal(harness, start_commander, tmp_path, text):
    navigator = Navigator(harness)
    robot = start_commander(commands_file=write_command_file(tmp_path, PLACE_FILE))
    await harness.graph.settle()
    await robot.send_text("go to the kitchen")
    await robot.send_text(text)
    assert navigator.cancel_count >= 1


async def test_missing_action_server_is_reported(start_commander, tmp_path):
    robot = start_commander(commands_file=write_command_file(tmp_path, PLACE_FILE))
    assert await robot.send_text("go to the kitchen") == "I cannot do it: no node serves 'navigate_to_pose'"


async def test_service_response_is_spoken(harness, start_commander):
    service_type = get_service("std_srvs/srv/Trigger")
    harness.node.create_service(
        service_type,
        "/vision/describe/en",
        lambda request, response: service_type.Response(success=True, message="a red ball"),
    )
    robot = start_commander()
    await harness.graph.settle()
    await robot.send_text("what do you see")
    await eventually(lambda: robot.texts_by_topic["response"][-1] == "a red ball")


def voice_client_names(harness):
    return [endpoint.name for endpoint in harness.graph.endpoints() if endpoint.kind is EndpointKind.CLIENT]


async def test_missing_service_does_not_delay_other_commands(harness, start_commander):
    robot = start_commander()
    await harness.graph.settle()
    assert [client for client in voice_client_names(harness) if "/_action/" not in client] == []
    assert await robot.send_text("what do you see") == "I cannot do it: no node serves '/vision/describe/en'"
    service_type = get_service("std_srvs/srv/Trigger")
    harness.node.create_service(
        service_type,
        "/vision/describe/en",
        lambda request, response: service_type.Response(success=True, message="a red ball"),
    )
    await robot.send_text("what do you see")
    await eventually(lambda: robot.texts_by_topic["response"][-1] == "a red ball")
    assert "/vision/describe/en" not in voice_client_names(harness)


async def test_service_of_other_type_is_not_called(harness, start_commander):
    harness.node.create_service("std_srvs/srv/Empty", "/vision/describe/en", lambda request, response: response)
    assert (
        await start_commander().send_text("what do you see") == "I cannot do it: no node serves '/vision/describe/en'"
    )


LAUNCH = """
commands:
  follow: {phrases: "follow the {object}",
           launch: {package: p, file: f.launch.py, arguments: {target: "{object}", k: 2}}}
  stop: {phrases: stop, stop: true}
objects: {red ball: {en: red ball}}
"""


class FakeProcess:
    """A process that ends when it is interrupted."""

    started: ClassVar[list[FakeProcess]] = []

    def __init__(self, command, **options):
        self.command, self.signals = command, []
        FakeProcess.started.append(self)

    def poll(self):
        return 0 if self.signals else None

    def wait(self, timeout=None):
        return 0

    def send_signal(self, number):
        self.signals.append(number)

    def terminate(self):
        self.signals.append(15)


async def test_launch_file_is_started_without_shell_and_ended_by_stop(start_commander, tmp_path, monkeypatch):
    FakeProcess.started.clear()
    monkeypatch.setattr("linkwright.speech.nodes.requests.subprocess.Popen", FakeProcess)
    robot = start_commander(commands_file=write_command_file(tmp_path, LAUNCH))
    await robot.send_text("follow the red ball")
    (process,) = FakeProcess.started
    assert process.command[-6:] == ["linkwright", "launch", "p", "f.launch.py", "target:=red ball", "k:=2"]
    assert not process.signals
    await robot.send_text("stop")
    assert len(process.signals) == 1


async def test_go_to_object_publishes_target_and_stop(harness, start_commander):
    targets = []
    harness.node.create_subscription(STRING, "/vision/go_to/en", lambda message: targets.append(message.data), 10)
    harness.node.create_subscription(
        STRING, "/vision/go_to/zh", lambda message: targets.append(("zh", message.data)), 10
    )
    harness.node.create_subscription("std_msgs/msg/Empty", "/vision/stop", lambda message: targets.append("stop"), 10)
    robot = start_commander()
    await robot.send_text("forward")
    await robot.send_text("go to the red ball")
    assert robot.speed == (0.0, 0.0, 0.0)
    await robot.send_text("stop")
    await robot.send_text("去红球那里")
    assert targets == ["stop", "red ball", "stop", ("zh", "red ball")]


async def test_invalid_command_file_ends_node(start_commander, tmp_path, logged):
    with pytest.raises(LinkwrightError) as error:
        start_commander(commands_file=write_command_file(tmp_path, "commands: {a: {phrases: b}}"))
    assert error.value.diagnostics[0].code == "VOICE302"
    assert logged("FATAL") == ["the command 'a' has no action"]
