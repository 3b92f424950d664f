"""Stands in for ``xacro``."""

import sys

from linkwright.standins.xacro_api.colour import error, message, warning
from linkwright.standins.xacro_api.command_line import process_args
from linkwright.standins.xacro_api.errors import XacroException
from linkwright.standins.xacro_api.evaluation import (
    ConstructUnits,
    YamlDictWrapper,
    YamlListWrapper,
    create_global_symbols,
    dotify,
    eval_extension,
    eval_text,
    get_boolean_value,
    is_valid_name,
    load_yaml,
    safe_eval,
    tokenize,
)
from linkwright.standins.xacro_api.macros import Macro, parse_macro_arg, resolve_macro
from linkwright.standins.xacro_api.nodes import (
    attribute,
    check_attrs,
    eval_default_arg,
    first_child_element,
    grab_macro,
    grab_property,
    import_xml_namespaces,
    next_sibling_element,
    opt_attrs,
    remove_previous_comments,
    replace_node,
    reqd_attrs,
)
from linkwright.standins.xacro_api.processing import main, open_output, parse, process, process_doc, process_file
from linkwright.standins.xacro_api.stacks import STATE, LiveModule, abs_filename_spec, init_stacks, print_location
from linkwright.standins.xacro_api.tables import NameSpace, Table
from xacro import cli, color, substitution_args, xmlutils

all_includes = STATE.all_includes
sys.modules[__name__].__class__ = LiveModule

__all__ = [
    "ConstructUnits",
    "Macro",
    "NameSpace",
    "Table",
    "XacroException",
    "YamlDictWrapper",
    "YamlListWrapper",
    "abs_filename_spec",
    "all_includes",
    "attribute",
    "check_attrs",
    "cli",
    "color",
    "create_global_symbols",
    "dotify",
    "error",
    "eval_default_arg",
    "eval_extension",
    "eval_text",
    "first_child_element",
    "get_boolean_value",
    "grab_macro",
    "grab_property",
    "import_xml_namespaces",
    "init_stacks",
    "is_valid_name",
    "load_yaml",
    "main",
    "message",
    "next_sibling_element",
    "open_output",
    "opt_attrs",
    "parse",
    "parse_macro_arg",
    "print_location",
    "process",
    "process_args",
    "process_doc",
    "process_file",
    "remove_previous_comments",
    "replace_node",
    "reqd_attrs",
    "resolve_macro",
    "safe_eval",
    "substitution_args",
    "tokenize",
    "warning",
    "xmlutils",
]
