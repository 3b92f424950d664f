"""The classes of messages behave as those of rosidl_generator_py (Humble).

They raise errors with the same texts.
"""

from __future__ import annotations

import copy
import pickle
from array import array
from collections import UserList, UserString
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context

import numpy as np
import pytest

from linkwright.messages import (
    DefinitionError,
    InterfaceNotFoundError,
    Message,
    definition_text,
    deserialize,
    get_action,
    get_interface,
    get_message,
    get_service,
    interface_names,
    prototype,
    serialize,
    shipped_packages,
)
from linkwright.messages.catalog import read_texts
from linkwright.messages.definitions.library import LIBRARY
from linkwright.messages.definitions.slot_types import (
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
    UnboundedWString,
)
from tests.messages.random_messages import random_message, rosbags_store

DOUBLES = f"in [{-1.7976931348623157e308:f}, {1.7976931348623157e308:f}]"


def assignment_error(cls, name, value):
    message = cls()
    before = getattr(message, name)
    with pytest.raises(AssertionError) as caught:
        setattr(message, name, value)
    assert np.array_equal(getattr(message, name), before)
    return str(caught.value)


class TestChecks:
    def test_number_fields_reject_wrong_types_and_ranges(self):
        time = get_message("builtin_interfaces/msg/Time")
        assert assignment_error(time, "sec", 1.0) == "The 'sec' field must be of type 'int'"
        assert (
            assignment_error(time, "sec", 1 << 31) == "The 'sec' field must be an integer in [-2147483648, 2147483647]"
        )
        assert (
            assignment_error(time, "nanosec", -1)
            == "The 'nanosec' field must be an unsigned integer in [0, 4294967295]"
        )
        assert assignment_error(time, "sec", np.int32(1)) == "The 'sec' field must be of type 'int'"
        vector = get_message("geometry_msgs/msg/Vector3")
        assert assignment_error(vector, "x", 1) == "The 'x' field must be of type 'float'"
        color = get_message("std_msgs/msg/ColorRGBA")
        expected = "The 'r' field must be a float in [-3.402823466e+38, 3.402823466e+38]"
        assert assignment_error(color, "r", 1e39) == expected
        assert color(r=float("inf")).r == float("inf")
        assert vector(x=np.float64(2.5)).x == 2.5

    def test_bool_string_and_byte_fields_reject_wrong_types(self):
        assert (
            assignment_error(get_message("std_msgs/msg/Bool"), "data", 1) == "The 'data' field must be of type 'bool'"
        )
        assert (
            assignment_error(get_message("std_msgs/msg/String"), "data", b"a")
            == "The 'data' field must be of type 'str'"
        )
        assert assignment_error(get_message("std_msgs/msg/String"), "data", UserString("a"))
        expected = "The 'data' field must be of type 'bytes' or 'ByteString' with length 1"
        byte = get_message("std_msgs/msg/Byte")
        assert assignment_error(byte, "data", b"ab") == assignment_error(byte, "data", 1) == expected
        assert byte(data=bytearray(b"a")).data == b"a"
        bounded = get_message("test_msgs/msg/Strings")
        expected = "The 'bounded_string_value' field must be string value not longer than 22"
        assert assignment_error(bounded, "bounded_string_value", "x" * 23) == expected
        assert bounded(bounded_string_value=UserString("abc")).bounded_string_value == "abc"

    def test_nested_message_field_rejects_other_types(self):
        twist = get_message("geometry_msgs/msg/Twist")
        expected = "The 'linear' field must be a sub message of type 'Vector3'"
        assert assignment_error(twist, "linear", get_message("geometry_msgs/msg/Point")()) == expected

    def test_number_sequences_reject_wrong_values(self):
        laser = get_message("sensor_msgs/msg/LaserScan")
        floats = (
            "The 'ranges' field must be a set or sequence and each value of type 'float' and each float in "
            "[-340282346600000016151267322115014000640.000000, 340282346600000016151267322115014000640.000000]"
        )
        assert assignment_error(laser, "ranges", [1.0, 2]) == floats
        assert assignment_error(laser, "ranges", [1e39]) == floats
        assert assignment_error(laser, "ranges", 3.0) == floats
        assert assignment_error(laser, "ranges", "ab") == floats
        assert (
            assignment_error(laser, "ranges", array("d")) == "The 'ranges' array.array() must have the type code of 'f'"
        )
        assert DOUBLES in assignment_error(get_message("sensor_msgs/msg/JointState"), "position", ["a"])
        image = get_message("sensor_msgs/msg/Image")
        expected = (
            "The 'data' field must be a set or sequence and each value of type 'int' "
            "and each unsigned integer in [0, 255]"
        )
        assert assignment_error(image, "data", [256]) == assignment_error(image, "data", np.array([300])) == expected
        assert assignment_error(image, "data", np.array([1.5])) == expected

    def test_bounded_sequences_and_arrays_reject_wrong_length(self):
        cls = get_message("test_msgs/msg/BoundedSequences")
        begin = "The 'int32_values' field must be a set or sequence with length <= 3 and each value of type 'int'"
        assert assignment_error(cls, "int32_values", [1, 2, 3, 4]).startswith(begin)
        expected = "The 'int32_values' array.array() must have a size <= 3"
        assert assignment_error(cls, "int32_values", array("i", range(4))) == expected
        assert assignment_error(cls, "string_values", ["a"] * 4) == (
            "The 'string_values' field must be a set or sequence with length <= 3 and each value of type 'str'"
        )
        arrays = get_message("test_msgs/msg/Arrays")
        expected = "The 'float32_values' numpy.ndarray() must have the dtype of 'numpy.float32'"
        assert assignment_error(arrays, "float32_values", np.zeros(3)) == expected
        expected = "The 'float64_values' numpy.ndarray() must have a size of 3"
        assert assignment_error(arrays, "float64_values", np.zeros(4)) == expected
        assert assignment_error(arrays, "bool_values", [True]) == (
            "The 'bool_values' field must be a set or sequence with length 3 and each value of type 'bool'"
        )
        assert assignment_error(arrays, "int8_values", [1, 2]) == (
            "The 'int8_values' field must be a set or sequence with length 3 and each value of type 'int' "
            "and each integer in [-128, 127]"
        )

    def test_message_sequences_reject_other_types(self):
        path = get_message("nav_msgs/msg/Path")
        expected = "The 'poses' field must be a set or sequence and each value of type 'PoseStamped'"
        assert assignment_error(path, "poses", [1]) == expected

    def test_constructor_rejects_unknown_arguments(self):
        with pytest.raises(AssertionError, match=r"^Invalid arguments passed to constructor: datum, foo$"):
            get_message("std_msgs/msg/String")(foo=1, data="a", datum=2)


class TestArrays:
    def test_fixed_size_arrays_are_numpy_arrays(self):
        info = get_message("sensor_msgs/msg/CameraInfo")(k=list(map(float, range(9))))
        assert info.k.dtype == np.float64
        assert info.k[4] == 4.0
        identity = np.eye(3).ravel()
        info.r = identity
        assert info.r is identity
        assert get_message("test_msgs/msg/Arrays")().bool_values == [False] * 3

    def test_sequences_share_memory_with_numpy(self):
        state = get_message("sensor_msgs/msg/JointState")()
        values = array("d", [1.0, 2.0])
        state.position = values
        assert state.position is values
        np.asarray(state.position)[0] = 7.0
        assert values[0] == 7.0
        for assigned in (
            (1.0, 2.0),
            UserList([1.0, 2.0]),
            np.array([1.0, 2.0]),
            np.array([1, 2]),
            np.float32([1.0, 2.0]),
        ):
            state.velocity = assigned
            assert state.velocity == array("d", [1.0, 2.0])

    def test_byte_sequences_accept_buffers_and_arrays(self):
        image = get_message("sensor_msgs/msg/Image")
        pixels = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
        for assigned in (pixels, pixels.tobytes(), bytearray(pixels.tobytes()), memoryview(pixels.tobytes())):
            assert image(data=assigned).data == array("B", range(24))
        assert image(data=pixels[:, ::2]).data.tolist() == pixels[:, ::2].ravel().tolist()

    def test_constructor_accepts_integers_for_floats_as_rclpy(self):
        assert get_message("sensor_msgs/msg/JointState")(position=[1, 2]).position == array("d", [1.0, 2.0])


def test_fields_have_declared_defaults():
    strings = get_message("test_msgs/msg/Strings")()
    assert strings.string_value_default4 == strings.string_value_default2 == "Hello'world!"
    assert strings.string_value_default5 == 'Hello"world!'
    assert get_message("test_msgs/msg/WStrings")().wstring_value_default3 == "ハローワールド"
    defaults = get_message("test_msgs/msg/Defaults")
    assert (defaults().bool_value, defaults().byte_value, defaults().char_value) == (True, b"2", 100)
    assert defaults.INT16_VALUE__DEFAULT == -1000
    sequences = get_message("test_msgs/msg/UnboundedSequences")
    assert sequences().bool_values_default == [False, True, False]
    assert sequences().byte_values_default == [b"\0", b"\1", b"\xff"]
    assert sequences().int16_values_default == array("h", [0, 32767, -32768])
    assert sequences().bool_values_default is not sequences().bool_values_default
    arrays = get_message("test_msgs/msg/Arrays")()
    assert arrays.int64_values_default.tolist() == [0, 2**63 - 1, -(2**63)]
    assert arrays.basic_types_values[0] is not arrays.basic_types_values[1]


def test_constants_are_class_attributes():
    constants = get_message("test_msgs/msg/Constants")
    assert (constants.BOOL_CONST, constants.BYTE_CONST, constants.FLOAT32_CONST) == (True, b"2", 1.125)
    assert get_message("test_msgs/msg/Strings").STRING_CONST == "Hello world!"
    assert get_service("nav_msgs/srv/LoadMap").Response.RESULT_UNDEFINED_FAILURE == 255
    assert "MAP" not in get_service("nav_msgs/srv/LoadMap").Request.__dict__


def test_class_metadata_matches_rclpy():
    cls = get_message("test_msgs/msg/BoundedSequences")
    types = cls.get_fields_and_field_types()
    assert types["float64_values"] == "sequence<double, 3>"
    assert types["byte_values"] == "sequence<octet, 3>"
    assert types["char_values"] == "sequence<uint8, 3>"
    assert types["basic_types_values"] == "sequence<test_msgs/BasicTypes, 3>"
    types["more"] = "x"
    assert "more" not in cls.get_fields_and_field_types()
    assert get_message("test_msgs/msg/Strings").get_fields_and_field_types()["bounded_string_value"] == "string<22>"
    assert get_message("geometry_msgs/msg/PoseWithCovariance").get_fields_and_field_types() == {
        "pose": "geometry_msgs/Pose",
        "covariance": "double[36]",
    }
    state = get_message("sensor_msgs/msg/JointState")
    assert list(state.__slots__) == ["_header", "_name", "_position", "_velocity", "_effort"]
    assert (
        NamespacedType(["std_msgs", "msg"], "Header"),
        UnboundedSequence(UnboundedString()),
        *[UnboundedSequence(BasicType("double"))] * 3,
    ) == state.SLOT_TYPES
    assert state.SLOT_TYPES[0].namespaced_name() == ("std_msgs", "msg", "Header")
    assert get_message("sensor_msgs/msg/CameraInfo").SLOT_TYPES[5] == Array(BasicType("double"), 9)
    assert get_message("test_msgs/msg/Strings").SLOT_TYPES[-1] == BoundedString(22)
    assert get_message("test_msgs/msg/WStrings").SLOT_TYPES[5] == BoundedSequence(UnboundedWString(), 3)


def test_repr_matches_rclpy():
    assert repr(get_message("std_msgs/msg/String")(data="hi")) == "std_msgs.msg.String(data='hi')"
    message = get_message("trajectory_msgs/msg/JointTrajectoryPoint")(positions=[1.0, 2.5])
    assert repr(message) == (
        "trajectory_msgs.msg.JointTrajectoryPoint(positions=[1.0, 2.5], velocities=[], accelerations=[], effort=[], "
        "time_from_start=builtin_interfaces.msg.Duration(sec=0, nanosec=0))"
    )
    uuid = get_message("unique_identifier_msgs/msg/UUID")()
    assert repr(uuid).startswith("unique_identifier_msgs.msg.UUID(uuid=array([0, 0,")
    assert repr(get_service("std_srvs/srv/SetBool").Request()) == "std_srvs.srv.SetBool_Request(data=False)"


@pytest.mark.parametrize("name", interface_names("msg"))
def test_copies_and_pickles_are_equal_and_independent(name):
    message = random_message(get_message(name), 11)
    for other in (copy.copy(message), copy.deepcopy(message), pickle.loads(pickle.dumps(message))):
        assert type(other) is type(message)
        assert other == message
        assert other is not message
    assert message != "a"


def test_messages_are_not_hashable():
    with pytest.raises(TypeError):
        hash(get_message("std_msgs/msg/String")())


def test_shipped_interfaces_can_be_instantiated():
    assert len(shipped_packages()) >= 28
    for package in shipped_packages():
        for name in read_texts(package):
            cls = get_interface(f"{package}/{name}")
            assert f"{package}/{name}" == cls.TYPE_NAME
            assert definition_text(cls) == read_texts(package)[name]
            assert prototype(cls)
            assert cls is get_interface(f"{package}/{name}")


def test_humble_messages_match_rosbags():
    store = rosbags_store()
    assert set(store.fielddefs) <= set(interface_names("msg"))
    for name, (constants, fields) in store.fielddefs.items():
        structure = LIBRARY.structure(name)
        expected = [field for field, _ in fields if field != "structure_needs_at_least_one_member"]
        assert [field.name for field in structure.fields] == expected
        assert [constant.name for constant in structure.constants] == [constant[0] for constant in constants]


def test_service_class_has_request_response_and_event():
    cls = get_service("std_srvs/srv/SetBool")
    assert cls is get_service("std_srvs/SetBool")
    assert cls.Request(data=True).data is True
    assert cls.Request is get_message("std_srvs/srv/SetBool_Request")
    assert cls.Request.TYPE_NAME == "std_srvs/srv/SetBool_Request"
    assert cls.__module__ == cls.Request.__module__ == "std_srvs.srv._set_bool"
    assert cls.Event(request=[cls.Request()]).info.event_type == 0
    with pytest.raises(NotImplementedError, match="Service classes can not be instantiated"):
        cls()


def test_action_class_has_goal_result_and_feedback():
    cls = get_action("example_interfaces/action/Fibonacci")
    assert cls.Goal(order=3).order == 3
    assert cls.Feedback().sequence == array("i")
    request = cls.Impl.SendGoalService.Request(goal=cls.Goal(order=2))
    assert request.goal_id == get_message("unique_identifier_msgs/msg/UUID")()
    assert cls.Impl.GetResultService.Response(status=4, result=cls.Result(sequence=[1])).status == 4
    assert cls.Impl.FeedbackMessage(feedback=cls.Feedback()).TYPE_NAME.endswith("Fibonacci_FeedbackMessage")
    assert cls.Impl.CancelGoalService is get_service("action_msgs/srv/CancelGoal")
    assert cls.Impl.GoalStatusMessage is get_message("action_msgs/msg/GoalStatusArray")
    with pytest.raises(NotImplementedError, match="Action classes can not be instantiated"):
        cls()


@pytest.mark.parametrize(
    ("getter", "name", "message", "hint"),
    [
        (get_message, "sensor_msgs/msg/JointStat", "no message 'sensor_msgs/msg/JointStat'", "'JointState'"),
        (get_message, "sensor_msg/msg/Imu", "no message 'sensor_msg/msg/Imu'", "'sensor_msgs'"),
        (get_message, "std_msgs/JointState", "no message 'std_msgs/JointState'", "'sensor_msgs/msg/JointState'"),
        (get_message, "turtlesim/msg/Xyzzy", "no message 'turtlesim/msg/Xyzzy'", "'turtlesim' defines Color, Pose"),
        (get_service, "std_msgs/msg/String", "no service 'std_msgs/msg/String'", "'std_msgs/msg/String' is a message"),
        (get_message, "std_srvs/srv/SetBool", "no message 'std_srvs/srv/SetBool'", "is a service"),
        (get_action, "std_srvs/SetBool", "no action 'std_srvs/SetBool'", "did you mean 'std_srvs/srv/SetBool'?"),
        (get_interface, "std_msgs.msg.String", "'std_msgs.msg.String' is not the name of", "'std_msgs/msg/String'"),
        (get_interface, "String", "'String' is not the name of a message, service or action", "'package/kind/Name'"),
        (get_message, "std_msgs/msg/String_Request", "no message 'std_msgs/msg/String_Request'", "String"),
    ],
)
def test_unknown_or_malformed_interface_name_is_rejected(getter, name, message, hint):
    get_service("std_srvs/srv/SetBool")  # a known interface is not found as another kind
    with pytest.raises(InterfaceNotFoundError) as caught:
        getter(name)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code in {"MSG101", "MSG102"}
    assert message in diagnostic.message
    assert hint in (diagnostic.hint or "")


def test_threads_get_same_class(interface_package):
    for number in range(20):
        interface_package.write("msg", f"Shared{number}", "std_msgs/Header header\nfloat64[] values\n")
    names = [f"{interface_package.name}/msg/Shared{number}" for number in range(20)] * 4
    with ThreadPoolExecutor(8) as pool:
        futures = [pool.submit(copy_context().run, get_message, name) for name in names]
        classes = [future.result() for future in futures]
    assert len(set(classes)) == 20
    assert all(issubclass(cls, Message) for cls in classes)


NAMES = """
string from
int32 class 3
float64[] lambda
int8 value
int8 other
int8 self
float64[] array [1, 2]
float64[2] np [1, 2]
string[2] range
bool[] list [true]
int8 set_other
int8 checks
int8 rest
"""


def test_fields_can_be_named_like_python_keywords(interface_package):
    interface_package.write("msg", "Words", NAMES)
    cls = get_message(f"{interface_package.name}/msg/Words")
    message = cls(**{"from": "a", "lambda": [1.0], "other": 4})
    assert getattr(message, "from") == "a"
    assert getattr(message, "class") == 3
    assert (message.other, message.set_other, message.array.tolist()) == (4, 0, [1.0, 2.0])
    assert cls(self=3).self == 3
    assert deserialize(serialize(message), cls) == message
    assert copy.deepcopy(message) == message


def test_invalid_definition_creates_no_class(interface_package):
    interface_package.write("msg", "Wrong", "int3 x\n")
    for _ in range(2):
        with pytest.raises(DefinitionError):
            get_message(f"{interface_package.name}/msg/Wrong")
    interface_package.write("msg", "Wrong", "int32 x\n")
    assert get_message(f"{interface_package.name}/msg/Wrong")().x == 0
