"""Renaming: the edited and unchanged names, and refusals."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.language.renaming import Renaming, find_references, occurrence_at, rename
from linkwright.language.workspace import Workspace
from linkwright.xacro import expand

MAIN = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="parts.xacro"/>
  <xacro:property name="reach" value="0.4"/>
  <link name="base"/>
  <xacro:bar name="upper" length="${2 * reach}"/>
  <xacro:if value="false"><joint name="spare" type="fixed"><parent link="base"/><child link="upper"/></joint></xacro:if>
  <gazebo reference="base"><plugin name="p"><base_frame>base</base_frame><topic>base</topic></plugin></gazebo>
</robot>
"""
PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="bar" params="name length">
    <link name="${name}"><visual><geometry><sphere radius="${length}"/></geometry></visual></link>
    <joint name="${name}_joint" type="continuous">
      <parent link="base"/>
      <child link="${name}"/>
    </joint>
  </xacro:macro>
</robot>
"""
YAML = """controller:
  ros__parameters:
    joints: ["upper_joint"]
    base_frame_id: base
    motto: base
"""
RVIZ = "Visualization Manager:\n  Global Options:\n    Fixed Frame: base\n"
SRDF = '<robot name="arm"><group name="g"><joint name="upper_joint"/><link name="base"/></group></robot>'
LAUNCH = "arguments = ['--frame-id', 'map', '--child-frame-id', 'base']\nname = 'base'\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    files = {
        "package.xml": "<package format='3'><name>arm</name></package>",
        "urdf/arm.urdf.xacro": MAIN,
        "urdf/parts.xacro": PARTS,
        "config/arm.yaml": YAML,
        "config/arm.rviz": RVIZ,
        "config/arm.srdf": SRDF,
        "launch/arm.launch.py": LAUNCH,
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path.resolve()


class Package:
    """A workspace with one package, and renamings in it.

    Args:
        folder: the package.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.workspace = Workspace([folder])
        self.workspace.index.refresh()

    def name(self, file: str, before: str):
        """Return the name that follows a text in a file."""
        path = self.folder / file
        text = path.read_text(encoding="utf-8")
        occurrence = occurrence_at(text, path, text.index(before) + len(before) + 1)
        assert occurrence is not None
        return occurrence

    def rename(self, file: str, before: str, new: str) -> Renaming:
        """Rename the name that follows a text in a file."""
        return rename(self.workspace, {}, self.name(file, before), new)

    def apply(self, renaming: Renaming) -> dict[str, str]:
        """Write the edits, and return the new texts of the edited files by their names."""
        found = {}
        for file in {edit.file for edit in renaming.edits}:
            text = file.read_text(encoding="utf-8")
            for edit in sorted((edit for edit in renaming.edits if edit.file == file), reverse=True):
                text = text[: edit.start] + edit.text + text[edit.end :]
            file.write_text(text, encoding="utf-8")
            found[file.name] = text
        return found


@pytest.fixture
def package(folder: Path) -> Package:
    return Package(folder)


@pytest.mark.parametrize(
    ("file", "before", "new", "changed"),
    [
        (
            "urdf/parts.xacro",
            'macro name="',
            "beam",
            {"arm.urdf.xacro": "<xacro:beam name", "parts.xacro": 'name="beam" params'},
        ),
        ("urdf/parts.xacro", 'params="name ', "size", {"arm.urdf.xacro": "size=", "parts.xacro": '"${size}"'}),
        ("urdf/arm.urdf.xacro", "${2 * ", "extent", {"arm.urdf.xacro": "${2 * extent}"}),
    ],
)
def test_xacro_only_names_are_renamed_without_changing_robot(package: Package, file, before, new, changed):
    main = package.folder / "urdf" / "arm.urdf.xacro"
    robot = str(expand(main))
    renaming = package.rename(file, before, new)
    texts = package.apply(renaming)
    assert texts.keys() == changed.keys()
    assert all(part in texts[name] for name, part in changed.items())
    assert str(expand(main)) == robot


def test_link_is_renamed_in_all_files_of_robot(package: Package):
    renaming = package.rename("urdf/arm.urdf.xacro", '<link name="', "trunk")
    texts = package.apply(renaming)
    assert renaming.names == {"base": "trunk"}
    assert texts["arm.urdf.xacro"] == MAIN.replace('link name="base"', 'link name="trunk"').replace(
        'link="base"', 'link="trunk"'
    ).replace('reference="base"', 'reference="trunk"').replace("<base_frame>base<", "<base_frame>trunk<")
    assert texts["parts.xacro"] == PARTS.replace("base", "trunk")
    assert texts["arm.yaml"] == YAML.replace("base_frame_id: base", "base_frame_id: trunk")
    assert texts["arm.rviz"] == RVIZ.replace("base", "trunk")
    assert texts["arm.srdf"] == SRDF.replace("base", "trunk")
    assert texts["arm.launch.py"] == LAUNCH.replace("'--child-frame-id', 'base'", "'--child-frame-id', 'trunk'")
    assert sorted(mention.file.name for mention in renaming.unchanged) == ["arm.launch.py", "arm.yaml"]


def test_composed_name_is_renamed_in_all_expansions(package: Package):
    renaming = package.rename("urdf/parts.xacro", '<joint name="${name}', "${name}_axle")
    texts = package.apply(renaming)
    assert renaming.names == {"upper_joint": "upper_axle"}
    assert 'joint name="${name}_axle"' in texts["parts.xacro"]
    assert "upper_axle" in texts["arm.yaml"]
    assert "upper_axle" in texts["arm.srdf"]


def test_files_of_another_robot_with_same_name_are_unchanged(package: Package):
    (package.folder / "urdf" / "other.urdf").write_text('<robot name="other"><link name="base"/></robot>')
    renaming = Package(package.folder).rename("urdf/arm.urdf.xacro", '<link name="', "trunk")
    # The SRDF has the name of the robot; the other files may mean both robots.
    assert {edit.file.name for edit in renaming.edits} == {"arm.urdf.xacro", "parts.xacro", "arm.srdf"}
    assert {mention.file.name for mention in renaming.unchanged} == {"arm.yaml", "arm.rviz", "arm.launch.py"}


def test_xacro_argument_is_renamed_in_launch_file(package: Package):
    main = package.folder / "urdf" / "arm.urdf.xacro"
    declared = '  <xacro:arg name="size" default="1"/>\n  <link'
    main.write_text(MAIN.replace('value="0.4"', 'value="$(arg size)"').replace("  <link", declared, 1))
    (package.folder / "launch" / "arm.launch.py").write_text(
        "from launch.substitutions import Command, PathJoinSubstitution\n"
        "from launch_ros.substitutions import FindPackageShare\n"
        "command = Command([\n"
        "    'xacro ', PathJoinSubstitution([FindPackageShare('arm'), 'urdf', 'arm.urdf.xacro']),\n"
        "    ' size:=2 other_size:=3',\n"
        "])\n"
    )
    texts = package.apply(Package(package.folder).rename("urdf/arm.urdf.xacro", '<xacro:arg name="', "reach_scale"))
    assert "' reach_scale:=2 other_size:=3'" in texts["arm.launch.py"]
    assert 'value="$(arg reach_scale)"' in texts["arm.urdf.xacro"]


def test_name_passed_to_macro_is_renamed_in_call(package: Package):
    main = package.folder / "urdf" / "arm.urdf.xacro"
    main.write_text(MAIN.replace('length="${2 * reach}"', 'length="1" parent="base"'))
    parts = package.folder / "urdf" / "parts.xacro"
    parts.write_text(PARTS.replace("name length", "name length parent").replace('link="base"', 'link="${parent}"'))
    texts = package.apply(package.rename("urdf/arm.urdf.xacro", '<link name="', "trunk"))
    assert 'parent="trunk"' in texts["arm.urdf.xacro"]
    assert "parts.xacro" not in texts


def test_computed_reference_is_rejected_with_location(package: Package):
    main = package.folder / "urdf" / "arm.urdf.xacro"
    main.write_text(MAIN.replace("  <link", '  <xacro:property name="b" value="ba"/>\n  <link', 1))
    parts = package.folder / "urdf" / "parts.xacro"
    parts.write_text(PARTS.replace('link="base"', 'link="${b}se"'))
    with pytest.raises(LinkwrightError, match="'base' is computed from") as raised:
        package.rename("urdf/arm.urdf.xacro", '<link name="', "trunk")
    assert raised.value.diagnostics[0].span.file == str(parts)


@pytest.mark.parametrize(
    ("file", "before", "new", "code"),
    [
        ("urdf/arm.urdf.xacro", '<link name="', "two words", "LANG102"),
        ("urdf/arm.urdf.xacro", "${2 * ", "2nd", "LANG102"),
        ("urdf/arm.urdf.xacro", "${2 * ", "lambda", "LANG102"),
        ("urdf/parts.xacro", 'params="name ', "name", "LANG103"),
        ("urdf/arm.urdf.xacro", '<link name="', "upper", "LANG104"),
        ("urdf/parts.xacro", '<joint name="$', "fixed_name", "LANG104"),
    ],
)
def test_invalid_and_conflicting_names_are_rejected(package: Package, file, before, new, code):
    if new == "fixed_name":  # two calls would create the same name
        main = package.folder / "urdf" / "arm.urdf.xacro"
        main.write_text(MAIN.replace("  <xacro:if", '  <xacro:bar name="lower" length="1"/>\n  <xacro:if'))
        before = '<joint name="${name}'
    with pytest.raises(LinkwrightError) as raised:
        package.rename(file, before, new)
    assert raised.value.diagnostics[0].code == code


def test_file_outside_workspace_is_not_edited(package: Package, tmp_path_factory: pytest.TempPathFactory):
    outside = tmp_path_factory.mktemp("outside") / "parts.xacro"
    outside.write_text(PARTS, encoding="utf-8")
    (package.folder / "urdf" / "parts.xacro").unlink()
    main = package.folder / "urdf" / "arm.urdf.xacro"
    main.write_text(MAIN.replace('filename="parts.xacro"', f'filename="{outside}"'))
    with pytest.raises(LinkwrightError, match="is outside the workspace"):
        Package(package.folder).rename("urdf/arm.urdf.xacro", '<link name="', "trunk")
    assert outside.read_text(encoding="utf-8") == PARTS


def test_material_is_renamed_at_definition_and_uses(package: Package):
    main = package.folder / "urdf" / "arm.urdf.xacro"
    material = '  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>\n  <link'
    main.write_text(MAIN.replace("  <link", material, 1))
    parts = package.folder / "urdf" / "parts.xacro"
    parts.write_text(PARTS.replace("</geometry>", '</geometry><material name="grey"/>'))
    texts = package.apply(package.rename("urdf/parts.xacro", '<material name="', "steel"))
    assert '<material name="steel"/>' in texts["parts.xacro"]
    assert '<material name="steel"><color' in texts["arm.urdf.xacro"]


def test_chinese_text_and_crlf_files_are_edited_at_correct_offsets(package: Package):
    (package.folder / "config" / "arm.yaml").write_bytes(("# 机械臂🤖\n" + YAML).replace("\n", "\r\n").encode())
    main = package.folder / "urdf" / "arm.urdf.xacro"
    main.write_bytes(MAIN.replace("  <link", "  <!-- 底座🤖 -->\n  <link", 1).replace("\n", "\r\n").encode())
    renaming = package.rename("urdf/arm.urdf.xacro", '<link name="', "trunk")
    texts = {file: file.read_bytes().decode() for file in {edit.file for edit in renaming.edits}}
    assert {texts[edit.file][edit.start : edit.end] for edit in renaming.edits} == {"base"}
    assert {"arm.yaml", "arm.urdf.xacro"} <= {file.name for file in texts}


def test_references_of_macro_parameter_are_in_its_scope(package: Package):
    name = package.name("urdf/parts.xacro", 'params="name ')
    uses = [(use.file.name, use.is_definition) for use in find_references(package.workspace, {}, name)]
    assert sorted(uses) == [("arm.urdf.xacro", False), ("parts.xacro", False), ("parts.xacro", True)]
