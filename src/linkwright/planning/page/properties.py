"""The properties of the MotionPlanning display, with the names and defaults of moveit_rviz_plugin.

The settings that RViz's panel shows are hidden properties, which have a value in the file but no row.
"""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.page.protocol.motion_planning import PlanningSettings
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.schema import PropertySpec, Schema
from linkwright.rviz.displays.moveit.properties import fraction_spec

REQUEST = "Planning Request"
GROUP = "Planning Group"
COLLIDING_COLOR = "Colliding Link Color"
VIOLATION_COLOR = "Joint Violation Color"
MARKER_SIZE = "Interactive Marker Size"
SHOW_WORKSPACE = "Show Workspace"

WORKSPACE = "MoveIt_Workspace"
PLANNING_TIME = "MoveIt_Planning_Time"
ATTEMPTS = "MoveIt_Planning_Attempts"
VELOCITY_SCALING = "Velocity_Scaling_Factor"
ACCELERATION_SCALING = "Acceleration_Scaling_Factor"
CARTESIAN = "MoveIt_Use_Cartesian_Path"
COLLISION_AWARE = "MoveIt_Use_Constraint_Aware_IK"
APPROXIMATE = "MoveIt_Allow_Approximate_IK"


def request_spec(groups: Sequence[str]) -> PropertySpec:
    """Return the declaration of the property group ``Planning Request``.

    Args:
        groups: the names of the planning groups, which the page offers.
    """
    return PropertySpec(
        REQUEST,
        "group",
        description="The group to plan for, and its start and goal states.",
        children=(
            PropertySpec(GROUP, "string", "", "The group of joints to plan for.", options=tuple(groups)),
            PropertySpec(SHOW_WORKSPACE, "bool", False, "Draw the box in which motions are planned."),
            PropertySpec("Query Start State", "bool", False, "Draw the start state."),
            PropertySpec("Query Goal State", "bool", True, "Draw the goal state."),
            PropertySpec(
                MARKER_SIZE,
                "float",
                0.0,
                "The size of the handles, in meters; 0 for a size that suits the arm.",
                minimum=0.0,
            ),
            PropertySpec("Start State Color", "color", "#00ff00", "Color of the start state."),
            fraction_spec("Start State Alpha", 1.0, "Opacity of the start state."),
            PropertySpec("Goal State Color", "color", "#fa8000", "Color of the goal state."),
            fraction_spec("Goal State Alpha", 1.0, "Opacity of the goal state."),
            PropertySpec(COLLIDING_COLOR, "color", "#ff0000", "Color of links that collide."),
            PropertySpec(VIOLATION_COLOR, "color", "#ff00ff", "Color of links whose joint exceeds its limits."),
        ),
    )


def _vector(name: str, default: float) -> PropertySpec:
    return PropertySpec(
        name, "group", hidden=True, children=tuple(PropertySpec(axis, "float", default, hidden=True) for axis in "XYZ")
    )


HIDDEN_SPECS: Schema = (
    PropertySpec(PLANNING_TIME, "float", 5.0, hidden=True, minimum=0.1, maximum=1000.0),
    PropertySpec(ATTEMPTS, "int", 10, hidden=True, minimum=1, maximum=1000),
    PropertySpec(VELOCITY_SCALING, "float", 0.1, hidden=True, minimum=0.01, maximum=1.0),
    PropertySpec(ACCELERATION_SCALING, "float", 0.1, hidden=True, minimum=0.01, maximum=1.0),
    PropertySpec(CARTESIAN, "bool", False, hidden=True),
    PropertySpec(COLLISION_AWARE, "bool", True, hidden=True),
    PropertySpec(APPROXIMATE, "bool", False, hidden=True),
    PropertySpec(WORKSPACE, "group", hidden=True, children=(_vector("Center", 0.0), _vector("Size", 2.0))),
)


def read_settings(properties: PropertyStore) -> PlanningSettings:
    """Return the values of the settings."""
    return PlanningSettings(
        planning_time=properties.number(PLANNING_TIME),
        attempts=int(properties.number(ATTEMPTS)),
        velocity_scaling=properties.number(VELOCITY_SCALING),
        acceleration_scaling=properties.number(ACCELERATION_SCALING),
        cartesian=properties.flag(CARTESIAN),
        collision_aware=properties.flag(COLLISION_AWARE),
        approximate=properties.flag(APPROXIMATE),
    )


def read_workspace(properties: PropertyStore) -> tuple[list[float], list[float]]:
    """Return the center and the size of the workspace, each as x, y, z in meters."""
    center, size = ([properties.number(WORKSPACE, part, axis) for axis in "XYZ"] for part in ("Center", "Size"))
    return center, size
