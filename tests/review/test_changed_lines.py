"""The changed lines of scripts, device rules and lists of packages in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

PACKAGES = " ".join(f"ros-jazzy-tool-{number}" for number in range(10))
LONG_OPTIONS = " ".join(f"_option_{number}:=value" for number in range(15))


@pytest.mark.parametrize(
    ("path", "old", "new", "expected"),
    [
        ("apt/packages.txt", "git\ncurl\nros-jazzy-a\n", "git\nros-jazzy-a\nros-jazzy-b\n",
         "ros-jazzy-b added; curl removed"),
        ("udev/99.rules", 'A=="1"\n', '# sonar\nA=="1"\nKERNEL=="ttyUSB*", SYMLINK+="sonar"\n',
         '`KERNEL=="ttyUSB*", SYMLINK+="sonar"` added'),
        ("start.sh", "run a && run b\n", "run a\n# && run b\n", "run a && run b -> run a"),
        ("Dockerfile", "FROM a\nRUN a \\\n  b\n", "FROM a\nRUN a b\n", None),
        ("start.sh", "a b\n", "a b\n" + "".join(f"echo {n} x\n" for n in range(7)) + "ros2 run arm driver\n",
         "`ros2 run arm driver`, 7 more lines added"),
        ("notes.md", "a\n", "b\n", None),
        ("op.robot", "[ control ]\ncycle = 12 # ms\n", "[ control ]\ncycle = 8 # ms\n",
         "cycle = 12 # ms -> cycle = 8 # ms"),
        ("map.lua", "-- a\nx = {\n  min_range = 0.1,\n}\n", "-- b\nx = {\n  min_range = 0.3,\n}\n",
         "min_range = 0.1, -> min_range = 0.3,"),
        ("ports.ini", "; old\n[a]\nport=1\n", "; new\n[a]\nport=1\nrate=2\n", "rate=2 added"),
        ("Dockerfile", f"RUN apt-get install {PACKAGES} joy\n", f"RUN apt-get install {PACKAGES} nav\nUSER a\n",
         ("`RUN apt-get install ros-jazzy-tool-0 ros-jazzy-tool-1 ros-jazzy-tool-2 ...`: nav added; joy removed; "
          "`USER a` added")),
        ("tox.ini", "[a]\nport=1\n", "[a]\nport=2\n", None),
    ],
)  # fmt: skip
def test_lines_that_a_text_file_gains_and_loses(repository, compare, path, old, new, expected):
    repository.commit({path: old})
    repository.write({path: new})
    result = compare(repository)
    assert result.other_files == [path]
    assert {name: str(text) for name, text in result.file_states.items()} == ({path: expected} if expected else {})


UNIT = """[Unit]
Description=Arm
[Service]
ExecStart=/bin/bash -c 'source setup.bash && rosrun arm driver __ns:=left'
"""


@pytest.mark.parametrize(
    ("path", "text", "state"),
    [
        ("arm/arm.service", UNIT, "`rosrun arm driver __ns:=left`"),
        (
            "arm/start",
            '#!/usr/bin/env bash\n# starts the arm\nros2 run arm driver "$@"\n',
            '`ros2 run arm driver "$@"`',
        ),
        (
            "arm/pose.service",
            f"[Service]\nExecStart=/bin/bash -c 'rosrun arm pose {LONG_OPTIONS} image:=front/image'\n",
            f"`rosrun arm pose {LONG_OPTIONS} image:=front/image`",
        ),
        ("arm/notes", "ros2 run arm driver\n", None),
        (
            "Dockerfile",
            "FROM ros:jazzy\nRUN apt-get update\nCMD ros2 run a b\n",
            "`FROM ros:jazzy`, `CMD ros2 run a b`",
        ),
        (
            "docker/compose.yaml",
            "services:\n  sim:\n    image: arm\n    command: bash\n    tty: true\n  arm:\n    image: arm\n",
            "`image: arm`, `command: bash`",
        ),
        ("docker/compose.yml", "volumes:\n  data:\n", None),
        ("udev/9.rules", '# sonar\nKERNEL=="ttyUSB*", MODE="0666"\n', '`KERNEL=="ttyUSB*", MODE="0666"`'),
    ],
)
def test_added_and_removed_scripts_and_units_show_their_commands(repository, compare, path, text, state):
    repository.commit({"README": "arm\n"})
    repository.commit({path: text})
    repository.commit({path: None})
    for commits, word in (("HEAD~2..HEAD~1", "added"), ("HEAD~1..HEAD", "removed")):
        result = compare(repository, commits)
        if word == "removed" and path.endswith(".service"):
            assert breaking(result) == [f"systemd unit removed: {state}"]
            continue
        assert str(result.file_states[path]) == (word if state is None else f"{word}: {state}")


def test_shell_script_without_a_suffix_is_compared(repository, compare):
    repository.commit({"arm/start": '#!/bin/sh\nros2 run arm driver "${@:1:$#-1}"\n'})
    repository.write({"arm/start": '#!/bin/sh\nros2 run arm driver "$@"\n'})
    assert str(compare(repository).file_states["arm/start"]).endswith('-> ros2 run arm driver "$@"')


def test_long_added_script_has_its_commands_of_ros_and_the_number_of_other_lines(repository, compare):
    lines = [
        "cleanup() {",
        'echo "bye"',
        "kill 0",
        "}",
        "trap cleanup EXIT",
        "sleep 1",
        "ros2 launch arm arm.launch.py",
    ]
    repository.commit({"README": "arm\n"})
    repository.write({"arm/start.sh": "\n".join(["#!/bin/sh", *lines])})
    state = str(compare(repository).file_states["arm/start.sh"])
    assert state == "added: `ros2 launch arm arm.launch.py`, 6 more lines"


def test_long_added_script_without_commands_of_ros_has_the_number_of_its_lines(repository, compare):
    repository.commit({"README": "arm\n"})
    repository.write({"arm/tune.sh": "#!/bin/sh\n" + "beep\n" * 9})
    assert str(compare(repository).file_states["arm/tune.sh"]) == "added: 9 lines"


def test_a_script_whose_commands_become_comments_starts_nothing(repository, compare):
    commands = [
        "if [ $# -eq 0 ]; then exit 1; fi",
        "declare -A pids",
        *(f"python3 arm/{name}.py &" for name in "abcdef"),
    ]
    repository.commit({"start.sh": "\n".join(["#!/bin/bash", *commands, ""])})
    repository.write({"start.sh": "\n".join(["# replaced", *(f"# {command}" for command in commands), ""])})
    (line,) = breaking(compare(repository))
    assert line.startswith("runs no command any more; removed: `python3 arm/a.py &`, `python3 arm/b.py &`")
    repository.write({"start.sh": "\n".join(["#!/bin/bash", commands[-1], ""])})
    assert breaking(compare(repository)) == []


def test_quoted_text_of_a_long_command_is_one_word(repository, compare):
    command = "docker exec box /entrypoint.sh ros2 run arm spawner bend --controller-manager /manager --timeout {}"
    old = command.format("30 --inactive --load-only --activate-as-group --namespace /left --ros-args -r a:=b -r c:=d")
    assert len(old) > 160
    repository.commit({"start.sh": f"{old}\n"})
    repository.write({"start.sh": f'cd /arm\n{old} || die "could not start"\n'})
    (text,) = map(str, compare(repository).file_states.values())
    assert '||, die, "could not start" added' in text
