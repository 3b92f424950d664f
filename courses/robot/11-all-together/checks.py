import importlib.util
import math
from functools import cache

import yaml
from missions import NODE, PACKAGE, Copies, Driver, String, finish, last_error, load_velocity, run_mission

from linkwright import open_recording
from linkwright.learning import NotYet, check
from linkwright.learning.checks.domains import reserve_domain
from linkwright.messages import deserialize
from linkwright.xmltree import parse_file

STOP, SPEED, TURN = 0.5, 0.3, 1.0
RED_BALL, GREEN_BALL = (-1.5, 1.8), (2.0, 1.5)
CENTER_TO_CAMERA = 0.17


@check("decide", en="A ball ahead is driven to, but not too fast.", zh="球在前方时向它行驶，但不太快。")
def drives_to_ball_ahead(work):
    velocity = load_velocity(work)
    for forward in (0.8, 2.0, 5.0):
        speed, turn = velocity(forward, 0.0, STOP, SPEED, TURN)
        if not 0.0 < speed <= SPEED + 1e-9 or abs(turn) > 1e-6:
            raise NotYet(
                en=f"For a ball {forward:g} m straight ahead, the speed is {speed:g} and the turn rate {turn:g}; "
                f"the speed should be over 0 and at most 0.3, the turn rate 0.",
                zh=f"球在正前方 {forward:g} m 时，速度是 {speed:g}，角速度是 {turn:g}；"
                f"速度应当大于 0、不超过 0.3，角速度应当是 0。",
            )


@check("decide", en="It turns toward the ball.", zh="它转向球。")
def turns_to_ball(work):
    velocity = load_velocity(work)
    for left in (0.6, -0.6):
        _, turn = velocity(2.0, left, STOP, SPEED, TURN)
        if turn * left <= 0.0 or abs(turn) > TURN + 1e-9:
            side_en, side_zh = ("left", "左") if left > 0 else ("right", "右")
            raise NotYet(
                en=f"For a ball on the {side_en}, the turn rate is {turn:g}; positive is to the left, and 1 the limit.",
                zh=f"球在{side_zh}边时，角速度是 {turn:g}；正值向左，上限是 1。",
            )


@check("decide", en="It turns slowly to a ball that is almost straight ahead.", zh="球几乎在正前方时，它慢慢转。")
def turns_in_proportion(work):
    velocity = load_velocity(work)
    _, turn = velocity(2.0, 0.1, STOP, SPEED, TURN)
    if turn > 0.5:
        raise NotYet(
            en=f"For a ball 2 m ahead and 0.1 m to the left, the turn rate is {turn:g}; it should be in proportion to "
            "the direction, 0.05 rad.",
            zh=f"球在前方 2 m、左侧 0.1 m 时，角速度是 {turn:g}；它应当与方向成正比，而方向是 0.05 rad。",
        )
    for left in (3.0, -3.0):
        _, turn = velocity(0.8, left, STOP, SPEED, TURN)
        if abs(turn) > TURN + 1e-9:
            raise NotYet(
                en=f"For a ball far to the side, the turn rate is {turn:g}, but turn_speed, the limit, is 1.",
                zh=f"球在很偏的一侧时，角速度是 {turn:g}，而上限 turn_speed 是 1。",
            )


@check("decide", en="It stops at the stop distance.", zh="它在停止距离处停下。")
def stops_at_distance(work):
    velocity = load_velocity(work)
    for forward, stop_distance in ((0.4, 0.5), (0.9, 1.0)):
        speed, turn = velocity(forward, 0.1, stop_distance, SPEED, TURN)
        if speed or turn:
            raise NotYet(
                en=f"For a ball at {forward:g} m and a stop distance of {stop_distance:g} m, the velocity is "
                f"{speed:g} and {turn:g}, but should be 0 and 0.",
                zh=f"球在 {forward:g} m 处、停止距离为 {stop_distance:g} m 时，速度是 {speed:g} 和 {turn:g}，"
                f"应当是 0 和 0。",
            )


MUTANT = """from my_mission.right_decisions import *
from my_mission import right_decisions


def velocity(*values, **named):
    speed, turn = right_decisions.velocity(*values, **named)
    return {result}
"""
MUTANTS = {
    "wrong_way": ("speed, -turn", "the robot turns away from the ball", "机器人背着球转弯"),
    "never_stops": ("(speed, turn) if speed else (0.1, turn)", "the robot does not stop", "机器人不停下"),
    "too_fast": ("5.0 * speed, turn", "the robot is five times as fast", "机器人快五倍"),
}
UNIT_TEST = "test/test_decisions.py"
PYTEST = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "linkwright.pytest_plugin", UNIT_TEST]


@cache
def run_unit_tests(work):
    """Return the results of the learner's tests, by the name of the mutant; '' is the learner's own code."""
    work.package(PACKAGE).file(UNIT_TEST)
    if importlib.util.find_spec("pytest") is None:
        raise NotYet(en="pytest is missing: pip install pytest", zh="没有安装 pytest：pip install pytest")
    with Copies(work) as copies:
        processes = {"": copies.start(PYTEST, copies.make("right"), PYTEST_DISABLE_PLUGIN_AUTOLOAD="1")}
        for name, (result, _, _) in MUTANTS.items():
            folder = copies.make(name, decisions=MUTANT.format(result=result))
            processes[name] = copies.start(PYTEST, folder, PYTEST_DISABLE_PLUGIN_AUTOLOAD="1")
        return {name: finish(process, 40.0, "test_decisions.py") for name, process in processes.items()}


@check("unit-test", en="The tests pass.", zh="测试通过。")
def unit_tests_pass(work):
    status, output = run_unit_tests(work)[""]
    if status == 5:
        raise NotYet(
            en="test_decisions.py has no test; the names of tests begin with test_.",
            zh="test_decisions.py 中没有测试；测试的名字以 test_ 开头。",
        )
    if status:
        line = last_error(output)
        raise NotYet(en=f"The tests fail: {line}", zh=f"测试没有通过：{line}")


@check(
    "unit-test",
    en="They fail if the robot turns the wrong way, does not stop, or is too fast.",
    zh="机器人转错方向、不停下或太快时，测试失败。",
)
def unit_tests_notice_mistakes(work):
    results = run_unit_tests(work)
    if results[""][0]:
        raise NotYet(en="First the tests must pass.", zh="首先测试必须通过。")
    for name, (_, en, zh) in MUTANTS.items():
        if not results[name][0]:
            raise NotYet(en=f"The tests also pass if {en}.", zh=f"{zh}时，测试也通过。")


@check("node", en="go_to_ball drives to the ball.", zh="go_to_ball 向球行驶。")
def node_drives(work):
    with Driver(work) as driver:
        driver.set_target("red")
        for left in (0.5, -0.5):
            speed, turn = driver.show(2.0, left)
            if speed <= 0.0 or turn * left <= 0.0:
                raise NotYet(
                    en=f"For the ball at x = 2, y = {left:g}, /cmd_vel has linear.x = {speed:g} and "
                    f"angular.z = {turn:g}.",
                    zh=f"球在 x = 2，y = {left:g} 时，/cmd_vel 的 linear.x 是 {speed:g}，angular.z 是 {turn:g}。",
                )


@check("node", en="It obeys speed and stop_distance.", zh="它遵守 speed 和 stop_distance。")
def node_obeys_parameters(work):
    with Driver(work, "speed:=0.1", "stop_distance:=1.5") as driver:
        driver.set_target("red")
        speed, _ = driver.show(3.0, 0.0)
        near, _ = driver.show(1.2, 0.0)
    if not 0.0 < speed <= 0.1001:
        raise NotYet(en=f"With speed:=0.1, the speed is {speed:g} m/s.", zh=f"speed:=0.1 时，速度是 {speed:g} m/s。")
    if near:
        raise NotYet(
            en=f"With stop_distance:=1.5, it drives at {near:g} m/s to a ball that is 1.2 m away.",
            zh=f"stop_distance:=1.5 时，它仍以 {near:g} m/s 驶向 1.2 m 远的球。",
        )


@check("node", en="Without a target it stands still.", zh="没有目标时，它静止不动。")
def node_waits(work):
    with Driver(work) as driver:
        before = driver.show(2.0, 0.5)
        driver.set_target("red")
        driver.show(2.0, 0.5)
        driver.set_target("")
        after = driver.show(2.0, 0.5)
    if any(before):
        raise NotYet(en="It drives before it has a target.", zh="还没有目标，它就行驶了。")
    if any(after):
        raise NotYet(en="It drives on after the empty target.", zh="收到空目标后，它仍在行驶。")


@check("node", en="It does not drive to a ball that is no longer seen.", zh="看不到球时，它不再前进。")
def node_forgets_ball(work):
    with Driver(work) as driver:
        driver.set_target("red")
        driver.show(2.0, 0.0)
        speed, _ = driver.wait(1.5)
    if speed:
        raise NotYet(
            en=f"1.5 s after the last ball, it still drives forward at {speed:g} m/s.",
            zh=f"最后一次看到球 1.5 s 之后，它仍以 {speed:g} m/s 前进。",
        )


@check("search", en="Without a ball it turns on the spot.", zh="看不到球时，它原地转圈。")
def searches(work):
    with Driver(work, "search_speed:=0.4") as driver:
        driver.set_target("red")
        speed, turn = driver.wait(1.0)
    if speed or not turn:
        raise NotYet(
            en=f"With a target and no ball, the velocity is {speed:g} and {turn:g}.",
            zh=f"有目标而看不到球时，速度是 {speed:g} 和 {turn:g}。",
        )
    if abs(abs(turn) - 0.4) > 0.001:
        raise NotYet(
            en=f"With search_speed:=0.4, it turns at {turn:g} rad/s.",
            zh=f"search_speed:=0.4 时，它以 {turn:g} rad/s 转弯。",
        )


@check("search", en="/state says what it does.", zh="/state 说明它在做什么。")
def tells_state(work):
    with Driver(work) as driver:
        expect_state(driver, "waiting", "before the first target", "在第一个目标之前")
        driver.set_target("red")
        driver.wait(0.5)
        expect_state(driver, "searching", "with a target and no ball", "有目标而看不到球时")
        driver.show(2.0, 0.2)
        expect_state(driver, "driving", "with the ball 2 m away", "球在 2 m 远处时")
        driver.wait(1.0)
        expect_state(driver, "searching", "1 s after the last ball", "最后一次看到球 1 s 之后")
        driver.show(0.4, 0.0)
        expect_state(driver, "arrived", "with the ball 0.4 m away", "球在 0.4 m 远处时")


@check(
    "search",
    en="An empty target leads to waiting, any other to searching.",
    zh="空目标使它进入 waiting，其他目标使它进入 searching。",
)
def obeys_targets(work):
    with Driver(work) as driver:
        for state, forward in (("searching", None), ("driving", 2.0), ("arrived", 0.4)):
            driver.set_target("red")
            if forward is None:
                driver.wait(0.3)
            else:
                driver.show(forward, 0.0)
            expect_state(driver, state, "shortly before the empty target", "在空目标之前")
            driver.set_target("")
            velocity = driver.wait(0.3)
            expect_state(
                driver, "waiting", f"after the empty target, which came in '{state}'", f"在“{state}”中收到空目标后"
            )
            if any(velocity):
                raise NotYet(en="It drives on after the empty target.", zh="收到空目标后，它仍在行驶。")
        driver.set_target("red")
        driver.show(0.4, 0.0)
        driver.set_target("green")
        driver.wait(0.3)
    if driver.state != "searching":
        raise NotYet(
            en=f"The next target comes in 'arrived', and the state is '{driver.state}' and not 'searching'; does "
            "on_target forget the ball of the last target?",
            zh=f"在“arrived”中收到下一个目标后，状态是“{driver.state}”，不是“searching”；"
            "on_target 忘记上一个目标的球了吗？",
        )


def expect_state(driver, state, en, zh):
    if driver.state != state:
        raise NotYet(
            en=f"/state is '{driver.state}' {en}, but should be '{state}'.",
            zh=f"{zh}，/state 是“{driver.state}”，应当是“{state}”。",
        )


@check("search", en="Once arrived, it stays until the next target.", zh="到达之后，它不再动，直到下一个目标。")
def stays(work):
    with Driver(work) as driver:
        driver.set_target("red")
        driver.show(0.4, 0.0)
        if any(driver.show(2.0, 0.5)) or any(driver.wait(1.0)):
            raise NotYet(en="After it arrived, it moves again.", zh="到达之后，它又动了。")
        driver.set_target("green")
        if not driver.show(2.0, 0.0)[0]:
            raise NotYet(en="After it arrived, it ignores the next target.", zh="到达之后，它不理会下一个目标。")


@check("search", en="In the playroom, it goes to the ball that one names.", zh="在游戏室里，它驶向人说的那个球。")
def reaches_ball(work):
    for command, start, goal in (
        ("去红球那里", (0.0, 0.0, 0.0), RED_BALL),
        ("go to the green ball", (-1.0, -1.0, 2.0), GREEN_BALL),
    ):
        position, movement = run_mission(work, command, start)
        distance = math.dist(position, goal) - CENTER_TO_CAMERA
        place = f"x = {position[0]:.1f}, y = {position[1]:.1f}"
        if not 0.3 < distance < 0.75:
            raise NotYet(
                en=f"After '{command}', the robot is at {place}; the ball is {distance:.2f} m away from its camera.",
                zh=f"说了“{command}”之后，机器人在 {place}；球离它的摄像头 {distance:.2f} m。",
            )
        if movement > 0.02:
            raise NotYet(en=f"After '{command}', the robot is still moving.", zh=f"说了“{command}”之后，机器人仍在动。")


LAUNCH, NODES = "mission.launch.py", ("/command_listener", "/color_finder", "/go_to_ball")


@check(
    "launch", en="mission.launch.py starts the playroom and three nodes.", zh="mission.launch.py 启动游戏室和三个节点。"
)
def launch_starts_all(work):
    with work.package(PACKAGE).launch(LAUNCH) as running:
        for name in ("/gazebo", *NODES):
            running.expect_node(name)
        for name in NODES:
            if running.wait_for_parameter(name, "use_sim_time") is not True:
                raise NotYet(
                    en=f"{name} does not use simulated time: use_sim_time is false.",
                    zh=f"{name} 没有使用仿真时间：use_sim_time 是 false。",
                )


@check("launch", en="The nodes have the parameters of mission.yaml.", zh="节点的参数来自 mission.yaml。")
def launch_sets_parameters(work):
    path = work.package(PACKAGE).file("config/mission.yaml")
    try:
        expected = yaml.safe_load(path.read_text(encoding="utf-8"))[NODE]["ros__parameters"]
        expected = {name: float(expected[name]) for name in ("stop_distance", "search_speed")}
    except (yaml.YAMLError, KeyError, TypeError, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise NotYet(
            en=f"mission.yaml has no go_to_ball, ros__parameters, stop_distance and search_speed: {reason}",
            zh=f"mission.yaml 中没有 go_to_ball、ros__parameters、stop_distance 和 search_speed：{reason}",
        ) from None
    if expected != {"stop_distance": 0.6, "search_speed": 0.8}:
        raise NotYet(
            en=f"mission.yaml has {expected}, but stop_distance should be 0.6 and search_speed 0.8.",
            zh=f"mission.yaml 中是 {expected}，stop_distance 应当是 0.6，search_speed 应当是 0.8。",
        )
    with work.package(PACKAGE).launch(LAUNCH, simulation="false") as running:
        for name, value in expected.items():
            actual = running.wait_for_parameter("/go_to_ball", name)
            if actual != value:
                raise NotYet(
                    en=f"{name} of /go_to_ball is {actual:g}; the launch file does not hand mission.yaml to the node.",
                    zh=f"/go_to_ball 的 {name} 是 {actual:g}；launch 文件没有把 mission.yaml 交给节点。",
                )
        if running.wait_for_parameter("/go_to_ball", "use_sim_time") is not False:
            raise NotYet(
                en="With simulation:=false, use_sim_time is still true.",
                zh="simulation:=false 时，use_sim_time 仍是 true。",
            )
        if "/gazebo" in running.nodes():
            raise NotYet(
                en="With simulation:=false, the simulator still starts.", zh="simulation:=false 时，仿真器仍然启动。"
            )


@check(
    "launch",
    en="setup.py installs both files, and the package has no findings.",
    zh="setup.py 安装这两个文件，功能包没有问题。",
)
def launch_is_installed(work):
    package = work.package(PACKAGE)
    package.expect_installed("config/mission.yaml", f"launch/{LAUNCH}")
    if missing := sorted({"launch", "launch_ros", "my_playroom", "my_senses"} - dependencies(package)):
        raise NotYet(
            en=f"package.xml does not list '{missing[0]}' as a dependency at run time.",
            zh=f"package.xml 没有把“{missing[0]}”列为运行时依赖。",
        )
    package.expect_no_findings()


def dependencies(package, tag="exec_depend"):
    """Return the dependencies in package.xml with a tag, and those for all purposes."""
    root = parse_file(package.file("package.xml")).root
    return {element.text().strip() for element in root.elements() if element.tag in {"depend", tag}}


SYSTEM_TEST = "test/test_mission.py"
IDLE_NODE = """import rclpy
from geometry_msgs.msg import PointStamped, Twist
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('go_to_ball')
    node.create_subscription(String, 'target', print, 10)
    node.create_subscription(PointStamped, 'ball', print, 10)
    velocity, state = node.create_publisher(Twist, 'cmd_vel', 10), node.create_publisher(String, 'state', 10)

    def stay():
        velocity.publish(Twist())
        state.publish(String(data='waiting'))

    node.create_timer(0.1, stay)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
"""


RESTLESS_NODE = IDLE_NODE.replace("(Twist())", "(Twist(linear=Vector3(x=0.2), angular=Vector3(z=0.5)))").replace(
    "import PointStamped, Twist", "import PointStamped, Twist, Vector3"
)
"""A node that always drives."""


@cache
def run_system_test(work):
    """Return the results of the learner's test with the learner's node, and with two wrong ones, by name."""
    work.package(PACKAGE).file(SYSTEM_TEST)
    words = ["-m", "linkwright", "test", SYSTEM_TEST]
    with Copies(work) as copies:
        result = finish(copies.start(words, copies.make("right")), 50.0, SYSTEM_TEST)
        if "did not happen in time" in result[1]:  # the test waits 10 s, which a busy machine can take
            result = finish(copies.start(words, copies.make("again")), 50.0, SYSTEM_TEST)
        if result[0]:
            return {"": result}
        processes = {
            name: copies.start(words, copies.make(name, go_to_ball=node), ROS_DOMAIN_ID=str(reserve_domain()))
            for name, node in {"idle": IDLE_NODE, "restless": RESTLESS_NODE}.items()
        }
        return {"": result} | {name: finish(process, 50.0, SYSTEM_TEST) for name, process in processes.items()}


@check("system-test", en="linkwright test passes.", zh="linkwright test 通过。")
def system_test_passes(work):
    results = run_system_test(work)
    status, output = results[""]
    if status:
        line = last_error(output)
        raise NotYet(en=f"The test fails: {line}", zh=f"测试没有通过：{line}")
    if "Ran 0 tests" in output and "Ran 1 test" not in output:
        raise NotYet(en="test_mission.py has no test.", zh="test_mission.py 中没有测试。")
    if not results["idle"][0]:
        raise NotYet(
            en="The test also passes with a go_to_ball that never drives.",
            zh="go_to_ball 从不行驶时，测试也通过。",
        )
    if not results["restless"][0]:
        raise NotYet(
            en="The test also passes with a go_to_ball that never stops; wait until the velocity is zero.",
            zh="go_to_ball 从不停下时，测试也通过；请等到速度为零。",
        )


@check(
    "system-test",
    en="package.xml lists launch_testing as a test_depend.",
    zh="package.xml 把 launch_testing 列为 test_depend。",
)
def system_test_is_declared(work):
    listed = dependencies(work.package(PACKAGE), "test_depend")
    if "launch_testing" not in listed:
        raise NotYet(
            en="package.xml does not list 'launch_testing' as a test_depend.",
            zh="package.xml 没有把“launch_testing”列为 test_depend。",
        )


@check("record", en="The recording run contains a command and an arrival.", zh="记录 run 中有命令和到达。")
def has_recording(work):
    read_times(work)


@check("record", en="The time between them is right.", zh="两者之间的时间正确。")
def knows_time(work):
    command, arrival, begin, end = read_times(work)
    slips = {
        round(end - begin, 2): NotYet(en="That is the duration of the whole recording.", zh="这是整个记录的时长。"),
        round(arrival, 2): NotYet(
            en="That is the time of the arrival; subtract the time of the command.",
            zh="这是到达的时刻；请减去命令的时刻。",
        ),
    }
    work.expect_number(arrival - command, tolerance=0.3, slips=slips)


def read_times(work):
    """Return the times of the command, of the arrival, and of the recording's begin and end, in s."""
    folder = work.folder / "run"
    if not folder.exists():
        raise NotYet(en="The workspace has no recording 'run'.", zh="工作空间中没有记录“run”。")
    with open_recording(folder) as recording:
        counts = {topic.name: topic.count for topic in recording.topics}
        for name in ("/command", "/state"):
            if not counts.get(name):
                raise NotYet(en=f"The recording has no messages of {name}.", zh=f"记录中没有 {name} 的消息。")
        texts = [
            (time * 1e-9, topic, deserialize(data, String).data)
            for topic, time, data in recording.messages(["/command", "/state"])
        ]
        begin, end = recording.start_ns * 1e-9, recording.end_ns * 1e-9
    command = next(time for time, topic, _ in texts if topic == "/command")
    arrival = next((time for time, _, text in texts if time >= command and text == "arrived"), None)
    if arrival is None:
        raise NotYet(
            en="In the recording, the robot does not arrive after the command.",
            zh="在记录中，下命令之后机器人没有到达。",
        )
    return command, arrival, begin, end
