"""Completion of commands, options, packages, launch files and names of the graph.

It is also tested in the shells.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.cli.command import collect_help_texts
from linkwright.cli.completion import graph_names
from linkwright.cli.completion.candidates import complete, split_line
from linkwright.cli.completion.scripts import FILES, completion_script, startup_script
from linkwright.graph import Graph
from linkwright.messages import get_message

PACKAGE = "<package format='3'><name>{}</name><version>1.0.0</version></package>"
PYTHON_LAUNCH = "DeclareLaunchArgument('gui', default_value='1')\nDeclareLaunchArgument(\n    name=\"speed\")\n"
XML_LAUNCH = '<launch><arg name="gui"/><arg default="1" name="speed"/></launch>'
YAML_LAUNCH = "launch:\n- arg:\n    name: gui\n- arg:\n    name: 'speed'\n"


@pytest.fixture(autouse=True)
def _workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("arm", "hand"):
        folder = tmp_path / "src" / name
        folder.mkdir(parents=True)
        (folder / "package.xml").write_text(PACKAGE.format(name))
    arm = tmp_path / "src" / "arm"
    (arm / "launch").mkdir()
    (arm / "msg").mkdir()
    (arm / "msg" / "Grip.msg").write_text("float64 width\n")
    (arm / "setup.py").write_text(
        "from setuptools import setup\nsetup(name='arm', entry_points={'console_scripts': ['move = arm.move:main']})\n"
    )
    for name, text in (("a.launch.py", PYTHON_LAUNCH), ("b.launch.xml", XML_LAUNCH), ("c_launch.yaml", YAML_LAUNCH)):
        (arm / "launch" / name).write_text(text)
    (arm / "arm.urdf.xacro").write_text('<robot xmlns:xacro="x"><xacro:arg name="side" default="left"/></robot>')
    monkeypatch.chdir(tmp_path / "src")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("ROS_DOMAIN_ID", "87")
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


def complete_line(line: str) -> list[str]:
    return complete(split_line(line))


def test_command_names_are_completed() -> None:
    assert complete_line("linkwright ")[: len(collect_help_texts())] == list(collect_help_texts())
    assert complete_line("linkwright la") == ["launch"]
    assert "launch" in complete_line("/some/bin/ros2 ")
    assert "view" not in complete_line("ros2 ")
    assert complete_line("linkwright topic e") == ["echo"]
    assert complete_line("linkwright nonsense ") == []


def test_options_and_option_values_are_completed() -> None:
    assert "--no-open" in complete_line("linkwright launch arm a.launch.py --")
    assert complete_line("linkwright topic echo --qos-reliability best") == ["best_effort", "best_available"]
    assert "--times" in complete_line("ros2 topic pub /a std_msgs/msg/String '{}' --t")
    assert complete_line("linkwright topic pub --rate ") == []
    assert complete_line("linkwright topic pub --rate 5 /a std_msgs/msg/Str") == ["std_msgs/msg/String"]
    assert complete_line("linkwright completion ") == ["bash", "zsh", "fish"]


def test_packages_and_executables_are_completed() -> None:
    assert complete_line("linkwright pkg prefix ar") == ["arm"]
    assert complete_line("ros2 run arm ") == ["move"]
    assert complete_line("ros2 run demo_nodes_cpp ta") == ["talker"]
    assert {"arm", "hand", "demo_nodes_cpp"} <= set(complete_line("ros2 run "))


def test_launch_files_and_launch_arguments_are_completed() -> None:
    assert complete_line("ros2 launch ar") == ["arm", FILES]
    assert complete_line("ros2 launch arm ") == ["a.launch.py", "b.launch.xml", "c_launch.yaml"]
    for file in ("a.launch.py", "b.launch.xml", "c_launch.yaml"):
        assert complete_line(f"ros2 launch arm {file} ") == ["gui:=", "speed:="]
        assert complete_line(f"linkwright launch arm/launch/{file} gui:=1 s") == ["speed:="]
    assert complete_line("linkwright launch nowhere ") == []


def test_interface_types_are_completed() -> None:
    assert complete_line("linkwright topic pub /a arm") == ["arm/msg/Grip"]
    assert complete_line("linkwright service call /a std_srvs/srv/T") == ["std_srvs/srv/Trigger"]
    assert complete_line("linkwright interface show action_tutorials_interfaces/action/F") == [
        "action_tutorials_interfaces/action/Fibonacci"
    ]


def test_description_files_and_arguments_are_completed() -> None:
    assert complete_line("linkwright view ") == [FILES]
    assert complete_line("linkwright view arm/arm.urdf.xacro ") == ["side:=", FILES]  # or a second description


def test_graph_names_are_completed_from_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[object] = []
    monkeypatch.setattr(subprocess, "Popen", lambda *words, **_: started.append(words))
    assert complete_line("linkwright topic echo /") == []
    assert len(started) == 1
    assert complete_line("linkwright topic echo /") == []
    assert len(started) == 1  # the first process still runs
    path = graph_names._find_cache_path()
    path.write_text(json.dumps({"topics": ["/tf"], "nodes": ["/talker"], "services": ["/go"], "actions": ["/turn"]}))
    assert complete_line("ros2 topic echo /t") == ["/tf"]
    assert complete_line("ros2 node info ") == ["/talker"]
    assert complete_line("ros2 service call ") == ["/go"]
    assert complete_line("ros2 action info ") == ["/turn"]
    assert len(started) == 1  # the file is fresh
    os.utime(path, (1.0, 1.0))
    path.with_suffix(".begun").unlink()
    assert complete_line("ros2 topic echo /t") == []
    assert len(started) == 2


def test_graph_discovery_stores_names_of_running_nodes(
    add_to_graph: Callable[[Callable[[Graph], object]], None],
) -> None:
    def make(graph: Graph) -> None:
        node = graph.create_node("talker", namespace="left")
        node.create_publisher(get_message("std_msgs/msg/String"), "chatter", 1)

    add_to_graph(make)
    assert graph_names.discover() == 0
    assert "/left/talker" in graph_names.read_names("nodes")
    assert "/left/chatter" in graph_names.read_names("topics")
    assert "/left/talker/get_parameters" in graph_names.read_names("services")
    assert graph_names.read_names("actions") == []


def test_completion_imports_no_slow_modules() -> None:
    """A completion takes less than a tenth of a second."""
    line = "ros2 launch arm a.launch.py "
    program = (
        "import sys\nfrom linkwright.cli.completion.candidates import complete, split_line\n"
        f"complete(split_line({line!r})); print(*sorted(sys.modules), sep='\\n')"
    )
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    slow_modules = (
        "argparse",
        "asyncio",
        "linkwright.graph",
        "linkwright.launch",
        "linkwright.messages",
        "numpy",
        "yaml",
    )
    assert [name for name in slow_modules if name in loaded] == []


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
@pytest.mark.parametrize(
    ("line", "candidates"),
    [
        ("linkwright lau", ["launch"]),
        ("linkwright launch arm a.launch.py s", ["speed:="]),
        ("linkwright view arm/p", ["arm/package.xml"]),
        ("linkwright 'open quote", []),
    ],
)
def test_completion_in_bash(line: str, candidates: list[str]) -> None:
    program = (
        completion_script("bash", sys.executable, ["linkwright"])
        + f'COMP_LINE="{line}"; COMP_POINT=${{#COMP_LINE}}; _linkwright_complete 2>/dev/null\n'
        + "printf '%s\\n' \"${COMPREPLY[@]}\"; complete -p linkwright >&2"
    )
    result = subprocess.run(["bash", "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout.split() == candidates
    assert "_linkwright_complete" in result.stderr


SHELL_LINES = [
    (["linkwright", "lau"], ["launch"]),
    (["linkwright", "launch", "arm", ""], ["a.launch.py", "b.launch.xml", "c_launch.yaml"]),
    (["linkwright", "launch", "arm", "b.launch.xml", "gui:=1", "s"], ["speed:="]),
    (["linkwright", "topic", "echo", "--qos-reliability", "best"], ["best_effort", "best_available"]),
    (["linkwright", "topic", "pub", "/a", "arm/msg/"], ["arm/msg/Grip"]),
    (["linkwright", "nonsense", ""], []),
]
"""The words that shells pass, the one at the cursor last, and the expected candidates."""


@pytest.mark.parametrize(("words", "candidates"), SHELL_LINES)
def test_completion_of_words_from_any_shell(words: list[str], candidates: list[str]) -> None:
    assert complete(words) == candidates


@pytest.mark.parametrize("quote", ["'", '"'])
def test_completion_inside_open_quote(quote: str) -> None:
    assert complete(["linkwright", "topic", "pub", "/a", f"{quote}arm/msg/"]) == ["arm/msg/Grip"]
    assert complete_line(f"linkwright topic pub /a {quote}arm/msg/") == ["arm/msg/Grip"]


ZSH_WITHOUT_ITS_COMPLETION = """
compdef() { print -ru2 -- compdef $@ }
compadd() { while [[ "$1" != -- ]] { shift }; shift; (( $# )) && print -rl -- "$@" }
_files() { print -r -- FILES }
"""
"""The functions of zsh's completion system, as functions that print their arguments."""


@pytest.mark.skipif(shutil.which("zsh") is None, reason="zsh is not installed")
@pytest.mark.parametrize(("words", "candidates"), [*SHELL_LINES, (["linkwright", "check", "ar"], ["FILES"])])
def test_completion_in_zsh(words: list[str], candidates: list[str]) -> None:
    typed = " ".join(f"'{word}'" for word in [*words[:-1], words[-1] + "after-the-cursor"])
    program = (
        ZSH_WITHOUT_ITS_COMPLETION
        + completion_script("zsh", sys.executable, ["linkwright"])
        + f"words=({typed}); CURRENT=$#words\n"
        + f"PREFIX={shlex.quote(words[-1])}; _linkwright_complete"
    )
    result = subprocess.run(["zsh", "-f", "-c", program], capture_output=True, text=True, check=False)
    assert result.stdout.split() == candidates
    assert "compdef _linkwright_complete linkwright" in result.stderr


@pytest.mark.skipif(shutil.which("fish") is None, reason="fish is not installed")
@pytest.mark.parametrize(
    ("words", "candidates"), [*SHELL_LINES, (["linkwright", "check", "arm/a"], ["arm/arm.urdf.xacro"])]
)
def test_completion_in_fish(words: list[str], candidates: list[str], tmp_path: Path) -> None:
    program = completion_script("fish", sys.executable, ["linkwright"]) + f"complete -C {shlex.quote(' '.join(words))}"
    environment = {**os.environ, "HOME": str(tmp_path)}
    result = subprocess.run(
        ["fish", "--no-config", "-c", program], capture_output=True, text=True, check=True, env=environment
    )
    assert sorted(line.partition("\t")[0] for line in result.stdout.splitlines()) == sorted(candidates)


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shell_accepts_generated_script(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    text = capsys.readouterr().out
    assert text == completion_script(shell, sys.executable, ["linkwright"])
    if shutil.which(shell):
        generated = startup_script(shell, sys.executable, "LINKWRIGHT_SHELL", ["rosdep", "rqt"])
        subprocess.run([shell, "-n"], input=text + generated, text=True, check=True)


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
def test_missing_ros_programs_print_alternatives() -> None:
    program = "command_not_found_handle() { echo other $1; return 9; }\n"
    program += startup_script("bash", sys.executable, "LINKWRIGHT_SHELL", ["rosdep", "gazebo"])
    program += "rosdep install; echo $?; gazebo --verbose; no_such_program; echo $?"
    # without the folder of Linkwright's programs, which a launch in this process may have appended and which has gazebo
    environment = {**os.environ, "LINKWRIGHT_SHELL": "/nowhere", "LINKWRIGHT_LANG": "en", "PATH": os.defpath}
    result = subprocess.run(["bash", "-c", program], capture_output=True, text=True, check=False, env=environment)
    assert result.stdout.split("\n") == ["127", "other no_such_program", "9", ""]
    assert "command 'rosdep' does not exist" in result.stderr
    assert "put the sources of a missing package into the workspace's src folder" in result.stderr
    assert "which starts Linkwright's simulation instead" in result.stderr
