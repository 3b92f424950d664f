"""The names of the module ``xacro`` except the functions that expand descriptions."""

from __future__ import annotations

import math
from xml.dom import minidom

import pytest

import xacro
from tests.standins.conftest import HEAD


def test_print_location_shows_macro_and_include_stack(write, capsys):
    write("b.xacro", '<xacro:macro name="in">${xacro.print_location()}</xacro:macro>')
    write("c.xacro", '<xacro:macro name="out"><xacro:in/><xacro:call macro="in"/></xacro:macro><xacro:out/>')
    path = write("a.xacro", '<xacro:include filename="b.xacro"/><xacro:include filename="c.xacro"/>')
    xacro.process_file(str(path))
    folder = path.parent
    expected = (
        f"when instantiating macro: in ({folder}/b.xacro)\ninstantiated from: out ({folder}/c.xacro)\n"
        f"in file: {folder}/c.xacro\nincluded from: {path}\n"
    )
    assert capsys.readouterr().err == expected * 2
    assert xacro.filestack == [str(path)]
    assert xacro.macrostack == []


def test_failed_expansion_keeps_file_stack(write, capsys):
    write("b.xacro", '<l n="${no}"/>')
    with pytest.raises(xacro.XacroException):
        xacro.process_file(write("a.xacro", '<xacro:include filename="b.xacro"/>'))
    assert [name.rpartition("/")[2] for name in xacro.filestack] == ["a.xacro", "b.xacro"]
    capsys.readouterr()
    xacro.print_location()
    assert capsys.readouterr().err.startswith("when processing file: ")


def test_abs_filename_spec_is_relative_to_current_file():
    xacro.init_stacks("sub/a.xacro")
    assert xacro.abs_filename_spec("b.xacro") == "sub/b.xacro"
    assert xacro.abs_filename_spec("/b.xacro") == "/b.xacro"
    xacro.init_stacks(None)
    assert xacro.abs_filename_spec("b.xacro") == "./b.xacro"


def test_eval_text_and_safe_eval():
    symbols = xacro.Table({})
    symbols["a"] = "2"
    symbols["b"] = "${a * 3}"
    assert xacro.eval_text("${b + 1}", symbols) == 7
    assert xacro.eval_text("b is ${b}, $${b}", symbols) == "b is 6, ${b}"
    assert xacro.eval_text("${a}", {"a": [1]}) == [1]
    assert xacro.safe_eval(" a + b + pi", {"a": 1}, {"b": 2}) == 3 + math.pi
    for text in ("${no}", "${1/0}", "${", "${().__class__}", "${open('f')}"):
        with pytest.raises(xacro.XacroException):
            xacro.eval_text(text, symbols)


def test_eval_text_resolves_namespaces():
    symbols, inner_scope = xacro.Table({}), xacro.NameSpace()
    inner_scope["p"] = "4"
    symbols["A"] = inner_scope
    assert inner_scope.p == 4
    assert xacro.eval_text("${A.p}", symbols) == 4
    with pytest.raises(NameError):
        inner_scope.q  # noqa: B018 - asking is what is tested


def test_resolve_args_evaluates_substitutions(monkeypatch):
    monkeypatch.setenv("V", "1")
    assert xacro.eval_extension("$(env V)") == "1"
    resolve = xacro.substitution_args.resolve_args
    assert resolve("a $(arg x) $(optenv W d)", {"arg": {"x": "1"}}) == "a 1 d"
    assert resolve("") == ""
    assert resolve(None) is None
    with pytest.raises(xacro.substitution_args.ArgException):
        resolve("$(arg x)", {})
    with pytest.raises(xacro.substitution_args.SubstitutionException):
        resolve("$(find no_such_package)")


def test_load_yaml_returns_attribute_access(write):
    write("a.yaml", "a: {b: [{c: !degrees 180}]}\nkeys: 1\n")
    value = xacro.load_yaml("a.yaml")
    assert value.a.b[0].c == math.pi
    assert value["keys"] == 1
    assert not hasattr(value, "none")
    assert xacro.eval_text("${v.a.b[0].c}", {"v": value}) == math.pi
    assert xacro.dotify({"a": {"b": 1}}, c=2).a.b == 1
    with pytest.raises(xacro.XacroException):
        xacro.load_yaml("none.yaml")


def test_table_evaluates_lazily_and_inherits(capsys):
    language = {"pi": 3}
    top = xacro.Table(language)
    inner_scope = xacro.Table(top)
    assert (top.depth, inner_scope.depth, inner_scope.root is language, inner_scope.top() is top) == (0, 1, True, True)
    top["a"] = "'x'"
    assert top["a"] == "x"
    inner_scope["b"] = "${a}y"
    assert inner_scope["b"] == "xy"
    assert "pi" in inner_scope
    assert "b" not in top
    with pytest.raises(KeyError):
        top["b"]
    inner_scope["pi"] = "4"
    assert "redefining global symbol: pi" in capsys.readouterr().err
    del inner_scope["pi"]
    assert inner_scope["pi"] == 3
    assert "Cannot remove global symbol: pi" in capsys.readouterr().err
    top["c"] = "${d}"
    top["d"] = "${c}"
    with pytest.raises(xacro.XacroException, match="c -> d -> c"):
        top["c"]
    assert "parent" in str(inner_scope)


def test_table_logs_by_verbosity(capsys):
    xacro.verbosity = 3
    top = xacro.Table({})
    inner_scope = xacro.Table(top)
    xacro.init_stacks("a.xacro")
    top["a"] = "1"
    assert top["a"] == 1
    inner_scope["b"] = "1"
    assert capsys.readouterr().err == "set a: 1 (a.xacro)\nuse a: 1 (a.xacro)\n"
    xacro.verbosity = 4
    inner_scope["b"] = "2"
    assert capsys.readouterr().err == " set b: 2 (a.xacro)\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a b", ("a", None, "b")),
        ("a:=1 b", ("a", (None, "1"), "b")),
        ("a=^ b", ("a", ("a", None), "b")),
        ("a:=^|'x y' *b", ("a", ("a", "'x y'"), "*b")),
        ("*a", ("*a", None, "")),
    ],
)
def test_parse_macro_arg_splits_parameters(text, expected):
    assert xacro.parse_macro_arg(text) == expected


def test_parse_macro_arg_rejects_malformed_parameters():
    with pytest.raises(IndexError):
        xacro.parse_macro_arg("  ")
    with pytest.raises(xacro.XacroException):
        xacro.parse_macro_arg("a:='b")


def test_resolve_macro_searches_namespaces():
    inner_scope = {"m": 2}
    outer_scope = {"m": 1, "N": inner_scope}
    assert xacro.resolve_macro("m", outer_scope, outer_scope) == (outer_scope, outer_scope, 1)
    assert xacro.resolve_macro("N.m", outer_scope, outer_scope) == (inner_scope, inner_scope, 2)
    with pytest.raises(KeyError):
        xacro.resolve_macro("N.x", outer_scope, outer_scope)


def test_grab_functions_remove_definitions_from_document(capsys):
    document = minidom.parseString(
        f"""{HEAD}
        <!-- stays -->

        <!-- goes --><xacro:macro name="m" params="a b:=^|1"/>
        <!-- goes --><xacro:property name="p" value="2" odd="1"/>
        <xacro:property name="q" default="${{p}}"/><xacro:property name="block"><b/></xacro:property><l/></robot>"""
    )
    macros, table = xacro.Table(), xacro.Table({})
    root = document.documentElement
    (macro,) = root.getElementsByTagName("xacro:macro")
    xacro.grab_macro(macro, macros)
    for element in list(root.getElementsByTagName("xacro:property")):
        xacro.grab_property(element, table)
    assert macros["m"].params == ["a", "b"]
    assert macros["m"].defaultmap == {"b": ("b", "1")}
    assert (table["p"], table["q"]) == (2, 2)
    assert table["**block"].firstChild.tagName == "b"
    text = root.toxml()
    assert "goes" not in text
    assert "stays" in text
    assert "xacro:" not in text.partition(">")[2]
    assert "has unknown attributes: 'odd'" in capsys.readouterr().err


@pytest.mark.parametrize(
    "tag",
    [
        '<xacro:property name="1"/>',
        '<xacro:property name="__a"/>',
        '<xacro:property name="a" value="" default=""/>',
        '<xacro:property name="a" value="1" scope="parent"/>',
    ],
)
def test_grab_property_rejects_malformed_properties(tag):
    document = minidom.parseString(f"{HEAD}{tag}</robot>")
    with pytest.raises(xacro.XacroException):
        xacro.grab_property(document.documentElement.firstChild, xacro.Table({}))


@pytest.mark.parametrize("name", ["call", "a.b"])
def test_grab_macro_rejects_malformed_names(name):
    document = minidom.parseString(f'{HEAD}<xacro:macro name="{name}"/></robot>')
    with pytest.raises(xacro.XacroException):
        xacro.grab_macro(document.documentElement.firstChild, xacro.Table())


def test_grab_property_sets_outer_scopes():
    top = xacro.Table({})
    middle_scope = xacro.Table(top)
    inner_scope = xacro.Table(middle_scope)
    inner_scope["v"] = "5"
    document = minidom.parseString(
        f'{HEAD}<xacro:property name="g" value="${{v}}" scope="global"/>'
        '<xacro:property name="p" value="${v}" scope="parent"/>'
        '<xacro:property name="v" remove="true"/><xacro:property name="z" value="${p}" lazy_eval="false"/></robot>'
    )
    for element in list(document.documentElement.childNodes):
        xacro.grab_property(element, inner_scope)
    assert dict.__getitem__(top, "g") == 5
    assert dict.__getitem__(middle_scope, "p") == 5
    assert "v" not in inner_scope
    assert dict.__getitem__(inner_scope, "z") == 5


def test_node_functions_navigate_and_replace():
    document = minidom.parseString('<a x="1"><!-- c --><b><i/>t</b><c/></a>')
    root = document.documentElement
    first = xacro.first_child_element(root)
    assert first.tagName == "b"
    assert xacro.next_sibling_element(first).tagName == "c"
    assert xacro.next_sibling_element(xacro.next_sibling_element(first)) is None
    assert xacro.first_child_element(xacro.next_sibling_element(first)) is None
    xacro.replace_node(first, by=[first.cloneNode(deep=True)], content_only=True)
    assert root.toxml() == '<a x="1"><!-- c --><i/>t<c/></a>'
    assert xacro.opt_attrs(root, ["x", "y"]) == ["1", None]
    assert xacro.reqd_attrs(root, ["x"]) == ["1"]
    with pytest.raises(RuntimeError):
        xacro.reqd_attrs(root, ["y"])


def test_import_xml_namespaces_copies_declarations(capsys):
    document = minidom.parseString('<a xmlns:n="1"><b xmlns:n="2" xmlns:m="3" o="4"/></a>')
    root = document.documentElement
    xacro.import_xml_namespaces(root, root.firstChild.attributes)
    assert (root.getAttribute("xmlns:n"), root.getAttribute("xmlns:m")) == ("1", "3")
    assert not root.hasAttribute("o")
    assert "xmlns:n" in capsys.readouterr().err


def test_eval_default_arg_uses_outer_value_or_default():
    table = xacro.Table({})
    table["a"] = "1"
    assert xacro.eval_default_arg("a", "${2}", table, None) == 1
    assert xacro.eval_default_arg("b", "${2}", table, None) == 2
    assert xacro.eval_default_arg(None, "${a+2}", table, None) == 3
    with pytest.raises(xacro.XacroException):
        xacro.eval_default_arg("b", None, table, None)


def test_get_boolean_value_and_is_valid_name():
    assert xacro.get_boolean_value("true") is True
    assert xacro.get_boolean_value(0.0, "c") is False
    with pytest.raises(xacro.XacroException, match="'c' gives 'maybe'"):
        xacro.get_boolean_value("maybe", "c")
    assert xacro.is_valid_name("a_1")
    assert not xacro.is_valid_name("class")
    assert xacro.tokenize("a, b;c") == ["a", "b", "c"]
    assert "pi" in xacro.create_global_symbols()


def test_process_args_parses_command_line():
    options, file = xacro.cli.process_args(["-v", "a.xacro", "x:=1", "_y:=2", "z:=", "-o", "out"])
    assert file == "a.xacro"
    assert vars(options) == {
        "output": "out",
        "just_deps": False,
        "in_order": True,
        "root_dir": None,
        "verbosity": 2,
        "mappings": {"x": "1"},
    }
    options, file = xacro.cli.process_args(["x:=1", "-q"], require_input=False)
    assert (file, options.verbosity) == (None, 0)
    with pytest.raises(SystemExit):
        xacro.cli.process_args([])
    with pytest.raises(RuntimeError):
        xacro.cli.process_args(["a", "x:=1:=2"])


def test_message_functions_print_to_stderr(capsys):
    xacro.warning("w", 1)
    xacro.error("e")
    xacro.message("m", color="red")
    assert capsys.readouterr().err == "warning: w 1\nerror: e\nm\n"
    assert xacro.color.colorize("x", "red", alt_text="a: ") == "a: x"


def test_module_variables_can_be_reassigned():
    xacro.filestack = ["a"]
    xacro.macrostack = []
    assert xacro.filestack == ["a"]
    xacro.print_location()
    assert xacro.abs_filename_spec("b") == "b"
