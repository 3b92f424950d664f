"""Messages of Autoware for tests: a trajectory, objects on a street, and reasons to stop."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from linkwright.messages import get_message


def make(name: str, **fields: Any) -> Any:
    """Return a message of a type such as ``autoware_planning_msgs/Path``."""
    package, _, kind = name.partition("/")
    return get_message(f"{package}/msg/{kind}")(**fields)


def stamped(name: str, frame: str = "base", **fields: Any) -> Any:
    """Return a message with a header."""
    message = make(name, **fields)
    message.header.frame_id = frame
    return message


def place(pose: Any, x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> Any:
    """Set a pose, and return it."""
    pose.position.x, pose.position.y, pose.position.z = float(x), float(y), float(z)
    pose.orientation.z, pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return pose


def make_points(kind: str, count: int = 21) -> list[Any]:
    """Return the points of a quarter of a circle of 10 m about y = 10, with velocities from 0 to 4 m/s."""
    points = []
    for angle, velocity in zip(np.linspace(0, math.pi / 2, count), np.linspace(0, 4, count), strict=True):
        point = make(f"autoware_planning_msgs/{kind}", longitudinal_velocity_mps=float(velocity))
        place(point.pose, 10 * math.sin(angle), 10 - 10 * math.cos(angle), 0.0, angle)
        points.append(point)
    return points


def make_trajectory() -> Any:
    """Return the quarter of a circle as a trajectory."""
    return stamped("autoware_planning_msgs/Trajectory", points=make_points("TrajectoryPoint"))


def make_path() -> Any:
    """Return the quarter of a circle as a path, with bounds of two points."""
    message = stamped("autoware_planning_msgs/Path", points=make_points("PathPoint"))
    message.left_bound = [make("geometry_msgs/Point", x=float(x), y=2.0) for x in (0, 5)]
    message.right_bound = [make("geometry_msgs/Point", x=float(x), y=-2.0) for x in (0, 5)]
    return message


def make_factors() -> Any:
    """Return a stop at a crosswalk, 5 m ahead to the left, and a point that is not safe."""
    point = make("autoware_internal_planning_msgs/ControlPoint")
    place(point.pose, 5.0, 1.0, 0.0, math.pi / 2)
    safety = make(
        "autoware_internal_planning_msgs/SafetyFactor",
        points=[make("geometry_msgs/Point", x=8.0, y=-3.0)],
        is_safe=False,
    )
    factor = make(
        "autoware_internal_planning_msgs/PlanningFactor",
        module="crosswalk",
        detail="pedestrian",
        behavior=3,
        is_driving_forward=True,
        control_points=[point],
    )
    factor.safety_factors.factors = [safety]
    return stamped("autoware_internal_planning_msgs/PlanningFactorArray", factors=[factor])


def fill_object(each: Any, label: int, x: float, y: float, yaw: float = 0.0, prefix: str = "") -> Any:
    """Set the class, place, velocity and uncertainty of an object, which is a box of 4 x 2 x 1.5 m, and return it."""
    each.existence_probability = 0.9
    each.classification = [
        make("autoware_perception_msgs/ObjectClassification", label=0, probability=0.2),
        make("autoware_perception_msgs/ObjectClassification", label=label, probability=0.8),
    ]
    pose = getattr(each.kinematics, f"{prefix}pose_with_covariance")
    place(pose.pose, x, y, 0.75, yaw)
    covariance = np.zeros((6, 6))
    covariance[0, 0], covariance[1, 1], covariance[5, 5] = 0.25, 0.04, 0.01
    pose.covariance = covariance.reshape(-1)
    twist = getattr(each.kinematics, f"{prefix}twist_with_covariance")
    twist.twist.linear.x, twist.twist.angular.z = 3.0, 0.5
    twist.covariance = covariance.reshape(-1)
    each.shape.dimensions.x, each.shape.dimensions.y, each.shape.dimensions.z = 4.0, 2.0, 1.5
    return each


def make_detected() -> Any:
    """Return a car with a heading, a pedestrian as a cylinder, and a polygon."""
    car, pedestrian, block = (make("autoware_perception_msgs/DetectedObject") for _ in range(3))
    fill_object(car, 1, 0.0, 5.0).kinematics.orientation_availability = 2
    fill_object(pedestrian, 7, 4.0, 5.0).shape.type = 1
    pedestrian.shape.dimensions.x = 0.8
    fill_object(block, 0, 8.0, 5.0).shape.type = 2
    corners = [(-1, -1), (1, -1), (1.5, 1), (-1, 1)]
    block.shape.footprint.points = [make("geometry_msgs/Point32", x=float(x), y=float(y)) for x, y in corners]
    return stamped("autoware_perception_msgs/DetectedObjects", objects=[car, pedestrian, block])


def make_tracked() -> Any:
    """Return a truck that moves and a bus that stands."""
    truck, bus = (make("autoware_perception_msgs/TrackedObject") for _ in range(2))
    fill_object(truck, 2, 0.0, -5.0, 0.3).object_id.uuid = np.arange(16, dtype=np.uint8)
    truck.kinematics.acceleration_with_covariance.accel.linear.x = 1.0
    fill_object(bus, 3, 6.0, -5.0).kinematics.is_stationary = True
    return stamped("autoware_perception_msgs/TrackedObjects", objects=[truck, bus])


def make_predicted() -> Any:
    """Return a car with two predicted paths."""
    car = fill_object(make("autoware_perception_msgs/PredictedObject"), 1, 0.0, -10.0, prefix="initial_")
    car.object_id.uuid = np.full(16, 171, dtype=np.uint8)
    for turn, confidence in ((0.0, 0.7), (0.2, 0.3)):
        poses = [place(make("geometry_msgs/Pose"), 2 * i, -10 + turn * i * i, 0.75, turn * i) for i in range(6)]
        path = make("autoware_perception_msgs/PredictedPath", path=poses, confidence=confidence)
        car.kinematics.predicted_paths = [*car.kinematics.predicted_paths, path]
    return stamped("autoware_perception_msgs/PredictedObjects", objects=[car])
