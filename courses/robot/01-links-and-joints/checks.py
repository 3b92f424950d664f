from linkwright.geometry.shapes import Cylinder
from linkwright.learning import ShapeSpec, check

PACKAGE, URDF = "my_robot_description", "urdf/mbot_base.urdf"


@check(
    "package", en="The workspace has the package my_robot_description.", zh="工作空间中有功能包 my_robot_description。"
)
def has_package(work):
    work.package(PACKAGE)


@check("body", en="The robot has the link base_link.", zh="机器人有名为 base_link 的 link。")
def has_base_link(work):
    work.package(PACKAGE).robot(URDF).link("base_link")


@check(
    "body",
    en="Its visual is a cylinder with a radius of 0.20 m and a length of 0.16 m.",
    zh="它的 visual 是半径 0.20 m、长度 0.16 m 的圆柱。",
)
def body_is_cylinder(work):
    base = work.package(PACKAGE).robot(URDF).link("base_link")
    base.expect_shape(ShapeSpec(Cylinder(0.20, 0.16), along=(0, 0, 1)))
