import re
from typing import Any, NamedTuple

import numpy as np

from linkwright.control.hardware.description import hardware_from_robot
from linkwright.diagnostics import SourceText
from linkwright.graph import LogLevel, QoSProfile, ReliabilityPolicy
from linkwright.graph.qos.compatibility import QoSCompatibility, qos_check_compatible
from linkwright.learning import NotYet, check, expect_published
from linkwright.messages import get_message
from linkwright.packages.readers.cmake import read_cmake
from linkwright.packages.readers.launch_files import read_launch_file
from linkwright.packages.readers.python_values import argument_of
from linkwright.testing import SteppedGraph

String, Image, CameraInfo, PointStamped = (
    get_message(name)
    for name in (
        "std_msgs/msg/String",
        "sensor_msgs/msg/Image",
        "sensor_msgs/msg/CameraInfo",
        "geometry_msgs/msg/PointStamped",
    )
)
WIDTH, HEIGHT, FOCAL_LENGTH = 320, 240, 240.0
BALL_COLUMN = 80
RELIABLE = QoSProfile(depth=10)
BEST_EFFORT = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
COLORS = {"red": ("红", (200, 20, 20)), "green": ("绿", (20, 160, 30)), "blue": ("蓝", (20, 30, 200))}
"""The Chinese name and the RGB value of each ball."""

IMAGES = 5


class Seen(NamedTuple):
    """The messages on /ball, and the warnings and errors in the log of color_finder."""

    balls: list[Any]
    complaints: list[Any]


def ball_image(color, encoding, stamp):
    """Return an image of a ball on the left, in an encoding."""
    pixels = np.full((HEIGHT, WIDTH, 3), 90, np.uint8)
    columns, rows = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    value = COLORS[color][1]
    pixels[np.hypot(columns - BALL_COLUMN, rows - 120) < 20] = value if encoding == "rgb8" else value[::-1]
    if encoding == "mono8":
        pixels = pixels[:, :, :1]
    image = Image(height=HEIGHT, width=WIDTH, encoding=encoding, step=pixels.strides[0], data=pixels.tobytes())
    image.header.stamp = stamp
    image.header.frame_id = "camera"
    return image


def see(work, color, encoding, profile=RELIABLE, target="red"):
    """Show images to color_finder, and return what it publishes and logs."""
    main = work.package("my_senses").program("color_finder")
    with SteppedGraph() as test:
        balls = test.record("/ball", "geometry_msgs/msg/PointStamped")
        test.start_program(main)
        test.advance(0.5)
        test.publish("/target", String(data=target))
        test.advance(0.1)
        for _ in range(IMAGES):
            stamp = test.node.get_clock().now().to_msg()
            lens = CameraInfo(height=HEIGHT, width=WIDTH)
            lens.k = [FOCAL_LENGTH, 0.0, WIDTH / 2, 0.0, FOCAL_LENGTH, HEIGHT / 2, 0.0, 0.0, 1.0]
            lens.header.stamp = stamp
            test.publish("/camera/camera_info", lens, profile)
            test.publish("/camera/image_raw", ball_image(color, encoding, stamp), profile)
            test.advance(0.1)
        if color == target and profile is BEST_EFFORT:
            expect_published(test, "/ball", "geometry_msgs/msg/PointStamped", balls)
        complaints = [record for record in test.log if record.level >= LogLevel.WARN]
        return Seen(list(balls), complaints)


def expect_ball(seen, what_en, what_zh):
    balls = seen.balls
    if not balls:
        raise NotYet(
            en=f"{what_en}, color_finder publishes nothing on /ball.",
            zh=f"{what_zh}，color_finder 没有在 /ball 上发布。",
        )
    point = balls[-1].point
    if not (1.5 < point.x < 2.1 and 0.4 < point.y < 0.8):
        raise NotYet(
            en=f"{what_en}, the ball is at x = {point.x:.2f}, y = {point.y:.2f}, but should be near 1.8, 0.6.",
            zh=f"{what_zh}，球在 x = {point.x:.2f}，y = {point.y:.2f}，应当在 1.8，0.6 附近。",
        )


@check(
    "camera",
    en="color_finder finds each ball in bgr8 and in rgb8.",
    zh="color_finder 在 bgr8 和 rgb8 图像中都能找到各种颜色的球。",
)
def finds_in_encodings(work):
    for encoding in ("rgb8", "bgr8"):
        for color, (chinese, _) in COLORS.items():
            expect_ball(
                see(work, color, encoding, target=color),
                f"For a {color} ball in an image of encoding {encoding}",
                f"图像编码为 {encoding}、其中有{chinese}球时",
            )


@check("camera", en="It does not take a blue ball for a red one.", zh="它不会把蓝球当作红球。")
def keeps_colors_apart(work):
    for encoding in ("rgb8", "bgr8"):
        if see(work, "blue", encoding).balls:
            raise NotYet(
                en=f"In an image of encoding {encoding}, it takes the blue ball for the red one.",
                zh=f"图像编码为 {encoding} 时，它把蓝球当作了红球。",
            )


@check(
    "camera",
    en="It leaves out an image without colors, and logs an error.",
    zh="它不理会没有颜色的图像，并在日志中报告错误。",
)
def survives_other_encodings(work):
    seen = see(work, "red", "mono8")
    if seen.balls:
        raise NotYet(
            en="It finds a red ball in an image of encoding mono8, which has no colors.",
            zh="它在编码为 mono8 的图像中找到了红球，而这种图像没有颜色。",
        )
    if not seen.complaints:
        raise NotYet(
            en="It logs no error for images of encoding mono8: self.get_logger().error(...).",
            zh="图像编码为 mono8 时，它没有在日志中报告错误：self.get_logger().error(...)。",
        )
    if len(seen.complaints) > 1:
        raise NotYet(
            en=f"It logs {len(seen.complaints)} errors for {IMAGES} images of encoding mono8 in {IMAGES / 10:g} s; "
            "with throttle_duration_sec=5.0, error() logs at most one every 5 s.",
            zh=f"{IMAGES / 10:g} s 内有 {IMAGES} 张编码为 mono8 的图像，它报告了 {len(seen.complaints)} 次错误；"
            "加上 throttle_duration_sec=5.0，error() 每 5 s 最多报告一次。",
        )


@check(
    "qos",
    en="color_finder receives images that are sent with best effort.",
    zh="color_finder 能收到以 best effort 发送的图像。",
)
def receives_best_effort(work):
    expect_ball(see(work, "red", "rgb8", BEST_EFFORT), "For a camera with best effort", "摄像头以 best effort 发布时")


@check("qos", en="It still receives those of the simulated camera.", zh="它仍然能收到仿真摄像头的图像。")
def receives_reliable(work):
    expect_ball(see(work, "red", "rgb8", RELIABLE), "For a reliable camera", "摄像头以 reliable 发布时")


@check("qos", en="go_to_ball receives the balls.", zh="go_to_ball 能收到球的位置。")
def driver_receives_balls(work):
    with SteppedGraph() as test:
        for package, name in (("my_senses", "color_finder"), ("my_mission", "go_to_ball")):
            test.start_program(work.package(package).program(name))
        test.advance(0.5)
        for offered in test.graph.get_publishers_info_by_topic("/ball"):
            for asked in test.graph.get_subscriptions_info_by_topic("/ball"):
                compatibility, _ = qos_check_compatible(offered.qos_profile, asked.qos_profile)
                if compatibility is QoSCompatibility.ERROR:
                    raise NotYet(
                        en="color_finder offers /ball with best effort, but go_to_ball asks for reliable; the profile "
                        "for sensors is for the subscriptions to the camera.",
                        zh="color_finder 以 best effort 发布 /ball，而 go_to_ball 要求 reliable；"
                        "传感器的配置只用于对摄像头的订阅。",
                    )


@check(
    "give-up",
    en="After search_time without a ball, go_to_ball stops and waits.",
    zh="search_time 内没看到球，go_to_ball 就停下等待。",
)
def gives_up(work):
    for arguments, before, after in (([], 18.0, 22.0), (["--ros-args", "-p", "search_time:=5.0"], 4.0, 6.0)):
        named = " ".join(arguments[2:])
        with_en, with_zh = (f" with {named}", f"（{named}）") if named else ("", "")
        with SteppedGraph() as test:
            commands, states = start_driver(work, test, arguments)
            test.publish("/target", String(data="red"))
            test.advance(before)
            if not commands.last.angular.z:
                raise NotYet(
                    en=f"{before:g} s after the command{with_en}, it no longer searches.",
                    zh=f"命令之后 {before:g} s{with_zh}，它已经不再寻找。",
                )
            test.advance(after - before)
            if commands.last.angular.z or states.last.data != "waiting":
                raise NotYet(
                    en=f"{after:g} s after the command{with_en}, it is {states.last.data} and turns at "
                    f"{commands.last.angular.z:g} rad/s.",
                    zh=f"命令之后 {after:g} s{with_zh}，它的状态是 {states.last.data}，"
                    f"以 {commands.last.angular.z:g} rad/s 转弯。",
                )
            test.publish("/target", String(data="red"))
            test.advance(before)
            if not commands.last.angular.z:
                raise NotYet(
                    en=f"It gave up. {before:g} s after the next target{with_en}, it does not search; does on_target "
                    "set the time at which the search begins?",
                    zh=f"它放弃了。在下一个目标之后 {before:g} s{with_zh}，它没有在寻找；"
                    "on_target 记下开始寻找的时刻了吗？",
                )


@check("give-up", en="A ball that it sees starts the time anew.", zh="看到球之后，时间重新开始计算。")
def searches_again(work):
    with SteppedGraph() as test:
        commands, _ = start_driver(work, test, ["--ros-args", "-p", "search_time:=5.0"])
        test.publish("/target", String(data="red"))
        test.advance(4.0)
        ball = PointStamped()
        ball.point.x, ball.point.y = 2.0, 0.1
        for _ in range(20):
            ball.header.stamp = test.node.get_clock().now().to_msg()
            test.publish("/ball", ball)
            test.advance(0.1)
        if not commands.last.linear.x:
            raise NotYet(en="It does not drive to a ball that it finds.", zh="找到球之后，它没有驶向球。")
        test.advance(3.0)
        if not commands.last.angular.z:
            raise NotYet(
                en="When it loses the ball, it does not search for another 5 s.",
                zh="球丢失之后，它没有再寻找 5 s。",
            )


def start_driver(work, test, arguments):
    commands = test.record("/cmd_vel", "geometry_msgs/msg/Twist")
    states = test.record("/state", "std_msgs/msg/String")
    test.start_program(work.package("my_mission").program("go_to_ball"), arguments)
    test.advance(0.5)
    if not len(commands) or not len(states):
        raise NotYet(
            en="go_to_ball publishes nothing on /cmd_vel or /state.",
            zh="go_to_ball 没有在 /cmd_vel 或 /state 上发布。",
        )
    return commands, states


BRINGUP, MODEL, LAUNCH = "my_robot_bringup", "urdf/mbot_hardware.xacro", "robot.launch.py"
REAL, MOCK = "diffdrive_arduino/DiffDriveArduinoHardware", "mock_components/GenericSystem"
WHEELS = ("left_wheel_joint", "right_wheel_joint")


def hardware(work, **arguments):
    """Return the only <ros2_control> of the learner's robot."""
    found, _ = hardware_from_robot(work.package(BRINGUP).robot(MODEL, **arguments).robot)
    if len(found) != 1:
        raise NotYet(
            en=f"The robot has {len(found)} elements <ros2_control>, but should have one.",
            zh=f"机器人有 {len(found)} 个 <ros2_control>，应当有一个。",
        )
    return found[0]


@check(
    "hardware",
    en="Both wheels take velocities, and report position and velocity.",
    zh="两个轮子都接受速度命令，并报告位置和速度。",
)
def wheels_have_interfaces(work):
    joints = {joint.name: joint for joint in hardware(work).joints}
    for name in WHEELS:
        if name not in joints:
            raise NotYet(en=f"<ros2_control> has no joint '{name}'.", zh=f"<ros2_control> 中没有关节“{name}”。")
        commands, states = (
            {each.name for each in each_kind} for each_kind in (joints[name].commands, joints[name].states)
        )
        if commands != {"velocity"} or states != {"position", "velocity"}:
            actual = f"{', '.join(sorted(commands)) or '-'}; {', '.join(sorted(states)) or '-'}"
            raise NotYet(
                en=f"The interfaces of '{name}' are: {actual}; they should be: velocity; position, velocity.",
                zh=f"“{name}”的命令接口和状态接口是：{actual}。应当是 velocity；position, velocity。",
            )


JOINTS = {"left_wheel_name": "left_wheel_joint", "right_wheel_name": "right_wheel_joint"}
NUMBERS = ("baud_rate", "timeout_ms", "loop_rate", "enc_counts_per_rev")


@check("hardware", en="The hardware is a system with its parameters.", zh="硬件的类型是 system，参数齐全。")
def hardware_has_parameters(work):
    system = hardware(work)
    if system.type != "system":
        raise NotYet(
            en=f"The type of <ros2_control> is '{system.type}', but should be 'system': it moves two joints.",
            zh=f"<ros2_control> 的 type 是“{system.type}”，应当是“system”：它驱动两个关节。",
        )
    for name in (*JOINTS, *NUMBERS, "calculate_dynamics"):
        value = system.parameters.get(name)
        if value is None:
            raise NotYet(en=f"<hardware> has no parameter '{name}'.", zh=f"<hardware> 中没有参数“{name}”。")
        if name in NUMBERS and not re.fullmatch(r"\s*[1-9][0-9]*\s*", value):
            raise NotYet(
                en=f"The parameter '{name}' is '{value}', but should be a whole number over 0.",
                zh=f"参数“{name}”是“{value}”，应当是大于 0 的整数。",
            )
        if name in JOINTS and value.strip() != JOINTS[name]:
            raise NotYet(
                en=f"The parameter '{name}' is '{value}', but should be the joint '{JOINTS[name]}'.",
                zh=f"参数“{name}”是“{value}”，应当是关节“{JOINTS[name]}”。",
            )


@check("hardware", en="The arguments hardware and device are used.", zh="参数 hardware 和 device 起作用。")
def arguments_select_hardware(work):
    for arguments, plugin, device in (
        ({}, REAL, "/dev/ttyUSB0"),
        ({"hardware": MOCK}, MOCK, "/dev/ttyUSB0"),
        ({"device": "/dev/ttyACM1"}, REAL, "/dev/ttyACM1"),
    ):
        system = hardware(work, **arguments)
        named = ", ".join(f"{name}:={value}" for name, value in arguments.items())
        actual = system.plugin, system.parameters.get("device", "-")
        if actual != (plugin, device):
            raise NotYet(
                en=f"With {named or 'no arguments'}, plugin and device are {actual[0]} and {actual[1]}, but should be "
                f"{plugin} and {device}.",
                zh=f"参数为“{named or '无'}”时，插件和设备是 {actual[0]} 和 {actual[1]}，应当是 {plugin} 和 {device}。",
            )


WHEEL_PARAMETERS = {
    "left_wheel_names": ["left_wheel_joint"],
    "right_wheel_names": ["right_wheel_joint"],
    "wheel_separation": 0.38,
    "wheel_radius": 0.06,
}


@check(
    "bringup",
    en="robot.launch.py starts the controllers and the mission.",
    zh="robot.launch.py 启动控制器和任务的节点。",
)
def launch_starts_robot(work):
    with work.package(BRINGUP).launch(LAUNCH, hardware=MOCK, camera="false") as running:
        for name in (
            "/robot_state_publisher",
            "/controller_manager",
            "/base_controller",
            "/color_finder",
            "/go_to_ball",
        ):
            running.expect_node(name)
        running.wait_for_message("/joint_states", lambda message: set(WHEELS) <= set(message.name))
        if "/gazebo" in running.nodes():
            raise NotYet(en="The simulator starts, too.", zh="仿真器也启动了。")
        for name in ("/go_to_ball", "/color_finder"):
            if running.wait_for_parameter(name, "use_sim_time"):
                raise NotYet(
                    en=f"{name} waits for simulated time: use_sim_time is true.",
                    zh=f"{name} 在等待仿真时间：use_sim_time 是 true。",
                )
        expect_controller(running)
        expect_hardware(running, MOCK, f"hardware:={MOCK}")
        if has_camera(running):
            raise NotYet(
                en="With camera:=false, the driver of the camera still starts; has its node the argument condition?",
                zh="camera:=false 时，摄像头的驱动仍然启动；它的节点有参数 condition 吗？",
            )


def expect_controller(running):
    """Require base_controller to have its parameters, and to subscribe to /cmd_vel."""
    for name, value in WHEEL_PARAMETERS.items():
        actual = running.wait_for_parameter("/base_controller", name)
        if actual != value:
            raise NotYet(
                en=f"{name} of /base_controller is {actual or 'missing'}, but should be {value}.",
                zh=f"/base_controller 的 {name} 是 {actual or '空'}，应当是 {value}。",
            )
    subscribers = running.subscribers("/cmd_vel")
    if "/base_controller" not in subscribers:
        en, zh = ([problem.get(language) for problem in running.problems()] for language in ("en", "zh"))
        raise NotYet(
            en=f"base_controller does not subscribe to /cmd_vel; its subscribers are: {', '.join(subscribers) or '-'}. "
            f"Has ros2_control_node the remapping, and is use_stamped_vel false? {''.join(en[:1])}",
            zh=f"base_controller 没有订阅 /cmd_vel；订阅者是：{', '.join(subscribers) or '-'}。"
            f"ros2_control_node 有这个重映射吗？use_stamped_vel 是 false 吗？{''.join(zh[:1])}",
        )


def expect_hardware(running, plugin, named):
    if plugin not in running.wait_for_parameter("/robot_state_publisher", "robot_description"):
        raise NotYet(
            en=f"With {named}, the robot of robot_state_publisher does not have the plugin {plugin}.",
            zh=f"{named} 时，robot_state_publisher 的机器人没有插件 {plugin}。",
        )


def has_camera(running):
    """Return whether the launch starts the driver of the camera, or reports that its package is missing."""
    started = any(name.startswith("/camera/") or "usb_cam" in name for name in running.nodes())
    return started or any("usb_cam" in str(problem) for problem in running.problems())


@check(
    "bringup",
    en="Without arguments, it starts the driver of the motors and that of the camera.",
    zh="没有参数时，它启动电机的驱动和摄像头的驱动。",
)
def launch_has_defaults(work):
    with work.package(BRINGUP).launch(LAUNCH) as running:
        running.expect_node("/base_controller")
        expect_hardware(running, REAL, "no arguments")
        if not has_camera(running):
            raise NotYet(
                en="Without arguments, the launch file does not start the driver of the camera, usb_cam.",
                zh="没有参数时，launch 文件没有启动摄像头的驱动 usb_cam。",
            )


@check(
    "bringup",
    en="The driver of the camera is usb_cam_node_exe in the namespace camera.",
    zh="摄像头的驱动是命名空间 camera 中的 usb_cam_node_exe。",
)
def camera_has_namespace(work):
    path = work.package(BRINGUP).file(f"launch/{LAUNCH}")
    python_file = read_launch_file(SourceText(str(path), path.read_text(encoding="utf-8")), path.name).python_file
    if python_file is None or any(python_file.calls("PushRosNamespace", "PushROSNamespace")):
        return
    for call in python_file.calls("Node"):
        if python_file.text(argument_of(call, "package")) != "usb_cam":
            continue
        executable = python_file.text(argument_of(call, "executable"))
        if executable not in (None, "usb_cam_node_exe"):
            raise NotYet(
                en=f"The executable of usb_cam is '{executable}', but should be usb_cam_node_exe.",
                zh=f"usb_cam 的可执行文件是“{executable}”，应当是 usb_cam_node_exe。",
            )
        given = {keyword.arg for keyword in call.keywords}
        namespace = python_file.text(argument_of(call, "namespace"))
        if namespace is None and given & {"namespace", "remappings", None}:
            continue  # a value that is known only at run time, or the topics themselves
        if (namespace or "").strip("/") != "camera":
            raise NotYet(
                en=f"usb_cam has {f'the namespace {namespace!r}' if namespace else 'no namespace'}, but the images "
                "should be on /camera/image_raw: namespace='camera'.",
                zh=f"usb_cam {f'的命名空间是“{namespace}”' if namespace else '没有命名空间'}，"
                "而图像应当在 /camera/image_raw 上：namespace='camera'。",
            )


NEEDED = ("controller_manager", "launch_ros", "my_mission", "my_robot_description", "usb_cam", "xacro")
FILES = ("config/controllers.yaml", f"launch/{LAUNCH}", MODEL)


@check(
    "install",
    en="CMakeLists.txt installs the folders config, launch and urdf.",
    zh="CMakeLists.txt 安装文件夹 config、launch 和 urdf。",
)
def cmake_installs(work):
    package = work.package(BRINGUP)
    path = package.file("CMakeLists.txt")
    rules = read_cmake(SourceText(str(path), path.read_text(encoding="utf-8")), package.folder)
    try:
        installed = {file.destination for file in rules.installed_files(package.folder)}
    except FileNotFoundError as error:
        raise NotYet(
            en=f"CMakeLists.txt installs '{error}', which does not exist.",
            zh=f"CMakeLists.txt 安装了不存在的“{error}”。",
        ) from None
    for name in FILES:
        package.file(name)
        if f"share/{BRINGUP}/{name}" not in installed:
            hint_en, hint_zh = hint_about_cmake(commands(path))
            raise NotYet(
                en=f"CMakeLists.txt does not install '{name}' as share/{BRINGUP}/{name}. {hint_en}",
                zh=f"CMakeLists.txt 没有把“{name}”安装为 share/{BRINGUP}/{name}。{hint_zh}",
            )


def commands(path):
    """Return the text of a CMakeLists.txt without comments."""
    return re.sub(r"#.*", "", path.read_text(encoding="utf-8"))


def hint_about_cmake(text):
    """Return the reason why files are not installed, in English and Chinese, or empty texts."""
    if "$(PROJECT_NAME)" in text:
        return "Write ${PROJECT_NAME}, with braces.", "请写 ${PROJECT_NAME}，用花括号。"
    if re.search(r"\binstall\s*\(.*\bproject\s*\(", text, re.DOTALL):
        return "Write install(...) below project(...).", "请把 install(...) 写在 project(...) 的下面。"
    return "", ""


@check("install", en="package.xml lists what the launch file needs.", zh="package.xml 列出了 launch 文件需要的东西。")
def manifest_lists_needed(work):
    work.package(BRINGUP).expect_dependencies(*NEEDED)


@check(
    "install",
    en="CMakeLists.txt finds ament_cmake, and ends with ament_package().",
    zh="CMakeLists.txt 查找 ament_cmake，并以 ament_package() 结束。",
)
def cmake_registers_package(work):
    text = commands(work.package(BRINGUP).file("CMakeLists.txt"))
    if not re.search(r"^\s*find_package\s*\(\s*ament_cmake\b", text, re.MULTILINE):
        raise NotYet(
            en="CMakeLists.txt does not call find_package(ament_cmake REQUIRED), so CMake does not know "
            "ament_package().",
            zh="CMakeLists.txt 没有调用 find_package(ament_cmake REQUIRED)，所以 CMake 不认识 ament_package()。",
        )
    end = re.search(r"^\s*ament_package\s*\(", text, re.MULTILINE)
    if end is None:
        raise NotYet(
            en="CMakeLists.txt does not call ament_package() at its end, so ROS does not find the built package.",
            zh="CMakeLists.txt 的末尾没有调用 ament_package()，所以 ROS 找不到构建好的功能包。",
        )
    if re.search(r"^\s*install\s*\(", text[end.end() :], re.MULTILINE):
        raise NotYet(
            en="ament_package() must be the last command of CMakeLists.txt: move install(...) above it.",
            zh="ament_package() 必须是 CMakeLists.txt 的最后一条命令：请把 install(...) 移到它的上面。",
        )


@check("install", en="No package has findings.", zh="所有功能包都没有问题。")
def packages_have_no_findings(work):
    for name in (BRINGUP, "my_mission", "my_senses"):
        work.package(name).expect_no_findings()


@check("domain", en="The port is right.", zh="端口正确。")
def knows_port(work):
    slips = {
        42: NotYet(en="That is the domain; the answer is a port.", zh="这是域；答案是端口。"),
        17.9: NotYet(en="Write the number without a comma.", zh="请不要在数字中写逗号。"),
        17650: NotYet(
            en="That is the port of domain 41; domain 0 has 7400.", zh="这是域 41 的端口；域 0 的端口是 7400。"
        ),
        7442: NotYet(en="Each domain has 250 ports, not one.", zh="每个域有 250 个端口，不是一个。"),
        10500: NotYet(en="Add the 7400 of domain 0.", zh="请加上域 0 的 7400。"),
        7650: NotYet(en="That is the port of domain 1.", zh="这是域 1 的端口。"),
        18150: NotYet(
            en="That is the port of domain 43; domain 0 has 7400.", zh="这是域 43 的端口；域 0 的端口是 7400。"
        ),
    }
    work.expect_number(17900, tolerance=0.5, slips=slips)
