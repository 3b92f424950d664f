"""mbot as a simulator needs it.

The tests cover mbot_gazebo.xacro with every choice of sensors, for both Gazebos.
"""

from __future__ import annotations

import itertools

import pytest

from linkwright.descriptions import load
from linkwright.kinematics import KinematicTree
from linkwright.lint import examine
from linkwright.urdf import Box, Cylinder, Robot, Sphere
from tests.places import PACKAGE

MODEL = PACKAGE / "urdf" / "mbot_gazebo.xacro"
SENSORS = ("camera", "kinect", "laser")
CHOICES = [
    {"simulator": simulator, **dict.fromkeys(chosen, "true")}
    for simulator in ("classic", "gz")
    for count in range(len(SENSORS) + 1)
    for chosen in itertools.combinations(SENSORS, count)
]
LINKS_WITHOUT_MASS = {"base_footprint", "imu_link", "camera_optical_frame", "kinect_optical_frame"}
SINGLE_SENSOR_MODELS = {"camera": "mbot_with_camera.urdf", "kinect": "mbot_with_kinect.urdf", "laser": "mbot_with_laser.urdf"}
"""The model of the tutorial that carries one sensor."""


def choice_name(choice: dict[str, str]) -> str:
    return "-".join([choice["simulator"], *(word for word in choice if word != "simulator")])


@pytest.fixture(params=CHOICES, ids=choice_name)
def choice(request: pytest.FixtureRequest) -> dict[str, str]:
    return request.param


def load_robot(choice: dict[str, str]) -> Robot:
    return load(MODEL, arguments=choice)


def test_model_has_no_findings(choice: dict[str, str]) -> None:
    assert examine(MODEL, arguments=choice).diagnostics == ()


def test_only_bodies_have_mass_collision_and_visual(choice: dict[str, str]) -> None:
    for link in load_robot(choice).links.values():
        bodily = link.name not in LINKS_WITHOUT_MASS
        assert (link.inertial is not None, bool(link.collisions), bool(link.visuals)) == (bodily,) * 3, link.name


def test_wheels_and_casters_touch_ground_at_footprint(choice: dict[str, str]) -> None:
    robot = load_robot(choice)
    heights = {link: low for link, (low, _) in collision_extents(robot).items()}
    for part in ("left_wheel_link", "right_wheel_link", "front_caster_link", "back_caster_link"):
        assert heights[part] == pytest.approx(0.0, abs=1e-12)
    assert min(heights.values()) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("choice", [choice for choice in CHOICES if "laser" in choice], ids=choice_name)
def test_laser_plane_is_above_all_other_parts(choice: dict[str, str]) -> None:
    robot = load_robot(choice)
    plane = height_above_root(robot, "laser_link")
    assert all(high < plane for link, (_, high) in collision_extents(robot).items() if link != "laser_link")


@pytest.mark.parametrize("sensor", SINGLE_SENSOR_MODELS)
def test_single_sensor_is_mounted_as_in_tutorial(sensor: str) -> None:
    link = f"{sensor}_link"
    tutorial_robot, full_robot = load(PACKAGE / "urdf" / SINGLE_SENSOR_MODELS[sensor]), load_robot({sensor: "true"})
    assert full_robot.joints[f"{sensor}_joint"].origin == tutorial_robot.joints[f"{sensor}_joint"].origin
    assert [visual.geometry for visual in full_robot.links[link].visuals] == [
        visual.geometry for visual in tutorial_robot.links[link].visuals
    ]


def test_base_matches_tutorial() -> None:
    base, full_robot = load(PACKAGE / "urdf" / "mbot_base.urdf"), load_robot({})
    for link in base.links.values():
        assert [visual.geometry for visual in full_robot.links[link.name].visuals] == [
            visual.geometry for visual in link.visuals
        ]
        assert [collision.geometry for collision in full_robot.links[link.name].collisions] == [
            visual.geometry for visual in link.visuals
        ]
    for joint in base.joints.values():
        assert full_robot.joints[joint.name].origin == joint.origin


@pytest.mark.parametrize(
    ("simulator", "drive"), [("classic", "libgazebo_ros_diff_drive.so"), ("gz", "gz-sim-diff-drive-system")]
)
def test_diff_drive_parameters_match_wheels(simulator: str, drive: str) -> None:
    plugins = {
        plugin.attributes["filename"]: {child.tag: child.text() for child in plugin.elements()}
        for extension in load_robot({"simulator": simulator}).extensions
        for plugin in extension.elements()
        if plugin.tag == "plugin"
    }
    values = plugins[drive]
    assert (values["left_joint"], values["right_joint"]) == ("left_wheel_joint", "right_wheel_joint")
    assert float(values["wheel_separation"]) == pytest.approx(0.38)
    radius = float(values["wheel_radius"]) if simulator == "gz" else float(values["wheel_diameter"]) / 2
    assert radius == pytest.approx(0.06)


def test_optical_frames_look_along_sensor_x_axis() -> None:
    robot = load_robot({"camera": "true", "kinect": "true"})
    tree = KinematicTree(robot)
    frames = tree.forward({joint: 0.0 for joint in robot.joints if "wheel" in joint or "caster" in joint})
    for sensor in ("camera", "kinect"):
        rotation = frames[tree.link_index(f"{sensor}_optical_frame")][:3, :3]
        assert rotation[:, 2] == pytest.approx([1, 0, 0])  # z points into the image
        assert rotation[:, 0] == pytest.approx([0, -1, 0])  # x points to the right


def height_above_root(robot: Robot, link: str) -> float:
    """Return the height of a link's frame above the footprint in meters.

    The model's fixed joints are not rotated.
    """
    by_child = {joint.child: joint for joint in robot.joints.values()}
    above = 0.0
    while link in by_child:
        above += by_child[link].origin.xyz[2]
        link = by_child[link].parent
    return above


def collision_extents(robot: Robot) -> dict[str, tuple[float, float]]:
    """Return the lowest and the highest point of each link's collision.

    They are above the ground, in meters.
    """
    extents_by_link = {}
    for link in robot.links.values():
        for collision in link.collisions:
            center_height = height_above_root(robot, link.name) + collision.origin.xyz[2]
            lying = abs(collision.origin.rpy[0]) > 1.0
            shape = collision.geometry
            if isinstance(shape, Box):
                half_height = shape.size[2] / 2
            elif isinstance(shape, Sphere) or (isinstance(shape, Cylinder) and lying):
                half_height = shape.radius
            else:
                assert isinstance(shape, Cylinder)
                half_height = shape.length / 2
            extents_by_link[link.name] = (center_height - half_height, center_height + half_height)
    return extents_by_link
