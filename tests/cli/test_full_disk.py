"""Commands on a full disk, or with full or closed standard streams.

The tests cover one message, and no loss.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pytest

from linkwright.bag import STORAGES, BagReader, BagWriter
from linkwright.cli import main
from linkwright.cli.command import collect_help_texts
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Graph
from linkwright.messages import String, serialize
from linkwright.rviz import RvizConfig
from linkwright.rviz.config.locations import RecentFiles
from tests.full_disk import full_disk, needs_limits
from tests.places import REPOSITORY
from tests.recordings import needs_rosbags

ROBOT = """<robot name="r">
  <link name="a"><visual><geometry><box size="1 1 1"/></geometry></visual>
    <collision><geometry><box size="1 1 1"/></geometry></collision></link>
</robot>
"""
OLD_CONTENT = "what was there before"
FREE_BYTES = 50  # less than any command writes here


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT, encoding="utf-8")
    return path


def list_files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


WRITING_COMMANDS = {
    "xacro": ["xacro", "r.urdf", "-o", "out"],
    "export html": ["export", "out.html", "r.urdf"],
    "export glb": ["export", "out.glb", "r.urdf"],
    "picture": ["picture", "r.urdf", "-o", "out.png"],
    "diagram": ["diagram", "r.urdf", "out"],
    "inertia": ["inertia", "r.urdf", "--write"],
    "drive": ["drive", "r.urdf", "--write"],
    "check": ["check", "r.urdf", "--unsafe-fixes", "--select", "URDF,LW,INR,XAC"],
}


@needs_limits
@pytest.mark.parametrize("words", WRITING_COMMANDS.values(), ids=WRITING_COMMANDS)
def test_command_on_full_disk_leaves_files_unchanged(
    words: Sequence[str], robot: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if words[0] == "check":  # give `check` something to fix
        robot.write_text(ROBOT.replace('name="a"', 'name="a" nmae="b"').replace("<robot ", "<robot version='1' "))
    for name in ("out", "out.html", "out.glb", "out.png", "out.gv", "out.pdf"):
        (robot.parent / name).write_text(OLD_CONTENT)
    before = list_files(robot.parent)
    with full_disk(FREE_BYTES):
        status = main(list(words))
    printed = capsys.readouterr().err
    assert list_files(robot.parent) == before
    if words[0] != "check" or "cannot write" in printed:
        assert status == 1
        assert "cannot write" in printed
        assert "File too large" in printed


@needs_limits
def test_package_is_created_completely_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["pkg", "create", "fine", "--license", "Apache-2.0"]
    with full_disk(2000):  # the license does not fit
        assert main(words) == 1
    assert "File too large" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
    assert main(words) == 0


@needs_limits
def test_unsaved_configuration_keeps_old_file(tmp_path: Path) -> None:
    path = tmp_path / "a.rviz"
    path.write_text("Panels: []\nVisualization Manager:\n  Displays: []\n")
    before = path.read_bytes()
    config = RvizConfig.load(path)
    with full_disk(10), pytest.raises(LinkwrightError) as caught:
        config.save(path)
    assert caught.value.diagnostics[0].code == "RVIZ104"
    assert path.read_bytes() == before
    recent = RecentFiles(tmp_path / "recent")
    recent.add(path)
    with full_disk(10):
        recent.add(tmp_path / "other.rviz")
    assert RecentFiles(tmp_path / "recent").paths == [str(path)]


@needs_limits
@needs_rosbags
@pytest.mark.parametrize(("storage", "single_file"), [*((storage, False) for storage in STORAGES), ("mcap", True)])
def test_recording_on_full_disk_fails_once_and_keeps_messages(tmp_path: Path, storage: str, single_file: bool) -> None:
    path = tmp_path / "bag.mcap"
    writer = BagWriter(path, storage, single_file=single_file)
    writer.add_topic("/chatter", "std_msgs/msg/String")
    data = serialize(String(data="x" * 1000))
    for stamp in range(10):
        writer.write("/chatter", stamp, data)
    writer.flush()

    def fill() -> None:
        for stamp in range(10, 100_000):
            writer.write("/chatter", stamp, data)
            writer.flush()

    with full_disk(120_000), pytest.raises(LinkwrightError) as caught:
        fill()
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["BAG108"]
    assert " stopped: " in str(caught.value)
    writer.write("/chatter", 1, data)  # nothing more is written or reported
    writer.flush()
    writer.close()
    with BagReader(path) as bag:
        assert sum(1 for _ in bag.messages()) >= 10


@needs_rosbags
@needs_limits
def test_bag_record_reports_full_disk_once(
    add_to_graph: Callable[[Callable[[Graph], object]], None],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def talk(graph: Graph) -> None:
        node = graph.create_node("talker")
        publisher = node.create_publisher(String, "chatter", 10)
        node.create_timer(0.001, lambda: publisher.publish(String(data="x" * 1000)))

    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    add_to_graph(talk)
    with full_disk(20_000):
        assert main(["bag", "record", "-a", "-o", str(tmp_path / "bag")]) == 1
    printed = capsys.readouterr().err
    assert printed.count(" stopped: File too large") == 1
    assert "Traceback" not in printed
    with BagReader(tmp_path / "bag") as bag:
        list(bag.messages())


QUICK_COMMANDS = {
    "version": ["--version"],
    "help": ["--help"],
    **{f"{verb} --help": [verb, "--help"] for verb in collect_help_texts()},
    "check": ["check", "r.urdf"],
    "check json": ["check", "r.urdf", "--format", "json"],
    "xacro": ["xacro", "r.urdf"],
    "explain": ["explain", "URDF101"],
    "inertia": ["inertia", "r.urdf"],
    "export": ["export", "out.glb", "r.urdf"],
    "pkg list": ["pkg", "list"],
    "interface show": ["interface", "show", "std_msgs/msg/Header"],
}

_RUN_MANY = """
import os, sys
from linkwright.cli import main
from linkwright.cli.command import collect_help_texts, create_parser
for name in collect_help_texts():
    create_parser(name)  # what verbs import is imported once, not by each process
failed = []
for words in {commands!r}:
    child = os.fork()
    if child == 0:
        sys.argv[1:] = words
        status = main()
        try:
            sys.stdout.flush()
        except OSError:
            status = 99  # Python would complain as it ends
        os._exit(status)
    failed.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
sys.stderr.write(repr(failed))
"""


def run_commands(commands: Mapping[str, Sequence[str]], folder: Path, redirection: str) -> tuple[dict[str, int], str]:
    """Run commands with redirected streams, and return their exit statuses and output."""
    program = _RUN_MANY.format(commands=[list(words) for words in commands.values()])
    environment = {**os.environ, "PYTHONPATH": str(REPOSITORY / "src")}
    result = subprocess.run(
        ["sh", "-c", f'exec "$@" {redirection}', "sh", sys.executable, "-c", program],
        cwd=folder,
        env=environment,
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        timeout=300,
        check=False,
    )
    printed, _, exit_statuses = result.stderr.rpartition("[")
    return dict(zip(commands, map(int, exit_statuses.rstrip("]").split(",")), strict=True)), printed


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has /dev/full")
@pytest.mark.parametrize(("redirection", "reason"), [(">/dev/full", "No space left"), (">&-", "Bad file descriptor")])
def test_unwritable_standard_output_is_one_error(robot: Path, redirection: str, reason: str) -> None:
    statuses_by_command, printed = run_commands(QUICK_COMMANDS, robot.parent, redirection)
    assert statuses_by_command == dict.fromkeys(QUICK_COMMANDS, 1)
    assert printed.count(f"error[CLI202]: cannot write to standard output: {reason}") == len(QUICK_COMMANDS)
    assert "bug in Linkwright" not in printed
    assert "Exception ignored" not in printed


LONG_COMMANDS = {
    "help": ["--help"],
    "check": ["check", "r.urdf"],
    "xacro": ["xacro", "r.urdf"],
    "inertia": ["inertia", "r.urdf"],
    "interface list": ["interface", "list"],
}


@needs_limits
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_output_truncated_by_full_disk_is_an_error(
    robot: Path, unbuffered: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The disk has space for only the first bytes of each output."""
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    for name, words in LONG_COMMANDS.items():
        with (robot.parent / "out").open("w") as out, full_disk(FREE_BYTES):
            result = subprocess.run(
                [sys.executable, "-m", "linkwright", *words],
                env={**os.environ, "PYTHONPATH": str(REPOSITORY / "src")},
                stdout=out,
                stderr=subprocess.PIPE,
                text=True,
                check=False,
            )
        assert (robot.parent / "out").stat().st_size == FREE_BYTES, name
        assert result.returncode == 1, name
        assert "error[CLI202]: cannot write to standard output: File too large" in result.stderr, name


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no fork")
def test_closed_standard_input_is_treated_as_empty(robot: Path) -> None:
    commands = {**QUICK_COMMANDS, "check -": ["xacro", "-"], "pub": ["interface", "show", "-"]}
    statuses_by_command, printed = run_commands(commands, robot.parent, "<&-")
    assert {name for name, status in statuses_by_command.items() if status} == {"check -", "pub"}
    assert "bug in Linkwright" not in printed


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has /dev/full")
@pytest.mark.parametrize("redirection", ["2>/dev/full", "2>&-"])
def test_unwritable_standard_error_keeps_exit_status(robot: Path, redirection: str) -> None:
    for words, status in ((["check", "r.urdf"], 0), (["check", "missing.urdf"], 1)):
        program = f'"$0" -m linkwright {" ".join(words)} {redirection}'
        environment = {**os.environ, "PYTHONPATH": str(REPOSITORY / "src")}
        result = subprocess.run(
            ["sh", "-c", program, sys.executable],
            cwd=robot.parent,
            env=environment,
            stdout=subprocess.PIPE,
            timeout=60,
            check=False,
        )
        assert result.returncode == status, words


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot remove folders that are in use")
def test_removed_working_directory_is_handled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    robot = tmp_path / "r.urdf"
    robot.write_text(ROBOT)
    working_directory = Path.cwd()
    for words in (
        ["check", str(robot)],
        ["check", "."],
        ["xacro", str(robot)],
        ["view", str(robot), "--no-open"],
        ["export", "a.glb", str(robot)],
        ["diagram", str(robot)],
        ["inertia", str(robot)],
        ["pkg", "create", "some_robot"],
        ["launch", "a.launch.py", "--print"],
    ):
        removed = tmp_path / "gone"
        removed.mkdir()
        os.chdir(removed)
        shutil.rmtree(removed)
        try:
            result = subprocess.run(
                [sys.executable, "-m", "linkwright", *words],
                env={**os.environ, "PYTHONPATH": str(REPOSITORY / "src"), "ROS_LOG_DIR": str(tmp_path / "log")},
                capture_output=True,
                text=True,
                timeout=60,
                check=False,
            )
        finally:
            os.chdir(working_directory)
        assert "bug in Linkwright" not in result.stderr, words
        assert result.returncode in (0, 1), (words, result.stderr)
        assert result.returncode == 0 or "error[" in result.stderr, words
