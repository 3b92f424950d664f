"""The targets of fuzzing, with the properties that hold for every input.

For each target: nothing but a `LinkwrightError` is raised, its diagnostics can be printed, what comes out can be read
again, and it takes less than a second of processor time.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from random import Random

from fuzz import documents, interfaces, robots, worlds
from fuzz.choices import Choices
from fuzz.expressions import expression
from linkwright.diagnostics import LinkwrightError, has_errors, render, to_data
from linkwright.kinematics import KinematicTree
from linkwright.packages import PackageFinder
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.sdf.frames import placed_links
from linkwright.sdf.includes import resolve_includes
from linkwright.sdf.listing import list_contents
from linkwright.sdf.reader import read as read_world
from linkwright.sdf.references import check_references
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.saved import with_saved_state
from linkwright.sdf.text import parse_as_gazebo
from linkwright.urdf import read, save, to_gv, tree_text
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xacro import cache, expand
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.expressions.yaml_data import YamlError, load
from linkwright.xacro.faults import Fault
from linkwright.xacro.limits import Limits, recursion_limit_for
from linkwright.xacro.session import Session
from linkwright.xmltree import Comment, parse, write

BUILT_IN = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
_LIMITS = Limits()
_SMALL_LIMITS = Limits(depth=40, elements=5_000, steps=100_000)
"""For whole descriptions: half of what a fuzzer finds interesting is recursion that runs into the limits."""
_LONGEST_OUTPUT = 10_000_000
"""Characters; a fuzzer's inputs are a few hundred bytes."""
_FIXED = {"items": [3, 1, 2], "data": {"a": 1, "b": [1, {"c": 2}]}, "name": "r", "a": 1, "b": 2.5, "n": 3}


def check_xml(text: str) -> None:
    """Check that a document can be written, read again, and written with the same result."""
    try:
        document = parse(text, "fuzz.xml")
    except LinkwrightError as error:
        _check_printable(error)
        return
    try:
        written = write(document)
    except LinkwrightError as error:
        _check_printable(error)
        return
    if document.doctype is None:
        assert write(parse(written, "again.xml")).split() == written.split()


def check_expansion(files: documents.Files) -> None:
    """Check that an expanded description is a readable document, and the same one each time."""
    folder = Path(_FOLDER.name)
    _save(folder / "other.xacro", files.other)
    _save(folder / "data.yaml", files.data)
    packages = {"pkg": str(folder)}
    try:
        expansion = expand(
            folder / "main.xacro", {"given": "1"}, packages=packages, text=files.main, limits=_SMALL_LIMITS
        )
    except LinkwrightError as error:
        _check_printable(error)
        return
    for diagnostic in expansion.diagnostics:
        render(diagnostic)
    expansion.document.prolog = [node for node in expansion.document.prolog if not isinstance(node, Comment)]
    try:
        written = write(expansion.document)
    except LinkwrightError as error:
        _check_printable(error)
        return
    assert len(written) <= _LONGEST_OUTPUT
    if expansion.document.doctype is None and not any(ord(sign) < 32 and sign not in "\t\n\r" for sign in written):
        parse(written, "expansion.xml")


def check_expression(source: str) -> None:
    """Check that an expression has a printable value, or its mistake is reported with its position."""
    session = Session("main.xacro", {"name": "r", "n": "3"}, {}, _LIMITS)
    scope = Scope(session.globals, session, dict(_FIXED, items=[3, 1, 2]))
    for text in ("${" + source + "}", "a ${" + source + "} b"):
        fault = _fault_of(session, text, scope)
        assert fault is None or fault.start is None or 0 <= fault.start <= len(text)


def _fault_of(session: Session, text: str, scope: Scope) -> Fault | None:
    try:
        with recursion_limit_for(_LIMITS):
            session.evaluate_text(text, scope)
    except Fault as fault:
        return fault
    except LinkwrightError as error:
        _check_printable(error)
    return None


def check_urdf(text: str) -> None:
    """Check that a robot can be written, and is the same when it is read again."""
    try:
        document, warnings = parse_as_urdfdom(text, "robot.urdf")
        reading = read(document)
    except LinkwrightError as error:
        _check_printable(error)
        return
    for diagnostic in (*warnings, *reading.diagnostics):
        assert render(diagnostic)
        assert to_data(diagnostic)["line"]
    robot = reading.robot
    if robot is None:
        assert reading.diagnostics
        return
    assert len(to_gv(robot)) + len(tree_text(robot)) <= _LONGEST_OUTPUT
    tree = KinematicTree(robot)
    tree.forward([0.0] * len(tree.joint_names))
    saved = save(robot)
    assert save(read(parse(saved, "saved.urdf")).robot or robot) == saved


def check_world(text: str) -> None:
    """Check that a world can be printed, and all its contents are listed or reported."""
    folder = Path(_FOLDER.name)
    try:
        document, warnings = parse_as_gazebo(text, str(folder / "fuzz.sdf"))
    except LinkwrightError as error:
        _check_printable(error)
        return
    reading = read_world(document)
    found = [*warnings, *reading.diagnostics]
    if reading.sdf is None:
        assert found
    else:
        included = resolve_includes(reading.sdf, folder / "fuzz.sdf", _NO_MODELS)
        found += [*included.diagnostics, *check_references(included.sdf)]
        assert len(list_contents(included.sdf)) <= _LONGEST_OUTPUT
        for world in map(with_saved_state, included.sdf.worlds):
            if not has_errors(found):
                assert all(place.name for place in placed_links(world))
    for diagnostic in found:
        assert render(diagnostic)
        assert to_data(diagnostic)["line"]


def check_yaml(text: str) -> None:
    """Check that a YAML file has a value, or a mistake."""
    session = Session("main.xacro", {}, {}, _LIMITS)
    try:
        load(text, session._evaluate_unit)
    except (YamlError, Fault):
        return


def check_rviz(text: str) -> None:
    """Check that a configuration can be written and read again."""
    try:
        config = RvizConfig.parse(text)
    except LinkwrightError as error:
        _check_printable(error)
        return
    for diagnostic in config.warnings:
        render(diagnostic)
    for display in config.displays:
        assert display.enabled in (True, False)
    config.views.current = config.views.current
    RvizConfig.parse(config.text())


def _check_printable(error: LinkwrightError) -> None:
    assert sum(len(render(diagnostic)) for diagnostic in error.diagnostics) <= _LONGEST_OUTPUT
    for diagnostic in error.diagnostics:
        assert diagnostic.code in render(diagnostic)
        assert to_data(diagnostic)["message"]


def _save(path: Path, text: str) -> None:
    if _contents.get(path) != text:
        path.write_text(text, encoding="utf-8", errors="surrogatepass", newline="")
        cache.documents.values.clear()  # a file that changes twice in a clock tick seems unchanged
        _contents[path] = text


_FOLDER = tempfile.TemporaryDirectory(prefix="linkwright-fuzz-")
"""Of the files that a description includes or loads; it goes with the process."""
_contents: dict[Path, str] = {}
_NO_MODELS = ResourceFinder(PackageFinder(start=Path(_FOLDER.name), environment={}), {"HOME": _FOLDER.name})


def _text(data: bytes) -> str:
    return data.decode("utf-8", "replace")


def _raw_files(data: bytes) -> documents.Files:
    main, _, rest = _text(data).partition("\x1e")
    other, _, yaml = rest.partition("\x1e")
    return documents.Files(main, other or f"{documents.HEAD}/>", yaml)


TARGETS: dict[str, Callable[[bytes], None]] = {
    "xacro": lambda data: check_expansion(documents.files(Choices(data))),
    "xacro-text": lambda data: check_expansion(_raw_files(data)),
    "attribute": lambda data: check_expansion(
        documents.Files(f'{BUILT_IN}<a v="{documents.text(Choices(data))}"/></robot>', f"{BUILT_IN}</robot>", "")
    ),
    "expression": lambda data: check_expression(expression(Choices(data))),
    "expression-text": lambda data: check_expression(_text(data).replace("}", "")),
    "urdf": lambda data: check_urdf(robots.urdf(Choices(data))),
    "urdf-text": lambda data: check_urdf(_text(data)),
    "world": lambda data: check_world(worlds.world(Choices(data))),
    "world-text": lambda data: check_world(_text(data)),
    "xml-text": lambda data: check_xml(_text(data)),
    "yaml": lambda data: check_yaml(documents.yaml_text(Choices(data))),
    "yaml-text": lambda data: check_yaml(_text(data)),
    "rviz": lambda data: check_rviz(robots.rviz(Choices(data))),
    "rviz-text": lambda data: check_rviz(_text(data)),
    "interface": lambda data: interfaces.check_interface(interfaces.words(Choices(data))),
    "interface-text": lambda data: interfaces.check_interface(_text(data)),
    "idl-text": lambda data: interfaces.check_idl(_text(data)),
    "message": lambda data: interfaces.check_message(interfaces.message_bytes(Choices(data))),
    "message-raw": interfaces.check_message,
}
"""Name -> what takes an input. Those with ``-text`` take the bytes as the text, the others decide a grammar by them."""


def seeds(name: str) -> list[bytes]:
    """Return the first inputs of a target: random decisions, or texts that a grammar makes of them."""
    random = Random(name)
    decisions = [random.randbytes(random.randrange(4, 400)) for _ in range(_SEEDS)]
    write_text = _SEED_TEXTS.get(name)
    if write_text is None:
        return decisions
    return [write_text(Choices(data)).encode("utf-8", "replace") for data in decisions]


def hard_seeds(name: str) -> list[str]:
    """Return texts of the kinds that once took too long, or too much memory."""
    return _HARD_SEEDS.get(name, [])


_CHAIN = "".join(
    f'<link name="{n}"/><joint name="j{n}" type="fixed"><parent link="{n}"/><child link="{n + 1}"/></joint>'
    for n in range(20)
)
_HARD_EXPRESSIONS = [
    r"xacro.tokenize('\\' + 'a'*34, '\\\\](a+)+b')",
    "len(python.set([i*2305843009213693951 for i in python.range(60000)]))",
    "dict([(i*2305843009213693951, i) for i in python.range(60000)])",
    "9**9**9",
    "[[x for x in python.range(1000)] for y in python.range(1000)]",
    "'%99999999d' % 1",
    "f'{1:>99999999999",
    "'a'*10**6*10**6",
]
_HARD_SEEDS: dict[str, list[str]] = {
    "expression-text": _HARD_EXPRESSIONS,
    "xacro-text": [
        f'{BUILT_IN}<a v="${{{hard_expression.replace("<", "&lt;")}}}"/></robot>'
        for hard_expression in _HARD_EXPRESSIONS
    ],
    "yaml-text": [
        "{" + ", ".join(f"{n * 2305843009213693951}: 1" for n in range(60)) + "}",
        "a: &a [x, x, x]\nb: &b [*a, *a, *a]\nc: &c [*b, *b, *b]\nd: [*c, *c, *c]",
        "[" * 150 + "]" * 150,
    ],
    "urdf-text": [f'<robot name="r">{_CHAIN}<link name="20"/></robot>'],
    "xml-text": [
        "<a>" * 250 + "</a>" * 250,
        "<a " + " ".join(f'a{n}="1"' for n in range(200)) + "/>",
        '<!DOCTYPE a [<!ENTITY b "cccccccc"><!ENTITY d "&b;&b;&b;&b;&b;">]><a>&d;&d;&d;&d;</a>',
    ],
}

_SEEDS = 300
_SEED_TEXTS: dict[str, Callable[[Choices], str]] = {
    "interface-text": interfaces.words,
    "xacro-text": lambda choices: "\x1e".join(documents.files(choices)),
    "expression-text": expression,
    "urdf-text": robots.urdf,
    "world-text": worlds.world,
    "xml-text": lambda choices: documents.files(choices).main,
    "yaml-text": documents.yaml_text,
    "rviz-text": robots.rviz,
}
