"""The tables of names, compared with real modules of Jazzy.

LINKWRIGHT_ROS_PYTHON names an interpreter that has these modules.
"""

from __future__ import annotations

import json
import os
import subprocess

import pytest

from linkwright.standins import table

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
GONE_SINCE_HUMBLE = {"rclpy.time.CONVERSION_CONSTANT", "rclpy.qos_overriding_options._declare_qos_parameteres"}
AFTER_JAZZY = ("kilted", "rolling")

INSPECTION_PROGRAM = """
import importlib, json, sys
lacking = []
for module, names in json.load(sys.stdin).items():
    try:
        real = importlib.import_module(module)
    except ModuleNotFoundError:
        continue
    lacking += [f"{module}.{name}" for name in names if not hasattr(real, name)]
print(json.dumps(lacking))
"""


@pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")
@pytest.mark.parametrize("package", ["rclpy", "ament_index_python", "rosidl_parser"])
def test_real_modules_have_names_of_tables(package):
    requested_names = {
        module.name: [name for name, origin in module.names.items() if origin.since not in AFTER_JAZZY]
        for module in table.read(package).values()
        if module.since not in AFTER_JAZZY
    }
    result = subprocess.run(
        [PYTHON, "-c", INSPECTION_PROGRAM],
        input=json.dumps(requested_names),
        env={**os.environ, "PYTHONPATH": ""},
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    assert set(json.loads(result.stdout)) - GONE_SINCE_HUMBLE == set()
