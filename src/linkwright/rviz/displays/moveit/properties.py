"""The properties shared by MoveIt's displays, with the names and defaults of moveit_rviz_plugin."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.schema import Path, PropertySpec, alpha
from linkwright.rviz.displays.moveit.robot import Look, PosableRobot
from linkwright.rviz.displays.moveit.solids import Color
from linkwright.rviz.displays.moveit.voxels import VOXEL_COLORING, VOXEL_RENDERING

DESCRIPTION = "Robot Description"
NAMESPACE = "Move Group Namespace"
GEOMETRY = "Scene Geometry"
ROBOT = "Scene Robot"
PATH = "Planned Path"
LINKS = "Links"
ALL_LINKS = "All Links Enabled"

SCENE_TOPIC = "Planning Scene Topic"
TRAJECTORY_TOPIC = "Trajectory Topic"


def fraction(name: str, default: float, description: str) -> PropertySpec:
    """Return the declaration of a property with a value from 0 to 1, such as an opacity."""
    return PropertySpec(name, "float", default, description, minimum=0.0, maximum=1.0)


DESCRIPTION_SPEC = PropertySpec(
    DESCRIPTION,
    "string",
    "robot_description",
    "The topic of the robot's description, std_msgs/msg/String.",
)
NAMESPACE_SPEC = PropertySpec(
    NAMESPACE, "string", "", "The namespace of the description and of move_group, which gives the full scene."
)
SCENE_TOPIC_SPEC = PropertySpec(
    SCENE_TOPIC,
    "topic",
    "/monitored_planning_scene",
    "The topic of planning scenes and their changes.",
    messages=("moveit_msgs/msg/PlanningScene",),
)
GEOMETRY_SPEC = PropertySpec(
    GEOMETRY,
    "group",
    description="The objects around the robot.",
    children=(
        PropertySpec("Scene Name", "string", "(noname)", "The name of the scene.", read_only=True),
        PropertySpec("Show Scene Geometry", "bool", True, "Draw the objects and the octomap."),
        fraction("Scene Alpha", 0.9, "Opacity of objects that have no colour, and of the octomap."),
        PropertySpec("Scene Color", "color", "#32e632", "Colour of objects that have no colour."),
        VOXEL_RENDERING,
        VOXEL_COLORING,
        PropertySpec(
            "Scene Display Time", "float", 0.01, "The minimum time between updates, in seconds.", minimum=0.0001
        ),
    ),
)
ATTACHED = PropertySpec("Attached Body Color", "color", "#963296", "Colour of attached bodies that have no colour.")


def visibility(visual: str, collision: str) -> tuple[PropertySpec, ...]:
    """Return the declarations of the check boxes for the visuals and the collisions of links."""
    return (
        PropertySpec(visual, "bool", True, "Draw the visual geometry."),
        PropertySpec(collision, "bool", False, "Draw the collision geometry."),
    )


SHOWN = visibility("Show Robot Visual", "Show Robot Collision")


def scene_robot_spec(links: Sequence[str]) -> PropertySpec:
    """Return the declaration of the property group ``Scene Robot``."""
    return PropertySpec(
        ROBOT,
        "group",
        description="The robot, in the state of the scene.",
        children=(*SHOWN, fraction("Robot Alpha", 1.0, "Opacity of the robot."), ATTACHED, links_spec(links)),
    )


def path_specs(links: Sequence[str]) -> tuple[PropertySpec, ...]:
    """Return the declarations of the properties that control how a motion is played."""
    return (
        PropertySpec(
            TRAJECTORY_TOPIC,
            "topic",
            "/display_planned_path",
            "The topic of motions.",
            messages=("moveit_msgs/msg/DisplayTrajectory",),
        ),
        *SHOWN,
        fraction("Robot Alpha", 0.5, "Opacity of the robot that moves."),
        PropertySpec(
            "State Display Time",
            "string",
            "3x",
            "How long each state is shown: seconds, such as 0.05s; a factor of the motion's speed, such as 3x; "
            "or REALTIME.",
        ),
        PropertySpec("Loop Animation", "bool", False, "Restart at the end."),
        PropertySpec("Show Trail", "bool", False, "Draw the robot in all its states."),
        PropertySpec("Trail Step Size", "int", 1, "Draw every n-th state of the trail.", minimum=1),
        PropertySpec(
            "Interrupt Display", "bool", False, "Show a new motion without waiting for the end of the previous one."
        ),
        PropertySpec("Robot Color", "color", "#963296", "Colour of the robot that moves."),
        PropertySpec("Color Enabled", "bool", False, "Draw the robot that moves in that colour."),
        links_spec(links),
    )


def links_spec(links: Sequence[str]) -> PropertySpec:
    """Return the declaration of the group with the check boxes of the links that have shapes."""
    boxes = tuple(
        PropertySpec(name, "bool", True, "Draw this link.", children=(alpha("Opacity of this link."),))
        for name in links
        if name != ALL_LINKS
    )
    every = PropertySpec(ALL_LINKS, "bool", True, "Enable or disable all links.")
    return PropertySpec(LINKS, "group", description="The links of the robot.", children=(every, *boxes))


def rgb(text: str) -> tuple[float, float, float]:
    """Return the RGB components, 0 to 1, of a colour such as ``#32e632``."""
    red, green, blue = (int(text[start : start + 2], 16) / 255.0 for start in (1, 3, 5))
    return red, green, blue


def rgba(message: object) -> Color:
    """Return the red, green, blue and alpha components of a std_msgs/msg/ColorRGBA."""
    parts = (getattr(message, part) for part in "rgba")
    red, green, blue, opacity = (min(max(float(part), 0.0), 1.0) for part in parts)
    return red, green, blue, opacity


def link_alphas(properties: PropertyStore, robot: PosableRobot, above: Path = ()) -> dict[str, float]:
    """Return the opacity of each link by name; 0 for links whose check box is off."""
    found = {}
    for name in robot.shaped_links:
        if name != ALL_LINKS:
            path = (*above, LINKS, name)
            found[name] = properties.number(*path, "Alpha") if properties.flag(*path) else 0.0
    return found


def look(
    properties: PropertyStore, robot: PosableRobot, namespace: str, above: Path = (), color: str | None = None
) -> Look:
    """Return the appearance of a robot that the properties below a path describe.

    Args:
        properties: the display's properties.
        robot: the robot whose links have check boxes.
        namespace: the markers' namespace.
        above: the path of the group that contains the properties.
        color: the colour of all links, such as ``#963296``; None to use the links' own colours.
    """
    return Look(
        namespace,
        visual=properties.flag(*above, "Show Robot Visual"),
        collision=properties.flag(*above, "Show Robot Collision"),
        alpha=properties.number(*above, "Robot Alpha"),
        alphas=link_alphas(properties, robot, above),
        color=None if color is None else rgb(color),
    )
