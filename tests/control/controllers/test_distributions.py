"""Parameters of controllers.

The current distribution's are declared, and those of Humble and Jazzy are read.
"""

from __future__ import annotations

import pytest

from linkwright.control.controllers.registry import controller_class

DRIVE_PARAMETERS = {
    "left_wheel_names": ["left"],
    "right_wheel_names": ["right"],
    "wheel_separation": 0.4,
    "wheel_radius": 0.1,
}
ARM_PARAMETERS = {"joints": ["hip"], "command_interfaces": ["position"], "state_interfaces": ["position"]}
DRIVE_TYPE = "diff_drive_controller/DiffDriveController"
TRAJECTORY_TYPE = "joint_trajectory_controller/JointTrajectoryController"
CAR_TYPE = "ackermann_steering_controller/AckermannSteeringController"


def parameter_names(controller) -> set[str]:
    """Return the names of a controller's parameters."""
    return set(controller.node.graph_node.parameter_names())


@pytest.mark.parametrize(
    ("kind", "parameters", "humble", "jazzy"),
    [
        (
            DRIVE_TYPE,
            DRIVE_PARAMETERS,
            {"linear.x.has_velocity_limits", "use_stamped_vel"},
            {"linear.x.max_deceleration"},
        ),
        (
            TRAJECTORY_TYPE,
            ARM_PARAMETERS,
            {"open_loop_control", "gains.hip.angle_wraparound"},
            {"interpolate_from_desired_state"},
        ),
        (CAR_TYPE, {}, {"front_steering", "front_wheels_radius"}, {"traction_joints_names", "traction_wheels_radius"}),
    ],
    ids=["drive", "trajectory", "car"],
)
async def test_declared_parameters_match_distribution(bench, monkeypatch, kind, parameters, humble, jazzy):
    names_by_distribution = {}
    for distribution in ("", "humble", "jazzy"):
        monkeypatch.setenv("ROS_DISTRO", distribution)
        names_by_distribution[distribution] = parameter_names(
            bench.make(controller_class(kind), f"it_{distribution}", **parameters)
        )
    assert names_by_distribution[""] == names_by_distribution["humble"]
    assert names_by_distribution["humble"] >= humble
    assert not names_by_distribution["humble"] & jazzy
    assert names_by_distribution["jazzy"] >= jazzy
    assert not names_by_distribution["jazzy"] & humble


@pytest.mark.parametrize(("distribution", "allowed"), [("humble", True), ("jazzy", False)])
async def test_default_matches_distribution(bench, monkeypatch, distribution, allowed):
    monkeypatch.setenv("ROS_DISTRO", distribution)
    controller = bench.make(controller_class(TRAJECTORY_TYPE), **ARM_PARAMETERS)
    assert controller.parameters.allow_nonzero_velocity_at_trajectory_end is allowed
    controller = bench.make(
        controller_class(TRAJECTORY_TYPE), "given", allow_nonzero_velocity_at_trajectory_end=True, **ARM_PARAMETERS
    )
    assert controller.parameters.allow_nonzero_velocity_at_trajectory_end


@pytest.mark.parametrize("distribution", ["humble", "jazzy"])
async def test_parameters_of_other_distribution_are_accepted(bench, monkeypatch, log, distribution):
    monkeypatch.setenv("ROS_DISTRO", distribution)
    limits = {"linear": {"x": {"has_velocity_limits": True, "max_velocity": 1.0, "max_deceleration": -2.0}}}
    controller = bench.make(controller_class(DRIVE_TYPE), **DRIVE_PARAMETERS, **limits)
    axis = controller.parameters.linear.x
    assert (axis.has_velocity_limits, axis.max_deceleration) == (True, -2.0)
    assert {"linear.x.has_velocity_limits", "linear.x.max_deceleration"} <= parameter_names(controller)
    assert "angular.z.has_velocity_limits" in parameter_names(controller) or distribution == "jazzy"
    assert not [record.text for record in log if "is not a parameter" in str(record.text)]
