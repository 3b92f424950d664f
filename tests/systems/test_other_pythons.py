"""What only some of the supported versions of Python refuse."""

from __future__ import annotations

import subprocess
import sys

from tests.systems.test_other_systems import IMPORT_ALL

FIND_MUTABLE_DEFAULTS = """
import dataclasses, inspect, sys, types
modules = [module for name, module in sys.modules.items() if name.startswith("linkwright")]
classes = {value for module in modules for value in vars(module).values() if inspect.isclass(value)}
for each in sorted(filter(dataclasses.is_dataclass, classes), key=repr):
    for field in dataclasses.fields(each):
        if isinstance(field.default, types.MappingProxyType) or type(field.default).__hash__ is None:
            print(each, field.name)
"""


def test_no_dataclass_has_a_default_that_python_3_11_refuses():
    # from Python 3.12, a MappingProxyType has a hash; in 3.10, dataclasses only refuse lists, dictionaries and sets
    program = [sys.executable, "-c", IMPORT_ALL + FIND_MUTABLE_DEFAULTS]
    result = subprocess.run(program, check=False, capture_output=True, text=True, timeout=120)
    assert (result.stdout, result.stderr) == ("all\n", "")
