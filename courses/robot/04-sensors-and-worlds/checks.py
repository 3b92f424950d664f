import math

from linkwright import SteppedSimulation, read_world
from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.learning import NotYet, ShapeSpec, check

BASE, SIM = "urdf/mbot_base.xacro", "urdf/mbot_sim.xacro"
MASSES = {
    "base_link": 5,
    "left_wheel_link": 0.2,
    "right_wheel_link": 0.2,
    "front_caster_link": 0.02,
    "camera_link": 0.1,
}


DRIVE = "libgazebo_ros_diff_drive.so"
NEEDED = ("gazebo_ros", "launch", "launch_ros", "my_robot_description", "robot_state_publisher", "xacro")


def package(work):
    return work.package("my_robot_description")


@check("collisions", en="Each part with a visual has a collision.", zh="每个有外观的部件都有碰撞体。")
def parts_have_collisions(work):
    for name, link in package(work).robot(BASE).robot.links.items():
        if link.visuals:
            package(work).robot(BASE).link(name).expect_part("collision")


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


INERTIAS = {
    "base_link": (Cylinder(0.20, 0.16), (0, 0, 1)),
    "left_wheel_link": (Cylinder(0.06, 0.025), (0, 1, 0)),
    "front_caster_link": (Sphere(0.015), None),
    "camera_link": (Box((0.03, 0.04, 0.04)), None),
}


@check("masses", en="The moments of inertia are those of the shapes.", zh="转动惯量由形状算出。")
def inertias_are_right(work):
    for name, (shape, along) in INERTIAS.items():
        package(work).robot(BASE).link(name).expect_inertia(shape, along=along, factor=1.5)


def simulate(work, world="empty", **options):
    path = package(work).file(SIM)
    package(work).robot(SIM)
    return SteppedSimulation(world, path, **options)


def pose(test):
    """Return x, y, z and yaw of the robot."""
    x, y, z, qx, qy, qz, qw = test.robot_pose()
    return x, y, z, math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))


def plugins(work):
    """Return the plugins of the robot's <gazebo> elements: file names without 'lib' and '.so'."""
    found = {}
    for element in package(work).robot(SIM).robot.extensions:
        for plugin in element.walk():
            if plugin.tag == "plugin":
                name = plugin.attributes.get("filename", "")
                found[name.removeprefix("lib").removesuffix(".so")] = (element, plugin)
    return found


def text_of(element, tag):
    return next((child.text().strip() for child in element.walk() if child.tag == tag), "")


def expect_drive(work):
    """Require a drive plugin that can be loaded and names the wheels."""
    found = plugins(work)
    drives = {name: pair for name, pair in found.items() if "diff" in name.lower()}
    known = {"gazebo_ros_diff_drive", "gz-sim-diff-drive-system", "ignition-gazebo-diff-drive-system"}
    if not drives:
        raise NotYet(
            en=f'The robot has no drive: a <plugin> inside <gazebo> with filename="{DRIVE}".',
            zh=f'机器人没有驱动：在 <gazebo> 里写一个 filename="{DRIVE}" 的 <plugin>。',
        )
    name, (element, plugin) = next(iter(drives.items()))
    if name not in known:
        raise NotYet(
            en=f"There is no plugin '{plugin.attributes.get('filename')}'; write filename=\"{DRIVE}\".",
            zh=f'没有插件“{plugin.attributes.get("filename")}”；请写 filename="{DRIVE}"。',
        )
    if element.tag != "gazebo":
        raise NotYet(en="Put the <plugin> into <gazebo>.", zh="请把 <plugin> 写在 <gazebo> 里。")
    for tag in ("left_joint", "right_joint"):
        joint = text_of(plugin, tag)
        if joint not in package(work).robot(SIM).robot.joints:
            raise NotYet(
                en=f"<{tag}> names '{joint}', but the robot has no such joint; write {tag[:-6]}_wheel_joint.",
                zh=f"<{tag}> 写的是“{joint}”，但机器人没有这个关节；请写 {tag[:-6]}_wheel_joint。",
            )
    remapping = text_of(plugin, "remapping")
    if remapping:
        raise NotYet(
            en=f"The plugin's topic is remapped: {remapping}; it must read /cmd_vel.",
            zh=f"插件的话题被改名了：{remapping}；它应当读取 /cmd_vel。",
        )
    if text_of(plugin, "left_joint") == text_of(plugin, "right_joint"):
        raise NotYet(
            en="<left_joint> and <right_joint> name the same joint.",
            zh="<left_joint> 和 <right_joint> 写的是同一个关节。",
        )
    for tag in ("wheel_separation", "wheel_diameter"):
        expect_length(plugin, tag)


def expect_length(plugin, tag):
    """Require a parameter of a plugin to be a length of a small robot, in m, if it is given."""
    text = text_of(plugin, tag)
    try:
        is_length = not text or 0 < float(text) < 2
    except ValueError:
        raise NotYet(
            en=f"<{tag}> is '{text}', which is not a number; write a point as decimal separator, and no unit.",
            zh=f"<{tag}> 是“{text}”，不是数字；小数点请用“.”，不要写单位。",
        ) from None
    if not is_length:
        raise NotYet(
            en=f"<{tag}> is {text}: lengths are in meters; 38 cm are 0.38.",
            zh=f"<{tag}> 是 {text}：长度的单位是米；38 厘米是 0.38。",
        )


def expect_known_parameters(work):
    """Require the drive plugin to have its two sizes, because it has other values without them."""
    for _, plugin in plugins(work).values():
        if plugin.attributes.get("filename") != DRIVE:
            continue
        for tag in ("wheel_separation", "wheel_diameter"):
            if not text_of(plugin, tag):
                raise NotYet(
                    en=f"The drive plugin has no <{tag}>; compare the spelling.",
                    zh=f"驱动插件没有 <{tag}>；请检查拼写。",
                )


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
    expect_drive(work)
    if math.hypot(x, y) < 0.05:
        raise NotYet(en="The robot does not move on /cmd_vel.", zh="机器人对 /cmd_vel 没有反应。")
    expect_known_parameters(work)
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
    expect_drive(work)
    if not 0.8 < yaw < 1.1:
        raise NotYet(
            en=f"The robot turned by {yaw:.2f} rad; check the wheel separation, and which joint is the left one.",
            zh=f"机器人转了 {yaw:.2f} rad；请检查轮距，以及哪个是左轮关节。",
        )


@check("drive", en="The casters slide.", zh="万向轮可以滑动。")
def casters_slide(work):
    robot = package(work).robot(SIM).robot
    friction = {}
    for element in robot.extensions:
        if element.tag == "gazebo":
            values = [text_of(element, tag) for tag in ("mu1", "mu2")]
            friction.setdefault(element.attributes.get("reference"), []).extend(value for value in values if value)
    for name in ("front_caster_link", "back_caster_link"):
        values = friction.get(name, [])
        if not values or any(float(value) > 0.1 for value in values):
            raise NotYet(
                en=f"'{name}' has friction: it needs a <gazebo reference=\"{name}\"> with <mu1> and <mu2> of 0.",
                zh=f'“{name}”有摩擦：需要 <gazebo reference="{name}">，其中 <mu1> 和 <mu2> 为 0。',
            )


@check("drive", en="/odom says where the robot is.", zh="/odom 给出机器人的位置。")
def odometry_is_right(work):
    with simulate(work) as test:
        odometry = test.record("/odom", "nav_msgs/msg/Odometry")
        transforms = test.record("/tf", "tf2_msgs/msg/TFMessage")
        test.advance(0.5)
        test.drive(0.3)
        test.advance(2.0)
        x, *_ = pose(test)
    expect_drive(work)
    if not len(odometry):
        raise NotYet(
            en="Nothing is published on /odom; the plugin needs <publish_odom>true</publish_odom>.",
            zh="/odom 上没有消息；插件需要 <publish_odom>true</publish_odom>。",
        )
    last = odometry.last
    frames = [name.rpartition("/")[2] for name in (last.header.frame_id, last.child_frame_id)]
    if frames != ["odom", "base_footprint"]:
        raise NotYet(
            en=f"/odom is about '{last.child_frame_id}' in '{last.header.frame_id}', but should be about "
            "'base_footprint' in 'odom'; compare <odometry_frame> and <robot_base_frame>.",
            zh=f"/odom 描述的是“{last.child_frame_id}”在“{last.header.frame_id}”中的位置，"
            "应当是“base_footprint”在“odom”中的位置；请检查 <odometry_frame> 和 <robot_base_frame>。",
        )
    if abs(last.pose.pose.position.x - x) > 0.05:
        raise NotYet(
            en=f"/odom says x = {last.pose.pose.position.x:.2f} m, but the robot is at x = {x:.2f} m.",
            zh=f"/odom 是 x = {last.pose.pose.position.x:.2f} m，而机器人在 x = {x:.2f} m。",
        )
    frames = {(one.header.frame_id, one.child_frame_id) for message in transforms for one in message.transforms}
    if ("odom", "base_footprint") not in frames:
        raise NotYet(
            en="The transform from odom to base_footprint is not published; the plugin needs "
            "<publish_odom_tf>true</publish_odom_tf>.",
            zh="没有发布从 odom 到 base_footprint 的变换；插件需要 <publish_odom_tf>true</publish_odom_tf>。",
        )


def explain_silent_laser(work):
    """Return why nothing is published on /scan."""
    robot = package(work).robot(SIM).robot
    sensors = [(element, sensor) for element in robot.extensions for sensor in element.walk() if sensor.tag == "sensor"]
    if not sensors:
        return NotYet(en="The robot has no <sensor>.", zh="机器人没有 <sensor>。")
    element, sensor = sensors[0]
    reference = element.attributes.get("reference", "")
    if reference not in robot.links:
        return NotYet(
            en=f'<gazebo reference="{reference}"> names no link; write laser_link.',
            zh=f'<gazebo reference="{reference}"> 中没有这个连杆；请写 laser_link。',
        )
    if not any(child.tag == "plugin" for child in sensor.walk()):
        return NotYet(
            en="The <sensor> contains no <plugin>; close </sensor> after </plugin>.",
            zh="<sensor> 里没有 <plugin>；请把 </sensor> 写在 </plugin> 之后。",
        )
    output = text_of(sensor, "output_type")
    if output != "sensor_msgs/LaserScan":
        return NotYet(
            en=f"The plugin's <output_type> is '{output}', but should be 'sensor_msgs/LaserScan'.",
            zh=f"插件的 <output_type> 是“{output}”，应当是“sensor_msgs/LaserScan”。",
        )
    remapping = text_of(sensor, "remapping")
    if remapping.replace(" ", "") not in {"~/out:=scan", "~/out:=/scan"}:
        return NotYet(
            en=f"The plugin's <remapping> is '{remapping}', but should be '~/out:=scan'.",
            zh=f"插件的 <remapping> 是“{remapping}”，应当是“~/out:=scan”。",
        )
    if float(text_of(sensor, "update_rate") or 0) < 2:
        return NotYet(
            en="The laser measures less than twice a second; write <update_rate>10</update_rate>.",
            zh="激光雷达每秒测量不到两次；请写 <update_rate>10</update_rate>。",
        )
    return NotYet(en="Nothing is published on /scan.", zh="/scan 上没有消息。")


def expect_laser_of_gazebo(work):
    """Require a type of sensor that Gazebo has."""
    for element in package(work).robot(SIM).robot.extensions:
        for sensor in element.walk():
            if sensor.tag == "sensor" and (kind := sensor.attributes.get("type", "")) == "laser":
                raise NotYet(
                    en=f"Gazebo has no sensor of the type '{kind}'; write type=\"ray\".",
                    zh=f'Gazebo 没有类型为“{kind}”的传感器；请写 type="ray"。',
                )


@check("laser", en="The laser is on top of the body.", zh="激光雷达在机身上方。")
def laser_is_on_top(work):
    z = package(work).robot(SIM).pose("laser_link", "base_link")[2, 3]
    if z < 0.09:
        raise NotYet(
            en=f"laser_link is {z:.3f} m above the middle of the body, inside it or below it; write 0.105.",
            zh=f"laser_link 在机身中心上方 {z:.3f} m，位于机身内部或下方；请写 0.105。",
        )
    package(work).robot(SIM).expect_direction("laser_link", (0, 0, 1), (0, 0, 1))


@check(
    "laser", en="The laser publishes /scan in the frame laser_link.", zh="激光雷达在坐标系 laser_link 中发布 /scan。"
)
def laser_publishes(work):
    with simulate(work) as test:
        scans = test.record("/scan", "sensor_msgs/msg/LaserScan")
        test.advance(1.0)
    if not len(scans):
        raise explain_silent_laser(work)
    expect_laser_of_gazebo(work)
    if len(scans) > 50:
        raise NotYet(
            en=f"The laser measures {len(scans)} times a second; write <update_rate>10</update_rate>.",
            zh=f"激光雷达每秒测量 {len(scans)} 次；请写 <update_rate>10</update_rate>。",
        )
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
        raise explain_silent_laser(work)
    scan = scans.last
    if scan.angle_max > 2 * math.pi:
        raise NotYet(
            en=f"The scan ends at {scan.angle_max:g}: angles are in radians, and half a turn is 3.14.",
            zh=f"扫描的终点是 {scan.angle_max:g}：角度的单位是弧度，半圈是 3.14。",
        )
    if len(scan.ranges) < 2:
        raise NotYet(
            en="The scan has a single value; write <samples>360</samples>.",
            zh="扫描只有一个值；请写 <samples>360</samples>。",
        )
    if not (scan.angle_min <= -1 and scan.angle_max >= 1):
        raise NotYet(
            en=f"The scan goes from {scan.angle_min:g} to {scan.angle_max:g} rad, but mbot needs to see both sides: "
            "straight ahead is 0, the right is negative, the left positive.",
            zh=f"扫描从 {scan.angle_min:g} 到 {scan.angle_max:g} rad，但 mbot 需要看到两侧："
            "正前方是 0，右侧为负，左侧为正。",
        )
    ahead = scan.ranges[min(round(-scan.angle_min / scan.angle_increment), len(scan.ranges) - 1)]
    expected = 2.0 - package(work).robot(SIM).pose("laser_link")[0, 3]
    if abs(ahead - expected) <= 0.1:
        return
    en, zh = "compare <range> and <scan>.", "请检查 <range> 和 <scan>。"
    if abs(scan.ranges[0] - expected) < 0.2:
        en, zh = "the laser looks back: compare the rpy of laser_joint.", "激光雷达朝后：请检查 laser_joint 的 rpy。"
    elif ahead == math.inf:
        en, zh = "that is farther than the <max> of <range>.", "这超过了 <range> 的 <max>。"
    elif ahead == -math.inf:
        en, zh = "that is nearer than the <min> of <range>.", "这小于 <range> 的 <min>。"
    raise NotYet(
        en=f"The laser measures {ahead:.2f} m straight ahead, but the wall is at {expected:.2f} m; {en}",
        zh=f"激光雷达在正前方测得 {ahead:.2f} m，而墙在 {expected:.2f} m 处；{zh}",
    )


def yard(work):
    return work.package("my_worlds").file("worlds/yard.world")


@check("world", en="yard.world has no mistakes.", zh="yard.world 中没有错误。")
def world_has_no_findings(work):
    yard(work)
    work.package("my_worlds").expect_no_findings("worlds/yard.world")


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


@check("world", en="The wall and the ball have their places and sizes.", zh="墙和球的位置和大小正确。")
def models_are_in_place(work):
    models = {model.name: model for model in read_world(str(yard(work))).world.models}
    for name, expected in (("wall", (3, 0)), ("ball", (1.5, 0.6))):
        if name not in models:
            raise NotYet(en=f"The world has no model '{name}'.", zh=f"世界中没有模型“{name}”。")
        at = models[name].pose.pose
        if max(map(abs, at.rpy)) > 2 * math.pi:
            raise NotYet(
                en=f"The <pose> of '{name}' has the angle {max(at.rpy, key=abs):g}: angles are in radians.",
                zh=f"“{name}”的 <pose> 中有角度 {max(at.rpy, key=abs):g}：角度的单位是弧度。",
            )
        if math.dist(at.xyz[:2], expected) > 0.1:
            x, y = expected
            raise NotYet(
                en=f"The model '{name}' is at x = {at.xyz[0]:g}, y = {at.xyz[1]:g}, but should be at x = {x:g}, "
                f"y = {y:g}; look at its <pose>.",
                zh=f"模型“{name}”在 x = {at.xyz[0]:g}、y = {at.xyz[1]:g}，应当在 x = {x:g}、y = {y:g}；"
                "请检查它的 <pose>。",
            )
    expect_sizes(models)


def expect_sizes(models):
    """Require the sizes of the text. A box without an element <size> is a cube of 1 m."""
    for shape in shapes_of(models["wall"], Box):
        if abs(max(shape.size[:2]) - 4) > 0.1:
            size = " ".join(f"{length:g}" for length in shape.size)
            raise NotYet(
                en=f"The wall has the size {size}, but should have 0.2 4 0.5: <box><size>0.2 4 0.5</size></box>.",
                zh=f"墙的大小是 {size}，应当是 0.2 4 0.5：<box><size>0.2 4 0.5</size></box>。",
            )
    for shape in shapes_of(models["ball"], Sphere):
        if abs(shape.radius - 0.15) > 0.02:
            raise NotYet(
                en=f"The radius of the ball is {shape.radius:g} m, but should be 0.15 m: "
                "<sphere><radius>0.15</radius></sphere>.",
                zh=f"球的半径是 {shape.radius:g} m，应当是 0.15 m：<sphere><radius>0.15</radius></sphere>。",
            )


def shapes_of(model, kind):
    parts = [part for link in model.links for part in (*link.collisions, *link.visuals)]
    return [part.geometry for part in parts if isinstance(part.geometry, kind)]


@check("world", en="mbot pushes the ball, and the wall stops mbot.", zh="mbot 能推动球，墙能挡住 mbot。")
def robot_meets_models(work):
    with simulate(work, yard(work), pose=(0.8, 0.6, 0, 0, 0, 0)) as test:
        start_x, start_y, *_ = test.simulation.model_pose("ball")
        if math.hypot(start_x - 1.5, start_y - 0.6) > 0.1:
            raise NotYet(
                en=f"The ball is at x = {start_x:g}, y = {start_y:g}, but should be at x = 1.5, y = 0.6.",
                zh=f"球在 x = {start_x:g}、y = {start_y:g}，应当在 x = 1.5、y = 0.6。",
            )
        test.drive(0.4)
        test.advance(10.0)
        x, _, z, _ = pose(test)
        if z < -0.5:
            raise NotYet(
                en="The robot falls: the world has no ground; include model://ground_plane.",
                zh="机器人一直下落：世界里没有地面；请 include model://ground_plane。",
            )
        ball_x, ball_y, *_ = test.simulation.model_pose("ball")
    if math.hypot(ball_x - 1.5, ball_y - 0.6) < 0.05:
        raise NotYet(
            en="The robot did not move the ball at x = 1.5, y = 0.6.", zh="机器人没有推动 x = 1.5、y = 0.6 处的球。"
        )
    if x > 2.9:
        raise NotYet(en="The robot drove through the wall.", zh="机器人穿过了墙。")


def explain_missing_robot(nodes):
    """Return why the started world has no robot with a drive, as far as the nodes tell."""
    if "/gazebo" not in nodes:
        return NotYet(
            en="The launch file does not start the simulation; include gazebo.launch.py.",
            zh="launch 文件没有启动仿真；请包含 gazebo.launch.py。",
        )
    if "/spawn_entity" in nodes:
        return NotYet(
            en="spawn_entity.py still waits for the robot; its arguments must be '-topic', 'robot_description'.",
            zh="spawn_entity.py 仍在等待机器人；它的参数应当是 '-topic', 'robot_description'。",
        )
    return NotYet(
        en="The world has no robot with a drive; the launch file must start spawn_entity.py, and load mbot_sim.xacro.",
        zh="世界里没有带驱动的机器人；launch 文件应当启动 spawn_entity.py，并加载 mbot_sim.xacro。",
    )


@check("load", en="load_mbot.launch.py puts the robot into the world.", zh="load_mbot.launch.py 把机器人放进世界。")
def launch_loads_robot(work):
    with work.package("my_worlds").launch("load_mbot.launch.py") as running:
        running.expect_node("/robot_state_publisher")
        try:
            running.wait_for_message("/odom")
        except NotYet as reason:
            if "the launch says" in str(reason):
                raise
            raise explain_missing_robot(running.nodes()) from None
        if running.wait_for_parameter("/robot_state_publisher", "use_sim_time") is not True:
            raise NotYet(
                en="robot_state_publisher does not use the clock of the simulation; set 'use_sim_time': True.",
                zh="robot_state_publisher 没有使用仿真的时钟；请设置 'use_sim_time': True。",
            )
        try:
            running.wait_for_message("/scan", lambda scan: min(scan.ranges) < 4.0)
        except NotYet:
            raise NotYet(
                en="The laser of the started world does not see the wall of yard.world; pass the argument world to "
                "gazebo.launch.py with launch_arguments.",
                zh="启动的世界里，激光雷达看不到 yard.world 的墙；"
                "请用 launch_arguments 把参数 world 传给 gazebo.launch.py。",
            ) from None


@check("load", en="The package my_worlds has no findings.", zh="功能包 my_worlds 没有任何问题。")
def package_has_no_findings(work):
    package = work.package("my_worlds")
    package.expect_installed("launch/load_mbot.launch.py", "worlds/yard.world")
    package.expect_dependencies(*NEEDED)
    package.expect_no_findings()


@check("wall", en="The distance to the wall is right.", zh="到墙的距离正确。")
def knows_distance(work):
    slips = {
        3.0: NotYet(en="3.0 m is the distance to the middle of the wall.", zh="3.0 m 是到墙中心的距离。"),
        2.7: NotYet(en="2.7 m is the distance from the front of the body.", zh="2.7 m 是从机身前缘算起的距离。"),
    }
    work.expect_number(2.9, tolerance=0.05, slips=slips)
