"""The properties of MoveIt's displays, with the names and defaults of moveit_rviz_plugin."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.schema import Path, PropertySpec, alpha
from linkwright.rviz.displays.moveit.robot import Appearance, PosableRobot
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


def fraction_spec(name: str, default: float, description: str) -> PropertySpec:
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
        fraction_spec("Scene Alpha", 0.9, "Opacity of objects that have no color, and of the octomap."),
        PropertySpec("Scene Color", "color", "#32e632", "Color of objects that have no color."),
        VOXEL_RENDERING,
        VOXEL_COLORING,
        PropertySpec(
            "Scene Display Time", "float", 0.01, "The minimum time between updates, in seconds.", minimum=0.0001
        ),
    ),
)
ATTACHED_COLOR_SPEC = PropertySpec(
    "Attached Body Color", "color", "#963296", "Color of attached bodies that have no color."
)


def visibility_specs(visual: str, collision: str) -> tuple[PropertySpec, ...]:
    """Return the declarations of the check boxes for the visuals and the collisions of links."""
    return (
        PropertySpec(visual, "bool", True, "Draw the visual geometry."),
        PropertySpec(collision, "bool", False, "Draw the collision geometry."),
    )


VISIBILITY_SPECS = visibility_specs("Show Robot Visual", "Show Robot Collision")


def scene_robot_spec(links: Sequence[str]) -> PropertySpec:
    """Return the declaration of the property group ``Scene Robot``."""
    return PropertySpec(
        ROBOT,
        "group",
        description="The robot, in the state of the scene.",
        children=(
            *VISIBILITY_SPECS,
            fraction_spec("Robot Alpha", 1.0, "Opacity of the robot."),
            ATTACHED_COLOR_SPEC,
            links_spec(links),
        ),
    )


def path_specs(links: Sequence[str]) -> tuple[PropertySpec, ...]:
    """Return the declarations of the properties for playing motions."""
    return (
        PropertySpec(
            TRAJECTORY_TOPIC,
            "topic",
            "/display_planned_path",
            "The topic of motions.",
            messages=("moveit_msgs/msg/DisplayTrajectory",),
        ),
        *VISIBILITY_SPECS,
        fraction_spec("Robot Alpha", 0.5, "Opacity of the robot that moves."),
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
        PropertySpec("Robot Color", "color", "#963296", "Color of the robot that moves."),
        PropertySpec("Color Enabled", "bool", False, "Draw the robot that moves in that color."),
        links_spec(links),
    )


def links_spec(links: Sequence[str]) -> PropertySpec:
    """Return the declaration of the group with a check box for each of the given links."""
    link_specs = tuple(
        PropertySpec(name, "bool", True, "Draw this link.", children=(alpha("Opacity of this link."),))
        for name in links
        if name != ALL_LINKS
    )
    all_spec = PropertySpec(ALL_LINKS, "bool", True, "Enable or disable all links.")
    return PropertySpec(LINKS, "group", description="The links of the robot.", children=(all_spec, *link_specs))


def parse_rgb(text: str) -> tuple[float, float, float]:
    """Return the RGB components, 0 to 1, of a color such as ``#32e632``."""
    red, green, blue = (int(text[start : start + 2], 16) / 255.0 for start in (1, 3, 5))
    return red, green, blue


def rgba_from_message(message: object) -> Color:
    """Return the red, green, blue and alpha components of a std_msgs/msg/ColorRGBA."""
    components = (getattr(message, part) for part in "rgba")
    red, green, blue, opacity = (min(max(float(part), 0.0), 1.0) for part in components)
    return red, green, blue, opacity


def read_link_alphas(properties: PropertyStore, robot: PosableRobot, group_path: Path = ()) -> dict[str, float]:
    """Return the opacity of each link by name.

    It is 0 if the check box of the link is off.
    """
    alphas = {}
    for name in robot.shaped_links:
        if name != ALL_LINKS:
            path = (*group_path, LINKS, name)
            alphas[name] = properties.number(*path, "Alpha") if properties.flag(*path) else 0.0
    return alphas


def read_appearance(
    properties: PropertyStore, robot: PosableRobot, namespace: str, group_path: Path = (), color: str | None = None
) -> Appearance:
    """Return the appearance of a robot that the properties below a path describe.

    Args:
        properties: the display's properties.
        robot: the robot whose links have check boxes.
        namespace: the markers' namespace.
        group_path: the path of the group that contains the properties.
        color: the color of all links, such as ``#963296``; None to use the colors in the description.
    """
    return Appearance(
        namespace,
        visual=properties.flag(*group_path, "Show Robot Visual"),
        collision=properties.flag(*group_path, "Show Robot Collision"),
        alpha=properties.number(*group_path, "Robot Alpha"),
        alphas=read_link_alphas(properties, robot, group_path),
        color=None if color is None else parse_rgb(color),
    )
