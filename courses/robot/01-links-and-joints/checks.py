from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.learning import NotYet, ShapeSpec, check

WHEEL = ShapeSpec(Cylinder(0.06, 0.025), along=(0, 1, 0), at=(0, 0, 0))


def robot(work):
    return work.package("my_robot_description").robot("urdf/mbot_base.urdf")


@check(
    "package",
    en="The workspace has the package my_robot_description.",
    zh="工作空间中有功能包 my_robot_description。",
)
def has_package(work):
    work.package("my_robot_description").expect_manifest()


@check("body", en="The robot has the link base_link.", zh="机器人有名为 base_link 的连杆。")
def has_base_link(work):
    robot(work).link("base_link")


@check(
    "body",
    en="The body is a cylinder with a radius of 0.20 m and a length of 0.16 m.",
    zh="机身是半径 0.20 m、长度 0.16 m 的圆柱。",
)
def body_is_cylinder(work):
    robot(work).link("base_link").expect_shape(ShapeSpec(Cylinder(0.20, 0.16), along=(0, 0, 1), at=(0, 0, 0)))


def expect_wheel(work, side, y):
    joint = robot(work).joint(f"{side}_wheel_joint")
    joint.expect_links("base_link", f"{side}_wheel_link")
    joint.expect_type("continuous")
    joint.expect_axis((0, 1, 0))
    robot(work).expect_position(f"{side}_wheel_link", (0, y, -0.05), frame="base_link")


@check(
    "left-wheel",
    en="left_wheel_joint turns the wheel about the y axis, 0.19 m to the left of the body's middle.",
    zh="left_wheel_joint 让轮子绕 y 轴转动，位于机身中心左侧 0.19 m。",
)
def left_wheel_turns(work):
    expect_wheel(work, "left", 0.19)


@check(
    "left-wheel",
    en="The wheel is a cylinder that lies on its side, with a radius of 0.06 m and a length of 0.025 m.",
    zh="轮子是侧躺的圆柱，半径 0.06 m，长度 0.025 m。",
)
def left_wheel_lies(work):
    robot(work).link("left_wheel_link").expect_shape(WHEEL)


@check(
    "right-wheel",
    en="right_wheel_joint turns the right wheel about the same axis, on the other side.",
    zh="right_wheel_joint 让右轮绕同一方向的轴转动，位于另一侧。",
)
def right_wheel_turns(work):
    expect_wheel(work, "right", -0.19)


@check("right-wheel", en="The right wheel is as large as the left one.", zh="右轮与左轮一样大。")
def right_wheel_lies(work):
    robot(work).link("right_wheel_link").expect_shape(WHEEL)


def expect_caster(work, side, x):
    robot(work).expect_position(f"{side}_caster_link", (x, 0, -0.095), frame="base_link")
    robot(work).link(f"{side}_caster_link").expect_shape(ShapeSpec(Sphere(0.015)))


@check("casters", en="A sphere at the front is the first caster.", zh="前部的小球是第一个万向轮。")
def has_front_caster(work):
    expect_caster(work, "front", 0.18)


@check("casters", en="A sphere at the back is the second caster.", zh="后部的小球是第二个万向轮。")
def has_back_caster(work):
    expect_caster(work, "back", -0.18)


@check("camera", en="camera_joint fixes the camera to the body.", zh="camera_joint 把相机固定在机身上。")
def camera_is_fixed(work):
    joint = robot(work).joint("camera_joint")
    joint.expect_type("fixed")
    joint.expect_links("base_link", "camera_link")


@check(
    "camera",
    en="The camera is 0.17 m before and 0.10 m above base_link.",
    zh="相机在 base_link 前方 0.17 m、上方 0.10 m。",
)
def camera_is_in_front(work):
    robot(work).expect_position("camera_link", (0.17, 0, 0.10), frame="base_link")
    robot(work).expect_direction("camera_link", (1, 0, 0), (1, 0, 0), frame="base_link")


@check("camera", en="The camera is a box of 0.03 m × 0.04 m × 0.04 m.", zh="相机是 0.03 m × 0.04 m × 0.04 m 的长方体。")
def camera_is_box(work):
    robot(work).link("camera_link").expect_shape(ShapeSpec(Box((0.03, 0.04, 0.04))))


@check("ground", en="The height of base_link above the ground is right.", zh="base_link 离地面的高度正确。")
def knows_height(work):
    slips = {
        0.05: NotYet(
            en="0.05 m is the distance down to the axle; the ground is one wheel radius lower.",
            zh="0.05 m 是到轮轴的距离；地面还要低一个轮子半径。",
        ),
        0.06: NotYet(
            en="0.06 m is the radius of a wheel; the axle is below base_link, too.",
            zh="0.06 m 是轮子的半径；轮轴本身也比 base_link 低。",
        ),
        0.17: NotYet(
            en="0.17 m counts the diameter of the wheel; the axle is in its middle.",
            zh="0.17 m 用的是轮子的直径；轮轴在轮子的中心。",
        ),
        0.08: NotYet(
            en="0.08 m is half of the body's height; the robot stands on its wheels.",
            zh="0.08 m 是机身高度的一半；机器人是站在轮子上的。",
        ),
    }
    work.expect_number(0.11, tolerance=0.002, slips=slips)
