"""The checks of the lesson. Each is a function that raises NotYet while the step is not done."""

from linkwright.geometry.shapes import Box
from linkwright.learning import NotYet, ShapeSpec, check


@check("one-link", en="The robot has the link box.", zh="机器人有名为 box 的连杆。")
def has_box(work):
    work.robot("robot.urdf").link("box")


@check("one-link", en="It looks like a cube of 0.5 m.", zh="它的外观是边长 0.5 m 的立方体。")
def is_cube(work):
    work.robot("robot.urdf").link("box").expect_shape(ShapeSpec(Box((0.5, 0.5, 0.5))))


@check("mass", en="The mass is right.", zh="质量正确。")
def knows_mass(work):
    area = NotYet(
        en="0.25 m² is the area of a side; the volume has three factors.",
        zh="0.25 m² 是一个面的面积；体积有三个因数。",
    )
    work.expect_number(12.5, tolerance=0.1, slips={25.0: area})
