from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.learning import NotYet, ShapeSpec, check

XACRO = "urdf/mbot_base.xacro"
WHEELS = {"left": 0.19, "right": -0.19}
CASTERS = {"front": 0.18, "back": -0.18}


def package(work):
    return work.package("my_robot_description")


def robot_with(work, name, value):
    return package(work).robot_with_property(XACRO, name, value)


def expect_wheels(robot, *, radius=0.06, length=0.025):
    for side, y in WHEELS.items():
        joint = robot.joint(f"{side}_wheel_joint")
        joint.expect_type("continuous")
        joint.expect_axis((0, 1, 0))
        robot.expect_position(f"{side}_wheel_link", (0, y, -0.05), frame="base_link")
        shape = ShapeSpec(Cylinder(radius, length), along=(0, 1, 0))
        robot.link(f"{side}_wheel_link").expect_shape(shape)


def expect_casters(robot, *, height=-0.095, radius=0.015):
    for side, x in CASTERS.items():
        robot.joint(f"{side}_caster_joint").expect_type("continuous")
        robot.expect_position(f"{side}_caster_link", (x, 0, height), frame="base_link")
        robot.link(f"{side}_caster_link").expect_shape(ShapeSpec(Sphere(radius)))


def expect_mbot(robot):
    robot.link("base_link").expect_shape(ShapeSpec(Cylinder(0.20, 0.16), along=(0, 0, 1)))
    expect_wheels(robot)
    expect_casters(robot)
    robot.link("camera_link").expect_shape(ShapeSpec(Box((0.03, 0.04, 0.04))))


@check("properties", en="mbot_base.xacro describes the same robot.", zh="mbot_base.xacro 描述同样的机器人。")
def is_same_robot(work):
    expect_mbot(package(work).robot(XACRO))


@check(
    "properties",
    en="Both wheels use wheel_radius and wheel_length.",
    zh="两个轮子都使用 wheel_radius 和 wheel_length。",
)
def wheels_use_properties(work):
    robot = robot_with(work, "wheel_radius", "0.1")
    expect_wheels(robot, radius=0.1)
    robot = robot_with(work, "wheel_length", "0.04")
    expect_wheels(robot, length=0.04)


@check("properties", en="Both casters use caster_radius.", zh="两个万向轮都使用 caster_radius。")
def casters_use_property(work):
    robot = robot_with(work, "caster_radius", "0.02")
    for side in CASTERS:
        robot.link(f"{side}_caster_link").expect_shape(ShapeSpec(Sphere(0.02)))


@check("properties", en="The body uses base_radius and base_length.", zh="机身使用 base_radius 和 base_length。")
def body_uses_properties(work):
    robot = robot_with(work, "base_radius", "0.3")
    robot.link("base_link").expect_shape(ShapeSpec(Cylinder(0.3, 0.16)))
    robot = robot_with(work, "base_length", "0.2")
    robot.link("base_link").expect_shape(ShapeSpec(Cylinder(0.2, 0.2)))


def expect_written_once(work, part, zh):
    """Require one link in the source for both parts of a kind."""
    links = package(work).source_elements(XACRO, "link")
    written = [link for link in links if part in link.attributes.get("name", "")]
    if len(written) > 1:
        raise NotYet(
            en=f"The source has {len(written)} links for the {part}s; a macro needs one.",
            zh=f"源文件中为{zh}写了 {len(written)} 个连杆；用宏只需要一个。",
        )


@check("macro", en="The wheels are the same as before.", zh="轮子与之前相同。")
def wheels_are_same(work):
    expect_mbot(package(work).robot(XACRO))


@check("macro", en="The source describes a wheel only once.", zh="源文件只描述一次轮子。")
def wheel_is_macro(work):
    expect_written_once(work, "wheel", "轮子")


@check("arithmetic", en="The casters are the same as before.", zh="万向轮与之前相同。")
def casters_are_same(work):
    expect_mbot(package(work).robot(XACRO))


@check("arithmetic", en="The source describes a caster only once.", zh="源文件只描述一次万向轮。")
def caster_is_macro(work):
    expect_written_once(work, "caster", "万向轮")


@check("arithmetic", en="The casters touch the body, whatever its size.", zh="无论机身多大，万向轮都与机身相接。")
def casters_touch_body(work):
    robot = robot_with(work, "base_length", "0.3")
    expect_casters(robot, height=-0.165)
    robot = robot_with(work, "caster_radius", "0.03")
    expect_casters(robot, height=-0.11, radius=0.03)


@check("footprint", en="The tree of links begins with base_footprint.", zh="连杆树从 base_footprint 开始。")
def footprint_is_root(work):
    robot = package(work).robot(XACRO)
    footprint = robot.link("base_footprint").link
    root = robot.robot.root
    if root != "base_footprint":
        raise NotYet(
            en=f"The root of the tree is '{root}': base_footprint must be the parent of base_link, not its child.",
            zh=f"树的根是“{root}”：base_footprint 应当是 base_link 的 parent，而不是它的 child。",
        )
    joint = next(joint for joint in robot.robot.joints.values() if joint.child == "base_link")
    robot.joint(joint.name).expect_type("fixed")
    if footprint.visuals or footprint.collisions:
        raise NotYet(
            en="base_footprint is a point on the ground: leave it without <visual> and <collision>.",
            zh="base_footprint 是地面上的一个点：不要给它 <visual> 和 <collision>。",
        )


@check("footprint", en="base_link is 0.11 m above it.", zh="base_link 在它上方 0.11 m。")
def body_is_above_ground(work):
    package(work).robot(XACRO).expect_position("base_link", (0, 0, 0.11), frame="base_footprint")


@check("footprint", en="The wheels stand on the ground, whatever their radius.", zh="无论半径多大，轮子都站在地面上。")
def wheels_stand_on_ground(work):
    robot = robot_with(work, "wheel_radius", "0.1")
    robot.expect_position("base_link", (0, 0, 0.15), frame="base_footprint")


@check("argument", en="Without an argument, the robot has a camera.", zh="不给参数时，机器人有相机。")
def has_camera_by_default(work):
    package(work).robot(XACRO).link("camera_link")


@check("argument", en="With camera:=false, the robot has none.", zh="camera:=false 时，机器人没有相机。")
def camera_can_be_left_out(work):
    robot = package(work).robot(XACRO, camera="false").robot
    for kind, names in (("link", robot.links), ("joint", robot.joints)):
        if f"camera_{kind}" in names:
            raise NotYet(
                en=f"With camera:=false, the robot still has 'camera_{kind}'.",
                zh=f"camera:=false 时，机器人仍有“camera_{kind}”。",
            )


@check(
    "include",
    en="parts.xacro contains the macros, and mbot_base.xacro none.",
    zh="宏在 parts.xacro 中，不在 mbot_base.xacro 中。",
)
def macros_are_in_parts(work):
    package(work).file("urdf/parts.xacro")
    macros = package(work).source_elements(XACRO, "xacro:macro")
    files = {macro.source.name.replace("\\", "/").rsplit("/", 1)[-1] for macro in macros}
    if "parts.xacro" not in files:
        raise NotYet(en="mbot_base.xacro does not include parts.xacro.", zh="mbot_base.xacro 没有包含 parts.xacro。")
    if "mbot_base.xacro" in files:
        raise NotYet(en="mbot_base.xacro still contains a macro.", zh="mbot_base.xacro 中仍有宏。")


@check("include", en="The robot is the same as before.", zh="机器人与之前相同。")
def robot_is_same(work):
    expect_mbot(package(work).robot(XACRO))
