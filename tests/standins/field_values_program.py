"""Assign values to fields of messages, and print the results as JSON.

The program runs with real ROS 2 and with Linkwright.
"""

import json
from array import array
from collections import UserList

import numpy as np
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import Float32, Float64, Int32
from test_msgs.msg import Arrays, BoundedSequences, UnboundedSequences

PIXELS = np.arange(12, dtype=np.uint8)
NUMBERS = np.array([0.5, 1.5])

CASES = {
    (Image, "data"): {
        "numpy": PIXELS,
        "numpy of rows": PIXELS.reshape(3, 4),
        "numpy of other integers": PIXELS.astype(np.int64),
        "numpy of floats": PIXELS.astype(float),
        "bytes": PIXELS.tobytes(),
        "bytearray": bytearray(PIXELS),
        "memoryview": memoryview(PIXELS.tobytes()),
        "list": PIXELS.tolist(),
        "list of numpy's": list(PIXELS),
        "tuple": (1, 2),
        "range": range(3),
        "generator": (number for number in (1, 2)),
        "too large": [256],
        "array": array("B", [1, 2]),
        "array of another type": array("b", [1, 2]),
        "array of too large ones": array("i", [256]),
        "text": "ab",
        "none": None,
    },
    (JointState, "position"): {
        "numpy": NUMBERS,
        "numpy of float32": NUMBERS.astype(np.float32),
        "numpy of rows": NUMBERS.reshape(1, 2),
        "no numbers": np.array([]),
        "list": [0.5],
        "list of integers": [1, 2],
        "list of numpy's": list(NUMBERS),
        "list of numpy's float32": list(NUMBERS.astype(np.float32)),
        "UserList": UserList([0.5]),
        "bytes": b"\0" * 16,
        "array of another type": array("f", [0.5]),
        "text": "ab",
    },
    (CameraInfo, "k"): {
        "numpy": np.arange(9.0),
        "numpy of rows": np.arange(9.0).reshape(3, 3),
        "numpy of float32": np.arange(9, dtype=np.float32),
        "too few in numpy": np.arange(8.0),
        "list": [0.5] * 9,
        "list of integers": [1] * 9,
        "too short": [0.5] * 8,
    },
    (UnboundedSequences, "bool_values"): {
        "numpy": np.array([True, False]),
        "list": [True],
        "list of numpy's": [np.bool_(True)],
    },
    (UnboundedSequences, "string_values"): {"numpy": np.array(["a"]), "tuple": ("a",), "text": "ab"},
    (UnboundedSequences, "int16_values"): {"numpy": np.array([1], np.int16), "buffer": memoryview(b"ab")},
    (BoundedSequences, "int32_values"): {"numpy": np.arange(3, dtype=np.int32), "too many": [1, 2, 3, 4]},
    (BoundedSequences, "uint8_values"): {"bytes": b"abc", "too many bytes": b"abcd"},
    (Arrays, "bool_values"): {"numpy": np.array([True] * 3), "list": [True] * 3},
    (Float64, "data"): {"numpy's": np.float64(0.5), "numpy's float32": np.float32(0.5), "integer": 1},
    (Float32, "data"): {"numpy's": np.float64(0.5), "too large": 1e39},
    (Int32, "data"): {"numpy's": np.int32(1), "bool": True, "too large": 2**31, "float": 1.0},
}


def outcome_of(assign, field):
    try:
        value = getattr(assign(), field)
    except AssertionError as error:
        return str(error)
    except Exception as error:  # noqa: BLE001 - whichever
        return type(error).__name__
    values = np.asarray(value).tolist()
    return [type(value).__name__, values]


def message_with_field(message_class, field, value):
    message = message_class()
    setattr(message, field, value)
    return message


def main():
    facts = {}
    for (message_class, field), values in CASES.items():
        for name, value in values.items():
            for way, assign in (
                ("set", lambda: message_with_field(message_class, field, value)),  # noqa: B023 - called at once
                ("made", lambda: message_class(**{field: value})),  # noqa: B023
            ):
                facts[f"{message_class.__name__}.{field} {way} of {name}"] = outcome_of(assign, field)
    print(json.dumps(facts))


if __name__ == "__main__":
    main()
