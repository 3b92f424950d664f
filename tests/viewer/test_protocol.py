from __future__ import annotations

import struct
import subprocess
import sys

import numpy as np
import pytest

from linkwright.viewer.protocol import pack_transforms
from tests.places import REPOSITORY


def test_the_types_of_the_page_are_those_of_the_server():
    script = REPOSITORY / "tools" / "protocol_types.py"
    done = subprocess.run([sys.executable, str(script), "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_binary_frame_is_as_described():
    poses = np.array([[1, 2, 3, 0, 0, 0, 1], [np.nan] * 7])
    frame = pack_transforms(7, 1.5, poses, np.array([0.0, 2.5]))
    assert struct.unpack_from("<IIIId", frame) == (1, 7, 2, 0, 1.5)
    numbers = struct.unpack_from("<16f", frame, 24)
    assert numbers[:7] == (1, 2, 3, 0, 0, 0, 1)
    assert all(np.isnan(numbers[7:14]))
    assert numbers[14:] == (0.0, 2.5)
    assert len(frame) == 24 + 16 * 4


@pytest.mark.parametrize(("poses", "ages"), [((2, 6), (2,)), ((2, 7), (3,)), ((14,), (2,))])
def test_shapes_that_do_not_agree_are_named(poses, ages):
    with pytest.raises(ValueError, match=r"\(N, 7\)"):
        pack_transforms(1, 0.0, np.zeros(poses), np.zeros(ages))
