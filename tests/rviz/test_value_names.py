"""Values of properties in the page's Chinese: files keep RViz's words."""

from __future__ import annotations

import json
import re
import subprocess
import sys

from tests.places import REPOSITORY

UNTRANSLATED_VALUES = {"RGB", "RGB8", "RGBF32", "X", "XY", "XYZ", "XZ", "Y", "YZ", "Z", "compressed", "compressedDepth"}
UNTRANSLATED_VALUES |= {"costmap", "map", "raw", "theora", "Float32", "Int32", "70%", "85%", "95%", "99%"}
"""Names that are not translated: axes, types, fields of messages, transports, shares, and names of color schemes."""

LIST_CHOICES = """
import gc, importlib, json, pkgutil
from linkwright.rviz import displays
from linkwright.rviz import config
from linkwright.rviz.config.schema import PropertySpec
for package in (displays, config):
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        importlib.import_module(module.name)
specs = [spec for spec in gc.get_objects() if isinstance(spec, PropertySpec) and spec.kind == "enum"]
print(json.dumps([option for spec in specs for option in spec.options]))
"""
"""Prints all choices. Functions create some of the rows, so the program searches the objects of a new interpreter."""


def test_property_choices_match_chinese_value_names():
    run = subprocess.run([sys.executable, "-c", LIST_CHOICES], capture_output=True, text=True, check=True, timeout=120)
    choices = set(json.loads(run.stdout))
    text = (REPOSITORY / "frontend/src/strings/zh/values.ts").read_text(encoding="utf-8")
    named = {quoted or unquoted for quoted, unquoted in re.findall(r'^  (?:"([^"]+)"|(\w+)): "', text, re.MULTILINE)}
    assert len(choices) > 40
    assert sorted(choices - UNTRANSLATED_VALUES - named) == []
    assert sorted(named - choices) == []
