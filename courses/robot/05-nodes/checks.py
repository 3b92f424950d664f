import math
import re

from linkwright import SteppedSimulation
from linkwright.learning import NotYet, check, expect_published
from linkwright.messages import get_message, get_service
from linkwright.testing import SteppedGraph

SPEED, TURN = 0.2, 0.5
TWIST = "geometry_msgs/msg/Twist"
SET_PARAMETERS = "/set_parameters"
BUDGET = 5.0
"""The seconds for which the node may compute without waiting."""


def program(work, name):
    return work.package("my_control").program(name)


def simulate(work):
    return SteppedSimulation("empty", work.package("my_robot_description").file("urdf/mbot_sim.xacro"))


@check(
    "package",
    en="The package my_control has the executable first_move.",
    zh="功能包 my_control 有可执行文件 first_move。",
)
def has_executable(work):
    program(work, "first_move")


def run_first_move(work, seconds, *arguments):
    """Run the node, and return the recorded velocities."""
    main = program(work, "first_move")
    with simulate(work) as test:
        commands = test.record("/cmd_vel", TWIST)
        test.start_program(main, ["--ros-args", "-p", "use_sim_time:=true", *arguments], budget=BUDGET)
        test.advance(seconds)
        expect_published(test, "/cmd_vel", TWIST, commands)
        running = list(commands)
        position = test.robot_pose()[:2]
    return running, list(commands), position


@check(
    "publish", en="first_move publishes on /cmd_vel ten times a second.", zh="first_move 每秒在 /cmd_vel 上发布十次。"
)
def publishes_at_rate(work):
    commands, _, _ = run_first_move(work, 2.0)
    if not 15 <= len(commands) <= 25:
        raise NotYet(
            en=f"The node published {len(commands)} messages in 2 s, but should publish about 20; compare the timer: "
            "create_timer(0.1, self.move), with the period in seconds and the function without parentheses.",
            zh=f"节点在 2 s 内发布了 {len(commands)} 条消息，应当约为 20 条；请检查定时器："
            "create_timer(0.1, self.move)，周期以秒为单位，函数名后不加括号。",
        )


@check("publish", en="It drives at 0.2 m/s and turns at 0.5 rad/s.", zh="它以 0.2 m/s 前进，以 0.5 rad/s 转弯。")
def publishes_velocity(work):
    commands, _, _ = run_first_move(work, 1.0)
    last = commands[-1]
    if abs(last.linear.x - SPEED) > 0.001 or abs(last.angular.z - TURN) > 0.001:
        raise NotYet(
            en=f"linear.x is {last.linear.x:g} and angular.z is {last.angular.z:g}, but should be 0.2 and 0.5.",
            zh=f"linear.x 是 {last.linear.x:g}，angular.z 是 {last.angular.z:g}，应当是 0.2 和 0.5。",
        )


@check("circle", en="The radius of the circle is right.", zh="圆的半径正确。")
def knows_radius(work):
    slips = {
        0.8: NotYet(en="0.8 m is the diameter.", zh="0.8 m 是直径。"),
        0.1: NotYet(en="0.1 is the product of both; divide them.", zh="0.1 是两者的乘积；应当相除。"),
        2.5: NotYet(en="2.5 is the turn rate divided by the speed.", zh="2.5 是角速度除以速度。"),
    }
    work.expect_number(0.4, tolerance=0.03, slips=slips)


@check("stop", en="rclpy leaves Ctrl-C to the program.", zh="rclpy 把 Ctrl-C 留给程序处理。")
def leaves_signals(work):
    sources = (work.package("my_control").folder / "my_control").glob("*.py")
    if not any(
        re.search(r"SignalHandlerOptions\.NO\b|\bsignal\.signal\(", source.read_text("utf-8")) for source in sources
    ):
        raise NotYet(
            en="After rclpy.init() alone, Ctrl-C shuts rclpy down before the program can publish; write "
            "rclpy.init(signal_handler_options=SignalHandlerOptions.NO).",
            zh="只写 rclpy.init() 时，按 Ctrl-C 会先关闭 rclpy，程序来不及发布；请写成 "
            "rclpy.init(signal_handler_options=SignalHandlerOptions.NO)。",
        )


@check("stop", en="The last velocity is zero when the node has ended.", zh="节点结束后，最后的速度是零。")
def stops_robot(work):
    _, all_commands, _ = run_first_move(work, 1.0)
    last = all_commands[-1]
    if last.linear.x or last.angular.z:
        raise NotYet(
            en="After Ctrl-C the last message still has a velocity; publish a zero Twist before rclpy shuts down.",
            zh="按 Ctrl-C 之后，最后一条消息仍有速度；请在 rclpy 关闭之前发布零 Twist。",
        )


def expect_speed(work, speed, *arguments):
    commands, _, _ = run_first_move(work, 1.0, *arguments)
    actual = commands[-1].linear.x
    if abs(actual - speed) > 0.001:
        what = " ".join(arguments) or "no arguments"
        raise NotYet(
            en=f"With {what}, the speed is {actual:g} m/s, but should be {speed:g}; it must come from a parameter with "
            "the name speed.",
            zh=f"参数为“{' '.join(arguments) or '无'}”时，速度是 {actual:g} m/s，应当是 {speed:g}；"
            "速度应当来自名为 speed 的参数。",
        )


@check("parameter", en="Without arguments the speed is 0.2 m/s.", zh="不带参数时，速度是 0.2 m/s。")
def has_default(work):
    expect_speed(work, SPEED)


@check("parameter", en="With speed:=0.4 it is 0.4 m/s.", zh="speed:=0.4 时，速度是 0.4 m/s。")
def obeys_parameter(work):
    expect_speed(work, 0.4, "-p", "speed:=0.4")


@check("parameter", en="A change while the node runs counts at once.", zh="节点运行时修改参数，立即生效。")
def obeys_change(work):
    with SteppedGraph() as test:
        commands = test.record("/cmd_vel", TWIST)
        test.start_program(program(work, "first_move"), budget=BUDGET)
        test.advance(0.5)
        expect_published(test, "/cmd_vel", TWIST, commands)
        service = next(name for name, _ in test.graph.get_service_names_and_types() if name.endswith(SET_PARAMETERS))
        request = get_service("rcl_interfaces/srv/SetParameters").Request()
        value = get_message("rcl_interfaces/msg/ParameterValue")(type=3, double_value=0.1)
        request.parameters = [get_message("rcl_interfaces/msg/Parameter")(name="speed", value=value)]
        test.call(service, request, timeout=1.0)
        test.advance(0.5)
        speed = commands.last.linear.x
    if abs(speed - 0.1) > 0.001:
        raise NotYet(
            en=f"After 'param set speed 0.1', the speed is still {speed:g} m/s; read the parameter in move().",
            zh=f"执行“param set speed 0.1”之后，速度仍是 {speed:g} m/s；请在 move() 中读取参数。",
        )


def drive_with_odometer(work, test):
    """Drive forward and back, and return the recorded distances and the way driven."""
    distances = test.record("/distance", "std_msgs/msg/Float64")
    test.start_program(program(work, "odometer"), ["--ros-args", "-p", "use_sim_time:=true"], budget=BUDGET)
    test.advance(0.5)
    way, last = 0.0, test.robot_pose()[:2]
    for speed in (0.4, -0.4):
        test.drive(speed)
        for _ in range(20):
            test.advance(0.1)
            here = test.robot_pose()[:2]
            way += math.dist(last, here)
            last = here
    expect_published(test, "/distance", "std_msgs/msg/Float64", distances)
    return distances, way


@check(
    "subscribe",
    en="odometer publishes the distance driven on /distance.",
    zh="odometer 在 /distance 上发布走过的路程。",
)
def publishes_distance(work):
    with simulate(work) as test:
        distances, way = drive_with_odometer(work, test)
        distance = distances.last.data
    if abs(distance - way) > 0.1 * way + 0.02:
        raise NotYet(
            en=f"The robot drove {way:.2f} m forward and back, but /distance says {distance:.2f} m.",
            zh=f"机器人前进又后退，共走了 {way:.2f} m，但 /distance 是 {distance:.2f} m。",
        )


@check("service", en="/reset_distance answers with success.", zh="/reset_distance 回答成功。")
def service_answers(work):
    with simulate(work) as test:
        drive_with_odometer(work, test)
        if not call_reset(test).success:
            raise NotYet(en="The answer has success = False.", zh="回答中 success = False。")


@check("service", en="It sets the distance back to zero.", zh="它把路程归零。")
def service_resets(work):
    with simulate(work) as test:
        distances, _ = drive_with_odometer(work, test)
        test.drive(0.0)
        test.advance(0.5)
        call_reset(test)
        test.advance(0.5)
        distance = distances.last.data
    if distance > 0.05:
        raise NotYet(
            en=f"After the call, /distance is still {distance:.2f} m.",
            zh=f"调用之后，/distance 仍是 {distance:.2f} m。",
        )


def offered_services(test):
    return sorted(
        service
        for node, namespace in test.program_nodes
        for service, types in test.graph.get_service_names_and_types_by_node(node, namespace)
        if not types[0].startswith(("rcl_interfaces/", "type_description_interfaces/"))
    )


def no_reset_service(test):
    if offered := offered_services(test):
        return NotYet(
            en=f"There is no service /reset_distance; the program offers {offered[0]}.",
            zh=f"没有服务 /reset_distance；程序提供的是 {offered[0]}。",
        )
    return NotYet(
        en="There is no service /reset_distance: does the program call create_service, and does it still run?",
        zh="没有服务 /reset_distance：程序调用了 create_service 吗？它还在运行吗？",
    )


def call_reset(test):
    types = dict(test.graph.get_service_names_and_types()).get("/reset_distance")
    if types and "std_srvs/srv/Trigger" not in types:
        raise NotYet(
            en=f"The service /reset_distance has the type {types[0]}, but should have std_srvs/srv/Trigger.",
            zh=f"服务 /reset_distance 的类型是 {types[0]}，应当是 std_srvs/srv/Trigger。",
        )
    try:
        return test.call("/reset_distance", get_service("std_srvs/srv/Trigger").Request(), timeout=2.0)
    except LookupError:
        raise no_reset_service(test) from None
    except TimeoutError:
        if "/reset_distance" not in offered_services(test):
            raise no_reset_service(test) from None
        raise NotYet(
            en="The service /reset_distance does not answer; does the callback return the response?",
            zh="服务 /reset_distance 没有回答；回调函数返回 response 了吗？",
        ) from None


@check("time", en="The robot drives during the four seconds.", zh="机器人在四秒之内行驶。")
def drives_during_time(work):
    commands, _, _ = run_first_move(work, 3.0)
    if not commands[-1].linear.x:
        raise NotYet(
            en="After 3 s the robot has stopped already; (now - self.start).nanoseconds * 1e-9 are the seconds since "
            "the first call.",
            zh="3 s 之后机器人已经停下了；(now - self.start).nanoseconds * 1e-9 是从第一次调用起的秒数。",
        )


@check("time", en="It stands still after them.", zh="四秒之后静止。")
def stands_after_time(work):
    commands, _, _ = run_first_move(work, 6.0)
    if commands[-1].linear.x or commands[-1].angular.z:
        raise NotYet(
            en="After 6 s the robot still drives: set the time of the first call only once, and let move() return "
            "after the zero velocity.",
            zh="6 s 之后机器人仍在行驶：第一次调用的时间只记录一次，发布零速度之后让 move() 返回。",
        )


@check("time", en="The four seconds are those of the node's clock.", zh="四秒由节点的时钟计量。")
def uses_clock(work):
    """Run the node with simulated time at half rate, in a simulation that has run for a minute."""
    with SteppedGraph() as test:
        commands = test.record("/cmd_vel", TWIST)
        test.start_program(program(work, "first_move"), ["--ros-args", "-p", "use_sim_time:=true"], budget=BUDGET)
        clock = get_message("rosgraph_msgs/msg/Clock")
        for step in range(130):
            if step == 110:
                early = list(commands)
            now = clock()
            now.clock.sec, now.clock.nanosec = 60 + step // 40, step % 40 * 25_000_000
            test.publish("/clock", now)
            test.advance(0.05)
        expect_published(test, "/cmd_vel", TWIST, commands)
    if early and not any(command.linear.x for command in early):
        raise NotYet(
            en="In a simulation that has run for a minute, the robot does not drive: remember the time at which move() "
            "is called first, and subtract it.",
            zh="仿真已运行一分钟时，机器人不行驶：请记下第一次调用 move() 的时间，并减去它。",
        )
    if early and not early[-1].linear.x:
        raise NotYet(
            en="With a simulation at half speed, the robot stops too early: use self.get_clock().now(), and the "
            "difference to the first time.",
            zh="仿真以一半速度运行时，机器人停得太早：请使用 self.get_clock().now()，并与第一次的时间相减。",
        )


@check("time", en="With duration:=1.0 it stops sooner.", zh="duration:=1.0 时更早停下。")
def obeys_duration(work):
    commands, _, _ = run_first_move(work, 2.0, "-p", "duration:=1.0")
    if commands[-1].linear.x:
        raise NotYet(
            en="With duration:=1.0 the robot still drives after 2 s.",
            zh="duration:=1.0 时，2 s 之后机器人仍在行驶。",
        )
