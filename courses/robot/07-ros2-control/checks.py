import math

from linkwright import load
from linkwright.control.hardware.description import hardware_from_robot
from linkwright.graph.parameters.files import read_parameter_file
from linkwright.learning import NotYet, check
from linkwright.learning.checks.findings import describe_finding

XACRO, CONTROLLERS = "urdf/mbot_control.xacro", "config/controllers.yaml"
WHEELS = ("left_wheel_joint", "right_wheel_joint")
MOCK, GAZEBO = "mock_components/GenericSystem", "gazebo_ros2_control/GazeboSystem"
LIBRARY, ROS1_LIBRARY = "libgazebo_ros2_control.so", "libgazebo_ros_control.so"
TYPES = {
    "joint_state_broadcaster": "joint_state_broadcaster/JointStateBroadcaster",
    "base_controller": "diff_drive_controller/DiffDriveController",
}
LIMITS = {"linear.x.max_velocity": 0.5, "linear.x.max_acceleration": 0.5, "angular.z.max_velocity": 2.0}


def package(work):
    return work.package("my_robot_description")


def systems(work, **arguments):
    found, findings = hardware_from_robot(package(work).robot(XACRO, **arguments).robot)
    if not found and findings:
        raise NotYet(describe_finding(findings[0]))
    if not found:
        raise NotYet(en="The robot has no <ros2_control>.", zh="机器人没有 <ros2_control>。")
    return found


def expect_dependencies(work, names):
    package(work).expect_dependencies(*names)


@check("interfaces", en="Both wheels take velocities.", zh="两个轮子都接受速度命令。")
def wheels_take_velocities(work):
    commands = {
        joint.name: [command.name for command in joint.commands] for system in systems(work) for joint in system.joints
    }
    for name in WHEELS:
        if name not in commands:
            names = ", ".join(commands) or "-"
            raise NotYet(
                en=f"<ros2_control> has no joint '{name}'; its joints are: {names}.",
                zh=f"<ros2_control> 中没有关节“{name}”；它的关节是：{names}。",
            )
        if commands[name] != ["velocity"]:
            names = ", ".join(commands[name]) or "-"
            raise NotYet(
                en=f"The command interface of '{name}' must be velocity; it is: {names}.",
                zh=f"“{name}”的命令接口应当是 velocity；现在是：{names}。",
            )


@check("interfaces", en="Both wheels report position and velocity.", zh="两个轮子都报告位置和速度。")
def wheels_report_state(work):
    states = {joint.name: {state.name for state in joint.states} for system in systems(work) for joint in system.joints}
    for name in WHEELS:
        if missing := {"position", "velocity"} - states.get(name, set()):
            raise NotYet(
                en=f"The joint '{name}' has no state interface '{min(missing)}'.",
                zh=f"关节“{name}”没有状态接口“{min(missing)}”。",
            )


@check("interfaces", en="The argument hardware selects the hardware.", zh="参数 hardware 选择硬件。")
def argument_selects_hardware(work):
    for arguments, expected in (({}, MOCK), ({"hardware": GAZEBO}, GAZEBO)):
        plugins = {system.plugin for system in systems(work, **arguments)}
        if plugins != {expected}:
            names = ", ".join(sorted(plugins))
            raise NotYet(
                en=f"With hardware:={expected}, the hardware is {names}; write <plugin>$(arg hardware)</plugin>, and "
                f"{MOCK} as the default.",
                zh=f"hardware:={expected} 时，硬件是 {names}；请写 <plugin>$(arg hardware)</plugin>，默认值是 {MOCK}。",
            )


def parameters(work, node):
    """Return the parameters that ROS 2 would read for a node from the learner's file."""
    found = read_parameter_file(package(work).file(CONTROLLERS)).for_node("/" + node)
    if not found:
        raise NotYet(
            en=f"controllers.yaml has no {node}: with ros__parameters: below it.",
            zh=f"controllers.yaml 中没有 {node}: 和它下面的 ros__parameters:。",
        )
    return found


@check("controllers", en="The manager knows the types of both controllers.", zh="管理器知道两个控制器的类型。")
def manager_knows_types(work):
    manager = parameters(work, "controller_manager")
    for name, expected in TYPES.items():
        actual = manager.get(f"{name}.type")
        if actual != expected:
            raise NotYet(
                en=f"The type of {name} is {actual}, but should be {expected}.",
                zh=f"{name} 的类型是 {actual}，应当是 {expected}。",
            )


@check("controllers", en="base_controller knows the wheels.", zh="base_controller 知道两个轮子。")
def controller_knows_wheels(work):
    found = parameters(work, "base_controller")
    wanted = {"left_wheel_names": [WHEELS[0]], "right_wheel_names": [WHEELS[1]]}
    for name, expected in wanted.items():
        if found.get(name) != expected:
            raise NotYet(
                en=f"{name} is {found.get(name)!r}, but should be the list {expected}.",
                zh=f"{name} 是 {found.get(name)!r}，应当是列表 {expected}。",
            )
    for name, size in (("wheel_separation", 0.38), ("wheel_radius", 0.06)):
        value = found.get(name)
        if not isinstance(value, (int, float)) or abs(value - size) > 0.001:
            raise NotYet(
                en=f"{name} is {value!r}, but should be {size}, a number in m.",
                zh=f"{name} 是 {value!r}，应当是数 {size}（单位 m）。",
            )


@check("controllers", en="The package installs the file.", zh="功能包会安装这个文件。")
def file_is_installed(work):
    package(work).file(CONTROLLERS)
    package(work).expect_installed(CONTROLLERS)


def expect_controllers(running):
    """Require the topics of both controllers."""
    expect_topic(running, "joint_state_broadcaster", "/joint_states", lambda message: set(WHEELS) <= set(message.name))
    expect_topic(running, "base_controller", "/base_controller/odom")


def expect_topic(running, controller, topic, condition=None):
    """Require a controller to publish, and name the spawner if nothing starts it."""
    try:
        running.wait_for_message(topic, *([] if condition is None else [condition]))
    except NotYet as reason:
        if "the launch says" in str(reason) or "/controller_manager" not in running.nodes():
            raise
        raise NotYet(
            en=f"Nothing of {controller} is published on {topic}; the launch file must start 'spawner' with "
            "arguments=['joint_state_broadcaster', 'base_controller'].",
            zh=f"{controller} 没有在 {topic} 上发布；launch 文件应当启动 'spawner'，并写 "
            "arguments=['joint_state_broadcaster', 'base_controller']。",
        ) from None


@check("start", en="control.launch.py starts both controllers.", zh="control.launch.py 启动两个控制器。")
def launch_starts_controllers(work):
    with package(work).launch("control.launch.py") as running:
        running.expect_node("/controller_manager")
        expect_controllers(running)


@check("start", en="package.xml lists what the launch file starts.", zh="package.xml 列出 launch 文件启动的东西。")
def lists_controllers(work):
    package(work).file("launch/control.launch.py")
    expect_dependencies(work, {"controller_manager", "diff_drive_controller", "joint_state_broadcaster"})


@check("start", en="The package has no findings.", zh="功能包没有任何问题。")
def package_has_no_findings(work):
    package(work).expect_installed("launch/control.launch.py")
    package(work).expect_no_findings()


@check("speed", en="The speed of the wheels is right.", zh="轮子的转速正确。")
def knows_speed(work):
    slips = {
        2.5: NotYet(
            en="2.5 rad/s is for a radius of 0.12 m; that is the diameter.", zh="2.5 rad/s 用的是 0.12 m；那是直径。"
        ),
        0.3: NotYet(
            en="0.3 m/s is the speed of the robot, not of a wheel.", zh="0.3 m/s 是机器人的速度，不是轮子的转速。"
        ),
    }
    work.expect_number(5.0, tolerance=0.15, slips=slips)


@check("limits", en="base_controller has the three limits.", zh="base_controller 有三个限制。")
def controller_has_limits(work):
    with package(work).launch("control.launch.py") as running:
        for name, expected in LIMITS.items():
            value = running.wait_for_parameter("/base_controller", name)
            if math.isnan(value):
                raise NotYet(en=f"base_controller has no {name}.", zh=f"base_controller 没有 {name}。")
            if value != expected:
                raise NotYet(
                    en=f"{name} of base_controller is {value}, but should be {expected}.",
                    zh=f"base_controller 的 {name} 是 {value}，应当是 {expected}。",
                )


@check("simulate", en="The hardware is that of the simulator.", zh="硬件是仿真器的。")
def hardware_is_simulated(work):
    with package(work).launch("control_world.launch.py") as running:
        text = running.wait_for_message("/robot_description").data
    found, _ = hardware_from_robot(load(text))
    plugins = ", ".join(sorted({system.plugin for system in found})) or "-"
    if plugins != GAZEBO:
        raise NotYet(
            en=f"In control_world.launch.py, the hardware is {plugins}, but should be {GAZEBO}.",
            zh=f"在 control_world.launch.py 中，硬件是 {plugins}，应当是 {GAZEBO}。",
        )
    if ROS1_LIBRARY in text:
        raise NotYet(
            en=f"{ROS1_LIBRARY} is the plugin of ROS 1, which does not read <ros2_control>; write {LIBRARY}.",
            zh=f"{ROS1_LIBRARY} 是 ROS 1 的插件，不读取 <ros2_control>；请写 {LIBRARY}。",
        )


@check("simulate", en="The controllers run in the simulated world.", zh="控制器在仿真世界中运行。")
def controllers_run_in_world(work):
    with package(work).launch("control_world.launch.py") as running:
        running.wait_for_message("/clock")
        expect_controllers(running)
        managers = running.nodes().count("/controller_manager")
    if managers > 1:
        raise NotYet(
            en=f"{managers} controller managers run; the simulator has its own, so ros2_control_node must not start.",
            zh=f"有 {managers} 个控制器管理器在运行；仿真器自带一个，因此不要启动 ros2_control_node。",
        )


@check("simulate", en="package.xml lists the simulator and its plugin.", zh="package.xml 列出仿真器和它的插件。")
def lists_simulator(work):
    expect_dependencies(work, {"gazebo_ros", "gazebo_ros2_control"})


@check("simulate", en="The package has no findings.", zh="功能包没有任何问题。")
def package_still_has_no_findings(work):
    package(work).expect_installed("launch/control_world.launch.py")
    package(work).expect_no_findings()
