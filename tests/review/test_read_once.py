"""Work that a review does only once or not at all, so that large repositories take seconds."""

from __future__ import annotations

import pytest

from linkwright.geometry import meshes
from linkwright.inertia import mesh_library
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.lint import affected
from linkwright.lint.affected import TextFiles
from linkwright.packages import PackageFinder
from linkwright.review import open_versions, review
from linkwright.review.robots import figures
from linkwright.review.sources import reading
from linkwright.review.sources.interface_uses import python as python_interface_uses
from linkwright.review.sources.python import passed_variables, source_nodes
from linkwright.review.sources.statements import python as python_statements
from linkwright.sdf.resources import ResourceFinder
from tests.review.test_scene_images import make_stl

CONFIG = "<model><name>{0}</name><sdf version='1.6'>model.sdf</sdf></model>"
MODEL = "<sdf version='1.6'><model name='{0}'><link name='link'/></model></sdf>"
INCLUDES = "".join(f"<include><name>b{number}</name><uri>model://box</uri></include>" for number in range(6))
WORLD = f"<sdf version='1.6'><world name='w'>{INCLUDES}</world></sdf>"


def files_of(name):
    return {
        f"w/models/{name}/model.config": CONFIG.format(name),
        f"w/models/{name}/model.sdf": MODEL.format(name),
    }


PACKAGE = "<package format='3'><name>w</name><version>1.0.0</version></package>"
FILES = {
    "w/package.xml": PACKAGE,
    **files_of("box"),
    **files_of("lamp"),
    "w/worlds/w.sdf": WORLD,
    "w/worlds/dark.sdf": WORLD.replace("box", "lamp"),
}
CANDIDATES = [path for path in FILES if path.endswith(".sdf")]


def record_calls(monkeypatch, owner, name):
    """Return a list to which each call of a function adds its arguments."""
    calls = []
    function = getattr(owner, name)
    monkeypatch.setattr(owner, name, lambda *values, **options: (calls.append(values), function(*values, **options))[1])
    return calls


def test_model_affects_only_the_worlds_that_include_it(repository):
    repository.write(FILES)
    found = TextFiles(repository.root).affected(["w/models/box/model.sdf"], CANDIDATES)
    assert found == {"w/models/box/model.sdf", "w/worlds/w.sdf"}


def test_unchanged_files_of_the_other_version_are_not_read(repository, monkeypatch):
    repository.write(FILES)
    old = TextFiles(repository.root)
    changed = "w/models/box/model.config"
    assert old.affected([changed], CANDIDATES) == {"w/models/box/model.sdf", "w/worlds/w.sdf"}
    reads = record_calls(monkeypatch, affected, "_read_beginning")
    new = TextFiles(repository.root, old, {changed})
    assert new.affected([changed], CANDIDATES) == {"w/models/box/model.sdf", "w/worlds/w.sdf"}
    assert reads == [(repository.root / changed,)]


def test_model_that_a_world_includes_often_is_searched_for_once(repository, monkeypatch):
    repository.commit(FILES)
    repository.write({"w/worlds/w.sdf": WORLD.replace("b0", "c0")})
    searches = record_calls(monkeypatch, ResourceFinder, "model")
    review_change(repository)
    folders = [folder for _, _, folder in searches]
    assert folders
    assert all(folders.count(folder) <= 2 for folder in folders)  # findings, and the comparison


ARM = "<robot name='arm'>{}</robot>"
PARTS = """<link name="base"><visual><geometry><mesh filename="package://w/meshes/base.stl"/></geometry></visual>
<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
""" + "".join(
    f"<link name='l{n}'/><joint name='j{n}' type='revolute'><parent link='{'base' if not n else f'l{n - 1}'}'/>"
    f"<child link='l{n}'/><origin xyz='0 0 1'/><axis xyz='0 1 0'/>"
    "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
    for n in range(4)
)


def review_change(repository):
    versions = open_versions(repository.root, "HEAD")
    try:
        return review(versions, with_images=True)
    finally:
        versions.close()


def test_mesh_that_both_versions_have_is_read_once(repository, monkeypatch):
    text = ARM.format(PARTS)
    repository.commit({"w/package.xml": PACKAGE, "w/urdf/arm.urdf": text, "w/meshes/base.stl": make_stl(4.75)})
    repository.write({"w/urdf/arm.urdf": text.replace("<mass value='1'", "<mass value='2'").replace("0 0 1", "0 0 2")})
    reads = record_calls(monkeypatch, meshes, "read_mesh")
    (subject,) = review_change(repository).subjects
    assert [str(figure.name) for figure in subject.figures] == ["reach of 'l3'"]
    assert len(reads) == 1


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('<mass value="1"', '<mass value="2"', ["mass"]),
        ('<mesh filename="package://w/meshes/base.stl"/>', '<box size="5 5 5"/>', ["size"]),
        ("base.stl", "tall.stl", ["size"]),
        ('base.stl"', 'base.stl" scale="2 2 2"', ["size"]),
        ("<visual>", '<visual><origin rpy="0.5 0 0"/>', ["size"]),
    ],
)
def test_size_is_measured_only_if_shapes_changed(repository, compare, monkeypatch, old, new, expected):
    sizes = record_calls(monkeypatch, figures.RobotMeasures, "_compute_bounds")
    stls = {"w/meshes/base.stl": make_stl(1.25), "w/meshes/tall.stl": make_stl(3.25)}
    repository.commit({"w/package.xml": PACKAGE, "w/urdf/arm.urdf": ARM.format(PARTS), **stls})
    repository.write({"w/urdf/arm.urdf": ARM.format(PARTS).replace(old, new, 1)})
    (subject,) = compare(repository).subjects
    names = [str(figure.name) for figure in subject.figures]
    assert [name for name in names if name in ("size", "mass")] == expected
    assert bool(sizes) == ("size" in expected)


def test_mesh_of_the_same_name_with_other_triangles_is_measured(repository, compare):
    repository.commit(
        {"w/package.xml": PACKAGE, "w/urdf/arm.urdf": ARM.format(PARTS), "w/meshes/base.stl": make_stl(1.75)}
    )
    repository.write({"w/meshes/base.stl": make_stl(2.75)})
    figures_by_path = {subject.path: subject.figures for subject in compare(repository).subjects}
    assert "size" in [str(figure.name) for figure in figures_by_path["w/urdf/arm.urdf"]]


def test_no_mesh_is_measured_if_another_one_is_missing(repository, compare, monkeypatch):
    loads = record_calls(monkeypatch, MeshLibrary, "load")
    visual = "<visual><geometry><mesh filename='package://w/meshes/lost.stl'/></geometry></visual></link>"
    text = ARM.format(PARTS).replace("</link>", visual, 1)
    repository.commit({"w/package.xml": PACKAGE, "w/urdf/arm.urdf": text, "w/meshes/base.stl": make_stl(1.0)})
    repository.write({"w/urdf/arm.urdf": text.replace('<mass value="1"', '<mass value="2"')})
    (subject,) = compare(repository).subjects
    assert [str(figure.name) for figure in subject.figures] == ["mass"]
    assert loads == []


def test_reach_is_not_searched_for_if_no_joint_changed(repository, monkeypatch):
    monkeypatch.setattr("linkwright.review.robots.figures.compare_reaches", None)
    text = ARM.format(PARTS)
    repository.commit({"w/package.xml": PACKAGE, "w/urdf/arm.urdf": text, "w/meshes/base.stl": make_stl(1.0)})
    repository.write({"w/urdf/arm.urdf": text.replace('<mass value="1"', '<mass value="2"')})
    (subject,) = review_change(repository).subjects
    assert [str(figure.name) for figure in subject.figures] == ["mass"]


@pytest.mark.parametrize("joint", ["lower='-1'", "0 1 0"])
def test_reach_is_searched_for_if_a_joint_changed(repository, monkeypatch, joint):
    searches = record_calls(monkeypatch, figures, "compare_reaches")
    text = ARM.format(PARTS)
    repository.commit({"w/package.xml": PACKAGE, "w/urdf/arm.urdf": text, "w/meshes/base.stl": make_stl(1.0)})
    repository.write({"w/urdf/arm.urdf": text.replace(joint, joint.replace("1", "0.5"))})
    review_change(repository)
    assert len(searches) == (joint == "lower='-1'")


def test_mesh_with_two_paths_fills_the_cache_once(repository):
    repository.write({"w/package.xml": PACKAGE, "w/a.stl": make_stl(6.25), "w/b.stl": make_stl(6.25)})
    library = MeshLibrary(PackageFinder(start=[repository.root]), repository.root)
    first, second = (library.read(repository.root / f"w/{name}.stl") for name in "ab")
    assert first is second
    assert list(mesh_library._MESH_CACHE.values.values()).count(first) == 1


@pytest.mark.parametrize("name", ["package.xml", "CMakeLists.txt", "src/main.cpp"])
def test_files_are_not_searched_for_names_if_no_description_can_read_a_changed_file(repository, monkeypatch, name):
    repository.commit(FILES)
    repository.write({f"w/{name}": PACKAGE.replace("1.0.0", "1.1.0")})
    reads = record_calls(monkeypatch, affected, "_read_beginning")
    versions = open_versions(repository.root, "HEAD")
    review(versions)
    versions.close()
    assert reads == []


def test_each_source_is_read_once(package, compare, monkeypatch):
    node = 'void start() {{ pub_ = create_publisher<std_msgs::msg::String>("{0}", 10); }}\n'
    files = {f"arm_description/src/{name}.cpp": node.format(name) for name in ("a", "b", "c")}
    package.commit(files)
    package.commit({path: text.replace('("', '("new_') for path, text in files.items()})
    calls = record_calls(monkeypatch, reading, "read_cpp")
    assert len(compare(package, "HEAD~1..HEAD").subjects) == 3
    paths = [source.name for source, _ in calls]
    assert len(paths) == len(set(paths)) == 6


def test_source_with_several_interfaces_is_searched_once_for_each_fact(repository, compare, monkeypatch):
    names = ("Speed", "State", "Limit")
    lines = [f"    {name.lower()} = {name}()\n    show({name.lower()})\n" for name in names]
    text = (
        f"from w.msg import {', '.join(names)}\n\n\ndef drive():\n{''.join(lines)}\n\ndef show(item):\n    item.x = 1\n"
    )
    repository.commit({"w/package.xml": PACKAGE, **{f"w/msg/{name}.msg": "int32 x\n" for name in names}})
    repository.write({"w/scripts/drive.py": text})
    parsed = record_calls(monkeypatch, python_interface_uses, "parse_source")
    scopes = record_calls(monkeypatch, passed_variables, "_list_passed")
    walked = record_calls(monkeypatch, source_nodes, "_walk_scope")
    compare(repository)
    assert len(parsed) == 1
    assert len(scopes) == 1
    assert len(walked) == len({id(scope) for (scope,) in walked}) == 3  # the module and both functions


def test_statements_of_a_python_source_are_read_once(package, compare, monkeypatch):
    path = "arm_description/scripts/a.py"
    text = "import subprocess\n\nLIMIT = {0}\n\n\ndef run(data):\n    subprocess.run('ls {0}')\n    return data['x']\n"
    package.commit({path: text.format(1)})
    package.write({path: text.format(2)})
    calls = record_calls(monkeypatch, python_statements, "parse_source")
    assert compare(package, "HEAD").subjects
    assert len(calls) == 2


def test_next_review_reads_a_changed_working_tree(package, compare):
    path = "arm_description/src/a.cpp"
    node = 'void start() { pub_ = create_publisher<std_msgs::msg::String>("first", 10); }\n'
    package.commit({path: node})
    for name in ("second", "third_"):
        package.write({path: node.replace("first", name)})
        (subject,) = compare(package, "HEAD").subjects
        assert f"'{name}'" in str(subject.changes[0].sentence)
