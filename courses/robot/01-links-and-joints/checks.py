import math
import runpy
from functools import cache

from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.learning import NotYet, ShapeSpec, check, expect_published

URDF, TWIST = "urdf/mbot_base.urdf", "geometry_msgs/msg/Twist"
WHEEL = ShapeSpec(Cylinder(0.06, 0.025), along=(0, 1, 0), at=(0, 0, 0))


def robot(work):
    return work.package("my_robot_description").robot(URDF)


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
    joint = robot(work).joint(f"{side}_caster_joint")
    joint.expect_links("base_link", f"{side}_caster_link")
    joint.expect_type("continuous")
    robot(work).expect_position(f"{side}_caster_link", (x, 0, -0.095), frame="base_link")
    robot(work).link(f"{side}_caster_link").expect_shape(ShapeSpec(Sphere(0.015), at=(0, 0, 0)))


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
    robot(work).link("camera_link").expect_shape(ShapeSpec(Box((0.03, 0.04, 0.04)), at=(0, 0, 0)))


@check("teleop", en="mbot drives ahead and turns to the left.", zh="mbot 能前进，也能左转。")
def robot_drives(work):
    with work.package("my_robot_description").simulate(URDF) as test:
        test.drive(0.3)
        test.advance(2.0)
        x = test.robot_pose()[0]
        test.drive(0.0, 1.0)
        test.advance(1.0)
        turn = 2 * math.atan2(*test.robot_pose()[5:])
    if x < 0.3 or turn < 0.3:
        raise NotYet(
            en=f"Commanded to drive ahead for 2 s and then to turn left, the robot drove {x:.2f} m and turned by "
            f"{turn:.1f} rad; compare the wheels with the steps before.",
            zh=f"命令机器人前进 2 s 再左转，它走了 {x:.2f} m，转了 {turn:.1f} rad；请与前面几步对照检查轮子。",
        )


@check("teleop", en="The speed that the pad sends is right.", zh="操纵板发送的速度正确。")
def knows_speed(work):
    slips = {
        0.0: NotYet(
            en="0 is the velocity after a key is released; look at the messages while you hold the up arrow.",
            zh="0 是松开按键之后的速度；请在按住上箭头时看消息。",
        ),
        1.0: NotYet(
            en="1 is angular.z, how fast the robot turns; hold the up arrow alone, and look at linear.x.",
            zh="1 是 angular.z，即转动的速度；请只按住上箭头，看 linear.x。",
        ),
    }
    work.expect_number(0.5, tolerance=0.02, slips=slips)


@cache
def run_first_drive(work):
    """Run first_drive.py for at most half a minute; return its commands, the way in m, the last speed, and the end."""
    program = work.file("first_drive.py")
    silence = NotYet(
        en="first_drive.py ends without a node: it must call rclpy.create_node. A function runs only if it is called.",
        zh="first_drive.py 没有创建节点就结束了：应当调用 rclpy.create_node。函数只有被调用才会运行。",
    )
    with work.package("my_robot_description").simulate(URDF) as test:
        commands = test.record("/cmd_vel", TWIST)
        running = test.start_program(lambda: runpy.run_path(str(program), run_name="__main__"), budget=3.0)
        way, last = 0.0, test.robot_pose()[:2]
        while running.is_running and test.now < 30.0:
            test.advance(0.1)
            way += math.dist(last, test.robot_pose()[:2])
            last = test.robot_pose()[:2]
            if test.program_nodes and not len(commands):
                silence = why_silent(test, commands)
        if not len(commands):
            raise silence
        has_ended = not running.is_running
        test.advance(1.0)
        last = test.robot_pose()[:2]
        test.advance(0.1)
        speed = math.dist(last, test.robot_pose()[:2]) / 0.1
    return commands, way, speed, has_ended


def why_silent(test, commands):
    try:
        expect_published(test, "/cmd_vel", TWIST, commands)
    except NotYet as reason:
        return reason


@check("program", en="first_drive.py drives mbot.", zh="first_drive.py 让 mbot 行驶。")
def program_drives(work):
    commands, way, _, _ = run_first_drive(work)
    fastest = max(abs(command.linear.x) for command in commands)
    if fastest > 3.0:
        raise NotYet(
            en=f"linear.x is {fastest:g}: that many meters in a second. Try 0.2.",
            zh=f"linear.x 是 {fastest:g}，也就是每秒这么多米。请用 0.2。",
        )
    if not fastest:
        raise NotYet(
            en="first_drive.py publishes on /cmd_vel, but linear.x, the speed ahead, is always 0.",
            zh="first_drive.py 在 /cmd_vel 上发布消息，但前进速度 linear.x 始终是 0。",
        )
    if way < 0.1:
        raise NotYet(
            en=f"The robot moved only {way:.2f} m: publish the velocity again and again for some seconds, with "
            "time.sleep(0.1) between the messages.",
            zh=f"机器人只移动了 {way:.2f} m：请在几秒钟内反复发布速度，两条消息之间用 time.sleep(0.1)。",
        )


@check("program", en="At the end it stops mbot.", zh="最后它让 mbot 停下。")
def program_stops(work):
    commands, _, speed, has_ended = run_first_drive(work)
    if not commands.last.linear.x and not commands.last.angular.z and speed < 0.01:
        return
    if has_ended:
        raise NotYet(
            en="The program has ended, but the robot drives on: at the end, publish a Twist() whose numbers are all 0.",
            zh="程序已经结束，机器人还在行驶：请在最后发布一个数值全为 0 的 Twist()。",
        )
    raise NotYet(
        en="After half a minute the program still drives the robot; let it stop after some seconds.",
        zh="半分钟后程序仍在让机器人行驶；请让它在几秒后停下。",
    )
