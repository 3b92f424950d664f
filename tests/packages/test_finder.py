"""The package finder: sources, prefixes and their precedence."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.loading import extensions
from linkwright.packages import PackageFinder, PackageNotFoundError, current_finder, is_substitute, use_finder
from linkwright.packages.finder import find_shipped_folder
from linkwright.packages.manifest import SourceScan


def make_source(folder: Path, name: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(f'<package format="3">\n  <name>{name}</name>\n</package>\n')
    return folder


def install_package(prefix: Path, name: str, *, marker: bool = True) -> Path:
    share = prefix / "share" / name
    make_source(share, name)
    if marker:
        markers = prefix / "share" / "ament_index" / "resource_index" / "packages"
        markers.mkdir(parents=True, exist_ok=True)
        (markers / name).touch()
    return share


def make_finder(start: Path, *prefixes: Path, **extra: Path) -> PackageFinder:
    environment = {"AMENT_PREFIX_PATH": os.pathsep.join(map(str, prefixes))} if prefixes else {}
    return PackageFinder(start=start, environment=environment, extra=extra)


def test_extra_packages_take_precedence(tmp_path: Path) -> None:
    install_package(tmp_path / "ros", "arm")
    assert make_finder(tmp_path, tmp_path / "ros", arm=tmp_path / "mine").share("arm") == tmp_path / "mine"


def test_prefixes_are_searched_in_order(tmp_path: Path) -> None:
    overlay = install_package(tmp_path / "overlay", "arm")
    install_package(tmp_path / "ros", "arm")
    underlay = install_package(tmp_path / "ros", "gripper")
    package_finder = make_finder(tmp_path, tmp_path / "overlay", tmp_path / "ros")
    assert package_finder.share("arm") == overlay
    assert package_finder.share("gripper") == underlay


def test_installed_package_without_index_marker_is_found(tmp_path: Path) -> None:
    share = install_package(tmp_path / "ros", "arm", marker=False)
    assert make_finder(tmp_path, tmp_path / "ros").share("arm") == share


def test_prefix_lookup_does_not_scan_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install_package(tmp_path / "ros", "arm")
    package_finder = make_finder(tmp_path, tmp_path / "ros")

    def forbidden(*_: object) -> None:
        raise AssertionError("the source tree is scanned")

    monkeypatch.setattr(os, "scandir", forbidden)
    assert package_finder.share("arm").name == "arm"


@pytest.mark.parametrize("merged", [True, False])
def test_colcon_install_folder_is_found_from_inside_workspace(tmp_path: Path, merged: bool) -> None:
    folder = tmp_path / "ws" / "install"
    share = install_package(folder if merged else folder / "arm", "arm")
    (folder / ".colcon_install_layout").write_text("merged\n" if merged else "isolated\n")
    inside = tmp_path / "ws" / "src" / "deep"
    inside.mkdir(parents=True)
    assert make_finder(inside).share("arm") == share
    assert make_finder(inside).packages()["arm"] == share


def test_packages_of_current_prefix_are_found_by_markers(tmp_path: Path) -> None:
    share = install_package(tmp_path / "ros", "arm-data")
    make_source(share, "arm_descriptions")  # URIs use the name of the marker
    (share / "urdf").mkdir()
    other = install_package(tmp_path / "ros", "meshes")
    package_finder = make_finder(share / "urdf")
    assert package_finder.share("arm-data") == share
    assert package_finder.share("meshes") == other
    assert package_finder.packages()["arm-data"] == share
    with pytest.raises(PackageNotFoundError) as caught:
        package_finder.share("nobody")
    assert any(str(tmp_path / "ros") in str(note) for note in caught.value.diagnostics[0].notes)


def test_share_folder_without_index_is_not_a_prefix(tmp_path: Path) -> None:
    inside = tmp_path / "share" / "arm"
    inside.mkdir(parents=True)
    (tmp_path / "share" / "elsewhere").mkdir()
    make_source(tmp_path / "share" / "elsewhere", "other_name")
    assert make_finder(inside).find("elsewhere") is None


def test_install_folder_without_colcon_layout_is_not_a_prefix(tmp_path: Path) -> None:
    install_package(tmp_path / "install", "arm")
    assert make_finder(tmp_path).find("arm") is None


def test_symlink_install_returns_share_path(tmp_path: Path) -> None:
    source = make_source(tmp_path / "src" / "arm", "arm")
    share = install_package(tmp_path / "install" / "arm", "arm")
    (share / "package.xml").unlink()
    (share / "package.xml").symlink_to(source / "package.xml")
    (tmp_path / "install" / ".colcon_install_layout").write_text("isolated\n")
    assert make_finder(tmp_path).share("arm") == share


def test_installed_copy_takes_precedence_over_source(tmp_path: Path) -> None:
    make_source(tmp_path / "src" / "arm", "arm")
    share = install_package(tmp_path / "install" / "arm", "arm")
    (tmp_path / "install" / "local_setup.sh").touch()
    assert make_finder(tmp_path).share("arm") == share


def test_sources_are_found_below_src_of_parent_folders(tmp_path: Path) -> None:
    arm = make_source(tmp_path / "ws" / "src" / "group" / "arm", "arm")
    unrelated_folder = tmp_path / "ws" / "notes" / "today"
    unrelated_folder.mkdir(parents=True)
    assert make_finder(unrelated_folder).share("arm") == arm


def test_current_package_and_its_siblings_are_found(tmp_path: Path) -> None:
    arm = make_source(tmp_path / "repo" / "arm", "arm")
    gripper = make_source(tmp_path / "repo" / "gripper", "gripper")
    (arm / "urdf").mkdir()
    package_finder = make_finder(arm / "urdf")
    assert package_finder.share("arm") == arm
    assert package_finder.share("gripper") == gripper


def test_start_folders_are_searched_in_order(tmp_path: Path) -> None:
    first = make_source(tmp_path / "a" / "arm", "arm")
    make_source(tmp_path / "b" / "arm", "arm")
    only_there = make_source(tmp_path / "b" / "gripper", "gripper")
    package_finder = PackageFinder(start=[tmp_path / "a", tmp_path / "b"], environment={})
    assert package_finder.share("arm") == first
    assert package_finder.share("gripper") == only_there


def _no_scan_below(folder: Path, root: Path) -> SourceScan:
    assert not root.is_relative_to(folder)
    return SourceScan(root)


def test_starting_at_reuses_scanned_source_trees(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    arm, leg = make_source(tmp_path / "src" / "arm", "arm"), make_source(tmp_path / "src" / "leg", "leg")
    first = PackageFinder(start=[arm, tmp_path], environment={}, extra={"hand": tmp_path / "mine"})
    assert first.find("wheel") is None
    monkeypatch.setattr("linkwright.packages.finder.SourceScan", partial(_no_scan_below, tmp_path))
    other = first.starting_at([leg, tmp_path])
    assert (other.find("arm"), other.find("hand"), other.find("wheel")) == (arm, tmp_path / "mine", None)
    assert other.starts == (leg, tmp_path)


def test_shipped_packages_are_found_anywhere(tmp_path: Path) -> None:
    shipped = find_shipped_folder()
    assert shipped is not None
    assert make_finder(tmp_path).share("my_robot_description") == shipped / "my_robot_description"


def test_unknown_package_error_lists_searched_folders_and_similar_names(tmp_path: Path) -> None:
    install_package(tmp_path / "ros", "turtlebot4_description")
    make_source(tmp_path / "ws" / "src" / "arm", "arm")
    nameless = tmp_path / "ws" / "src" / "broken"
    nameless.mkdir()
    (nameless / "package.xml").write_text("<package/>")
    package_finder = make_finder(tmp_path / "ws", tmp_path / "ros")
    with pytest.raises(PackageNotFoundError) as caught:
        package_finder.share("turtlebot_description")
    (diagnostic,) = caught.value.diagnostics
    notes = "\n".join(note.message for note in diagnostic.notes)
    assert diagnostic.code == "PKG101"
    assert diagnostic.message == "package 'turtlebot_description' not found"
    assert (diagnostic.hint or "").startswith("did you mean 'turtlebot4_description'")
    assert f"AMENT_PREFIX_PATH: {tmp_path / 'ros'}" in notes
    assert str(tmp_path / "ws" / "src") in notes
    assert "broken/package.xml, which does not contain a package name" in notes
    assert "my_robot_description" in notes


def test_package_sharing_only_common_words_is_not_suggested(tmp_path: Path) -> None:
    install_package(tmp_path / "ros", "kuka_robot_description")
    with pytest.raises(PackageNotFoundError) as caught:
        make_finder(tmp_path, tmp_path / "ros").share("abb_robot_description")
    assert "did you mean" not in (caught.value.diagnostics[0].hint or "")


def test_error_is_key_error_as_in_ament_index_python(tmp_path: Path) -> None:
    with pytest.raises(KeyError) as caught:
        make_finder(tmp_path).share("no_such_package_at_all")
    assert "package 'no_such_package_at_all' not found" in str(caught.value)


def test_use_finder_sets_current_finder(tmp_path: Path) -> None:
    own_finder = make_finder(tmp_path)
    with use_finder(own_finder):
        assert current_finder() is own_finder
    assert current_finder() is not own_finder


class TestSourceScan:
    @pytest.mark.parametrize("marker", ["COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"])
    def test_folders_with_ignore_markers_are_skipped(self, tmp_path: Path, marker: str) -> None:
        make_source(tmp_path / "off" / "arm", "arm")
        (tmp_path / "off" / marker).touch()
        assert SourceScan(tmp_path).packages() == {}

    @pytest.mark.parametrize("folder", ["build", "install", "log", ".git", "node_modules"])
    def test_folders_without_sources_are_skipped(self, tmp_path: Path, folder: str) -> None:
        make_source(tmp_path / folder / "arm", "arm")
        assert SourceScan(tmp_path).packages() == {}

    def test_scan_does_not_descend_into_package(self, tmp_path: Path) -> None:
        arm = make_source(tmp_path / "arm", "arm")
        make_source(arm / "templates" / "x", "template")
        assert SourceScan(tmp_path).packages() == {"arm": arm}

    def test_nearer_of_duplicate_packages_is_used(self, tmp_path: Path) -> None:
        make_source(tmp_path / "a" / "deep" / "arm", "arm")
        nearer = make_source(tmp_path / "z_arm", "arm")
        assert SourceScan(tmp_path).find("arm") == nearer

    def test_circular_symlinks_end_scan(self, tmp_path: Path) -> None:
        arm = make_source(tmp_path / "group" / "arm", "arm")
        (tmp_path / "group" / "loop").symlink_to(tmp_path)
        scan = SourceScan(tmp_path)
        assert scan.packages() == {"arm": arm}
        assert not scan.truncated

    def test_symlinked_package_is_found(self, tmp_path: Path) -> None:
        make_source(tmp_path / "elsewhere" / "arm", "arm")
        (tmp_path / "src").mkdir()
        (tmp_path / "src" / "arm").symlink_to(tmp_path / "elsewhere" / "arm")
        assert SourceScan(tmp_path / "src").packages() == {"arm": tmp_path / "src" / "arm"}

    def test_scan_is_truncated_at_maximum_folders(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr("linkwright.packages.manifest.MAX_FOLDERS", 3)
        for number in range(5):
            (tmp_path / f"f{number}").mkdir()
        make_source(tmp_path / "f4" / "arm", "arm")
        scan = SourceScan(tmp_path)
        assert scan.find("arm") is None
        assert scan.truncated

    def test_name_in_xml_comment_is_ignored(self, tmp_path: Path) -> None:
        (tmp_path / "arm").mkdir()
        (tmp_path / "arm" / "package.xml").write_text(
            "<?xml version='1.0'?><!-- <package><name>old</name> --><package format='2'><name> arm </name></package>"
        )
        assert SourceScan(tmp_path).packages() == {"arm": tmp_path / "arm"}


class TestResolve:
    @pytest.fixture
    def packages(self, tmp_path: Path) -> PackageFinder:
        return make_finder(tmp_path, arm=tmp_path / "arm")

    @pytest.mark.parametrize(
        ("address", "path"),
        [
            ("package://arm/meshes/a.stl", "arm/meshes/a.stl"),
            ("package://arm", "arm"),
            ("package://arm/a%20b.stl", "arm/a b.stl"),
            ("PACKAGE://arm/a.stl", "arm/a.stl"),
        ],
    )
    def test_package_uri_is_resolved(self, packages: PackageFinder, tmp_path: Path, address: str, path: str) -> None:
        assert packages.resolve(address) == tmp_path / path

    @pytest.mark.parametrize("address", ["file:///a/b.stl", "file:/a/b.stl", "file://localhost/a/b.stl", "/a/b.stl"])
    def test_absolute_path_is_resolved(self, packages: PackageFinder, address: str) -> None:
        assert packages.resolve(address) == Path("/a/b.stl")

    def test_relative_path_is_resolved(self, packages: PackageFinder) -> None:
        assert packages.resolve("meshes/a.stl", Path("/robot")) == Path("/robot/meshes/a.stl")
        assert packages.resolve("meshes/a.stl") == Path("meshes/a.stl")

    @pytest.mark.parametrize(
        ("address", "message"),
        [
            ("package:/arm/a.stl", "has no '//' after the scheme"),
            ("package:///a.stl", "does not name a package"),
            ("file://a.stl", "has no absolute path"),
            ("http://example.org/a.stl", "does not name a local file"),
            ("model://arm/a.stl", "does not name a local file"),
            ("", "is empty"),
        ],
    )
    def test_malformed_uri_is_rejected(self, packages: PackageFinder, address: str, message: str) -> None:
        with pytest.raises(LinkwrightError, match=message) as caught:
            packages.resolve(address)
        assert caught.value.diagnostics[0].code == "PKG102"

    def test_unknown_package_is_rejected(self, packages: PackageFinder) -> None:
        with pytest.raises(PackageNotFoundError, match="'armm' not found"):
            packages.resolve("package://armm/a.stl")


@pytest.mark.parametrize("name", ["launch_ros", "rclpy", "std_msgs", "robot_state_publisher", "rviz2", "xacro"])
def test_stand_in_packages_have_share_folder_unless_installed(tmp_path: Path, name: str) -> None:
    package_finder = make_finder(tmp_path)
    share = package_finder.share(name)
    assert is_substitute(share)
    assert share.name == name
    assert name not in package_finder.packages()
    installed_folder = install_package(tmp_path / "ros", name)
    assert make_finder(tmp_path, tmp_path / "ros").share(name) == installed_folder


def test_entry_points_provide_substitutes_for_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module = tmp_path / "site" / "my_sea_substitutes"
    install_package(module, "sea_ros")
    (module / "__init__.py").touch()
    metadata = tmp_path / "site" / "my_sea-1.0.dist-info"
    metadata.mkdir()
    (metadata / "entry_points.txt").write_text(
        "[linkwright.package_substitutes]\nsea_ros = my_sea_substitutes\nlost_ros = my_sea_that_is_not_there\n"
    )
    monkeypatch.syspath_prepend(tmp_path / "site")
    extensions._read_all_groups.cache_clear()
    try:
        package_finder = make_finder(tmp_path / "ws")
        assert package_finder.share("sea_ros") == module / "share" / "sea_ros"
        assert is_substitute(package_finder.share("sea_ros"))
        assert not is_substitute(tmp_path / "share" / "sea_ros")
        with pytest.warns(UserWarning, match="'my_sea' provides no substitute for 'lost_ros'"):
            assert "sea_ros" in package_finder.packages()
    finally:
        extensions._read_all_groups.cache_clear()


def test_searched_locations_are_described_once_for_a_missing_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package_finder = make_finder(tmp_path)
    calls = []
    describe = package_finder._searched_locations
    monkeypatch.setattr(package_finder, "_searched_locations", lambda: (calls.append(1), describe())[1])
    for _ in range(3):
        with pytest.raises(PackageNotFoundError) as caught:
            package_finder.share("armm")
        assert any(str(tmp_path) in str(note.message) for note in caught.value.diagnostics[0].notes)
    assert calls == [1]
