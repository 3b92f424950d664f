import { BufferAttribute, BufferGeometry } from "three";
import { strings } from "../../strings";
import { formatCount, MeshError } from "./mesh-error";
import { collapseNonFinite, describeNonFinite } from "./non-finite";
import type { MeshTemplate } from "./mesh-template";
import { readAsciiStl } from "./stl-text";

const HEADER_BYTES = 84;
const COUNT_OFFSET = 80;
const TRIANGLE_BYTES = 50;
/** The size of the normal with which a triangle begins: three floats. */
const NORMAL_BYTES = 12;
/** A byte order mark and the like may precede the text. */
const MAX_PREFIX_BYTES = 5;

/**
 * Reads STL, text or binary. As in RViz, it has no colors: the link's material applies. Normals are computed, because
 * exporters often leave them at zero.
 *
 * @throws MeshError if the file is not STL, or is damaged or truncated.
 */
export function readStl(data: ArrayBuffer): MeshTemplate {
  const positions = isText(data) ? readAsciiStl(new TextDecoder().decode(data)) : readBinary(data);
  if (positions.length === 0) throw new MeshError(strings.meshes.stl.none);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  const problem = describeNonFinite([collapseNonFinite(geometry)]);
  geometry.computeVertexNormals();
  return { parts: [{ geometry, materials: [null] }], problem };
}

/**
 * Whether a file is text. Binary files may begin with "solid", too, but have a matching length or, if truncated, zero
 * bytes.
 */
function isText(data: ArrayBuffer): boolean {
  const bytes = new Uint8Array(data);
  const start = String.fromCharCode(...bytes.subarray(0, HEADER_BYTES));
  const index = start.toLowerCase().indexOf("solid");
  const hasSolid = index >= 0 && (index <= MAX_PREFIX_BYTES || start.slice(0, index).trim() === "");
  if (!hasSolid) return false;
  const isWhole = bytes.length >= HEADER_BYTES && bytes.length === HEADER_BYTES + readTriangleCount(data) * TRIANGLE_BYTES;
  return !isWhole && !bytes.subarray(0, 4 * HEADER_BYTES).includes(0);
}

function readTriangleCount(data: ArrayBuffer): number {
  return new DataView(data).getUint32(COUNT_OFFSET, true);
}

function readBinary(data: ArrayBuffer): Float32Array {
  const texts = strings.meshes.stl;
  if (data.byteLength < HEADER_BYTES) throw new MeshError(texts.short(formatCount(data.byteLength)));
  const count = readTriangleCount(data);
  const availableCount = Math.floor((data.byteLength - HEADER_BYTES) / TRIANGLE_BYTES);
  if (availableCount < count) throw new MeshError(texts.fewer(formatCount(count), formatCount(availableCount)));
  const view = new DataView(data);
  const positions = new Float32Array(count * 9);
  for (let i = 0; i < count; i++) {
    const byteOffset = HEADER_BYTES + i * TRIANGLE_BYTES + NORMAL_BYTES;
    for (let j = 0; j < 9; j++) positions[9 * i + j] = view.getFloat32(byteOffset + 4 * j, true);
  }
  return positions;
}
