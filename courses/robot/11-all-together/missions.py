"""What the checks of the lesson share: the learner's programs, with a graph or a world around them."""

import contextlib
import importlib
import inspect
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from linkwright import SteppedSimulation
from linkwright.learning import NotYet, expect_published
from linkwright.messages import get_message
from linkwright.process.patience import PatientClock
from linkwright.testing import SteppedGraph

PACKAGE, NODE = "my_mission", "go_to_ball"
SIM_TIME = ["--ros-args", "-p", "use_sim_time:=true"]
String, PointStamped = get_message("std_msgs/msg/String"), get_message("geometry_msgs/msg/PointStamped")
TWIST, STRING = "geometry_msgs/msg/Twist", "std_msgs/msg/String"


def load_velocity(work):
    """Return the learner's function `velocity`."""
    package = work.package(PACKAGE)
    package.file("my_mission/decisions.py")
    sys.path.insert(0, str(package.folder))
    velocity = getattr(importlib.import_module("my_mission.decisions"), "velocity", None)
    if velocity is None:
        raise NotYet(en="decisions.py has no function 'velocity'.", zh="decisions.py 中没有函数“velocity”。")

    try:
        inspect.signature(velocity).bind(2.0, 0.0, 0.5, 0.3, 1.0)
    except TypeError:
        raise NotYet(
            en="velocity() needs five parameters: forward, left, stop_distance, speed and turn_speed.",
            zh="velocity() 需要五个参数：forward、left、stop_distance、speed 和 turn_speed。",
        ) from None

    def call(*values):
        result = velocity(*values)
        try:
            speed, turn = result
        except TypeError:
            raise NotYet(
                en=f"velocity{values} returns {result!r}, but should return two numbers: speed and turn rate.",
                zh=f"velocity{values} 返回 {result!r}，应当返回两个数：速度和角速度。",
            ) from None
        return float(speed), float(turn)

    return call


class Driver:
    """The learner's go_to_ball in a graph, whose balls the check invents."""

    def __init__(self, work, *parameters):
        self.main = work.package(PACKAGE).program(NODE)
        self.arguments = ["--ros-args", *(word for value in parameters for word in ("-p", value))]
        self.test = SteppedGraph()

    def __enter__(self):
        self.test.__enter__()
        self.commands = self.test.record("/cmd_vel", TWIST)
        self.states = self.test.record("/state", STRING)
        self.test.start_program(self.main, self.arguments)
        self.test.advance(0.5)
        return self

    def __exit__(self, *error):
        return self.test.__exit__(*error)

    def set_target(self, color):
        self.test.publish("/target", String(data=color))
        self.test.advance(0.05)

    def show(self, forward, left, seconds=0.5):
        """Let the camera see a ball for some time, and return the last velocity."""
        for _ in range(round(seconds * 10)):
            ball = PointStamped()
            ball.header.stamp = self.test.node.get_clock().now().to_msg()
            ball.header.frame_id = "camera_link"
            ball.point.x, ball.point.y = float(forward), float(left)
            self.test.publish("/ball", ball)
            self.test.advance(0.1)
        return self.velocity

    def wait(self, seconds):
        """Let time pass without a ball, and return the last velocity."""
        self.test.advance(seconds)
        return self.velocity

    @property
    def velocity(self):
        expect_published(self.test, "/cmd_vel", TWIST, self.commands)
        return self.commands.last.linear.x, self.commands.last.angular.z

    @property
    def state(self):
        expect_published(self.test, "/state", STRING, self.states)
        return self.states.last.data


def run_mission(work, command, start, seconds=45.0):
    """Give a command in the playroom, and return the final position and how far the robot moved in the last second."""
    playroom = work.package("my_playroom")
    programs = [
        work.package(package).program(name)
        for package, name in (("my_senses", "color_finder"), ("my_senses", "command_listener"), (PACKAGE, NODE))
    ]
    x, y, yaw = start
    world, robot = playroom.file("worlds/playroom.world"), playroom.file("urdf/mbot_camera.xacro")
    with SteppedSimulation(world, robot, pose=(x, y, 0, 0, 0, yaw)) as test:
        states = test.record("/state", STRING)
        for main in programs:
            test.start_program(main, SIM_TIME)
        test.advance(0.5)
        test.publish("/command", String(data=command))
        while test.now < seconds and not (len(states) and states.last.data == "arrived"):
            test.advance(0.5)
        test.advance(0.5)
        before = test.robot_pose()[:2]
        test.advance(1.0)
        after = test.robot_pose()[:2]
    return after, math.dist(before, after)


class Copies:
    """Copies of the learner's packages, in which a file is replaced by a wrong one."""

    def __init__(self, work):
        self.work = work
        self.processes = []

    def __enter__(self):
        self.folder = Path(tempfile.mkdtemp(prefix="linkwright-lesson-"))
        return self

    def __exit__(self, *error):
        for process in self.processes:
            process.kill()
            process.communicate()
        shutil.rmtree(self.folder, ignore_errors=True)

    def make(self, name, **files):
        """Copy the sources, with other contents of modules of my_mission, and return the folder of the copy."""
        copy = self.folder / name
        ignored = shutil.ignore_patterns("build", "install", "__pycache__", ".git", "meshes")
        shutil.copytree(self.work.folder / "src", copy / "src", ignore=ignored)
        package = copy / "src" / self.work.package(PACKAGE).folder.relative_to(self.work.folder / "src")
        for module, content in files.items():
            path = package / "my_mission" / f"{module}.py"
            path.rename(path.with_name(f"right_{module}.py"))
            path.write_text(content, encoding="utf-8")
        return package

    def start(self, words, folder, **environment):
        """Start Python in a copy."""
        process = subprocess.Popen(  # noqa: S603 - the learner's own tests
            [sys.executable, *words],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": "", "PYTHONDONTWRITEBYTECODE": "1", **environment},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            encoding="utf-8",
            errors="replace",
        )
        self.processes.append(process)
        return process


def finish(process, seconds, file):
    """Return the exit status of a test run, and its output. The load of the machine does not count."""
    clock = PatientClock(process.pid)
    while clock.read() < seconds:
        with contextlib.suppress(subprocess.TimeoutExpired):
            output, _ = process.communicate(timeout=0.2)
            return process.returncode, output
    raise NotYet(en=f"{file} took longer than {seconds:g} s.", zh=f"{file} 运行超过了 {seconds:g} s。")


def last_error(output):
    """Return the line of a test's output that names the error."""
    lines = [line.strip() for line in output.splitlines()]
    reasons = [line.removeprefix("E ").strip() for line in lines if line.startswith("E ")]
    errors = [line for line in reasons or lines if re.match(r"[\w.]*(Error|Exception)\b", line)]
    return (errors or reasons or lines or [""])[0]
