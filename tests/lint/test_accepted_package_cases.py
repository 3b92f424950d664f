"""Cases of packages that rules ignore on purpose, compared with cases that they report."""

from __future__ import annotations

import pytest

from linkwright.lint.engine import examine_package
from linkwright.lint.settings import Settings
from tests.lint.manifest import MANIFEST


@pytest.mark.parametrize(("build", "codes"), [("ament_cmake", []), ("ament_python", ["LW827"])])
def test_setup_py_of_cmake_package_is_ignored(tmp_path, build, codes):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=f"<export><build_type>{build}</build_type></export>"))
    (tmp_path / "CMakeLists.txt").write_text("project(p)\n")
    (tmp_path / "p").mkdir()
    (tmp_path / "p/__init__.py").write_text("")
    (tmp_path / "setup.py").write_text(
        "from setuptools import setup\n"
        "setup(name='p', packages=['p'], entry_points={'console_scripts': ['run = p.run:main']})\n"
    )
    findings = examine_package(tmp_path, Settings(select=("LW827",))).diagnostics
    assert [finding.code for finding in findings] == codes


@pytest.mark.parametrize(
    ("driver", "codes"), [("init(self, webots_node, properties)", []), ("__init__(self, a, b)", ["LW827"])]
)
def test_webots_driver_needs_no_main(tmp_path, driver, codes):
    (tmp_path / "package.xml").write_text(
        MANIFEST.format(more="<export><build_type>ament_python</build_type></export>")
    )
    (tmp_path / "p").mkdir()
    (tmp_path / "p/run.py").write_text(f"class Driver:\n    def {driver}:\n        pass\n")
    (tmp_path / "setup.py").write_text(
        "from setuptools import setup\n"
        "setup(name='p', packages=['p'], entry_points={'console_scripts': ['run = p.run:main']})\n"
    )
    findings = examine_package(tmp_path, Settings(select=("LW827",))).diagnostics
    assert [finding.code for finding in findings] == codes


@pytest.mark.parametrize("path", ["sdk", "sdk/cxx"])
def test_missing_folder_of_submodule_hints_at_git_submodule_update(tmp_path, path):
    (tmp_path / ".gitmodules").write_text(f'[submodule "{path}"]\n\tpath = {path}\n\turl = x\n')
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "CMakeLists.txt").write_text(
        "project(p)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY sdk/cxx/include DESTINATION include)\nament_package()\n"
    )
    (finding,) = examine_package(tmp_path, Settings(select=("LW824",))).diagnostics
    assert str(finding.hint) == f"'{path}' is a Git submodule: run git submodule update --init"


@pytest.mark.parametrize(("ignored", "codes"), [("dist/", []), ("*.log", ["LW824"])])
def test_missing_installed_folder_that_git_ignores_is_accepted(tmp_path, ignored, codes):
    (tmp_path / ".git").mkdir()
    (tmp_path / ".gitignore").write_text(f"{ignored}\n")
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "CMakeLists.txt").write_text(
        "project(p)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY web/dist DESTINATION share/p)\nament_package()\n"
    )
    findings = examine_package(tmp_path, Settings(select=("LW824",))).diagnostics
    assert [finding.code for finding in findings] == codes


_DOWNLOAD = 'set(net "${PROJECT_SOURCE_DIR}/nets/a.onnx")\nfile(DOWNLOAD "https://example.org/a.onnx" "${net}")\n'


@pytest.mark.parametrize(
    ("before", "codes"),
    [
        (_DOWNLOAD, []),
        (_DOWNLOAD.replace("nets", "networks"), ["LW824"]),
        ("# file(DOWNLOAD) into nets/\n", ["LW824"]),
        ("file(MAKE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/nets)\n", []),
    ],
)
def test_installed_folder_that_cmake_creates_is_accepted(tmp_path, before, codes):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "CMakeLists.txt").write_text(
        f"project(p)\nfind_package(ament_cmake REQUIRED)\n{before}"
        "install(DIRECTORY nets DESTINATION share/p)\nament_package()\n"
    )
    findings = examine_package(tmp_path, Settings(select=("LW824",))).diagnostics
    assert [finding.code for finding in findings] == codes


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("<exec_depend>xacro</exec_depend><exec_depend>xacro</exec_depend>", ["info"]),
        ("<depend>xacro</depend><exec_depend>xacro</exec_depend>", ["error"]),
        ("<build_depend>xacro</build_depend><depend>xacro</depend>", ["error"]),
        ("<depend>xacro</depend><test_depend>xacro</test_depend>", []),
    ],
)
def test_repeated_dependency_is_an_info_or_error_beside_depend(tmp_path, lines, message):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=lines))
    findings = examine_package(tmp_path, Settings(select=("LW809",))).diagnostics
    assert [finding.severity.value for finding in findings] == message


@pytest.mark.parametrize("name", ["iCub", "neo-mpo"])
def test_package_name_that_colcon_accepts_is_an_info(tmp_path, name):
    """The author of a published package cannot rename it."""
    (tmp_path / "package.xml").write_text(MANIFEST.format(more="").replace("<name>p</name>", f"<name>{name}</name>"))
    findings = examine_package(tmp_path, Settings(select=("LW805",))).diagnostics
    assert [finding.severity.value for finding in findings] == ["info"]


@pytest.mark.parametrize(
    ("text", "message"),
    [("", "info"), ("# from launch import LaunchDescription\n", "info"), ("import launch\n", "warning")],
)
def test_empty_launch_file_is_an_info(tmp_path, text, message):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "launch").mkdir()
    (tmp_path / "launch" / "a.launch.py").write_text(text)
    findings = examine_package(tmp_path, Settings(select=("LW841",))).diagnostics
    assert [finding.severity.value for finding in findings] == [message]


@pytest.mark.parametrize(
    ("text", "files", "count"),
    [
        ("import ast\ndef test_it():\n    pass\n", [], 0),
        ("import launch\n", ["__init__.py"], 0),
        ("import launch\ndef tested():\n    pass\n", [], 1),
    ],
    ids=["pytest", "a module", "neither"],
)
def test_tests_and_modules_named_like_launch_files_are_accepted(tmp_path, text, files, count):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "p").mkdir()
    for name in ("a_launch.py", *files):
        (tmp_path / "p" / name).write_text(text if name == "a_launch.py" else "")
    findings = examine_package(tmp_path, Settings(select=("LW841",))).diagnostics
    assert [finding.code for finding in findings] == ["LW841"] * count


def test_uninstalled_sibling_folders_are_one_finding(tmp_path):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more="").replace("ament_cmake", "ament_python"))
    (tmp_path / "setup.py").write_text(
        "from setuptools import setup\n\nsetup(name='p', packages=['p'], data_files=[('share/p', ['package.xml'])])\n"
    )
    for name in ("default", "fake", "schema"):
        (tmp_path / "config" / name).mkdir(parents=True)
        (tmp_path / "config" / name / "arm.yaml").write_text("a: 1\n")
    findings = examine_package(tmp_path, Settings(select=("LW822",))).diagnostics
    assert [str(finding.message) for finding in findings] == [
        "setup.py does not install the folder 'config/default' (and 2 more)"
    ]


@pytest.mark.parametrize(
    ("file", "launch", "severity"),
    [
        ("a.yaml", "config/a.yaml", "WARNING"),
        ("a.yaml", "", "INFO"),
        ("a.launch.yaml", "", "WARNING"),
        ("a.urdf", "", "WARNING"),
    ],
)
def test_uninstalled_file_that_no_launch_file_reads_is_an_info(tmp_path, file, launch, severity):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "CMakeLists.txt").write_text(
        "project(p)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\nament_package()\n"
    )
    for folder in ("config", "launch"):
        (tmp_path / folder).mkdir()
    (tmp_path / "config" / file).write_text("a: 1\n")
    (tmp_path / "launch/p.launch.py").write_text(
        "import os\nfrom ament_index_python.packages import get_package_share_directory\n\n\n"
        "def generate_launch_description():\n"
        f"    os.path.join(get_package_share_directory('p'), {launch!r})\n"
    )
    findings = examine_package(tmp_path, Settings(select=("LW822",))).diagnostics
    assert [finding.severity.name for finding in findings] == [severity]


@pytest.mark.parametrize(
    ("program", "data", "codes"),
    [
        ("driver.py", "(os.path.join('lib', name), [name + '/driver.py'])", []),
        ("driver.py", "('lib/p', ['p/driver.py'])", []),
        ("driver.py", "('share/p', ['p/driver.py'])", ["LW844"]),
        ("driver.bash", "(os.path.join('lib', name), glob('p/*'))", []),
    ],
)
def test_program_in_data_files_is_an_executable(tmp_path, program, data, codes):
    (tmp_path / "package.xml").write_text(
        MANIFEST.format(more="<export><build_type>ament_python</build_type></export>")
    )
    (tmp_path / "setup.py").write_text(
        "import os\nfrom glob import glob\nfrom setuptools import setup\n\nname = 'p'\n"
        f"setup(name=name, packages=[name], data_files=[{data}], entry_points={{'console_scripts': []}})\n"
    )
    for folder in ("p", "launch"):
        (tmp_path / folder).mkdir()
    (tmp_path / "p" / program).write_text("")
    (tmp_path / "launch/p.launch.py").write_text(
        "from launch_ros.actions import Node\n\n\n"
        f"def generate_launch_description():\n    Node(package='p', executable='{program}')\n"
    )
    findings = examine_package(tmp_path, Settings(select=("LW844",))).diagnostics
    assert [finding.code for finding in findings] == codes


@pytest.mark.parametrize(
    ("existing_file", "codes"), [("launch/sensors.launch.py", []), ("launch/other.launch.py", ["LW842"])]
)
def test_launched_file_missing_only_from_old_build_is_accepted(tmp_path, existing_file, codes):
    for name in ("p", "q"):
        (tmp_path / "src" / name / "launch").mkdir(parents=True)
        manifest = MANIFEST.format(more="").replace("<name>p<", f"<name>{name}<")
        (tmp_path / "src" / name / "package.xml").write_text(manifest)
    built = tmp_path / "install/q/share/q"
    built.mkdir(parents=True)
    (built / "package.xml").write_text(manifest)
    (tmp_path / "install/.colcon_install_layout").write_text("isolated\n")
    (tmp_path / "install/q/share/colcon-core/packages").mkdir(parents=True)
    (tmp_path / "install/q/share/colcon-core/packages/q").write_text("")
    (tmp_path / "src/q" / existing_file).write_text("def generate_launch_description():\n    pass\n")
    launch = "import os\n\n\ndef generate_launch_description():\n    share = get_package_share_directory('q')\n"
    launch += "    return os.path.join(share, 'launch', 'sensors.launch.py')\n"
    (tmp_path / "src/p/launch/a.launch.py").write_text(launch)
    findings = examine_package(tmp_path / "src/p", Settings(select=("LW842",))).diagnostics
    assert [finding.code for finding in findings] == codes


@pytest.mark.parametrize(
    ("path", "messages"),
    [
        ("share + '/config/a.yaml'", []),
        ("os.path.join(share, 'config/a.yaml')", []),
        ("share + 'config/a.yaml'", ["there is no '/' between the share folder of 'p' and 'config/a.yaml'"]),
        ("f'{share}config/a.yaml'", ["there is no '/' between the share folder of 'p' and 'config/a.yaml'"]),
        ("share + '_backup'", []),
    ],
)
def test_path_below_a_share_folder_needs_a_separator(tmp_path, path, messages):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    for folder in ("launch", "config"):
        (tmp_path / folder).mkdir()
    (tmp_path / "config/a.yaml").write_text("a: 1\n")
    launch = "import os\n\n\ndef generate_launch_description():\n    share = get_package_share_directory('p')\n"
    (tmp_path / "launch/a.launch.py").write_text(f"{launch}    return {path}\n")
    findings = examine_package(tmp_path, Settings(select=("LW842",))).diagnostics
    assert [str(finding.message) for finding in findings] == messages
