"""The joint trajectory controller.

The tests cover its commands over time, rejections, and the ends of goals.
"""

from __future__ import annotations

from math import inf, nan, pi
from typing import Any

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.joint_trajectory_controller import JointTrajectoryController
from linkwright.control.controllers.registry import controller_class
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import Duration, Time, get_service
from tests.control.controllers.arm import (
    JOINTS,
    POSITION_PARAMETERS,
    SECOND_NS,
    TRAJECTORY_TYPE,
    Arm,
    run,
    tolerance,
    trajectory,
)

SUCCEEDED, CANCELED, ABORTED = 4, 5, 6


def test_controller_is_found_by_type():
    assert controller_class("joint_trajectory_controller/JointTrajectoryController") is JointTrajectoryController


async def test_joints_are_held_until_first_trajectory(bench):
    bench.joint("shoulder", commands=("position",), position=0.3, velocity=0.0)
    bench.joint("elbow", commands=("position",), position=-0.2, velocity=0.0)
    controller = bench.start(JointTrajectoryController, **POSITION_PARAMETERS)
    await run(bench, controller, 0.05)
    assert [command.value for command in controller.commands] == [0.3, -0.2]


async def test_positions_are_interpolated_linearly_one_update_ahead(bench):
    arm = Arm(bench)
    await arm.run(0.1)
    arm.publish(trajectory((1.0, [1.0, -2.0]), (2.0, [0.0, 0.0])))
    await arm.run(0.5)
    assert arm.command("shoulder") == pytest.approx(0.5)
    await arm.run(0.5)
    assert (arm.command("shoulder"), arm.command("elbow")) == pytest.approx((1.0, -2.0))
    await arm.run(0.25)
    assert arm.command("shoulder") == pytest.approx(0.75)
    await arm.run(5.0)
    assert (arm.command("shoulder"), arm.command("elbow")) == (0.0, 0.0)


async def test_velocities_are_interpolated_as_cubic_and_commanded(bench):
    arm = Arm(bench, command_interfaces=["position", "velocity"])
    arm.publish(trajectory((2.0, [1.0, 1.0], [0.0, 0.0])))
    await arm.run(1.0)
    assert arm.command("shoulder") == pytest.approx(0.5, abs=1e-6)
    assert arm.command("shoulder", "velocity") == pytest.approx(0.75, abs=1e-4)
    await arm.run(2.0)
    assert arm.command("shoulder", "velocity") == 0.0


async def test_accelerations_are_commanded(bench):
    for joint in JOINTS:
        bench.joint(
            joint, commands=("position", "velocity", "acceleration"), position=0.0, velocity=0.0, acceleration=0.0
        )
    interfaces = ["position", "velocity", "acceleration"]
    controller = bench.start(
        JointTrajectoryController, joints=list(JOINTS), command_interfaces=interfaces, state_interfaces=interfaces
    )
    point = (2.0, [1.0, 1.0], [0.0, 0.0], [0.0, 0.0])
    bench.publish(TRAJECTORY_TYPE, "/controller/joint_trajectory", trajectory(point))
    await run(bench, controller, 1.0)
    values = [bench.commands[f"shoulder/{interface}"].value for interface in interfaces]
    assert values == pytest.approx([0.5, 15.0 / 16.0, 0.0], abs=1e-9)


async def test_velocity_command_is_feed_forward_plus_error(bench):
    gains = {joint: {"p": 2.0, "ff_velocity_scale": 1.0} for joint in JOINTS}
    arm = Arm(bench, command_interfaces=["velocity"], gains=gains)
    arm.publish(trajectory((1.0, [1.0, 1.0])))
    await arm.run(0.5)
    assert arm.command("shoulder", "velocity") == pytest.approx(1.0 + 2.0 * 0.49)


async def test_effort_by_pid_moves_mass_along_trajectory(bench):
    gains = {joint: {"p": 400.0, "d": 40.0, "i": 10.0, "i_clamp": 5.0} for joint in JOINTS}
    arm = Arm(bench, command_interfaces=["effort"], gains=gains)

    def move_by_effort() -> None:
        for joint in JOINTS:
            position, velocity = (bench.states[f"{joint}/{interface}"] for interface in ("position", "velocity"))
            velocity.value += 0.01 * (arm.command(joint, "effort") - 1.0)
            position.value += 0.01 * velocity.value

    goal = arm.send_goal(trajectory((2.0, [1.0, 0.5], [0.0, 0.0])))
    await run(bench, arm.controller, 4.0, move_by_effort)
    assert bench.states["shoulder/position"].value == pytest.approx(1.0, abs=0.01)
    assert goal.status == SUCCEEDED


async def test_gains_can_be_changed_while_active(bench):
    arm = Arm(bench, command_interfaces=["velocity"], gains={joint: {"p": 1.0} for joint in JOINTS})
    arm.publish(trajectory((0.01, [1.0, 1.0])))
    await arm.run(0.1)
    assert arm.command("shoulder", "velocity") == pytest.approx(1.0)
    node = arm.controller.node.graph_node
    node.set_parameters([type(node.get_parameter("gains.shoulder.p"))("gains.shoulder.p", value=3.0)])
    await arm.run(0.05)
    assert (arm.command("shoulder", "velocity"), arm.command("elbow", "velocity")) == pytest.approx((3.0, 1.0))


async def test_goal_succeeds_with_feedback(bench):
    arm = Arm(bench, action_monitor_rate=10.0)
    goal = arm.send_goal(trajectory((1.0, [1.0, 0.5])))
    await arm.run(1.1)
    assert goal.status == SUCCEEDED
    assert (goal.result.error_code, goal.result.error_string) == (0, "Goal successfully reached!")
    assert len(goal.feedback) == 10
    assert goal.feedback[5].joint_names == list(JOINTS)
    assert goal.feedback[5].desired.positions[0] == pytest.approx(0.5)
    assert goal.feedback[5].error.positions[0] == pytest.approx(0.0)
    assert "Goal reached, success!" in arm.log_texts()


async def test_joints_can_be_listed_in_any_order(bench):
    arm = Arm(bench)
    arm.publish(trajectory((0.5, [2.0, 1.0]), names=("elbow", "shoulder")))
    await arm.run(1.0)
    assert (arm.command("shoulder"), arm.command("elbow")) == (1.0, 2.0)


async def test_joints_omitted_from_partial_goal_are_held(bench):
    arm = Arm(bench, allow_partial_joints_goal=True)
    arm.publish(trajectory((0.5, [0.7, 0.4])))
    await arm.run(1.0)
    goal = arm.send_goal(trajectory((0.5, [1.0], [0.0]), names=("elbow",)))
    await arm.run(1.0)
    assert goal.status == SUCCEEDED
    assert (arm.command("shoulder"), arm.command("elbow")) == (0.7, 1.0)


VALID_POINT = (1.0, [1.0, 1.0])


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        (
            trajectory(VALID_POINT, names=("shoulder",)),
            "Joints on incoming trajectory don't match the controller joints.",
        ),
        (trajectory(names=JOINTS), "Empty trajectory received."),
        (
            trajectory(VALID_POINT, names=("shoulder", "knee")),
            "Incoming joint knee doesn't match the controller's joints.",
        ),
        (trajectory(VALID_POINT, names=("elbow", "elbow")), "Incoming joint elbow appears twice."),
        (
            trajectory(VALID_POINT, (1.0, [0.0, 0.0])),
            "Time between points 0 and 1 is not strictly increasing, it is 1.000000 and 1.000000 respectively",
        ),
        (
            trajectory((1.0, [1.0])),
            "Mismatch between joint_names size (2) and positions (1) at point #0.",
        ),
        (
            trajectory((1.0, [1.0, 1.0], [0.0])),
            "Mismatch between joint_names size (2) and velocities (1) at point #0.",
        ),
        (
            trajectory((1.0, [], [1.0, 1.0])),
            "Mismatch between joint_names size (2) and positions (0) at point #0.",
        ),
        (trajectory((1.0, [1.0, nan])), "The positions at point #0 are not all finite."),
        (trajectory((1.0, [1.0, 1.0], [inf, 0.0])), "The velocities at point #0 are not all finite."),
        (
            trajectory((1.0, [1.0, 1.0], [], [], [1.0, 1.0])),
            "Trajectories with effort fields are currently not supported.",
        ),
        (
            trajectory((0.5, [1.0, 1.0]), start_ns=SECOND_NS // 4),
            "Received trajectory with non-zero start time (0.250000) that ends in the past (0.750000)",
        ),
    ],
)
async def test_invalid_trajectory_is_rejected_with_reason(bench, message, expected):
    arm = Arm(bench)
    await arm.run(1.0)
    goal = arm.send_goal(message)
    arm.publish(message)
    await arm.run(1.5)
    assert goal.accepted is False
    assert arm.log_texts().count(expected) == 2
    assert arm.command("shoulder") == 0.0


async def test_partial_goal_requires_joint_names(bench):
    arm = Arm(bench, allow_partial_joints_goal=True)
    goal = arm.send_goal(trajectory(names=()))
    await arm.run(0.05)
    assert goal.accepted is False
    assert "Empty joint names on incoming trajectory." in arm.log_texts()


async def test_nonzero_final_velocity_can_be_forbidden(bench):
    arm = Arm(bench, allow_nonzero_velocity_at_trajectory_end=False)
    goal = arm.send_goal(trajectory((1.0, [1.0, 1.0], [0.0, 0.1])))
    await arm.run(0.05)
    assert goal.accepted is False
    assert "Velocity of last trajectory point of joint elbow is not zero: 0.100000000000000" in arm.log_texts()


async def test_points_without_positions_are_integrated_if_allowed(bench):
    arm = Arm(bench, allow_integration_in_goal_trajectories=True)
    goal = arm.send_goal(trajectory((1.0, [], [2.0, 0.0]), (2.0, [], [0.0, 0.0])))
    await arm.run(2.5)
    assert goal.status == SUCCEEDED
    assert arm.command("shoulder") == pytest.approx(2.0)
    empty = arm.send_goal(trajectory((1.0, [])))
    await arm.run(0.05)
    assert empty.accepted is False


async def test_trajectory_with_future_start_reaches_first_point_on_time(bench):
    arm = Arm(bench)
    await arm.run(1.0)
    arm.publish(trajectory((1.0, [1.0, 1.0]), start_ns=2 * SECOND_NS))
    await arm.run(1.0)
    assert arm.command("shoulder") == pytest.approx(0.5, abs=0.01)
    await arm.run(1.0)
    assert arm.command("shoulder") == pytest.approx(1.0)


async def test_trajectory_with_past_start_continues_at_current_time(bench):
    arm = Arm(bench)
    await arm.run(1.0)
    arm.publish(trajectory((0.5, [0.5, 0.5]), (2.5, [2.5, 2.5]), start_ns=SECOND_NS // 2))
    await arm.run(0.5)
    assert arm.command("shoulder") == pytest.approx(1.01)


async def test_violated_path_tolerance_aborts_goal_and_holds_joints(bench):
    arm = Arm(bench, constraints={"shoulder": {"trajectory": 0.1}})
    arm.stuck.add("shoulder")
    goal = arm.send_goal(trajectory((1.0, [1.0, 1.0])))
    await arm.run(0.5)
    assert goal.status == ABORTED
    assert goal.result.error_code == goal.result.PATH_TOLERANCE_VIOLATED
    assert goal.result.error_string == "Aborted due to path tolerance violation"
    assert arm.command("shoulder") == 0.0
    assert arm.command("elbow") == pytest.approx(0.11)
    assert "State tolerances failed for joint 'shoulder': Position Error: 0.110000, Position Tolerance: 0.100000" in (
        arm.log_texts()
    )


async def test_goal_is_aborted_after_goal_time(bench):
    arm = Arm(bench, constraints={"goal_time": 0.5, "shoulder": {"goal": 0.1}})
    arm.stuck.add("shoulder")
    goal = arm.send_goal(trajectory((1.0, [1.0, 1.0])))
    await arm.run(1.5)
    assert goal.status is None
    await arm.run(0.05)
    assert goal.status == ABORTED
    assert goal.result.error_code == goal.result.GOAL_TOLERANCE_VIOLATED
    assert goal.result.error_string.startswith("Aborted due to goal_time_tolerance exceeding by 0.51")
    assert arm.command("shoulder") == 0.0


async def test_goal_never_times_out_without_goal_time(bench):
    arm = Arm(bench, constraints={"shoulder": {"goal": 0.1}})
    arm.stuck.add("shoulder")
    goal = arm.send_goal(trajectory((0.1, [1.0, 1.0])))
    await arm.run(5.0)
    assert goal.status is None
    arm.stuck.clear()
    await arm.run(0.05)
    assert goal.status == SUCCEEDED


async def test_goal_overrides_tolerances(bench):
    arm = Arm(bench, constraints={"goal_time": 0.1, "shoulder": {"trajectory": 0.1, "goal": 0.1}})
    arm.stuck.add("shoulder")
    erased_tolerances = [tolerance("shoulder", -1.0)]
    first = arm.send_goal(
        trajectory((0.5, [1.0, 1.0])), path_tolerance=erased_tolerances, goal_tolerance=erased_tolerances
    )
    await arm.run(1.0)
    assert first.status == SUCCEEDED
    second = arm.send_goal(
        trajectory((0.5, [1.0, 0.0])),
        path_tolerance=[tolerance("shoulder", 3.0)],
        goal_time_tolerance=Duration(sec=1, nanosec=0),
    )
    await arm.run(1.2)
    assert second.status is None
    await arm.run(0.5)
    assert (second.status, second.result.error_code) == (ABORTED, second.result.GOAL_TOLERANCE_VIOLATED)


@pytest.mark.parametrize(
    ("tolerance_fields", "message"),
    [
        (
            tolerance("knee", 1.0),
            "joint 'knee' specified in goal.path_tolerance does not exist. Using default tolerances.",
        ),
        (
            tolerance("elbow", -0.5),
            "joint 'elbow' specified in goal.path_tolerance has a negative tolerance that is not -1.",
        ),
    ],
)
async def test_invalid_goal_tolerances_keep_controller_tolerances(bench, tolerance_fields, message):
    arm = Arm(bench, constraints={"shoulder": {"trajectory": 0.1}})
    arm.stuck.add("shoulder")
    goal = arm.send_goal(trajectory((0.5, [1.0, 1.0])), path_tolerance=[tolerance("shoulder", -1.0), tolerance_fields])
    await arm.run(0.5)
    assert goal.status == ABORTED
    assert message in arm.log_texts()


async def test_canceled_goal_holds_joints(bench):
    arm = Arm(bench)
    goal = arm.send_goal(trajectory((1.0, [1.0, 1.0])))
    await arm.run(0.5)
    goal.cancel()
    await arm.run(1.0)
    assert goal.status == CANCELED
    assert arm.command("shoulder") == pytest.approx(0.5)
    await arm.run(1.0)
    assert arm.command("shoulder") == pytest.approx(0.5)


async def test_new_goal_preempts_previous_goal(bench):
    arm = Arm(bench)
    first = arm.send_goal(trajectory((1.0, [1.0, 1.0])))
    await arm.run(0.5)
    second = arm.send_goal(trajectory((1.0, [0.0, 0.0])))
    await arm.run(1.2)
    assert (first.status, second.status) == (CANCELED, SUCCEEDED)
    assert first.result.error_code == first.result.INVALID_GOAL
    assert first.result.error_string == "Current goal cancelled due to new incoming action."


async def test_trajectory_on_topic_preempts_goal(bench):
    arm = Arm(bench)
    goal = arm.send_goal(trajectory((1.0, [1.0, 1.0])))
    await arm.run(0.5)
    arm.publish(trajectory((0.5, [0.0, 0.0])))
    await arm.run(1.0)
    assert goal.status == CANCELED
    assert arm.command("shoulder") == 0.0


async def test_rejected_goal_keeps_previous_goal(bench):
    arm = Arm(bench)
    first = arm.send_goal(trajectory((1.0, [1.0, 1.0])))
    await arm.run(0.5)
    arm.send_goal(trajectory())
    await arm.run(0.6)
    assert first.status == SUCCEEDED


async def test_inactive_controller_rejects_goals_and_ends_current_goal(bench):
    arm = Arm(bench, command_interfaces=["position", "velocity"])
    current_goal = arm.send_goal(trajectory((1.0, [1.0, 1.0], [0.0, 0.0])))
    await arm.run(0.5)
    arm.controller.on_deactivate()
    bench.exchange.deliver()
    rejected_goal = arm.send_goal(trajectory(VALID_POINT))
    await bench.graph.settle()
    assert (current_goal.status, rejected_goal.accepted) == (CANCELED, False)
    assert current_goal.result.error_string == "Current goal cancelled during deactivate transition."
    assert "Can't accept new action goals. Controller is not running." in arm.log_texts()
    assert arm.command("shoulder") == pytest.approx(0.5, abs=0.01)
    assert arm.command("shoulder", "velocity") == 0.0


async def test_reactivation_holds_last_commands(bench):
    arm = Arm(bench)
    arm.publish(trajectory((0.5, [1.0, 1.0])))
    await arm.run(1.0)
    arm.controller.on_deactivate()
    bench.states["shoulder/position"].value = 0.9
    arm.controller.on_activate()
    assert arm.controller._trajectory.points[0].state.positions == [1.0, 1.0]


async def test_open_loop_trajectory_starts_at_last_command(bench):
    arm = Arm(bench, open_loop_control=True)
    arm.publish(trajectory((0.5, [1.0, 1.0])))
    await arm.run(1.0)
    arm.stuck.update(JOINTS)
    for joint in JOINTS:
        bench.states[f"{joint}/position"].value = 0.5
    arm.publish(trajectory((1.0, [2.0, 2.0])))
    await arm.run(0.5)
    assert arm.command("shoulder") == pytest.approx(1.5)


async def test_angle_wraparound_turns_shorter_way(bench):
    arm = Arm(bench, gains={"shoulder": {"angle_wraparound": True}})
    bench.states["shoulder/position"].value = 3.0
    bench.commands["shoulder/position"].value = 3.0
    arm.controller.on_activate()
    goal = arm.send_goal(trajectory((1.0, [-3.0, 0.0])))
    await arm.run(0.5)
    assert arm.command("shoulder") == pytest.approx(-pi)
    await arm.run(0.6)
    assert goal.status == SUCCEEDED


async def test_points_are_commanded_when_due_without_interpolation(bench):
    arm = Arm(bench, interpolation_method="none")
    arm.publish(trajectory((1.0, [1.0, 1.0]), (2.0, [2.0, 2.0])))
    await arm.run(0.9)
    assert arm.command("shoulder") == 0.0
    await arm.run(0.2)
    assert arm.command("shoulder") == 2.0


async def test_ended_trajectory_is_dropped_after_cmd_timeout(bench):
    arm = Arm(bench, cmd_timeout=0.5)
    arm.stuck.update(JOINTS)
    arm.publish(trajectory((0.5, [1.0, 1.0])))
    await arm.run(0.9)
    assert arm.command("shoulder") == 1.0
    await arm.run(0.2)
    assert "Aborted due to command timeout" in arm.log_texts()
    assert arm.command("shoulder") == 0.0


async def test_cmd_timeout_below_goal_time_is_ignored_with_warning(bench):
    arm = Arm(bench, cmd_timeout=0.5, constraints={"goal_time": 0.6})
    assert "Command timeout must be higher than goal_time tolerance (0.500000 vs. 0.600000)" in arm.log_texts()


async def test_state_is_published_each_update_or_at_set_rate(bench):
    arm = Arm(bench, state_publish_rate=20.0)
    new, old = (
        bench.record("control_msgs/msg/JointTrajectoryControllerState", f"/controller/{topic}")
        for topic in ("controller_state", "state")
    )
    arm.publish(trajectory((1.0, [1.0, 1.0])))
    await arm.run(0.5)
    assert len(new) == len(old) == 10
    message = new[-1]
    assert message.joint_names == list(JOINTS)
    assert message.reference.positions[0] == pytest.approx(0.45)
    assert (message.desired, message.actual) == (message.reference, message.feedback)
    assert message.output.positions[0] == pytest.approx(0.46)
    assert message.error.positions[0] == message.reference.positions[0] - message.feedback.positions[0]


async def test_errors_of_held_joints_are_computed_only_for_subscribers(bench, monkeypatch):
    compare, comparisons = JointTrajectoryController._compute_error, []
    monkeypatch.setattr(
        JointTrajectoryController,
        "_compute_error",
        lambda self, target: comparisons.append(target) or compare(self, target),
    )
    arm = Arm(bench)
    await arm.run(0.1)
    assert comparisons == []
    states = bench.record("control_msgs/msg/JointTrajectoryControllerState", "/controller/controller_state")
    await arm.run(0.02)
    assert len(states) == len(comparisons) == 2
    assert list(states[-1].error.positions) == [0.0, 0.0]


async def test_query_state_returns_state_at_time(bench):
    arm = Arm(bench)
    query = get_service("control_msgs/srv/QueryTrajectoryState")
    client = bench.node.create_client(query, "/controller/query_state")

    async def query_state(seconds: float) -> Any:
        future = client.call_async(query.Request(time=Time.from_nanoseconds(round(seconds * SECOND_NS))))
        await arm.run(0.01)
        return future.result()

    arm.publish(trajectory((1.0, [1.0, 0.0])))
    await arm.run(0.1)
    response = await query_state(0.51)
    assert (response.success, response.name) == (True, list(JOINTS))
    assert response.position[0] == pytest.approx(0.5)
    assert response.velocity[0] == pytest.approx(1.0)
    for seconds, text in (
        (0.001, "Requested sample time is earlier than the current trajectory start time."),
        (9.0, "Requested sample time precedes the current trajectory end time."),
    ):
        response = await query_state(seconds)
        assert (response.success, response.message) == (False, text)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"joints": []}, "Parameter 'joints' cannot be empty"),
        ({"command_interfaces": ["torque"]}, "'torque' is not one of"),
        ({"command_interfaces": ["velocity", "effort"]}, "'velocity' command interface can be used either alone"),
        ({"command_interfaces": ["position", "acceleration"]}, "'acceleration' command interface can only be used"),
        ({"command_interfaces": ["position", "effort"]}, "'effort' command interface has to be used alone"),
        ({"state_interfaces": ["velocity"]}, "'velocity' state interface cannot be used"),
        ({"state_interfaces": ["position", "acceleration"]}, "'acceleration' state interface cannot be used"),
        ({"interpolation_method": "linear"}, "'linear' is not one of"),
    ],
)
async def test_invalid_parameters_are_rejected(bench, parameters, message):
    with pytest.raises(LinkwrightError, match=message):
        bench.make(JointTrajectoryController, **{**POSITION_PARAMETERS, **parameters})


@pytest.mark.parametrize("kind", ["velocity", "effort"])
async def test_pid_commands_require_position_and_velocity_states(bench, kind):
    parameters = {"joints": ["hip"], "command_interfaces": [kind], "state_interfaces": ["position"]}
    with pytest.raises(ControllerError, match=f"'{kind}' command interface can only be used alone if"):
        bench.make(JointTrajectoryController, **parameters).on_configure()


async def test_activation_fails_without_known_positions(bench):
    bench.joint("hip", commands=("position",), position=nan)
    parameters = {"joints": ["hip"], "command_interfaces": ["position"], "state_interfaces": ["position"]}
    with pytest.raises(ControllerError, match="not known yet"):
        bench.start(JointTrajectoryController, **parameters)


async def test_unknown_velocity_state_counts_as_zero(bench):
    arm = Arm(bench)
    bench.states["shoulder/velocity"].value = nan
    arm.publish(trajectory((1.0, [1.0, 1.0], [0.0, 0.0])))
    await arm.run(0.5)
    assert arm.command("shoulder") == pytest.approx(0.5)
    await arm.run(0.6)
    assert arm.command("shoulder") == 1.0


async def test_command_joints_can_differ_from_state_joints(bench):
    bench.joint("hip", position=0.0)
    bench.joint("motor", commands=("position",))
    parameters = {"joints": ["hip"], "command_interfaces": ["position"], "state_interfaces": ["position"]}
    controller = bench.start(JointTrajectoryController, command_joints=["motor"], **parameters)
    await run(bench, controller, 0.02)
    assert bench.commands["motor/position"].value == 0.0


async def test_time_reset_holds_joints(bench):
    arm = Arm(bench)
    arm.publish(trajectory((1.0, [1.0, 1.0])))
    await arm.run(0.5)
    bench.time_ns = 0
    await arm.run(0.1)
    assert arm.command("shoulder") == pytest.approx(0.5)


async def test_controller_can_be_configured_again_after_cleanup(bench):
    arm = Arm(bench)
    arm.controller.on_deactivate()
    arm.controller.on_cleanup()
    await bench.graph.settle()
    bench.activate(arm.controller)
    goal = arm.send_goal(trajectory((0.1, [1.0, 1.0])))
    await arm.run(0.2)
    assert goal.status == SUCCEEDED
