import importlib
import math
import sys
from functools import cache

import numpy as np
from cell import BASE, CUBE, LOOK, PACKAGE, TABLE, TIP, Cell, answer_gripper, camera, sent_motion

from linkwright.learning import NotYet, check

COLORS = {"red": (199, 13, 15), "green": (26, 140, 51), "blue": (26, 64, 179)}
CHINESE = {"red": "红色", "green": "绿色", "blue": "蓝色"}


@check("fingers", en="The distance between the open fingers is right.", zh="张开的两指之间的距离正确。")
def knows_fingers(work):
    slips = {
        0.035: NotYet(
            en="0.035 is what one finger moves; the other mimics it, to the other side.",
            zh="0.035 是一个手指移动的距离；另一个手指模仿它，向另一边移动。",
        ),
        7.0: NotYet(en="That is in cm; the answer is in m.", zh="这是以 cm 为单位；答案以 m 为单位。"),
        70.0: NotYet(en="That is in mm; the answer is in m.", zh="这是以 mm 为单位；答案以 m 为单位。"),
    }
    work.expect_number(0.07, tolerance=0.002, slips=slips)


@check("look", en="The goal has an angle for each of the six joints.", zh="目标为六个关节各给出一个角度。")
def goal_is_look(work):
    constraints = sent_motion(work, "look").goal_constraints[0].joint_constraints
    found = {constraint.joint_name: constraint.position for constraint in constraints}
    for name in found:
        if name not in LOOK:
            raise NotYet(en=f"The arm has no joint '{name}'.", zh=f"机械臂没有关节“{name}”。")
    for name, angle in LOOK.items():
        if name not in found:
            raise NotYet(en=f"The goal has no angle for '{name}'.", zh=f"目标没有“{name}”的角度。")
        if abs(found[name] - angle) > 0.005:
            raise NotYet(
                en=f"The goal has {found[name]:g} rad for '{name}'; in the state 'look' of the SRDF it is {angle:g}.",
                zh=f"目标中“{name}”是 {found[name]:g} rad；SRDF 的状态“look”中是 {angle:g}。",
            )


@check("look", en="The arm moves there, and the node ends.", zh="机械臂移动到那里，节点结束。")
def arm_looks(work):
    with Cell(work) as test:
        test.run_program("look", seconds=20.0)
        positions, reason = test.joint_positions(), test.last_warning()
    for name, angle in LOOK.items():
        if abs(positions[name] - angle) > 0.03:
            raise NotYet(
                en=f"When look has ended, '{name}' is at {positions[name]:.2f} rad and not at {angle:g}. {reason}",
                zh=f"look 结束时，“{name}”在 {positions[name]:.2f} rad，而不是 {angle:g}。{reason}",
            )


def meters(values):
    return ", ".join(f"{value:.3f}" for value in values)


@check("reach", en="The goal has a place and a direction of grasp_link.", zh="目标有 grasp_link 的位置和方向。")
def goal_is_pose(work):
    place = 0.55, -0.1, 0.45
    words = [f"{axis}:={value}" for axis, value in zip("xyz", place, strict=True)]
    goal = sent_motion(work, "reach", *words).goal_constraints[0]
    if not goal.position_constraints or not goal.orientation_constraints:
        raise NotYet(
            en="The goal needs position_constraints and orientation_constraints.",
            zh="目标需要 position_constraints 和 orientation_constraints。",
        )
    position, orientation = goal.position_constraints[0], goal.orientation_constraints[0]
    for part in (position, orientation):
        if part.link_name != TIP:
            raise NotYet(
                en=f"link_name is '{part.link_name}'; the middle between the fingers is '{TIP}'.",
                zh=f"link_name 是“{part.link_name}”；两指的中间是“{TIP}”。",
            )
        if part.header.frame_id != BASE:
            raise NotYet(
                en=f"header.frame_id is '{part.header.frame_id}', but x, y and z are in the frame '{BASE}'.",
                zh=f"header.frame_id 是“{part.header.frame_id}”，而 x、y 和 z 属于坐标系“{BASE}”。",
            )
    poses = position.constraint_region.primitive_poses
    actual = tuple(getattr(poses[0].position, axis) for axis in "xyz") if poses else ()
    if not poses or math.dist(actual, place) > 0.002:
        raise NotYet(
            en=f"With x, y, z = {meters(place)}, the place in the goal is {meters(actual) or 'missing'}.",
            zh=f"x、y、z = {meters(place)} 时，目标中的位置是 {meters(actual) or '空的'}。",
        )
    expect_down(orientation.orientation)


def expect_down(q):
    """Require the z axis of a quaternion to point down."""
    length = math.sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w)
    z = 1 - 2 * (q.x * q.x + q.y * q.y) / max(length * length, 1e-9)
    if abs(length - 1.0) > 0.01 or z > -0.99:
        raise NotYet(
            en=f"The orientation is x = {q.x:.2f}, y = {q.y:.2f}, z = {q.z:.2f}, w = {q.w:.2f}: with it, the gripper "
            "does not point down; use that of down().",
            zh=f"方向是 x = {q.x:.2f}，y = {q.y:.2f}，z = {q.z:.2f}，w = {q.w:.2f}：这样夹爪不朝下；"
            "请用 down() 的方向。",
        )


@check("reach", en="The gripper moves there, and the node ends.", zh="夹爪移动到那里，节点结束。")
def gripper_reaches(work):
    with Cell(work) as test:
        for place in ((0.6, 0.0, 0.5), (0.55, -0.2, 0.45)):
            words = [f"{axis}:={value}" for axis, value in zip("xyz", place, strict=True)]
            test.run_program("reach", *words, seconds=20.0)
            actual = test.tip()
            if math.dist(actual, place) > 0.02:
                reason = test.last_warning()
                raise NotYet(
                    en=f"The gripper should be at {meters(place)}, but is at {meters(actual)}. {reason}",
                    zh=f"夹爪应当在 {meters(place)}，现在在 {meters(actual)}。{reason}",
                )


@check("reach", en="It tells if the arm does not reach.", zh="够不到时，它说出来。")
def tells_unreachable(work):
    with Cell(work) as test:
        test.run_program("reach", "x:=0.6", "y:=0.0", "z:=0.5", seconds=20.0)
        near = test.last_line("reach")
        test.run_program("reach", "x:=2.0", "y:=0.0", "z:=0.5", seconds=20.0)
        far = test.last_line("reach")
    if near == far:
        raise NotYet(
            en=f"It logs '{near}' for a place within reach, and also for one that is 2 m away.",
            zh=f"够得到的位置和 2 m 远的位置，日志都是“{near}”。",
        )


@check("grip", en="The goal has the position and the force.", zh="目标有位置和力。")
def goal_is_grip(work):
    for position in (0.035, 0.0):
        command, _ = answer_gripper(work, position, position)
        if abs(command.position - position) > 1e-6:
            raise NotYet(
                en=f"With position:={position:g}, the position in the goal is {command.position:g}.",
                zh=f"position:={position:g} 时，目标中的位置是 {command.position:g}。",
            )
        if not 5.0 <= command.max_effort <= 20.0:
            raise NotYet(
                en=f"max_effort is {command.max_effort:g} N, but should be 20 N, which is the limit of the controller.",
                zh=f"max_effort 是 {command.max_effort:g} N，应当是 20 N，即控制器的上限。",
            )


@check("grip", en="It tells whether something is between the fingers.", zh="它说出两指之间是否有东西。")
def tells_whether_held(work):
    _, held = answer_gripper(work, 0.0, 0.02)
    for position, reached in ((0.0, 0.0005), (0.035, 0.035)):
        _, empty = answer_gripper(work, position, reached)
        if held == empty:
            raise NotYet(
                en=f"It logs '{held}' when the fingers stop at 0.02 on their way to 0, and also when they stop at "
                f"{reached:g} on their way to {position:g}.",
                zh=f"手指要去 0 却停在 0.02 时，日志是“{held}”；要去 {position:g} 停在 {reached:g} 时也是。",
            )


def load_function(work, name):
    """Return a function of seeing.py."""
    package = work.package(PACKAGE)
    package.file("my_picking/seeing.py")
    if str(package.folder) not in sys.path:
        sys.path.insert(0, str(package.folder))
    function = getattr(importlib.import_module("my_picking.seeing"), name, None)
    if function is None:
        raise NotYet(en=f"seeing.py has no function '{name}'.", zh=f"seeing.py 中没有函数“{name}”。")
    return function


@cache
def drawn_picture():
    """Return an image of a brown table with a square of each color, and the first and last pixel of the squares."""
    picture = np.full((480, 640, 3), (140, 97, 56), dtype=np.uint8)
    squares = {}
    for number, (color, rgb) in enumerate(COLORS.items()):
        left, top = 100 + 150 * number, 60 + 100 * number
        picture[top : top + 40, left : left + 50] = rgb
        squares[color] = (left, top), (left + 49, top + 39)
    return picture, squares


@check("see", en="find_pixels finds the pixels of a color.", zh="find_pixels 找到一种颜色的像素。")
def finds_pixels(work):
    find = load_function(work, "find_pixels")
    picture, squares = drawn_picture()
    for color, (first, last) in squares.items():
        pixels = np.asarray(find(picture.copy(), color))
        if pixels.ndim != 2 or pixels.shape[1] != 2:
            raise NotYet(
                en=f"find_pixels returns an array of the shape {pixels.shape}; it needs a row (column, row) per pixel.",
                zh=f"find_pixels 返回形状为 {pixels.shape} 的数组；每个像素应当是一行（列号，行号）。",
            )
        if len(pixels) != 2000:
            raise NotYet(
                en=f"The image has 2000 pixels that are {color}, but find_pixels finds {len(pixels)}.",
                zh=f"图像中有 2000 个{CHINESE[color]}像素，find_pixels 找到 {len(pixels)} 个。",
            )
        if tuple(pixels.min(axis=0)) == first[::-1] and tuple(pixels.max(axis=0)) == last[::-1]:
            raise NotYet(
                en="find_pixels returns (row, column), but should return (column, row).",
                zh="find_pixels 返回（行号，列号），应当是（列号，行号）。",
            )
        if tuple(pixels.min(axis=0)) != first or tuple(pixels.max(axis=0)) != last:
            raise NotYet(
                en=f"find_pixels finds other pixels than those that are {color}.",
                zh=f"find_pixels 找到的不是{CHINESE[color]}像素。",
            )


@check("see", en="to_plane says where the pixels are on the table.", zh="to_plane 说出像素在桌面上的位置。")
def finds_places(work):
    to_plane = load_function(work, "to_plane")
    pixels = np.array([(320.5, 240.5), (420.5, 240.5), (320.5, 140.5)])
    for x, y, camera_height, height in ((0.55, 0.0, 0.74, 0.34), (0.6, 0.1, 0.9, 0.3)):
        k, position, rotation = camera(x, y, camera_height)
        cell = (camera_height - height) / k[0, 0]
        expected = np.array([(x, y), (x, y - 100 * cell), (x + 100 * cell, y)])
        actual = np.asarray(to_plane(pixels.copy(), k, position, rotation, height))
        if actual.shape != expected.shape:
            raise NotYet(
                en=f"For three pixels, to_plane returns the shape {actual.shape}, but should return (3, 2): x and y.",
                zh=f"对三个像素，to_plane 返回的形状是 {actual.shape}，应当是 (3, 2)：x 和 y。",
            )
        for pixel, point, right in zip(pixels, actual, expected, strict=True):
            if math.dist(point, right) > 0.001:
                raise NotYet(
                    en=f"A camera at {meters(position)} looks down. Its pixel ({pixel[0]:g}, {pixel[1]:g}) shows "
                    f"{meters(right)} at the height {height:g}, but to_plane returns {meters(point)}.",
                    zh=f"相机在 {meters(position)}，朝下看。它的像素 ({pixel[0]:g}, {pixel[1]:g}) "
                    f"在高度 {height:g} 处是 {meters(right)}，而 to_plane 返回 {meters(point)}。",
                )


@check("see", en="It also does with a camera that looks at an angle.", zh="相机斜着看时也正确。")
def finds_places_at_angle(work):
    to_plane = load_function(work, "to_plane")
    k, position, rotation = camera(0.5, 0.1, 0.8)
    tilt, turn = 0.3, 0.5
    about_x = np.array([[1, 0, 0], [0, math.cos(tilt), -math.sin(tilt)], [0, math.sin(tilt), math.cos(tilt)]])
    about_z = np.array([[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    rotation = about_z @ rotation @ about_x
    points = np.array([(0.6, 0.1, 0.34), (0.7, -0.1, 0.34)])
    seen = (points - position) @ rotation @ k.T
    actual = np.asarray(to_plane(seen[:, :2] / seen[:, 2:], k, position, rotation, 0.34))
    for point, right in zip(actual, points, strict=True):
        if math.dist(point, right[:2]) > 0.001:
            raise NotYet(
                en=f"A tilted camera sees the point {meters(right[:2])}, but to_plane returns {meters(point)}; is the "
                "rotation applied to the ray, and not its inverse?",
                zh=f"倾斜的相机看见点 {meters(right[:2])}，而 to_plane 返回 {meters(point)}；"
                "作用在射线上的是旋转，而不是它的逆吗？",
            )


TASKS = (
    ("red", {"red": (0.6, 0.12, 0.3)}, (0.62, 0.3)),
    ("blue", {"blue": (0.57, -0.22, 0.6), "red": (0.66, 0.1, 0.0)}, (0.55, 0.05)),
)


@check("pick", en="pick brings the cube to its place, twice.", zh="pick 把方块放到指定的位置，两次都行。")
def picks_and_places(work):
    for color, cubes, place in TASKS:
        with Cell(work, cubes) as test:
            others = {other: test.cube(other) for other in COLORS if other != color}
            words = (f"color:={color}", f"place_x:={place[0]}", f"place_y:={place[1]}")
            test.run_program("pick", *words, seconds=60.0)
            expect_placed(test, color, cubes[color], place)
            for other, before in others.items():
                if math.dist(test.cube(other), before) > 0.02:
                    raise NotYet(
                        en=f"The {color} cube is placed, but the arm has moved the {other} one, too.",
                        zh=f"{CHINESE[color]}方块放好了，但机械臂也移动了{CHINESE[other]}方块。",
                    )


def expect_placed(test, color, start, place):
    """Require a cube to be on the table at a place, or tell how far it came."""
    actual = test.cube(color)
    if math.dist(actual[:2], place) < 0.03 and abs(actual[2] - TABLE - CUBE / 2) < 0.01:
        return
    line = test.last_line("pick")
    said = f" pick says: {line}" if line else ""
    said_zh = f" pick 说：{line}" if line else ""
    if math.dist(actual[:2], start[:2]) < 0.03:
        raise NotYet(
            en=f"The {color} cube is still where it was, at {meters(actual[:2])}.{said}",
            zh=f"{CHINESE[color]}方块仍在原处 {meters(actual[:2])}。{said_zh}",
        )
    if actual[2] > TABLE + CUBE:
        raise NotYet(
            en=f"The {color} cube is in the air, {actual[2]:.2f} m high; does the gripper open?{said}",
            zh=f"{CHINESE[color]}方块在空中，高 {actual[2]:.2f} m；夹爪张开了吗？{said_zh}",
        )
    raise NotYet(
        en=f"The {color} cube is at {meters(actual[:2])}, but should be at {meters(place)}.{said}",
        zh=f"{CHINESE[color]}方块在 {meters(actual[:2])}，应当在 {meters(place)}。{said_zh}",
    )


@check("pick", en="It tells if there is no such cube.", zh="没有这种方块时，它说出来。")
def tells_missing(work):
    with Cell(work) as test:
        test.delete("green_cube")
        test.run_program("pick", "color:=green", seconds=30.0)
        line = test.last_line("pick")
    if not line:
        raise NotYet(
            en="There is no green cube, and pick ends without a line in the log.",
            zh="没有绿色方块，pick 结束时在日志中什么也没有写。",
        )


@check("pick", en="package.xml lists what the nodes need.", zh="package.xml 列出节点所需的功能包。")
def is_packaged(work):
    package = work.package(PACKAGE)
    package.expect_dependencies("control_msgs", "moveit_msgs", "my_robot_arm", "sensor_msgs", "shape_msgs", "tf2_ros")
    package.expect_no_findings()
