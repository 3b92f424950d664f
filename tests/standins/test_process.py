"""Processes that can import the stand-ins, with only an environment variable set."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from linkwright.diagnostics import package_hint
from linkwright.standins import process, table


def run_python(*arguments, cwd=None, env=None, **variables):
    base = {"PATH": os.environ["PATH"], "HOME": str(cwd or "/"), "LINKWRIGHT_DDS": "0", **variables}
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        env=env or process.create_environment(base),
        cwd=cwd,
        check=False,
        capture_output=True,
        text=True,
        timeout=60,
    )


def run_and_read(*arguments, **options):
    ended = run_python(*arguments, **options)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout.strip()


NODE = """\
import rclpy
from std_msgs.msg import String
def main():
    rclpy.init()
    node = rclpy.create_node("mine")
    got = []
    node.create_subscription(String, "chatter", got.append, 1)
    node.create_publisher(String, "chatter", 1).publish(String(data="hello"))
    rclpy.spin_once(node, timeout_sec=60.0)
    print(got[0].data)
    rclpy.shutdown()
if __name__ == "__main__":
    main()
"""


class TestRunning:
    def test_file_is_run_with_standins(self, tmp_path):
        (tmp_path / "my_node.py").write_text(NODE)
        assert run_and_read("my_node.py", cwd=tmp_path) == "hello"

    @pytest.mark.parametrize("module", ["launch", "xacro"])
    def test_folder_with_same_name_does_not_hide_standin(self, tmp_path, module):
        (tmp_path / module).mkdir()
        program = f"import {module}; print({module}.__spec__.origin)"
        assert run_and_read("-c", program, cwd=tmp_path).endswith(f"{module}.txt")

    def test_package_with_same_name_takes_precedence(self, tmp_path):
        (tmp_path / "launch").mkdir()
        (tmp_path / "launch" / "__init__.py").write_text("mine = 1")
        assert run_and_read("-c", "import launch; print(launch.mine)", cwd=tmp_path) == "1"

    def test_pythonpath_alone_enables_standins(self, tmp_path):
        (tmp_path / "my_node.py").write_text(NODE)
        variables = {"PATH": os.environ["PATH"], "PYTHONPATH": process.standin_path(), "LINKWRIGHT_DDS": "0"}
        assert run_and_read("my_node.py", cwd=tmp_path, env=variables) == "hello"

    def test_module_is_run_with_standins(self, tmp_path):
        package = tmp_path / "my_package"
        package.mkdir()
        (package / "__init__.py").touch()
        (package / "my_node.py").write_text(NODE)
        assert run_and_read("-m", "my_package.my_node", cwd=tmp_path) == "hello"

    def test_entry_point_script_is_run_with_standins(self, tmp_path):
        (tmp_path / "my_node.py").write_text(NODE)
        script = tmp_path / "bin" / "talker"
        script.parent.mkdir()
        script.write_text(
            f"import sys\nsys.path.insert(0, {str(tmp_path)!r})\nfrom my_node import main\nsys.exit(main())\n"
        )
        assert run_and_read(script) == "hello"

    def test_child_process_inherits_standins(self, tmp_path):
        (tmp_path / "my_node.py").write_text(NODE)
        parent = "import subprocess, sys; sys.exit(subprocess.call([sys.executable, 'my_node.py']))"
        assert run_and_read("-c", parent, cwd=tmp_path) == "hello"

    @pytest.mark.slow
    def test_virtual_environment_finds_standins(self, tmp_path):
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "venv"], check=True, timeout=60)
        (tmp_path / "my_node.py").write_text(NODE)
        python = tmp_path / "venv" / "bin" / "python"
        environment = process.create_environment({"PATH": os.environ["PATH"], "LINKWRIGHT_DDS": "0"})
        ended = subprocess.run(
            [python, "my_node.py"],
            cwd=tmp_path,
            env=environment,
            check=False,
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert (ended.stdout, ended.returncode) == ("hello\n", 0), ended.stderr

    def test_all_standins_can_be_imported(self):
        names = table.list_packages()
        assert {"rclpy", "tf2_ros", "tf2_py", "tf2_geometry_msgs", "tf_transformations", "launch", "xacro"} <= set(
            names
        )
        imports = "; ".join(f"import {name}; assert {name}.__file__" for name in names)
        assert run_and_read("-c", f"{imports}; print('all')") == "all"

    def test_interfaces_can_be_imported(self, tmp_path):
        code = "from sensor_msgs.msg import JointState; from std_srvs.srv import SetBool; print(JointState.__name__)"
        assert run_and_read("-c", code, cwd=tmp_path) == "JointState"

    def test_workspace_interfaces_are_importable_without_build(self, tmp_path):
        package = tmp_path / "src" / "my_robot"
        (package / "msg").mkdir(parents=True)
        (package / "msg" / "Count.msg").write_text("int32 number\nstring[] names\n")
        (package / "package.xml").write_text(
            "<package format='3'><name>my_robot</name><version>0.0.1</version><description>d</description>"
            "<maintainer email='a@example.com'>a</maintainer><license>MIT</license></package>"
        )
        code = "from my_robot.msg import Count; print(Count(number=3, names=['a']))"
        assert run_and_read("-c", code, cwd=tmp_path) == "my_robot.msg.Count(number=3, names=['a'])"
        # In src, Python itself would import the folders as packages.
        assert run_and_read("-c", code, cwd=tmp_path / "src") == "my_robot.msg.Count(number=3, names=['a'])"


@pytest.mark.skipif(os.name == "nt", reason="Windows cannot send SIGINT")
class TestInterrupt:
    def interrupted(self, tmp_path, code):
        (tmp_path / "node.py").write_text("import rclpy, signal\n" + textwrap.dedent(code))
        ended = run_python("node.py", cwd=tmp_path)
        assert ended.returncode == -signal.SIGINT
        return ended.stderr

    def test_spinning_node_ends_without_traceback(self, tmp_path):
        code = """
            import os, threading
            rclpy.init()
            threading.Timer(0.2, os.kill, [os.getpid(), signal.SIGINT]).start()
            rclpy.spin(rclpy.create_node("mine"))
            """
        assert self.interrupted(tmp_path, code) == ""

    def test_interrupt_during_import_ends_without_traceback(self, tmp_path):
        (tmp_path / "parts.py").write_text("import signal\nsignal.raise_signal(signal.SIGINT)\n")
        assert self.interrupted(tmp_path, "import parts") == ""

    def test_interrupt_in_user_code_names_its_line(self, tmp_path):
        code = """
            rclpy.init()
            node = rclpy.create_node("mine")
            node.create_timer(0.01, lambda: signal.raise_signal(signal.SIGINT))
            rclpy.spin(node)
            """
        output = self.interrupted(tmp_path, code)
        assert "node.py" in output
        assert output.endswith("KeyboardInterrupt\n")


class TestProcessEffects:
    def test_unrelated_imports_load_nothing_of_linkwright(self):
        code = """
            import sys
            for name in ("no_such_module", "other._private", "json.nothing"):
                try:
                    __import__(name)
                except ImportError:
                    pass
            print([name for name in sys.modules if "linkwright" in name or name in ("numpy", "importlib.util")])
            """
        minimal_environment = {"PATH": os.environ["PATH"]}
        # Ubuntu has a sitecustomize of its own.
        has_site_customization = (
            run_and_read("-c", "import sys; print('sitecustomize' in sys.modules)", env=minimal_environment) == "True"
        )
        assert run_and_read("-c", textwrap.dedent(code)) == ("['importlib.util']" if has_site_customization else "[]")

    def test_similar_missing_module_is_not_found(self):
        ended = run_python("-c", "import rclpy_of_another_kind")
        assert "ModuleNotFoundError: No module named 'rclpy_of_another_kind'" in ended.stderr

    @pytest.mark.parametrize(
        ("module", "hint"),
        [
            ("carrier_msgs.msg", "hint: put the ROS package 'carrier_msgs' into the workspace's src folder"),
            ("image_geometry", "hint: it is part of vision_opencv, which must be compiled"),
            ("serial", f"hint: {package_hint('pyserial')}"),
            ("moveit_commander", "hint: 'moveit_commander' is part of ROS 1; in ROS 2 it is 'moveit.planning'"),
            ("rospy", "hint: 'rospy' is part of ROS 1; in ROS 2 it is 'rclpy'"),
            ("unheard_of", "ModuleNotFoundError: No module named 'unheard_of'"),
        ],
    )
    def test_missing_module_has_hint(self, module, hint):
        last = run_python("-c", f"import {module}").stderr.splitlines()[-1]
        assert last.startswith(hint)

    @pytest.mark.parametrize(
        ("line", "hint"),
        [
            ("from rclpy.qos import Node", "hint: import it from 'launch_ros.actions' or 'rclpy.node'"),
            ("from rclpy.node import QoSPresetProfiles", "hint: import it from 'rclpy.qos'"),
            ("from tf2_ros import PoseArray", "ImportError: cannot import name 'PoseArray' from 'tf2_ros'"),
        ],
    )
    def test_missing_name_in_module_has_hint(self, line, hint):
        last = run_python("-c", line).stderr.splitlines()[-1]
        assert last.startswith(hint)

    def test_next_sitecustomize_is_run(self, tmp_path):
        (tmp_path / "sitecustomize.py").write_text("WAS_RUN = 'yes'\n")
        code = "import sitecustomize; print(sitecustomize.WAS_RUN); import rclpy"
        assert run_and_read("-c", code, PYTHONPATH=str(tmp_path)) == "yes"

    def test_real_rclpy_disables_all_standins(self, tmp_path):
        for name in ("rclpy", "std_msgs"):
            (tmp_path / name).mkdir()
            (tmp_path / name / "__init__.py").write_text("REAL = True\n")
        code = """
            import rclpy, std_msgs
            print(rclpy.REAL, std_msgs.REAL)
            for name in ("tf2_ros", "sensor_msgs.msg", "launch"):
                try:
                    __import__(name)
                except ImportError as error:
                    print(error)
            import tf_transformations
            """
        assert run_and_read("-c", textwrap.dedent(code), PYTHONPATH=str(tmp_path)).splitlines() == [
            "True True",
            "No module named 'tf2_ros'",
            "No module named 'sensor_msgs'",
            "No module named 'launch'",
        ]

    def test_environment_prepends_standin_path_once(self, tmp_path):
        process_environment = process.create_environment({"PYTHONPATH": str(tmp_path), "OTHER": "kept"})
        assert process_environment["PYTHONPATH"] == os.pathsep.join([process.standin_path(), str(tmp_path)])
        assert process_environment["OTHER"] == "kept"
        assert process.create_environment(process_environment) == process_environment
        modules = {path.name for path in Path(process.standin_path()).glob("*.py")}
        assert modules == {"linkwright_pytest.py", "sitecustomize.py"}

    def test_python_command_prefers_virtual_environment(self, tmp_path):
        assert process.python_command(["node.py"], {}) == [sys.executable, "node.py"]
        name = f"python{sys.version_info.major}.{sys.version_info.minor}"
        other = tmp_path / "bin" / name
        other.parent.mkdir()
        other.touch()
        assert process.python_command(["node.py"], {"VIRTUAL_ENV": str(tmp_path)}) == [str(other), "node.py"]
        assert process.python_command(["node.py"], {"VIRTUAL_ENV": str(tmp_path / "gone")})[0] == sys.executable
