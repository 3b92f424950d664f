"""Interface files of the workspace: accepted syntax, and the positions of mistakes."""

from __future__ import annotations

import contextlib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.messages import (
    DefinitionError,
    add_definitions,
    definition_text,
    deserialize,
    get_action,
    get_message,
    get_service,
    interface_names,
    serialize,
    type_hash,
)
from linkwright.messages.definitions.idl import parse_idl
from linkwright.messages.definitions.parser import parse_interface
from linkwright.packages import PackageFinder, use_finder
from linkwright.packages.interface_files import find_interface_file


class Everything:
    """A library that knows every message."""

    def has_message(self, type_name):
        return True

    def find_hint(self, type_name):
        return None


def parse_definition(text, kind="msg"):
    return parse_interface(SourceText("F.msg", text), f"my_msgs/{kind}/F", Everything())


def field_names(text):
    return {field.name: (field.type.to_msg_text("my_msgs"), field.default) for field in parse_definition(text).fields}


def fault_texts(text, kind="msg"):
    with pytest.raises(DefinitionError) as caught:
        parse_definition(text, kind)
    return [(diagnostic.code, str(diagnostic.span), diagnostic.message) for diagnostic in caught.value.diagnostics]


class TestFields:
    def test_field_types_are_parsed(self):
        text = """
        # comment
        bool a  # the robot's
        byte[] b\t
        float64[3] c
        string<=10 d
        string<=5[<=2] e
        wstring f
        std_msgs/Header g
        std_msgs/msg/Header h
        Other i
        Other[<=4]   j
        """
        assert {name: kind for name, (kind, _) in field_names(text).items()} == {
            "a": "bool",
            "b": "byte[]",
            "c": "float64[3]",
            "d": "string<=10",
            "e": "string<=5[<=2]",
            "f": "wstring",
            "g": "std_msgs/Header",
            "h": "std_msgs/Header",
            "i": "Other",
            "j": "Other[<=4]",
        }

    @pytest.mark.parametrize(
        ("line", "value"),
        [
            ("bool x true", True),
            ("bool x FALSE", False),
            ("bool x 1", True),
            ("int8 x -128", -128),
            ("uint8 x 0x1F", 31),
            ("int32 x 007", 7),
            ("byte x 200", b"\xc8"),
            ("char x 65", 65),
            ("float32 x 1e3", 1000.0),
            ("float64 x 3", 3.0),
            ("float64 x inf", float("inf")),
            ("string x hello world", "hello world"),
            ('string x "a # b"  # c', "a # b"),
            (r"string x 'it\'s'", "it's"),
            (r'string x "a\tb\\"', "a\tb\\"),
            ('string x ""', ""),
            ("string x it's  # not a quote", "it's"),
            ("int32[] x []", ()),
            ("int32[] x [1, 2,3]", (1, 2, 3)),
            ("int32[3] x [1, 2, 3,]", (1, 2, 3)),
            ("string[] x ['a, b', \"c\", d]", ("a, b", "c", "d")),
            ("bool[2] x [true, false]", (True, False)),
        ],
    )
    def test_default_values_are_parsed(self, line, value):
        assert field_names(line)["x"][1] == value

    def test_constants_are_parsed(self):
        text = 'int32 A=1\nint32 B = -2 # b\nstring NAME="a=b"\nstring PLAIN= x y \nfloat64 PI2=6.28\nbool ON=true\n'
        constants = {constant.name: constant.value for constant in parse_definition(text).constants}
        assert constants == {"A": 1, "B": -2, "NAME": "a=b", "PLAIN": "x y", "PI2": 6.28, "ON": True}

    def test_service_and_action_parts_are_parsed(self):
        service = parse_definition("int64 a\n---\nint64 sum\n", "srv")
        assert service.request.type_name == "my_msgs/srv/F_Request"
        assert service.response.type_name == "my_msgs/srv/F_Response"
        assert [field.name for field in service.response.fields] == ["sum"]
        action = parse_definition("---\n---\n", "action")
        assert action.goal.fields == action.result.fields == action.feedback.fields == ()


class TestFaults:
    @pytest.mark.parametrize(
        ("text", "code", "place", "message"),
        [
            ("int32", "MSG110", "F.msg:1:1", "'int32' is neither a field ('TYPE name') nor a constant"),
            ("# a\n  int3 x", "MSG111", "F.msg:2:3", "there is no type 'int3'"),
            (
                "a/b/c x",
                "MSG111",
                "F.msg:1:1",
                "'a/b/c' is not a type: write 'package/Name' for a type of another package",
            ),
            ("int32 Max", "MSG112", "F.msg:1:7", "'Max' is not a valid name for a field"),
            ("int32 a__b", "MSG112", "F.msg:1:7", "'a__b' is not a valid name for a field"),
            ("int32 max=5", "MSG113", "F.msg:1:7", "'max' is not a valid name for a constant"),
            (
                "int8 x 128",
                "MSG114",
                "F.msg:1:8",
                "the default value of 'x' is invalid: 128 is outside the range of int8",
            ),
            ("bool x yes", "MSG114", "F.msg:1:8", "'yes' is neither true nor false"),
            ("int8 x 1.5", "MSG114", "F.msg:1:8", "'1.5' is not an integer"),
            ("float32 x 1e39", "MSG114", "F.msg:1:11", "1e39 is outside the range of float32"),
            ("float32 x one", "MSG114", "F.msg:1:11", "'one' is not a number"),
            ("int8[] x 5", "MSG114", "F.msg:1:10", "write the default of 'int8[]' as a list in square brackets"),
            ("int8[2] x [1]", "MSG114", "F.msg:1:11", "'int8[2]' must have 2 values, not 1"),
            ("int8[<=1] x [1,2]", "MSG114", "F.msg:1:13", "'int8[<=1]' must have at most 1 values, not 2"),
            ("string<=2 x abc", "MSG114", "F.msg:1:13", "the string is longer than 2 characters"),
            ('string x "abc', "MSG114", "F.msg:1:10", 'the string that begins with " does not end with it'),
            ("Other x 5", "MSG114", "F.msg:1:9", "cannot have a default value"),
            ("int8[] X=5", "MSG114", "F.msg:1:8", "the constant 'X' cannot be of type 'int8[]'"),
            ("uint8 X=-1", "MSG114", "F.msg:1:8", "the value of 'X' is invalid: -1 is outside the range of uint8"),
            ("int8 x\nint8 x", "MSG115", "F.msg:2:6", "the name 'x' is used twice"),
            ("int8[0] x", "MSG119", "F.msg:1:6", "'0' is not a valid length of an array"),
            ("int8[<=n] x", "MSG119", "F.msg:1:8", "'n' is not a valid length of a sequence"),
            ("string<=z x", "MSG119", "F.msg:1:9", "'z' is not a valid length of a string"),
            ("int8<=3 x", "MSG119", "F.msg:1:1", "only strings can have a length bound, and 'int8' is not a string"),
            ("int8 x\n---\n", "MSG118", "F.msg:2:1", "a .msg file has 1 part, but this '---' begins another"),
        ],
    )
    def test_syntax_error_is_reported_with_position(self, text, code, place, message):
        ((found_code, found_place, found_message),) = fault_texts(text)
        assert (found_code, found_place) == (code, place)
        assert message in found_message

    def test_all_syntax_errors_are_reported_together(self):
        assert [code for code, _, _ in fault_texts("int3 x\nint32 Y\nint8 z 300\n\nint32\n")] == [
            "MSG111",
            "MSG112",
            "MSG114",
            "MSG110",
        ]

    def test_wrong_number_of_parts_is_reported(self):
        assert (
            fault_texts("int8 x\n", "srv")[0][2]
            == "a .srv file has 2 parts with '---' between them, but this file has 1"
        )
        assert fault_texts("---\n---\n", "srv")[0][1] == "F.msg:2:1"
        assert fault_texts("---\n", "action")[0][0] == "MSG118"

    @given(st.text(st.sampled_from("int32 float64[]<=3/x'\"#\n-=AStrinHeader,0.é"), max_size=60))
    @settings(max_examples=500)
    def test_any_text_is_parsed_or_rejected(self, text):
        with contextlib.suppress(DefinitionError):
            assert parse_definition(text).type_name == "my_msgs/msg/F"


class TestWorkspace:
    def found(self, name):
        with pytest.raises(LinkwrightError) as caught:
            get_message(name)
        return caught.value.diagnostics

    def test_messages_services_and_actions_of_package_are_found(self, interface_package):
        package = interface_package
        text = "# how many\nint32 MOST=10\nint32 n 5\nInner[2] inner\nstd_msgs/Header header\n"
        package.write("msg", "Count", text)
        package.write("msg", "Inner", "uint8[3] rgb [1, 2, 3]\n")
        package.write("srv", "Add", "int64 a\n---\nCount sum\n")
        package.write("action", "Go", "Count order\n---\n---\n")
        cls = get_message(f"{package.name}/Count")
        assert (cls().n, cls.MOST, cls().inner[1].rgb.tolist()) == (5, 10, [1, 2, 3])
        assert deserialize(serialize(cls(n=7)), cls).n == 7
        assert get_service(f"{package.name}/srv/Add").Response().sum == cls()
        assert get_action(f"{package.name}/Go").Goal(order=cls(n=1)).order.n == 1
        assert definition_text(cls) == text
        assert type_hash(cls).startswith("RIHS01_")
        assert [name for name in interface_names("msg") if name.startswith(package.name)] == [
            f"{package.name}/msg/Count",
            f"{package.name}/msg/Inner",
        ]

    def test_unknown_type_names_are_reported_with_suggestion(self, interface_package):
        interface_package.write("msg", "Count", "int32 n\n")
        interface_package.write("msg", "Bad", "Cuont a\nTwist b\nstd_msgs/Headr c\nother/Thing d\n")
        name = interface_package.name
        first, second, third, fourth = self.found(f"{name}/msg/Bad")
        assert (first.message, first.hint) == (f"there is no message '{name}/msg/Cuont'", "did you mean 'Count'?")
        assert second.hint == "did you mean 'geometry_msgs/msg/Twist'?"
        assert "'Header'" in third.hint
        assert fourth.message == "there is no message 'other/msg/Thing'"
        assert str(fourth.span).endswith("Bad.msg:4:1")
        assert self.found(f"{name}/msg/Cnt")[0].hint == "did you mean 'Count'?"

    def test_ros_1_types_are_reported(self, interface_package):
        interface_package.write("msg", "Old", "Header header\ntime stamp\nduration length\n")
        diagnostics = self.found(f"{interface_package.name}/msg/Old")
        assert [diagnostic.code for diagnostic in diagnostics] == ["MSG117"] * 3
        assert diagnostics[0].hint == "use 'std_msgs/Header' in ROS 2"

    def test_package_can_define_its_own_header(self, interface_package):
        interface_package.write("msg", "Header", "int8 x\n")
        interface_package.write("msg", "New", "Header header\n")
        assert get_message(f"{interface_package.name}/msg/New")().header.x == 0

    def test_recursive_messages_are_reported(self, interface_package):
        interface_package.write("msg", "One", "Two[] two\n")
        interface_package.write("msg", "Two", "int8 x\nThree a\n")
        interface_package.write("msg", "Three", "One[] one\n")
        interface_package.write("msg", "Self", "Self[] me\n")
        name = interface_package.name
        for message_name in ("One", "Two", "Three", "One"):
            (diagnostic,) = self.found(f"{name}/msg/{message_name}")
            assert diagnostic.code == "MSG116"
            assert "would contain itself" in diagnostic.message
        (diagnostic,) = self.found(f"{name}/msg/Self")
        assert diagnostic.message == f"'{name}/msg/Self' would contain itself: it is part of {name}/msg/Self"

    def test_error_in_nested_type_is_reported_at_its_file(self, interface_package):
        interface_package.write("msg", "Outer", "Inner inner\n")
        interface_package.write("msg", "Inner", "int32 X\n")
        (diagnostic,) = self.found(f"{interface_package.name}/msg/Outer")
        assert diagnostic.code == "MSG112"
        assert str(diagnostic.span).endswith("Inner.msg:1:7")

    def test_unreadable_interface_files_are_reported(self, interface_package):
        path = interface_package.write("msg", "Latin", "")
        path.write_bytes(b"# caf\xe9\nint8 x\n")
        assert self.found(f"{interface_package.name}/msg/Latin")[0].code == "MSG121"
        path.write_bytes(b"\xef\xbb\xbf# caf\xc3\xa9\r\nint8 x\r\n")
        assert get_message(f"{interface_package.name}/msg/Latin")().x == 0

    def test_workspace_does_not_override_shipped_interfaces(self, tmp_path, interface_package):
        other = type(interface_package)(tmp_path, "std_msgs")
        other.write("msg", "Int8", "int8 wrong\n")
        other.write("msg", "Unheard", "int8 x\n")
        assert not hasattr(get_message("std_msgs/msg/Int8"), "wrong")
        assert get_message("std_msgs/msg/Unheard")().x == 0

    def test_current_finder_is_used(self, tmp_path, interface_package):
        other = type(interface_package)(tmp_path / "elsewhere", "elsewhere_msgs")
        other.write("msg", "Here", "int8 x\n")
        with use_finder(PackageFinder(start=tmp_path / "elsewhere", environment={})):
            assert get_message("elsewhere_msgs/msg/Here")().x == 0
        assert find_interface_file(other.folder, "msg", "Here") == other.folder / "msg" / "Here.msg"


IDL = """\
// made by rosidl
#include "std_msgs/msg/Header.idl"
module my_msgs { module msg {
  typedef double double__36[36];
  typedef sequence<string<4>> names;
  module F_Constants {
    const int32 MOST = 5;
    const string NAME = "hi; there";
    @unit (value="m") const double LENGTH = 1.5;
  };
  @verbatim (language="comment", text="a (b) " "c\\n")
  struct F {
    std_msgs::msg::Header header; /* where */
    @default (value=2.5) @unit(value="m")
    double x;
    double__36 covariance;
    sequence<my_msgs::msg::Inner, 4> inners;
    names words;
    string<5> short_text;
    wstring wide;
    @default (value="(1, 2)")
    sequence<long> numbers;
    @default (value=TRUE) boolean flag;
    octet raw;
    unsigned long long big, bigger;
    uint8 pixels[2];
  };
}; };
"""


class TestIdl:
    def parsed(self, text, type_name="my_msgs/msg/F"):
        return parse_idl(SourceText("F.idl", text), type_name, Everything())

    def test_idl_written_by_rosidl_is_parsed(self):
        definition = self.parsed(IDL)
        assert {field.name: field.type.to_idl_text() for field in definition.fields} == {
            "header": "std_msgs/Header",
            "x": "double",
            "covariance": "double[36]",
            "inners": "sequence<my_msgs/Inner, 4>",
            "words": "sequence<string<4>>",
            "short_text": "string<5>",
            "wide": "wstring",
            "numbers": "sequence<int32>",
            "flag": "boolean",
            "raw": "octet",
            "big": "uint64",
            "bigger": "uint64",
            "pixels": "uint8[2]",
        }
        defaults = {field.name: field.default for field in definition.fields if field.default is not None}
        assert defaults == {"x": 2.5, "numbers": (1, 2), "flag": True}
        constants = {constant.name: constant.value for constant in definition.constants}
        assert constants == {"MOST": 5, "NAME": "hi; there", "LENGTH": 1.5}

    def test_idl_services_and_empty_structures_are_parsed(self):
        text = """module a_msgs { module srv {
            struct Do_Request { uint8 structure_needs_at_least_one_member; };
            struct Do_Response { boolean done; }; }; };"""
        service = self.parsed(text, "a_msgs/srv/Do")
        assert service.request.fields == ()
        assert service.response.fields[0].name == "done"

    def test_package_with_idl_file_is_supported(self, interface_package):
        name = interface_package.name
        interface_package.write("msg", "F", f"module {name} {{ module msg {{ struct F {{ long x; }}; }}; }};", "idl")
        interface_package.write("msg", "G", "F f\n")
        assert get_message(f"{name}/msg/G")().f.x == 0

    @pytest.mark.parametrize(
        ("text", "code", "message"),
        [
            ("union U switch (long) {};", "MSG120", "'union' is not supported in messages"),
            ("enum E { A };", "MSG120", "'enum' is not supported"),
            ("module a { struct F { char c; }; };", "MSG120", "'char' is not supported in messages"),
            ("module a { struct F { long double c; }; };", "MSG120", "'long double' is not supported"),
            ("module a { struct F { sequence<sequence<long>> c; }; };", "MSG120", "sequences of sequences"),
            ("module a { struct F { long c[2][3]; }; };", "MSG120", "arrays of arrays"),
            ("module a { struct F { thing c; }; };", "MSG111", "there is no type 'thing'"),
            ("module a { struct F { string<0> c; }; };", "MSG119", "'0' is not a length"),
            ("module a { struct F { long c }; };", "MSG120", "expected ';', but found '}'"),
            ("module a { struct F { long", "MSG120", "expected a name, but found the end of the file"),
            ("module a { const octet X = 300; };", "MSG114", "the value of 'X' is invalid"),
            ("module a { struct G { long x; }; };", "MSG118", "does not define the structure 'my_msgs::msg::F'"),
            ("module a ? {}", "MSG120", "unexpected '?'"),
        ],
    )
    def test_unsupported_idl_is_rejected(self, text, code, message):
        with pytest.raises(DefinitionError) as caught:
            self.parsed(text)
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.code == code
        assert message in diagnostic.message
        assert diagnostic.span is not None

    @given(st.lists(st.sampled_from(IDL.split()), max_size=40))
    def test_any_idl_is_parsed_or_rejected(self, words):
        with contextlib.suppress(DefinitionError):
            self.parsed(" ".join(words))


class TestEmbeddedDefinitions:
    def test_embedded_definition_includes_nested_messages(self):
        text = (
            "Inner[] inner\nstd_msgs/Header header\n"
            f"{'=' * 80}\nMSG: carried_msgs/Inner\nint32 n 5\n"
            f"{'=' * 80}\nMSG: std_msgs/Header\nint32 another_header\n"
        )
        add_definitions("carried_msgs/msg/Outer", text, "some.mcap")
        outer_class = get_message("carried_msgs/msg/Outer")
        inner_class = get_message("carried_msgs/msg/Inner")
        assert outer_class(inner=[inner_class()]).inner[0].n == 5
        assert outer_class.get_fields_and_field_types()["header"] == "std_msgs/Header"
        assert hasattr(outer_class().header, "frame_id"), "Linkwright's definitions take precedence"
        assert {"carried_msgs/msg/Inner", "carried_msgs/msg/Outer"} <= set(interface_names("msg"))
        assert deserialize(serialize(outer_class()), outer_class) == outer_class()

    def test_first_of_two_embedded_definitions_is_used(self):
        add_definitions("carried_msgs/msg/Twice", "int32 first\n", "a.mcap")
        add_definitions("carried_msgs/msg/Twice", "int32 second\n", "b.mcap")
        assert list(get_message("carried_msgs/msg/Twice").get_fields_and_field_types()) == ["first"]

    def test_embedded_idl_is_supported(self):
        separator = "=" * 80
        text = (
            f"{separator}\nIDL: carried_msgs/msg/Written\n"
            "module carried_msgs { module msg { struct Written { long n; carried_msgs::msg::Part part; }; }; };\n"
            f"{separator}\nIDL: carried_msgs/msg/Part\n"
            "module carried_msgs { module msg { struct Part { double x; }; }; };\n"
        )
        add_definitions("carried_msgs/msg/Written", text, "some.mcap", idl=True)
        assert get_message("carried_msgs/msg/Written")().part.x == 0.0

    def test_error_in_embedded_definition_is_reported_on_lookup(self):
        add_definitions("carried_msgs/msg/Wrong", "int32 n\nint33 m\n", "some.mcap")
        with pytest.raises(
            DefinitionError, match=r"some\.mcap/carried_msgs/msg/Wrong\.msg:2:1: there is no type 'int33'"
        ):
            get_message("carried_msgs/msg/Wrong")

    @given(name=st.text(), text=st.text(), idl=st.booleans())
    def test_malformed_embedded_definitions_are_accepted(self, name, text, idl):
        add_definitions(name, text, "some.mcap", idl=idl)

    @pytest.mark.parametrize("field", ["first", "second"])
    def test_embedded_definitions_do_not_leak_between_tests(self, field):
        assert not any(name.startswith("carried_msgs/") for name in interface_names("msg"))
        add_definitions("carried_msgs/msg/Again", f"int32 {field}\n", "some.mcap")
        assert list(get_message("carried_msgs/msg/Again").get_fields_and_field_types()) == [field]
