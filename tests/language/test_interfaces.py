"""Interface files: completion, hover and definition of types."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.language.formats import Place, make_packages


@pytest.fixture
def at(tmp_path: Path):
    folder = make_packages(tmp_path)
    (folder / "msg").mkdir()
    (folder / "msg" / "Glow.msg").write_text("# How bright\nfloat64 level\n")
    other = folder.parent / "lamp_nodes" / "msg"
    other.mkdir()
    (other / "Blink.msg").write_text("bool on\n")
    return lambda text, name="msg/Lamp.msg": Place(folder / name, text)


def test_type_completion_offers_builtin_own_and_foreign_types(at):
    assert at("|").labels()[0] == "float64"
    assert at("uint8 a\nint|").labels()[:2] == ["int32", "int64"]
    assert at("G|").labels() == ["Glow"]
    assert at("lamp_nodes/|").labels() == ["lamp_nodes/Blink"]
    assert at("std_|").labels()[0] == "std_msgs/Header"
    assert "geometry_msgs/PoseStamped" in at("geometry_msgs/Pose|[] poses").labels()
    assert at("# int|").labels() == []


def test_field_name_completion_follows_type(at):
    assert at("std_msgs/Header |").labels() == ["header"]
    assert at("geometry_msgs/PoseStamped[] p|").labels() == ["pose_stamped"]


def test_hover_shows_type_definition(at):
    assert "# How bright\nfloat64 level" in at("Gl|ow glow").hover()
    assert "builtin_interfaces/Time stamp" in at("std_msgs/Hea|der header").hover()
    assert at("uin|t8 a").hover() == "`uint8`: an integer from 0 to 255"
    assert at("---\nGlow gl|ow", "srv/Set.srv").hover().startswith("**Glow**")


def test_definition_of_type_is_its_file(at):
    assert at("Gl|ow glow").targets() == ["Glow.msg:"]
    assert at("lamp_nodes/Bl|ink[<=2] b").targets() == ["Blink.msg:"]
    assert at("geometry_msgs/Po|se p").targets() == ["geometry_msgs.txt:msg/Pose"]


def test_symbols_are_fields_of_request_and_response(at):
    place = at("|int32 a\n---\nint32 B=3\nstring<=5 c", "srv/Set.srv")
    symbols = [(part.name, [child.name for child in part.children]) for part in place.format.symbols(place.document)]
    assert symbols == [("Request", ["a"]), ("Response", ["B", "c"])]


def test_types_used_in_package_come_first(at):
    place = at("geometry_msgs/|")
    (place.document.file.parent / "Arm.msg").write_text("geometry_msgs/Wrench force\n")
    assert place.labels()[0] == "geometry_msgs/Wrench"
