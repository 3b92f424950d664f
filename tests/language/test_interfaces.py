"""Interface files: completion, hover and definition of types."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.language.formats import Place, make_packages


@pytest.fixture
def position_at(tmp_path: Path):
    folder = make_packages(tmp_path)
    (folder / "msg").mkdir()
    (folder / "msg" / "Glow.msg").write_text("# How bright\nfloat64 level\n")
    other = folder.parent / "lamp_nodes" / "msg"
    other.mkdir()
    (other / "Blink.msg").write_text("bool on\n")
    return lambda text, name="msg/Lamp.msg": Place(folder / name, text)


def test_type_completion_offers_builtin_own_and_foreign_types(position_at):
    assert position_at("|").labels()[0] == "float64"
    assert position_at("uint8 a\nint|").labels()[:2] == ["int32", "int64"]
    assert position_at("G|").labels() == ["Glow"]
    assert position_at("lamp_nodes/|").labels() == ["lamp_nodes/Blink"]
    assert position_at("std_|").labels()[0] == "std_msgs/Header"
    assert "geometry_msgs/PoseStamped" in position_at("geometry_msgs/Pose|[] poses").labels()
    assert position_at("# int|").labels() == []


def test_field_name_completion_follows_type(position_at):
    assert position_at("std_msgs/Header |").labels() == ["header"]
    assert position_at("geometry_msgs/PoseStamped[] p|").labels() == ["pose_stamped"]


def test_hover_shows_type_definition(position_at):
    assert "# How bright\nfloat64 level" in position_at("Gl|ow glow").hover()
    assert "builtin_interfaces/Time stamp" in position_at("std_msgs/Hea|der header").hover()
    assert position_at("uin|t8 a").hover() == "`uint8`: an integer from 0 to 255"
    assert position_at("---\nGlow gl|ow", "srv/Set.srv").hover().startswith("**Glow**")


def test_definition_of_type_is_its_file(position_at):
    assert position_at("Gl|ow glow").targets() == ["Glow.msg:"]
    assert position_at("lamp_nodes/Bl|ink[<=2] b").targets() == ["Blink.msg:"]
    assert position_at("geometry_msgs/Po|se p").targets() == ["geometry_msgs.txt:msg/Pose"]


def test_symbols_are_fields_of_request_and_response(position_at):
    place = position_at("|int32 a\n---\nint32 B=3\nstring<=5 c", "srv/Set.srv")
    symbols = [(part.name, [child.name for child in part.children]) for part in place.format.symbols(place.document)]
    assert symbols == [("Request", ["a"]), ("Response", ["B", "c"])]


def test_types_used_in_package_come_first(position_at):
    place = position_at("geometry_msgs/|")
    (place.document.file.parent / "Arm.msg").write_text("geometry_msgs/Wrench force\n")
    assert place.labels()[0] == "geometry_msgs/Wrench"
