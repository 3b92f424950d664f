"""The protocol between page and server: generated types, and binary layouts."""

from __future__ import annotations

import struct
import subprocess
import sys

import numpy as np
import pytest

from linkwright.page.protocol.configuration import StatusRow
from linkwright.page.protocol.message import pack_transforms
from tests.places import REPOSITORY
from tests.repository_tools import load_tool

protocol_types = load_tool("protocol_types")


def test_page_types_match_server_types():
    script = REPOSITORY / "tools" / "protocol_types.py"
    result = subprocess.run([sys.executable, str(script), "--check"], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


def test_stale_type_files_are_found_and_removed(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(protocol_types, "FOLDER", tmp_path)
    assert protocol_types.main([]) == 0
    assert protocol_types.main(["--check"]) == 0
    (tmp_path / "gone.ts").write_text("export interface Gone {}\n", encoding="utf-8")
    (tmp_path / "robot.ts").write_text("", encoding="utf-8")
    assert protocol_types.main(["--check"]) == 1
    assert [line.split(" ")[0] for line in capsys.readouterr().err.splitlines()] == [
        str(tmp_path / "gone.ts"),
        str(tmp_path / "robot.ts"),
    ]
    assert protocol_types.main([]) == 0
    assert protocol_types.main(["--check"]) == 0
    assert not (tmp_path / "gone.ts").exists()


def test_type_file_imports_types_of_other_files():
    files = protocol_types.generate()
    assert 'import type { LinkInertia } from "./description";' in files["robot.ts"]
    assert "  inertia: LinkInertia | null;" in files["robot.ts"]
    assert "export interface LinkInertia {" in files["description.ts"]
    assert 'export * from "./description";' in files["index.ts"]
    assert max(text.count("\n") for name, text in files.items() if name != "index.ts") < 400


def test_records_compare_and_print_like_dataclasses():
    row = StatusRow("Topic", "ok", "OK")
    assert row == StatusRow("Topic", "ok", "OK")
    assert row != StatusRow("Topic", "warn", "OK")
    assert row != ("Topic", "ok", "OK")
    assert repr(row) == "StatusRow(name='Topic', level='ok', text='OK')"
    assert not hasattr(row, "__dict__")
    with pytest.raises(TypeError, match="unhashable"):
        hash(row)


def test_transform_frame_has_documented_layout():
    poses = np.array([[1, 2, 3, 0, 0, 0, 1], [np.nan] * 7])
    frame = pack_transforms(7, 1.5, poses, np.array([0.0, 2.5]))
    assert struct.unpack_from("<IIIId", frame) == (1, 7, 2, 0, 1.5)
    numbers = struct.unpack_from("<16f", frame, 24)
    assert numbers[:7] == (1, 2, 3, 0, 0, 0, 1)
    assert all(np.isnan(numbers[7:14]))
    assert numbers[14:] == (0.0, 2.5)
    assert len(frame) == 24 + 16 * 4


@pytest.mark.parametrize(("poses", "ages"), [((2, 6), (2,)), ((2, 7), (3,)), ((14,), (2,))])
def test_mismatched_array_shapes_are_reported(poses, ages):
    with pytest.raises(ValueError, match=r"\(N, 7\)"):
        pack_transforms(1, 0.0, np.zeros(poses), np.zeros(ages))
