"""The codec of page messages: round trips and rejected input."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import to_builtins

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation.translate import load_catalog
from linkwright.page.protocol.configuration import (
    DisplayProperties,
    DisplayStatus,
    Folder,
    Property,
    PropertyChanged,
    SetProperty,
    StatusRow,
)
from linkwright.page.protocol.geometry import PolygonLine
from linkwright.page.protocol.message import BadMessageError, decode, encode, make_redundancy_key, pack_data
from linkwright.page.protocol.robot import (
    CenterJoints,
    JointPositions,
    Joints,
    MeshStatus,
    RandomizeJoints,
    RobotScene,
    SetJoint,
)
from linkwright.page.protocol.views_and_tools import View, ViewChanged

FLOATS = st.floats(allow_nan=False, allow_infinity=False)
MESSAGES = st.one_of(
    st.builds(SetProperty, id=st.text(), value=st.none() | st.booleans() | st.integers() | FLOATS | st.text()),
    st.builds(SetJoint, name=st.text(), position=FLOATS),
    st.builds(RandomizeJoints),
    st.builds(CenterJoints),
    st.builds(MeshStatus, display=st.text(), link=st.text(), url=st.text(), error=st.none() | st.text()),
    st.builds(
        ViewChanged,
        view=st.builds(
            View,
            cls=st.text(),
            name=st.text(),
            values=st.dictionaries(st.text(), st.booleans() | FLOATS | st.text()),
        ),
    ),
)
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | FLOATS | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


@given(MESSAGES)
def test_page_messages_round_trip(message):
    assert decode(json.dumps(to_builtins(message))) == message


@given(MESSAGES, st.data())
def test_missing_extra_or_mistyped_field_is_rejected(message, data):
    fields = to_builtins(message)
    name = data.draw(st.sampled_from(sorted(fields)))
    with pytest.raises(BadMessageError):
        decode(json.dumps({key: value for key, value in fields.items() if key != name}))
    with pytest.raises(BadMessageError):
        decode(json.dumps(fields | {"more": 1}))
    with pytest.raises(BadMessageError):
        decode(json.dumps(fields | {name: {"another": "kind"}}))


@given(JSON, JSON)
def test_arbitrary_json_is_rejected(first, second):
    for data in (first, {"type": first}, {"type": "set_joint", "name": first, "position": second, "x": 1}):
        with pytest.raises(BadMessageError):
            decode(json.dumps(data))


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "null",
        "[" * 100_000,
        '{"type": "set_joint", "name": "a", "position": NaN}',
        '{"type": "set_joint", "name": "a", "position": 1e999}',
        '{"type": "set_joint", "name": "a", "position": ' + "9" * 400 + "}",
        '{"type": "set_joint", "name": "a", "position": true}',
        '{"type": "set_joint", "name": "a", "position": "1"}',
        '{"type": "set_property", "id": "x", "value": [1]}',
        '{"type": "hello"}',
        '{"type": ["set_joint"]}',
    ],
)
def test_malformed_messages_are_rejected(text):
    with pytest.raises(BadMessageError):
        decode(text)


@pytest.mark.parametrize(
    "text",
    [
        r'{"type": "set_property", "id": "\ud800", "value": true}',
        r'{"type": "set_property", "id": "a", "value": "half \udc00"}',
        r'{"type": "view_changed", "view": {"cls": "a", "name": "b", "values": {"\ud800": 1}}}',
    ],
)
def test_lone_surrogates_are_rejected(text):
    with pytest.raises(BadMessageError):
        decode(text)
    assert decode(r'{"type": "set_property", "id": "\ud83e\udd16", "value": true}').id == "\U0001f916"


def test_lone_surrogates_are_not_sent():
    folder = Folder("/h\u00f6me", None, ["caf\udce9"], [])
    assert json.loads(encode(folder).encode())["folders"] == ["caf?"]
    frame = pack_data("display-1", PolygonLine(np.zeros((1, 3), np.float32)), frame="caf\udce9")
    assert b'"frame":"caf?"' in frame


def test_integers_are_converted_to_float_fields():
    position = decode('{"type": "set_joint", "name": "a", "position": 1}').position
    assert (position, type(position)) == (1.0, float)


def test_phrases_are_translated_to_page_language():
    frame = phrase("Frame [{frame}] does not exist", frame="base")
    row = StatusRow("Fixed Frame", "warn", phrase("No tf data.  Actual error: {missing}", missing=frame))
    message = DisplayStatus("global", "warn", [row])

    def text(language):
        return json.loads(encode(message, language))["status"][0]["text"]

    assert text("zh") == "没有 tf 数据。实际的错误：坐标系 [base] 不存在"
    assert text("en") == text(None) == "No tf data.  Actual error: Frame [base] does not exist"
    in_chinese = frame.translated(load_catalog("zh"))
    message.status = [StatusRow("Fixed Frame", "error", in_chinese)]
    assert (text("en"), text(None)) == ("Frame [base] does not exist", "坐标系 [base] 不存在")
    malformed = DisplayStatus("global", "warn", [StatusRow("caf\udce9", "warn", frame)])
    assert json.loads(encode(malformed, "zh"))["status"] == [{"name": "caf?", "level": "warn", "text": in_chinese}]


def test_server_messages_are_plain_json():
    row = Property("a/b", "b", "float", 0.5, children=[Property("a/b/c", "c", "group")])
    message = DisplayProperties("a", [row])
    assert json.loads(encode(message)) == to_builtins(message)
    assert json.loads(encode(JointPositions({"轮": 1.0}))) == {
        "positions": {"轮": 1.0},
        "type": "joint_positions",
    }


def test_redundancy_key_identifies_replaceable_messages():
    assert make_redundancy_key(PropertyChanged("a/b", 1)) != make_redundancy_key(PropertyChanged("a/c", 1))
    assert make_redundancy_key(PropertyChanged("a/b", 1)) == make_redundancy_key(PropertyChanged("a/b", 2))
    assert make_redundancy_key(RobotScene("a", 1, "", [])) != make_redundancy_key(RobotScene("b", 1, "", []))
    assert make_redundancy_key(Joints(None)) != make_redundancy_key(JointPositions({}))
