"""Requests about incomplete texts: any text, and any position in it."""

from __future__ import annotations

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from linkwright.language.colors import colors_in
from linkwright.language.definitions import definitions_in
from linkwright.language.extraction import find_selected_value
from linkwright.language.format import Document
from linkwright.language.formats import format_of
from linkwright.language.highlighting import highlights_in
from linkwright.language.hover import definitions_at
from linkwright.language.links import file_references
from linkwright.language.macro_extraction import selected_elements
from linkwright.language.refactoring import find_offers
from linkwright.language.suppressions import find_code_at, make_suppression
from linkwright.language.workspace import Workspace
from linkwright.language.xml_completion import complete
from linkwright.language.xml_hover import explain_at
from linkwright.lsp.positions import TextPositions
from linkwright.lsp.requests.navigation import find_uses_in_file
from linkwright.lsp.requests.texts import find_folds, find_linked_tags, find_selections, format_edits, list_symbols
from linkwright.packages import PackageFinder

ROBOT = (Path(__file__).parents[2] / "robots/my_robot_description/urdf/mbot_gazebo.xacro").read_text(encoding="utf-8")
FINDER = PackageFinder(start=[Path(__file__).parents[2] / "robots"])
WORKSPACE = Workspace([Path(__file__).parents[2] / "robots"])
CUT = st.tuples(st.integers(0, len(ROBOT)), st.integers(0, 40), st.text("<>/=\"' ${}()\n机a", max_size=8))


@given(CUT, st.sampled_from(["robot.xacro", "robot.urdf", "robot.world"]))
def test_requests_survive_any_incomplete_description(cut, name):
    start, length, typed = cut
    text = ROBOT[:start] + typed + ROBOT[start + length :]
    offset = start + len(typed)
    file = Path(name)
    names = [*definitions_in(text, file)]
    for item in complete(Document(WORKSPACE, {file: text}, file, text), offset, names):
        assert 0 <= item.start <= offset
    explained = explain_at(Document(WORKSPACE, {file: text}, file, text), offset, names)
    assert explained is None or explained.start <= explained.end <= len(text)
    assert set(definitions_at(text, offset, names)) <= set(names)
    positions = TextPositions(text)
    place = positions.position(offset)
    assert positions.offset(place) == offset
    assert all(fold.start_line < fold.end_line for fold in find_folds(positions))
    (selection,) = find_selections(positions, [place])
    while selection.parent is not None:
        inner, outer = selection.range, selection.parent.range
        assert outer.start <= inner.start
        assert inner.end <= outer.end
        selection = selection.parent
    ends = [0, *(highlight.end for highlight in highlights_in(text, file))]
    assert ends == sorted(set(ends))
    assert all(0 <= color.start < color.end <= len(text) for color in colors_in(text))
    assert all(text[link.start : link.end] for link in file_references(text, file, FINDER))
    assert all(use.start <= use.end <= len(text) for use in find_uses_in_file(text, file, offset))
    other = min(offset + 30, len(text))
    for start, end in ((offset, offset), (offset, other)):
        value = find_selected_value(text, start, end)
        assert value is None or start <= value.start < value.end <= end or start == end
        assert all(element.end <= end for element in selected_elements(text, start, end))
        assert all(offer.title for offer in find_offers(text, file, start, end, names))
    comment = make_suppression(text, file, "LW104", offset)
    assert comment is None or 0 <= comment.start <= len(text)
    find_code_at(text, offset)
    list_symbols(positions)
    find_linked_tags(positions, place)
    format_edits(positions, file)


LAUNCH = """<launch><arg name="a" default="$(find-pkg-share my_robot_description)/urdf"/>
<include file="$(find-pkg-share ros_gz_sim)/launch/gz_sim.launch.py"><arg name="gz_args" value="$(var a)"/></include>
<node pkg="my_robot_description" exec="b"><param from="$(var a)/m.yaml"/></node></launch>"""
PYTHON = """share = get_package_share_directory('my_robot_description')
KNOWN = {'a': ('1', "two")}
x = [DeclareLaunchArgument(n, default_value=d) for n, (d, e) in KNOWN.items()]
IncludeLaunchDescription(Source([os.path.join(share, 'launch', f'{x}.py')]), launch_arguments={'a': '1'}.items())
y = y + '/' / Path(y) + PathJoinSubstitution([FindPackageShare("my_robot_description"), y, 'urdf'])
Node(package=share, executable='b', output='screen', remappings=[('c', 'd')])
"""
MESSAGE = """# A lamp
std_msgs/Header header
Glow[<=3] glow  # of it
int32 LIMIT=3
---
string<=5 name "x"
"""
SEMANTICS = """<robot name="mbot"><group name="a"><chain base_link="b" tip_link="c"/></group>
<group_state name="s" group="a"><joint name="j" value="0"/></group_state></robot>"""
PACKAGE = """<package format="3"><name>a</name><license file="LICENSE">MIT</license>
<exec_depend condition="x">my_robot_description</exec_depend><export><build_type>ament_cmake</build_type></export>"""
PARAMETERS = """controller_manager:
  ros__parameters:
    drive: {type: diff_drive_controller/DiffDriveController}
drive:
  ros__parameters:
    left_wheel_names: ["left_wheel_joint", # two
      'b']
    linear.x: {max_velocity: 1.0}
    joints:
    - a
/**/local_costmap:
  local_costmap:
    ros__parameters: # of the map
      layer:
        plugin: "nav2_costmap_2d::ObstacleLayer"
        note: |
          a: b
"""
VIEWER = """Visualization Manager:
  Displays:
    - Alpha: 0.5
      Class: rviz_default_plugins/LaserScan
      Topic: {Depth: 5}
    - Class: rviz_default_plugins/TF
      Frames:
        base_link: {Value: true}
  Global Options:
    Fixed Frame: base_link
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
"""
ACTIONS = """launch:
- arg: {name: a, default: "$(dirname)/urdf"}
- node:
    pkg: my_robot_description
    param:
    - from: "$(var a)/m.yaml"
- group:
  - include:
      file: $(find-pkg-share ros_gz_sim)/launch/gz_sim.launch.py
      arg:
      - name: gz_args
        value: 'b'
"""
OWN_FORMATS = [
    ("launch/a.launch.xml", LAUNCH),
    ("launch/a.launch.py", PYTHON),
    ("srv/A.srv", MESSAGE),
    ("a.launch.yaml", ACTIONS),
]
OWN_FORMATS += [("config/a.srdf", SEMANTICS), ("config/a.srdf.xacro", SEMANTICS), ("package.xml", PACKAGE)]
OWN_FORMATS += [("a.launch.yaml", ACTIONS), ("config/a.yaml", PARAMETERS), ("rviz/a.rviz", VIEWER)]
MARKS = st.text("<>/=\"' ${}()[],.:#\\n\n机a-@", max_size=8)


@given(st.data())
def test_requests_survive_any_incomplete_text_of_own_formats(data):
    name, complete_text = data.draw(st.sampled_from(OWN_FORMATS))
    start, length = data.draw(st.integers(0, len(complete_text))), data.draw(st.integers(0, 60))
    typed = data.draw(MARKS)
    text = complete_text[:start] + typed + complete_text[start + length :]
    offset = start + len(typed)
    file = Path(__file__).parents[2] / "robots/my_robot_description" / name
    document = Document(WORKSPACE, {file: text}, file, text)
    file_format = format_of(file)
    assert file_format is not None
    assert all(0 <= item.start <= offset for item in file_format.complete(document, offset))
    explained = file_format.explain(document, offset)
    assert explained is None or 0 <= explained.start <= explained.end <= len(text)
    for target in file_format.define(document, offset):
        assert 0 <= target.start <= target.end
    assert all(0 <= link.start < link.end <= len(text) for link in file_format.links(document))
    for symbol in file_format.symbols(document) if file_format.symbols is not None else ():
        assert 0 <= symbol.start <= symbol.end <= len(text)


LINES = st.lists(st.sampled_from(["a", "机", "🤖", "<", "\n", "\r\n"]), max_size=30).map("".join)


@given(LINES, st.sampled_from(["utf-8", "utf-16", "utf-32"]), st.data())
def test_positions_and_offsets_round_trip_in_each_encoding(text, encoding, data):
    offset = data.draw(st.integers(0, len(text)).filter(lambda at: text[at - 1 : at + 1] != "\r\n"))
    positions = TextPositions(text, encoding)
    assert positions.offset(positions.position(offset)) == offset
