"""Exercises and their judges. The scores of the solutions are in `test_exercises_part_0` and the next ones."""

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from linkwright.cli.entry import main
from linkwright.diagnostics import LinkwrightError
from linkwright.learning.judging import Scene
from linkwright.learning.judging.companions import plan_companions
from linkwright.learning.judging.exercise import Figure, find_exercise, list_exercise_names, load_exercise
from linkwright.learning.judging.runs import judge_program
from linkwright.learning.judging.world import create_judge, write_world
from linkwright.learning.local_text import LocalText
from linkwright.testing import SteppedSimulation
from tests.domains import own_domain
from tests.waiting import wait_until

pytestmark = pytest.mark.extra("sim")

NAMES = list_exercise_names()
FAST_EXERCISES = "avoid_obstacles"


@pytest.mark.parametrize("name", NAMES)
def test_exercise_texts_exist_in_both_languages(name):
    exercise = find_exercise(name)
    assert set(exercise.title.texts) == set(exercise.figure.name.texts) == {"en", "zh"}
    assert exercise.text("en") != exercise.text("zh")
    for text in (exercise.text("en"), exercise.text("zh")):
        assert f"{exercise.figure.full:g}" in text
        assert f"{exercise.figure.half:g}" in text


def test_failing_program_gets_traceback(tmp_path):
    program = tmp_path / "program.py"
    program.write_text("import rclpy\nrclpy.init()\nunknown\n", encoding="utf-8")
    (result,) = judge_program(find_exercise(FAST_EXERCISES), program, [0])
    assert result.score == 0.0
    assert "program.py" in result.error
    assert "line 3" in result.error
    assert result.error.startswith(f'  File "{program}"')
    assert result.data["time"] < 5.0


def test_program_has_no_access_to_simulator(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        "import rclpy, time\nfrom rclpy.node import Node\nrclpy.init()\nnode = Node('n')\ntime.sleep(1.0)\n"
        "print([n for n, _ in node.get_service_names_and_types()], [n for n, _ in node.get_topic_names_and_types()])\n"
        "assert not [n for n, _ in node.get_service_names_and_types() if 'entity' in n or 'physics' in n]\n"
        "assert not [n for n, _ in node.get_topic_names_and_types() if 'states' in n and 'joint' not in n]\n",
        encoding="utf-8",
    )
    (result,) = judge_program(find_exercise(FAST_EXERCISES), program, [0])
    assert result.error is None
    with SteppedSimulation(services=False) as test, pytest.raises(LookupError):
        test.call("/get_entity_state", None)


def test_an_exercise_uses_its_own_robot_in_a_workspace_with_a_package_of_the_same_name(tmp_path, monkeypatch):
    package = tmp_path / "src" / "my_robot_description"
    (package / "urdf" / "base").mkdir(parents=True)
    (package / "package.xml").write_text(
        "<package format='3'><name>my_robot_description</name></package>", encoding="utf-8"
    )
    own_base = "<robot><joint/></robot>"
    (package / "urdf" / "base" / "mbot_base_gazebo.xacro").write_text(own_base, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    exercise = find_exercise(FAST_EXERCISES)
    (result,) = judge_program(exercise, exercise.template, [0])
    assert result.error is None


MEDDLING_PROGRAM = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

rclpy.init()
node = Node("race", namespace="{namespace}")
publisher = node.create_publisher(Twist, "{topic}", 10)
node.create_timer(0.1, lambda: publisher.publish(Twist()))
rclpy.spin(node)
"""


@pytest.mark.parametrize(("namespace", "topic"), [("", "/rival/cmd_vel"), ("rival", "cmd_vel")])
def test_a_program_that_commands_the_rival_gets_no_points(tmp_path, namespace, topic):
    program = tmp_path / "program.py"
    program.write_text(MEDDLING_PROGRAM.format(namespace=namespace, topic=topic), encoding="utf-8")
    (result,) = judge_program(find_exercise("race"), program, [0])
    assert result.score == 0.0
    assert result.data["time"] < 1.0
    assert "on a topic of the other robot" in result.data["reasons"][-1]["en"]


def test_a_rival_that_fails_does_not_fail_the_program(tmp_path):
    rival = tmp_path / "rival.py"
    rival.write_text("import rclpy\nrclpy.init()\nunknown\n", encoding="utf-8")
    exercise = find_exercise("race")
    (result,) = judge_program(exercise, exercise.solution("reference"), [0], rival=rival)
    assert result.error is None
    assert result.data["is_solved"]
    assert "the program of the other robot ended" in [reason["en"] for reason in result.data["reasons"]]


def test_a_program_with_absolute_names_drives_the_rival(tmp_path):
    rival = tmp_path / "rival.py"
    text = find_exercise("race").solution("simple").read_text(encoding="utf-8")
    rival.write_text(text.replace("'cmd_vel'", "'/cmd_vel'").replace("'scan'", "'/scan'"), encoding="utf-8")
    exercise = find_exercise("race")
    (result,) = judge_program(exercise, exercise.template, [0], rival=rival)
    assert result.data["progress"] == pytest.approx(0.0, abs=0.1)
    assert result.data["figure"] < -4.0


def test_the_rival_option_is_checked(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("mine.py").touch()
    assert main(["learn", "judge", FAST_EXERCISES, "mine.py", "--rival", "mine.py"]) != 0
    assert "LEARN145" in capsys.readouterr().err
    assert main(["learn", "judge", "race", "mine.py", "--rival", "missing.py"]) != 0
    assert "LEARN142" in capsys.readouterr().err


@pytest.mark.slow
def test_the_rival_drives_in_real_time(tmp_path):
    rival = tmp_path / "rival.py"
    rival.write_text(
        "import pathlib, rclpy\nfrom rclpy.node import Node\nfrom sensor_msgs.msg import LaserScan\nrclpy.init()\n"
        f"seen = pathlib.Path({str(tmp_path / 'seen')!r})\nnode = Node('n')\n"
        "node.create_subscription(LaserScan, '/scan', lambda _: seen.write_text(node.get_namespace()), 10)\n"
        "rclpy.spin(node)\n",
        encoding="utf-8",
    )
    words = ["learn", "world", "race", "--headless", "--seconds", "60", "--rival", str(rival)]
    environment = {**os.environ, "ROS_DOMAIN_ID": str(own_domain())}
    program = tmp_path / "mine.py"
    program.write_text(
        "import pathlib, rclpy, time\nfrom geometry_msgs.msg import Twist\nrclpy.init()\n"
        "node = rclpy.create_node('m')\n"
        "publisher = node.create_publisher(Twist, 'cmd_vel', 10)\n"
        "while not publisher.get_subscription_count():\n    time.sleep(0.1)\n"
        "time.sleep(1.0)\n"
        f"assert not pathlib.Path({str(tmp_path / 'seen')!r}).exists()\n"
        f"while not pathlib.Path({str(tmp_path / 'seen')!r}).exists():\n"
        "    publisher.publish(Twist())\n    time.sleep(0.1)\n",
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "linkwright"]
    with subprocess.Popen([*command, *words], cwd=tmp_path, env=environment) as process:
        try:
            started = subprocess.run([*command, "shell", "--", sys.executable, program], env=environment, check=False)
            assert started.returncode == 0
            wait_until((tmp_path / "seen").exists, pause=0.1)
        finally:
            process.send_signal(signal.SIGINT)
    assert (tmp_path / "seen").read_text(encoding="utf-8") == "/rival"
    assert process.returncode == 130


def test_judge_command_prints_table_or_json(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["learn", "judge", FAST_EXERCISES, "--start"]) == 0
    assert (tmp_path / f"{FAST_EXERCISES}.py").read_text(encoding="utf-8") == find_exercise(
        FAST_EXERCISES
    ).template.read_text(encoding="utf-8")
    assert main(["learn", "judge", FAST_EXERCISES, "--start"]) != 0, "the user's file is not overwritten"
    capsys.readouterr()
    (tmp_path / "done.py").write_text("import sys\nprint('hello')\nsys.exit(0)\n", encoding="utf-8")
    assert main(["learn", "judge", FAST_EXERCISES, "done.py", "--seeds", "1", "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert data["exercise"] == FAST_EXERCISES
    assert data["runs"][0]["seed"] == 0
    assert set(data["runs"][0]["reasons"][0]) == {"en", "zh"}
    assert main(["learn", "judge", FAST_EXERCISES, "missing.py"]) != 0
    assert "LEARN142" in capsys.readouterr().err
    assert main(["learn", "exercises"]) == 0
    assert FAST_EXERCISES in capsys.readouterr().out


def test_mistakes_in_exercise_are_reported(tmp_path):
    with pytest.raises(LinkwrightError, match="there is no exercise"):
        find_exercise("avoid_obstacle")
    (tmp_path / "exercise.toml").write_text("difficulty = 1\n", encoding="utf-8")
    with pytest.raises(LinkwrightError, match="'figure' is missing"):
        load_exercise(tmp_path)
    (tmp_path / "exercise.toml").write_text("difficulty = \n", encoding="utf-8")
    with pytest.raises(LinkwrightError, match="TOML"):
        load_exercise(tmp_path)


def test_real_time_world_publishes_judge_status(tmp_path):
    arrangement = write_world(find_exercise(FAST_EXERCISES), 1, tmp_path, publishes=True)
    with SteppedSimulation(arrangement.world, find_exercise(FAST_EXERCISES).robot, pose=arrangement.pose) as test:
        status = test.record("/judge/status")
        test.advance(1.0)
        data = json.loads(status.last.data)
        assert data["exercise"] == FAST_EXERCISES
        assert data["time"] == pytest.approx(1.0, abs=0.1)
        test.reset()
        test.advance(0.4)
        assert json.loads(status.last.data)["time"] < 0.5


_SEED_OF_BLUE = 3
WRONG_PICKS = {
    "a fixed color": ("color, place_x, place_y = order.split()", "color, (_, place_x, place_y) = 'red', order.split()"),
    "a fixed place": ("float(place_x), float(place_y)", "0.63, -0.02"),
    "no release": ("GRASP + 0.004, straight=True)\n        self.grip(OPEN)", "GRASP + 0.004, straight=True)"),
    "a grip in the air": ("GRASP, ABOVE = TABLE + 0.032", "GRASP, ABOVE = TABLE + 0.09"),
}
REASONS = {
    "a fixed color": "the robot moved the red block, but the order was for the",
    "a fixed place": "m from its place",
    "no release": "the block is still in the air",
    "a grip in the air": "the block is still where it was",
}


@pytest.mark.slow
@pytest.mark.extra("arm")
@pytest.mark.parametrize("name", WRONG_PICKS)
def test_wrong_pick_is_told_what_is_wrong(tmp_path, name):
    exercise = find_exercise("pick_place")
    text, (old, new) = exercise.solution("simple").read_text(encoding="utf-8"), WRONG_PICKS[name]
    assert text.count(old) == 1
    program = tmp_path / "wrong.py"
    program.write_text(text.replace(old, new), encoding="utf-8")
    judge = create_judge(exercise, _SEED_OF_BLUE)
    judge.arrange(Scene())
    assert judge.orders[0].color == "blue"
    (result,) = judge_program(exercise, program, [_SEED_OF_BLUE])
    assert result.error is None
    assert result.score == 0.0
    assert REASONS[name] in " ".join(reason["en"] for reason in result.data["reasons"])


def test_nodes_of_an_exercise_get_its_robot_and_their_moveit_files(tmp_path):
    exercise = find_exercise("pick_place")
    arrangement = write_world(exercise, 0, tmp_path, publishes=False)
    spawner, move_group = plan_companions(exercise, arrangement.robot)
    assert spawner.arguments[-1] == "gripper_controller"
    assert spawner.parameters == {"use_sim_time": True}
    assert move_group.parameters["robot_description"] == arrangement.robot.read_text(encoding="utf-8")
    assert 'group name="arm"' in move_group.parameters["robot_description_semantic"]
    assert move_group.parameters["use_sim_time"] is True


def test_unknown_node_of_an_exercise_is_reported(tmp_path):
    folder = tmp_path / "copy"
    shutil.copytree(find_exercise(FAST_EXERCISES).folder, folder)
    with (folder / "exercise.toml").open("a", encoding="utf-8") as file:
        file.write('\n[[nodes]]\npackage = "no_package"\nexecutable = "no_node"\n')
    exercise = load_exercise(folder)
    with pytest.raises(LinkwrightError, match="there is no node 'no_package/no_node'"):
        list(judge_program(exercise, exercise.template, [0]))


def test_points_between_figures_are_linear():
    figure = Figure(LocalText({"en": "time"}), "s", 100.0, 60.0, 30.0)
    assert [figure.points(seconds) for seconds in (120.0, 100.0, 80.0, 60.0, 45.0, 30.0, 10.0)] == [
        *(0.0, 0.0, 25.0, 50.0, 75.0, 100.0, 100.0)
    ]


def test_localization_progress_grows_with_better_estimate(monkeypatch):
    judge = create_judge(find_exercise("localize"), 0)
    monkeypatch.setattr(judge, "pose", lambda: (1.0, 1.0, 0.0))
    judge.start()
    progress_values = []
    for x in (None, 3.0, 1.5, 1.0):
        if x is not None:
            judge.on_message("/estimate", SimpleNamespace(pose=SimpleNamespace(position=SimpleNamespace(x=x, y=1.0))))
        judge.update()
        progress_values.append((judge.figure, round(judge.progress, 3)))
    assert progress_values == [(3.0, 0.0), (2.0, 0.333), (0.5, 0.833), (0.0, 1.0)]
