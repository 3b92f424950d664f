"""``CMakeLists.txt`` and ``setup.py``: completion, hover and definition."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.language.formats import Place, make_packages


@pytest.fixture
def position_in_cmake(tmp_path: Path):
    folder = make_packages(tmp_path)
    manifest = folder / "package.xml"
    manifest.write_text(manifest.read_text().replace("<exec_depend>", "<depend>rclcpp</depend><exec_depend>"))
    (folder / "msg").mkdir()
    (folder / "msg/Glow.msg").write_text("bool on\n")

    def place(text: str) -> Place:
        return Place(folder / "CMakeLists.txt", text, folder.parent)

    return place


@pytest.fixture
def position_in_setup(tmp_path: Path):
    folder = make_packages(tmp_path).parent / "lamp_nodes"
    (folder / "launch").mkdir()
    (folder / "launch/lamp.launch.py").write_text("")
    return lambda text: Place(folder / "setup.py", f"setup({text})", folder.parent)


def test_cmake_commands_are_completed_at_line_start(position_in_cmake):
    assert position_in_cmake("find_p|").labels() == ["find_package"]
    assert position_in_cmake("set(a b)\n  ament_p|").labels() == ["ament_python_install_package", "ament_package"]
    assert "finds a package" in position_in_cmake("find_pa|ckage(a)").hover()


def test_manifest_packages_come_first_and_found_ones_are_omitted(position_in_cmake):
    assert position_in_cmake("find_package(|)").labels()[0] == "rclcpp"
    assert "rclcpp" not in position_in_cmake("find_package(rclcpp REQUIRED)\nfind_package(r|)").labels()
    assert position_in_cmake("find_package(rclcpp REQUIRED)\nament_target_dependencies(glow |)").labels()[0] == "rclcpp"
    assert "Starts a lamp." in position_in_cmake("find_package(lamp_br|ingup)").hover()
    assert position_in_cmake("find_package(lamp_br|ingup)").targets() == ["package.xml:"]


def test_install_paths_and_destinations_are_completed(position_in_cmake):
    assert position_in_cmake("install(DIRECTORY la|)").labels() == ["launch"]
    assert position_in_cmake("install(\n  DIRECTORY launch # the files\n  DESTINATION sh|)").labels() == [
        "share/${PROJECT_NAME}"
    ]
    assert "parts.launch.py" in position_in_cmake("install(FILES launch/|)").labels()
    assert position_in_cmake("install(FILES launch/parts.la|unch.py)").targets() == ["parts.launch.py:"]
    assert position_in_cmake("install(FILES launch/parts.launch.py|)").links() == ["parts.launch.py"]


def test_cmake_targets_and_interfaces_are_completed(position_in_cmake):
    assert position_in_cmake("add_executable(glow a.cpp)\ninstall(TARGETS gl|)").labels() == ["glow"]
    assert position_in_cmake("add_executable(glow a.cpp)\ntarget_link_libraries(gl|ow)").targets() == [
        "CMakeLists.txt:glow"
    ]
    assert position_in_cmake('rosidl_generate_interfaces(${PROJECT_NAME} "m|")').labels() == ["msg/Glow.msg"]


def test_setup_entry_points_are_completed(position_in_setup):
    script = 'entry_points={{"console_scripts": ["{}"]}}'
    assert position_in_setup(script.format("bl|")).labels() == ["blink = lamp_nodes.blink:main"]
    assert position_in_setup(script.format("blink = lamp_nodes.b|")).labels() == ["lamp_nodes.blink"]
    assert position_in_setup(script.format("blink = lamp_nodes.blink:|")).labels() == ["main"]
    assert position_in_setup(script.format("blink = lamp_nodes.bl|ink:main")).targets() == ["blink.py:main"]
    assert "`lamp_nodes.blink:main`" in position_in_setup(script.format("blink = lamp_nodes.bl|ink:main")).hover()


def test_setup_data_files_and_arguments_are_completed(position_in_setup):
    assert position_in_setup('data_files=[("share/lamp_nodes", ["launch/|"])]').labels() == ["lamp.launch.py"]
    assert position_in_setup('data_files=[("share/lamp_nodes", ["launch/lamp.la|unch.py"])]').targets() == [
        "lamp.launch.py:"
    ]
    assert position_in_setup('name="a", entry|').labels() == ["entry_points="]


@pytest.mark.parametrize("text", ["(|", "install(|", ')")|(', "find_package(\0|", "#(|", "add_library(\n\n|"])
def test_requests_survive_any_build_file_text(position_in_cmake, position_in_setup, text):
    for place in (position_in_cmake(text), position_in_setup(text)):
        place.items()
        place.hover()
        place.targets()
        place.links()
