"""Diagnosis of mesh files that a parser rejects: the line, element or number that is wrong.

Error messages of parsers are in terms of their code, or of Python. This module examines only files that the parser
could not read, for common faults: a truncated file, another format than the extension, malformed numbers, missing
references.
"""

from __future__ import annotations

import json
import re
import struct
from collections.abc import Callable, Iterator
from math import isfinite

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, phrase
from linkwright.diagnostics.diagnostic import is_pointer
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import Any
from linkwright.xmltree import Element, parse

_WEB_PAGE_PATTERN = lazy_pattern(rb"\s*<(?:!doctype\s+)?html", re.IGNORECASE)

_STL_HEADER_BYTES, _STL_TRIANGLE_BYTES = 84, 50  # Sizes in a binary STL, in bytes.
_GLB_HEADER_BYTES, _CHUNK_HEADER_BYTES = 12, 8
_JSON_CHUNK = 0x4E4F534A
_COMPONENT_SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
_COMPONENT_COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_NUMBER_COUNTS = {"matrix": 16, "translate": 3, "scale": 3, "rotate": 4}


def find_fault(data: bytes, kind: str) -> Phrase | None:
    """Return a description of the first fault of a mesh file, or None if none is found.

    Args:
        data: the content of the file.
        kind: the file extension, without the dot.
    """
    if not data.strip():
        return phrase("it is empty")
    if is_pointer(data):
        return phrase("it is a Git LFS pointer: the mesh itself was not fetched")
    if _WEB_PAGE_PATTERN.match(data):
        return phrase("it is a web page, not a mesh")
    return next(_FAULT_FINDERS[kind](data), None) if kind in _FAULT_FINDERS else None


# --- STL and OBJ ---------------------------------------------------------------------------------------------------


def _find_stl_faults(data: bytes) -> Iterator[Phrase]:
    if data.lstrip().startswith(b"solid") and b"facet" in data[:1000]:
        yield from _find_text_stl_faults(data)
        return
    if len(data) < _STL_HEADER_BYTES:
        yield phrase(
            "it ends after {count} bytes, but the header of an STL has {header}",
            count=len(data),
            header=_STL_HEADER_BYTES,
        )
        return
    (declared_count,) = struct.unpack_from("<I", data, _STL_HEADER_BYTES - 4)
    triangle_count = (len(data) - _STL_HEADER_BYTES) // _STL_TRIANGLE_BYTES
    if declared_count > triangle_count:
        yield phrase(
            "its header declares {declared} triangles, but the file has {found}",
            declared=declared_count,
            found=triangle_count,
        )


def _find_text_stl_faults(data: bytes) -> Iterator[Phrase]:
    corners = 0
    for line_number, tokens in _split_lines(data):
        if tokens[0] == "vertex":
            corners += 1
            yield from _find_number_faults(line_number, tokens[1:], 3)
        elif tokens[0] == "endloop":
            if corners != 3:
                yield _add_line(line_number, phrase("a facet has {count} corners, not 3", count=corners))
            corners = 0


def _find_obj_faults(data: bytes) -> Iterator[Phrase]:
    vertices = sum(tokens[0] == "v" for _, tokens in _split_lines(data))
    for line_number, words in _split_lines(data):
        if words[0] == "v":
            yield from _find_number_faults(line_number, words[1:4], 3)
        elif words[0] == "f":
            for token in words[1:]:
                try:
                    index = int(token.partition("/")[0])
                except ValueError:
                    yield _add_line(line_number, phrase("'{text}' is not a vertex number", text=token))
                    continue
                if not 1 <= abs(index) <= vertices:
                    yield _add_line(
                        line_number,
                        phrase(
                            "there is no vertex {index}: the mesh has {count} vertices", index=index, count=vertices
                        ),
                    )


def _split_lines(data: bytes) -> Iterator[tuple[int, list[str]]]:
    for line_number, line in enumerate(data.decode("utf-8", "replace").splitlines(), 1):
        tokens = line.split()
        if tokens:
            yield line_number, tokens


def _find_number_faults(line: int, tokens: list[str], count: int) -> Iterator[Phrase]:
    yield from (
        _add_line(line, phrase("'{text}' is not a finite number", text=token))
        for token in tokens
        if not _is_number(token)
    )
    if len(tokens) != count:
        yield _add_line(
            line, phrase("{count} numbers are needed, but there are {found}", found=len(tokens), count=count)
        )


def _is_number(token: str) -> bool:
    try:
        return isfinite(float(token))
    except ValueError:
        return False


def _add_line(line: int, fault: Phrase) -> Phrase:
    return phrase("line {line}: {problem}", line=line, problem=fault)


# --- COLLADA -------------------------------------------------------------------------------------------------------


def _find_collada_faults(data: bytes) -> Iterator[Phrase]:
    try:
        root = parse(data, "<mesh>").root
    except LinkwrightError as error:
        diagnostic = error.diagnostics[0]
        yield _add_line(diagnostic.span.line, diagnostic.message) if diagnostic.span else diagnostic.message
        return
    if root.tag != "COLLADA":
        yield _add_element_line(root, phrase("the file begins with <{tag}>, not with <COLLADA>", tag=root.tag))
        return
    elements = list(root.walk())
    ids = {element.attributes["id"] for element in elements if "id" in element.attributes}
    for element in elements:
        yield from _find_element_faults(element, ids)
        if element.tag == "mesh":
            yield from _find_index_faults(element)
    if not any(element.tag == "geometry" for element in elements):
        yield phrase("it has no <geometry>")
    if not any(element.tag == "instance_geometry" for element in elements):
        yield phrase("none of its <node> elements has an <instance_geometry>, so there is nothing to draw")


def _find_element_faults(element: Element, ids: set[str]) -> Iterator[Phrase]:
    for name in ("source", "url"):
        value = element.attributes.get(name, "")
        if value.startswith("#") and value[1:] not in ids:
            message = phrase("<{tag}> refers to '{value}', which is not in the file", tag=element.tag, value=value)
            yield _add_element_line(element, message)
    if element.tag in ("triangles", "polylist", "polygons"):
        for child in element.elements("input"):
            if "offset" not in child.attributes:
                yield _add_element_line(child, phrase("<{tag}> has no attribute '{name}'", tag="input", name="offset"))
    if element.tag == "float_array" or element.tag in _NUMBER_COUNTS:
        yield from _find_list_faults(element, _is_number, phrase("a finite number"))
        count = element.attributes.get("count") if element.tag == "float_array" else str(_NUMBER_COUNTS[element.tag])
        number_count = len(element.text().split())
        if count != str(number_count):
            message = phrase(
                "<{tag}> has {found} numbers, but {count} are needed",
                tag=element.tag,
                found=number_count,
                count=count or "?",
            )
            yield _add_element_line(element, message)
    elif element.tag in ("p", "vcount"):
        yield from _find_list_faults(element, str.isdecimal, phrase("an index"))


def _find_index_faults(mesh: Element) -> Iterator[Phrase]:
    """Yield the faults of indices that are out of range of the mesh's lists."""
    counts = [element.attributes.get("count", "") for element in mesh.walk() if element.tag == "accessor"]
    vertex_count = max((int(count) for count in counts if count.isdecimal()), default=0)
    for element in mesh.walk():
        if element.tag == "p":
            max_index = max((int(word) for word in element.text().split() if word.isdecimal()), default=0)
            if max_index >= vertex_count:
                yield _add_element_line(
                    element,
                    phrase(
                        "there is no vertex {index}: the mesh has {count} vertices",
                        index=max_index,
                        count=vertex_count,
                    ),
                )


def _find_list_faults(element: Element, is_valid: Callable[[str], bool], expected: Phrase) -> Iterator[Phrase]:
    for token in element.text().split():
        if not is_valid(token):
            message = phrase("'{text}' in <{tag}> is not {type}", text=token, tag=element.tag, type=expected)
            yield _add_element_line(element, message)


def _add_element_line(element: Element, fault: Phrase) -> Phrase:
    span = element.span()
    return fault if span is None else _add_line(span.line, fault)


# --- glTF ----------------------------------------------------------------------------------------------------------


def _find_glb_faults(data: bytes) -> Iterator[Phrase]:
    if not data.startswith(b"glTF"):
        yield phrase("it does not begin with the letters glTF")
        return
    if len(data) < _GLB_HEADER_BYTES + _CHUNK_HEADER_BYTES:
        header = _GLB_HEADER_BYTES + _CHUNK_HEADER_BYTES
        yield phrase(
            "it ends after {count} bytes, but the header of a .glb has {header}", count=len(data), header=header
        )
        return
    version, length, size, chunk_type = struct.unpack_from("<IIII", data, 4)
    if version != 2:
        yield phrase("it is glTF {version}, but only glTF 2 is supported", version=version)
    if length > len(data):
        yield phrase("its header declares {declared} bytes, but the file has {found}", declared=length, found=len(data))
    if chunk_type != _JSON_CHUNK:
        yield phrase("its first chunk is not JSON")
        return
    binary_size = len(data) - (_GLB_HEADER_BYTES + 2 * _CHUNK_HEADER_BYTES + size)
    yield from _find_document_faults(data[_GLB_HEADER_BYTES + _CHUNK_HEADER_BYTES :][:size], max(binary_size, 0))


def _find_gltf_faults(data: bytes) -> Iterator[Phrase]:
    return _find_document_faults(data, None)


def _find_document_faults(text: bytes, binary_size: int | None) -> Iterator[Phrase]:
    """Yield the faults of a glTF file's JSON.

    `binary_size` is the size of its first buffer in bytes, or None if that is unknown.
    """
    try:
        document = json.loads(text)
    except ValueError as error:
        yield phrase("its JSON cannot be read: {error}", error=foreign(error))
        return
    if not isinstance(document, dict):
        yield phrase("its JSON is not an object")
        return
    try:
        yield from _find_reference_faults(document)
        yield from _find_range_faults(document, binary_size)
    except (AttributeError, TypeError, KeyError, IndexError):
        yield phrase("its JSON does not have the structure of glTF")


def _find_reference_faults(document: dict[str, Any]) -> Iterator[Phrase]:
    for number, node in enumerate(document.get("nodes", ())):
        yield from _find_missing_reference_faults(document, f"nodes[{number}].mesh", "meshes", node.get("mesh"))
    for number, mesh in enumerate(document.get("meshes", ())):
        for index, primitive in enumerate(mesh["primitives"]):
            location = f"meshes[{number}].primitives[{index}]"
            attributes = primitive["attributes"]
            if "POSITION" not in attributes:
                yield phrase("{entry} has no attribute '{name}'", entry=location, name="POSITION")
            for name, accessor in attributes.items():
                yield from _find_missing_reference_faults(
                    document, f"{location}.attributes.{name}", "accessors", accessor
                )
            yield from _find_missing_reference_faults(
                document, f"{location}.indices", "accessors", primitive.get("indices")
            )
    for number, accessor in enumerate(document.get("accessors", ())):
        location = f"accessors[{number}]"
        yield from _find_missing_reference_faults(
            document, f"{location}.bufferView", "bufferViews", accessor.get("bufferView")
        )
        for name, values in (("componentType", _COMPONENT_SIZES), ("type", _COMPONENT_COUNTS)):
            if accessor.get(name) not in values:
                yield phrase(
                    "{entry}.{name} is {value}, which glTF does not define",
                    entry=location,
                    name=name,
                    value=str(accessor.get(name)),
                )
    for number, view in enumerate(document.get("bufferViews", ())):
        yield from _find_missing_reference_faults(document, f"bufferViews[{number}].buffer", "buffers", view["buffer"])


def _find_missing_reference_faults(
    document: dict[str, Any], entry: str, kind: str, index: int | None
) -> Iterator[Phrase]:
    count = len(document.get(kind, ()))
    if index is not None and not 0 <= index < count:
        yield phrase(
            "{entry} is {index}, but the number of {kind} is {count}", entry=entry, index=index, count=count, kind=kind
        )


def _find_range_faults(document: dict[str, Any], binary_size: int | None) -> Iterator[Phrase]:
    views = document.get("bufferViews", [])
    for index, view in enumerate(views):
        buffer = document["buffers"][view["buffer"]]
        buffer_size = binary_size if binary_size is not None and "uri" not in buffer else buffer["byteLength"]
        if view.get("byteOffset", 0) + view["byteLength"] > buffer_size:
            yield phrase(
                "{entry} reaches beyond the {found} bytes of its buffer",
                entry=f"bufferViews[{index}]",
                found=buffer_size,
            )
    for index, accessor in enumerate(document.get("accessors", ())):
        if "bufferView" in accessor:
            element_size = _COMPONENT_SIZES[accessor["componentType"]] * _COMPONENT_COUNTS[accessor["type"]]
            end = accessor.get("byteOffset", 0) + element_size * accessor["count"]
            if end > views[accessor["bufferView"]]["byteLength"]:
                yield phrase("{entry} reaches beyond its bufferView", entry=f"accessors[{index}]")


_FAULT_FINDERS: dict[str, Callable[[bytes], Iterator[Phrase]]] = {
    "stl": _find_stl_faults,
    "obj": _find_obj_faults,
    "dae": _find_collada_faults,
    "glb": _find_glb_faults,
    "gltf": _find_gltf_faults,
}
