import math

from linkwright import SteppedSimulation, read_world
from linkwright.geometry.shapes import Cylinder, Sphere
from linkwright.learning import NotYet, ShapeSpec, check

BASE, SIM = "urdf/mbot_base.xacro", "urdf/mbot_sim.xacro"
MASSES = {
    "base_link": 5,
    "left_wheel_link": 0.2,
    "right_wheel_link": 0.2,
    "front_caster_link": 0.02,
    "camera_link": 0.1,
}


def package(work):
    return work.package("my_robot_description")


@check("collisions", en="Each part with a visual has a collision.", zh="每个有外观的部件都有碰撞体。")
def parts_have_collisions(work):
    for name, link in package(work).robot(BASE).robot.links.items():
        if link.visuals and not link.collisions:
            raise NotYet(en=f"The link '{name}' has no <collision>.", zh=f"连杆“{name}”没有 <collision>。")


@check("collisions", en="The collisions have the shapes of the visuals.", zh="碰撞体的形状与外观相同。")
def collisions_fit(work):
    robot = package(work).robot(BASE)
    robot.link("base_link").expect_shape(ShapeSpec(Cylinder(0.20, 0.16), along=(0, 0, 1)), "collision")
    for side in ("left", "right"):
        shape = ShapeSpec(Cylinder(0.06, 0.025), along=(0, 1, 0))
        robot.link(f"{side}_wheel_link").expect_shape(shape, "collision")
    for side in ("front", "back"):
        robot.link(f"{side}_caster_link").expect_shape(ShapeSpec(Sphere(0.015)), "collision")


@check("masses", en="Each part has its mass.", zh="每个部件都有质量。")
def parts_have_masses(work):
    for name, mass in MASSES.items():
        package(work).robot(BASE).link(name).expect_mass(0.5 * mass, 2 * mass)


@check("masses", en="Masses and inertias fit the shapes.", zh="质量和惯量与形状相符。")
def inertias_fit(work):
    package(work).expect_no_findings(BASE)


def simulate(work, world="empty", **options):
    path = package(work).file(SIM)
    package(work).robot(SIM)
    return SteppedSimulation(world, path, **options)


def pose(test):
    """Return x, y, z and yaw of the robot."""
    x, y, z, qx, qy, qz, qw = test.robot_pose()
    return x, y, z, math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))


@check("drive", en="The robot stands on its wheels.", zh="机器人靠轮子站立。")
def robot_stands(work):
    with simulate(work) as test:
        test.advance(1.0)
        z = pose(test)[2]
    if abs(z) > 0.01:
        raise NotYet(
            en=f"After one second, base_footprint is {z:.2f} m above the ground.",
            zh=f"一秒后，base_footprint 在地面以上 {z:.2f} m。",
        )


@check(
    "drive",
    en="It drives 0.6 m in 2 s when it is told to drive 0.3 m/s.",
    zh="命令为 0.3 m/s 时，它在 2 s 内前进 0.6 m。",
)
def robot_drives(work):
    with simulate(work) as test:
        test.advance(0.5)
        test.drive(0.3)
        test.advance(2.0)
        x, y, *_ = pose(test)
    if math.hypot(x, y) < 0.05:
        raise NotYet(en="The robot does not move on /cmd_vel.", zh="机器人对 /cmd_vel 没有反应。")
    if not 0.5 < x < 0.66 or abs(y) > 0.05:
        raise NotYet(
            en=f"The robot drove to x = {x:.2f} m, y = {y:.2f} m; check the wheel diameter and the joints.",
            zh=f"机器人到了 x = {x:.2f} m，y = {y:.2f} m；请检查轮子直径和关节。",
        )


@check(
    "drive",
    en="It turns to the left by 1 rad in 1 s when it is told to turn 1 rad/s.",
    zh="命令为 1 rad/s 时，它在 1 s 内左转 1 rad。",
)
def robot_turns(work):
    with simulate(work) as test:
        test.advance(0.5)
        test.drive(0.0, 1.0)
        test.advance(1.0)
        yaw = pose(test)[3]
    if not 0.8 < yaw < 1.1:
        raise NotYet(
            en=f"The robot turned by {yaw:.2f} rad; check the wheel separation, and which joint is the left one.",
            zh=f"机器人转了 {yaw:.2f} rad；请检查轮距，以及哪个是左轮关节。",
        )


@check(
    "laser", en="The laser publishes /scan in the frame laser_link.", zh="激光雷达在坐标系 laser_link 中发布 /scan。"
)
def laser_publishes(work):
    with simulate(work) as test:
        scans = test.record("/scan", "sensor_msgs/msg/LaserScan")
        test.advance(1.0)
    if not len(scans):
        raise NotYet(en="Nothing is published on /scan.", zh="/scan 上没有消息。")
    if (frame := scans.last.header.frame_id) != "laser_link":
        raise NotYet(
            en=f"The frame of /scan is '{frame}', but should be 'laser_link'.",
            zh=f"/scan 的坐标系是“{frame}”，应当是“laser_link”。",
        )


@check("laser", en="It measures a wall 2 m ahead.", zh="它能测出前方 2 m 处的墙。")
def laser_measures(work):
    with simulate(work, work.lesson / "wall.world") as test:
        scans = test.record("/scan", "sensor_msgs/msg/LaserScan")
        test.advance(1.0)
    if not len(scans):
        raise NotYet(en="Nothing is published on /scan.", zh="/scan 上没有消息。")
    scan = scans.last
    ahead = scan.ranges[round(-scan.angle_min / scan.angle_increment)]
    if not 1.9 < ahead < 2.1:
        raise NotYet(
            en=f"The laser measures {ahead:.2f} m straight ahead, but the wall is at 2 m.",
            zh=f"激光雷达在正前方测得 {ahead:.2f} m，而墙在 2 m 处。",
        )


def yard(work):
    return work.package("my_worlds").file("worlds/yard.world")


@check("world", en="yard.world has a static wall and a ball that can roll.", zh="yard.world 中有静态的墙和能滚动的球。")
def world_has_models(work):
    models = {model.name: model for model in read_world(str(yard(work))).world.models}
    for name, is_static in (("wall", True), ("ball", False)):
        if name not in models:
            raise NotYet(en=f"The world has no model '{name}'.", zh=f"世界中没有模型“{name}”。")
        if models[name].static is not is_static:
            raise NotYet(
                en=f"The model '{name}' must {'' if is_static else 'not '}be static.",
                zh=f"模型“{name}”{'应当' if is_static else '不应当'}是静态的。",
            )


@check("world", en="mbot pushes the ball, and the wall stops mbot.", zh="mbot 能推动球，墙能挡住 mbot。")
def robot_meets_models(work):
    with simulate(work, yard(work), pose=(0.8, 0.6, 0, 0, 0, 0)) as test:
        test.drive(0.4)
        test.advance(10.0)
        x = pose(test)[0]
        ball_x, ball_y, *_ = test.simulation.model_pose("ball")
    if math.hypot(ball_x - 1.5, ball_y - 0.6) < 0.05:
        raise NotYet(
            en="The robot did not move the ball at x = 1.5, y = 0.6.", zh="机器人没有推动 x = 1.5、y = 0.6 处的球。"
        )
    if x > 2.9:
        raise NotYet(en="The robot drove through the wall.", zh="机器人穿过了墙。")


@check("load", en="load_mbot.launch.py puts the robot into the world.", zh="load_mbot.launch.py 把机器人放进世界。")
def launch_loads_robot(work):
    with work.package("my_worlds").launch("load_mbot.launch.py") as running:
        running.expect_node("/robot_state_publisher")
        running.wait_for_message("/odom")
        running.wait_for_message("/scan")


@check("load", en="The package my_worlds has no findings.", zh="功能包 my_worlds 没有任何问题。")
def package_has_no_findings(work):
    package = work.package("my_worlds")
    package.expect_installed("launch/load_mbot.launch.py", "worlds/yard.world")
    package.expect_no_findings()


@check("wall", en="The distance to the wall is right.", zh="到墙的距离正确。")
def knows_distance(work):
    slips = {
        3.0: NotYet(en="3.0 m is the distance to the middle of the wall.", zh="3.0 m 是到墙中心的距离。"),
        2.7: NotYet(en="2.7 m is the distance from the front of the body.", zh="2.7 m 是从机身前缘算起的距离。"),
    }
    work.expect_number(2.9, tolerance=0.05, slips=slips)
