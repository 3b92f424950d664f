"""`linkwright check` for several files and folders.

The tests cover selection, formats, settings, fixes, exit status.
"""

from __future__ import annotations

import gc
import json
import os
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.lint import checking
from linkwright.lint.engine import examine
from linkwright.lint.package import PackageContext
from linkwright.lint.subject import Subject
from linkwright.lint.targets import find_targets
from linkwright.lint.xacro_facts import FileFacts
from tests.cli.checked_robots import LONG_AXIS, SELECTION, VALID_ROBOT, XACRO
from tests.sdf.worlds import write_files

ROBOT_WITH_A_PROPERTY = f"""<robot name="{{name}}" {XACRO}>
  <xacro:property name="unused" value="1"/>
  <link name="base_link"/>
</robot>
"""


@pytest.fixture(autouse=True)
def working_directory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_folder_check_selects_standalone_descriptions(working_directory):
    write_files(
        working_directory,
        {
            "a/plain.urdf": VALID_ROBOT,
            "a/robot.urdf.xacro": f'<robot name="r" {XACRO}><xacro:include filename="parts/arm.xacro"/><x/></robot>',
            "a/parts/colors.urdf": f'<robot name="c" {XACRO}/>',
            "a/parts/arm.xacro": f'<robot name="arm" {XACRO}><link name="b"/></robot>',
            "a/macros.xacro": f'<robot name="m" {XACRO}><xacro:macro name="m"><link name="c"/></xacro:macro></robot>',
            "a/unnamed.xacro": f'<robot {XACRO}><link name="c"/></robot>',
            "a/wrapper.xacro": f'<robot name="w" {XACRO}><xacro:include filename="robot2.xacro"/></robot>',
            "a/unnamed2.xacro": f'<robot {XACRO}><xacro:include filename="parts/colors.urdf"/></robot>',
            "a/r.srdf.xacro": f'<robot name="s" {XACRO}><group name="arm"/></robot>',
            "a/broken.xacro": "<robot",
            "build/copy.urdf": VALID_ROBOT,
            ".hidden/h.urdf": VALID_ROBOT,
            "ignored/COLCON_IGNORE": "",
            "ignored/i.urdf": VALID_ROBOT,
        },
    )
    targets = [path.relative_to(working_directory).as_posix() for path in find_targets([working_directory]).files]
    assert targets == ["a/broken.xacro", "a/plain.urdf", "a/robot.urdf.xacro", "a/wrapper.xacro"]


@pytest.mark.parametrize(
    ("part", "is_robot"),
    [
        ('<link name="base_link"/>', True),
        ('<xacro:include filename="inner.links"/>', True),
        ('<material name="red"/>', False),
        ('<xacro:macro name="arm"><link name="base_link"/></xacro:macro>', False),
        ('<!-- <xacro:include filename="inner.links"/> --><xacro:property name="a" value="1"/>', False),
    ],
)
def test_robot_with_plugins_and_links_in_included_files_is_checked_in_folder(working_directory, part, is_robot):
    includes = '<xacro:include filename="$(find arm)/urdf/arm.links"/><gazebo/><xacro:property name="a" value="1"/>'
    write_files(
        working_directory,
        {
            "arm/package.xml": "<package><name>arm</name></package>",
            "arm/urdf/arm.urdf.xacro": f'<robot name="arm" {XACRO}>{includes}</robot>',
            "arm/urdf/arm.links": f"<robot {XACRO}>{part}</robot>",
            "arm/urdf/inner.links": '<robot><link name="base_link"/></robot>',
        },
    )
    assert [path.name for path in find_targets([working_directory]).files] == ["arm.urdf.xacro"] * is_robot


def test_files_included_by_argument_or_environment_are_not_standalone(working_directory):
    text = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
      <xacro:arg name="accessories" default="empty.urdf"/><xacro:arg name="model" default="other.urdf"/>
      <xacro:include filename="$(find r)/urdf/$(arg accessories)"/>
      <xacro:include filename="$(optenv R_URDF_EXTRAS nothing.urdf)"/>
      <link name="base_link"/>
    </robot>"""
    nothing = "<robot></robot>"
    write_files(
        working_directory,
        {"r.urdf.xacro": text, "empty.urdf": nothing, "nothing.urdf": nothing, "other.urdf": VALID_ROBOT},
    )
    assert [path.name for path in find_targets([working_directory]).files] == ["other.urdf", "r.urdf.xacro"]


@pytest.mark.parametrize(("text", "files"), [("<robot></robot>", []), ('<robot name="r"></robot>', ["r.urdf"])])
def test_robot_without_name_and_content_is_not_checked_in_folder(working_directory, text, files):
    write_files(working_directory, {"r.urdf": text})
    assert [path.name for path in find_targets([working_directory]).files] == files


def test_package_files_are_read_once_for_all_descriptions(working_directory, monkeypatch):
    walks, walked = [], []
    files = {f"p/urdf/{name}.xacro": ROBOT_WITH_A_PROPERTY.format(name=name) for name in ("a", "b", "c")}
    write_files(working_directory, {"p/package.xml": "<package><name>p</name></package>", **files})
    for name in files:
        os.utime(working_directory / name, (1, 1))  # files that were written just now are read again
    listed, facts = PackageContext._walk, FileFacts._walk
    monkeypatch.setattr(PackageContext, "_walk", lambda self: [walks.append(self.folder), *listed(self)][1:])
    monkeypatch.setattr(FileFacts, "_walk", lambda self: [walked.append(self.document.source.name), facts(self)][1])
    main(["check", "--select", "ALL", str(working_directory / "p")])
    assert walks == [working_directory / "p"]
    assert sorted(Path(name).name for name in walked) == ["a.xacro", "b.xacro", "c.xacro"]


def test_packages_are_found_around_files_and_in_folders(working_directory):
    manifest = "<package><name>{}</name></package>"
    write_files(
        working_directory,
        {
            "src/one/package.xml": manifest.format("one"),
            "src/one/urdf/r.urdf": VALID_ROBOT,
            "src/two/package.xml": manifest.format("two"),
        },
    )
    assert find_targets([working_directory / "src"]).packages == (
        working_directory / "src" / "one",
        working_directory / "src" / "two",
    )
    assert find_targets([working_directory / "src/one/urdf"]).packages == (working_directory / "src" / "one",)
    assert find_targets([working_directory / "src/one/urdf/r.urdf"]).packages == ()
    assert find_targets([working_directory / "src/one/urdf/r.urdf"], with_packages=True).packages == (
        working_directory / "src" / "one",
    )


def test_file_is_checked_without_package_by_default(working_directory, capsys):
    manifest = "<package><name>one</name><exec_depend>xacro</exec_depend><exec_depend>xacro</exec_depend></package>"
    write_files(working_directory, {"one/package.xml": manifest, "one/urdf/r.urdf": VALID_ROBOT})
    assert main(["check", "one/urdf/r.urdf"]) == 0
    assert "LW8" not in capsys.readouterr().err
    assert main(["check", "--fix", "one/urdf/r.urdf"]) == 0
    assert (working_directory / "one/package.xml").read_text() == manifest
    assert main(["check", "--package", "one/urdf/r.urdf"]) == 1
    assert "error[LW802]" in capsys.readouterr().err
    main(["check", "--package", "--fix", "one/urdf/r.urdf"])
    assert (working_directory / "one/package.xml").read_text().count("<exec_depend>") == 1


def test_diff_shows_each_package_fix_once(working_directory, capsys):
    line = "  <exec_depend>xacro</exec_depend>\n"
    write_files(
        working_directory,
        {"one/package.xml": f"<package>\n  <name>one</name>\n{line * 3}</package>\n", "one/r.urdf": VALID_ROBOT},
    )
    assert main(["check", "--diff", "one"]) == 1
    diff = capsys.readouterr().out
    assert [line for line in diff.splitlines() if line.startswith(("-", "+"))] == [
        "--- one/package.xml",
        "+++ one/package.xml",
        *2 * ["-" + line.rstrip()],
    ]


def _make_joints(count):
    links = "".join(f'<link name="l{number}"/>\n' for number in range(count + 1))
    joints = "".join(
        f'<joint name="j{number}" type="continuous"><parent link="l{number}"/><child link="l{number + 1}"/>'
        '<axis xyz="0 0 2"/></joint>\n'
        for number in range(count)
    )
    return f'<robot name="r">\n{links}{joints}</robot>\n'


def test_many_similar_findings_are_grouped_in_text_output(working_directory, capsys):
    write_files(working_directory, {"r.urdf": _make_joints(70)})
    main(["check", "r.urdf", *SELECTION])
    output = capsys.readouterr().err
    assert output.count("warning[LW221]") == 1
    assert "note: the axis of joint 'j2' has length 2, not 1: '0 0 2' (r.urdf:75:" in output
    assert "note: and 67 more like it (--all shows them)" in output
    assert output.endswith("0 errors, 70 warnings\n")
    main(["check", "r.urdf", *SELECTION, "--all"])
    assert capsys.readouterr().err.count("warning[LW221]") == 70
    main(["check", "r.urdf", *SELECTION, "--format", "json"])
    assert len(json.loads(capsys.readouterr().out)["diagnostics"]) == 70


def test_few_similar_findings_are_shown_separately(working_directory, capsys):
    write_files(working_directory, {"r.urdf": _make_joints(3)})
    main(["check", "r.urdf", *SELECTION])
    assert capsys.readouterr().err.count("warning[LW221]") == 3


def test_checked_robot_is_freed_without_garbage_collector(working_directory, monkeypatch):
    """Count the robots when the next check begins.

    The garbage collector, which may not run for long, is off.
    """
    robot = _make_joints(3).replace('<robot name="r">', f'<robot name="r" {XACRO}><xacro:property name="x" value="1"/>')
    names = [f"r{number}.{ending}" for number in range(6) for ending in ("urdf", "urdf.xacro")]
    write_files(working_directory, dict.fromkeys(names, robot))
    alive = []

    def counted(*arguments, **options):
        alive.append(sum(isinstance(candidate, Subject) for candidate in gc.get_objects()))
        return examine(*arguments, **options)

    monkeypatch.setattr(checking, "examine", counted)
    gc.collect()
    gc.disable()
    try:
        main(["check", *names])
    finally:
        gc.enable()
    assert alive == [0, *[1] * (len(names) - 1)] or alive == [0] * len(names)


def test_several_files_print_summary_instead_of_tree(working_directory, capsys):
    write_files(working_directory, {"a.urdf": VALID_ROBOT, "b.urdf": LONG_AXIS})
    assert main(["check", "a.urdf", "b.urdf", *SELECTION]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "warning[LW221]" in captured.err
    assert captured.err.endswith("0 errors, 1 warning\n")


def test_strict_exits_with_1_on_warnings(working_directory):
    write_files(working_directory, {"b.urdf": LONG_AXIS})
    assert main(["check", "b.urdf", *SELECTION]) == 0
    assert main(["check", "b.urdf", *SELECTION, "--strict"]) == 1
    assert main(["check", "b.urdf", *SELECTION, "--strict", "--ignore", "axis-not-unit"]) == 0


def test_format_option_writes_findings_to_standard_output(working_directory, capsys):
    write_files(working_directory, {"b.urdf": LONG_AXIS})
    main(["check", "b.urdf", *SELECTION, "--format", "concise"])
    assert capsys.readouterr().out.startswith("b.urdf:7:16: warning[LW221] ")
    main(["check", "b.urdf", *SELECTION, "--format", "json"])
    (diagnostic,) = json.loads(capsys.readouterr().out)["diagnostics"]
    assert (diagnostic["code"], diagnostic["file"], diagnostic["line"], diagnostic["column"]) == (
        "LW221",
        "b.urdf",
        7,
        16,
    )
    main(["check", "b.urdf", *SELECTION, "--format", "sarif"])
    assert json.loads(capsys.readouterr().out)["version"] == "2.1.0"
    main(["check", "b.urdf", *SELECTION, "--format", "github"])
    captured = capsys.readouterr()
    assert captured.out.startswith("::warning file=b.urdf,line=7")
    assert captured.err == ""


def test_file_included_by_two_robots_is_reported_once(working_directory, capsys):
    robot = f'<robot name="r" {XACRO}><xacro:include filename="../arm.xacro"/></robot>'
    write_files(
        working_directory,
        {"a/one.xacro": robot, "a/two.xacro": robot, "arm.xacro": LONG_AXIS.replace('name="r"', XACRO, 1)},
    )
    main(["check", "a", *SELECTION, "--format", "json"])
    assert len(json.loads(capsys.readouterr().out)["diagnostics"]) == 1


def test_argument_values_apply_to_all_files(working_directory, capsys):
    text = f'<robot name="r" {XACRO}><link name="$(arg n)"/></robot>'
    write_files(working_directory, {"a.xacro": text, "b.xacro": text})
    assert main(["check", "a.xacro", "n:=x", "b.xacro", *SELECTION]) == 0
    assert main(["check", "a.xacro", "b.xacro", *SELECTION]) == 1


def test_fixes_are_written_and_counted(working_directory, capsys):
    write_files(working_directory, {"b.urdf": LONG_AXIS})
    assert main(["check", "b.urdf", "--diff", *SELECTION]) == 1
    assert '+    <axis xyz="0 0 1"/>' in capsys.readouterr().out
    assert (working_directory / "b.urdf").read_text() == LONG_AXIS
    assert main(["check", "b.urdf", "--fix", *SELECTION]) == 0
    assert (working_directory / "b.urdf").read_text() == LONG_AXIS.replace("0 0 2", "0 0 1")
    assert "fixed 1 finding in 1 file" in capsys.readouterr().err
    assert main(["check", "b.urdf", "--diff", *SELECTION]) == 0


def test_statistics_count_findings_by_rule(working_directory, capsys):
    write_files(working_directory, {"b.urdf": LONG_AXIS})
    main(["check", "b.urdf", "--statistics", *SELECTION])
    assert capsys.readouterr().err.endswith("     1  LW221     axis-not-unit\n")


def test_configuration_is_found_or_given_by_option(working_directory, capsys):
    write_files(
        working_directory,
        {"r/b.urdf": LONG_AXIS, "r/linkwright.toml": 'select = ["LW1"]\n', "other.toml": 'select = ["LW2"]\n'},
    )
    main(["check", "r/b.urdf", "--format", "concise"])
    assert "LW221" not in capsys.readouterr().out
    main(["check", "r/b.urdf", "--format", "concise", "--config", "other.toml"])
    assert "LW221" in capsys.readouterr().out


def test_configuration_errors_are_reported_once(working_directory, capsys):
    write_files(
        working_directory, {"a.urdf": VALID_ROBOT, "b.urdf": VALID_ROBOT, "linkwright.toml": 'ignore = ["nonsens"]\n'}
    )
    assert main(["check", "a.urdf", "b.urdf"]) == 1
    assert capsys.readouterr().err.count("error[LINT104]") == 1


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["n:=1"], "pass a file or folder to check"),
        (["b.urdf", "--select", "limit-invertd"], "there is no rule 'limit-invertd'; did you mean 'limit-inverted'?"),
        (["b.urdf", "--config", "none.toml"], "no such file: 'none.toml'"),
    ],
)
def test_invalid_usage_is_rejected(working_directory, capsys, words, message):
    write_files(working_directory, {"b.urdf": VALID_ROBOT})
    assert main(["check", *words]) == 2
    assert message in capsys.readouterr().err


def test_missing_file_error_suggests_existing_files(working_directory, capsys):
    write_files(working_directory, {"b.urdf": VALID_ROBOT})
    assert main(["check", "c.urdf"]) == 1
    assert "choose from b.urdf" in capsys.readouterr().err


def test_url_argument_is_printed_as_typed(working_directory, capsys):
    for command in ("check", "xacro", "convert", "launch"):
        assert main([command, "https://example.org/r.urdf"]) == 1
        assert "'https://example.org/r.urdf'" in capsys.readouterr().err


@pytest.mark.parametrize(("manifest", "is_reported"), [("web/package.json", False), ("package.json", True)])
def test_public_folder_of_nested_web_package_is_skipped(working_directory, manifest, is_reported):
    write_files(
        working_directory,
        {
            "package.xml": "<package/>",
            manifest: "{}",
            "web/public/robot.urdf": VALID_ROBOT,
            "urdf/robot.urdf": VALID_ROBOT,
        },
    )
    write_files(working_directory, {"inner/package.xml": "<package/>"})
    for folder in (working_directory, Path()):
        folders = [path.parent.name for path in find_targets([folder]).files]
        assert folders == (["urdf", "public"] if is_reported else ["urdf"])


def test_launch_file_has_the_findings_of_its_package_in_this_file(working_directory, capsys):
    launch = "from launch import LaunchDescription\n\n\ndef generate_launch_description():\n"
    launch += "    return LaunchDescription([Node(package='p', executable='x', parameters=[{}])])\n"
    manifest = "<package format='3'><name>Big</name></package>"
    paths = {name: launch.format(f"get_package_share_directory('Big') + '{name}.yaml'") for name in ("/a", "/b")}
    write_files(
        working_directory,
        {"w/package.xml": manifest, "w/launch/a.launch.py": paths["/a"], "w/launch/b.launch.py": paths["/b"]},
    )
    assert main(["check", "w/launch/a.launch.py", "--format", "concise"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any("has no file 'a.yaml'" in line for line in lines)
    assert all(line.startswith("w/launch/a.launch.py:") for line in lines)
    for words in (["w"], ["--package", "w/launch/a.launch.py"], ["w/launch/a.launch.py", "w"]):
        main(["check", *words, "--format", "concise"])
        assert {line.partition(":")[0] for line in capsys.readouterr().out.splitlines()} >= {
            "w/package.xml",
            "w/launch/b.launch.py",
        }


def test_launch_file_outside_of_a_package_is_not_read_as_xml(working_directory, capsys):
    write_files(working_directory, {"a.launch.py": "import os\n"})
    assert main(["check", "a.launch.py"]) == 1
    error = capsys.readouterr().err
    assert "error[CLI302]: there is nothing to check in 'a.launch.py'" in error
    assert "in a package, which has a package.xml" in error


def test_empty_folder_is_an_error(working_directory, capsys):
    (working_directory / "empty").mkdir()
    assert main(["check", "empty"]) == 1
    assert "error[CLI302]: there is nothing to check in 'empty'" in capsys.readouterr().err


def test_empty_file_is_skipped_in_folder(tmp_path, capsys):
    (tmp_path / "later.xacro").write_text("\n")
    (tmp_path / "robot.urdf").write_text('<robot name="r"><link name="base_link"/></robot>')
    assert main(["check", str(tmp_path)]) == 0
    assert "later.xacro" not in capsys.readouterr().err
    assert main(["check", str(tmp_path / "later.xacro")]) == 1


def test_warnings_in_test_folders_are_skipped_in_folder_check(working_directory, capsys):
    joint = '<joint name="j" type="fixed"><parent link="a"/>{}</joint>'
    robot = f'<robot name="r"><link name="a"/><link name="b"/>{joint}</robot>'
    for folder, child in (
        ("test", '<child link="b"/>'),
        ("tests2", '<child link="c"/>'),
        ("attest", '<child link="b"/>'),
    ):
        (working_directory / "p" / folder).mkdir(parents=True)
        (working_directory / "p" / folder / "r.urdf").write_text(robot.format(child))
    main(["check", "--format", "concise", "p"])
    output = {tuple(line.split(" ")[:2]) for line in capsys.readouterr().out.splitlines()}
    assert {place.partition("/")[2].partition("/")[0] for place, kind in output if kind.startswith("error")} == {
        "tests2"
    }
    assert {place.partition("/")[2].partition("/")[0] for place, kind in output if "LW102" in kind} == {"attest"}
    main(["check", "--format", "concise", "p/test"])
    assert "LW102" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("folder", "is_reported"),
    [
        ("old", False),
        ("bak", False),
        ("my_Backup_2024", False),
        ("Discard", False),
        ("vendor", False),
        ("third-party", False),
        ("gold", True),
        ("old_town", True),
        ("vendors_arm", True),
    ],
)
def test_warnings_in_backup_and_vendor_folders_are_skipped(working_directory, capsys, folder, is_reported):
    write_files(working_directory, {f"p/{folder}/r.urdf": LONG_AXIS})
    main(["check", *SELECTION, "p"])
    assert ("LW221" in capsys.readouterr().err) is is_reported
