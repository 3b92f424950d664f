import { Box3, ExtrudeGeometry, Path, PlaneGeometry, Shape as Outline, ShapeUtils, Vector2, Vector3, type BufferGeometry } from "three";
import type { Submesh } from "../../protocol";
import type { MeshPart } from "../meshes/mesh-template";

/** Heights along a side; more are not told apart. */
const MOST_HEIGHTS = 257;

/** The polygons x y x y ..., raised along z; those that lie in others are holes, and what lies in holes is solid again. */
export function extrusion(outlines: readonly (readonly number[])[], height: number): BufferGeometry {
  const polygons = outlines.map((numbers) => {
    return Array.from({ length: Math.floor(numbers.length / 2) }, (_, i) => new Vector2(numbers[2 * i], numbers[2 * i + 1]));
  }).filter((points) => points.length > 2);
  const around = polygons.map((points) => polygons.filter((other) => other !== points && contains(other, points[0])));
  const shapes: Outline[] = [];
  polygons.forEach((points, i) => {
    if ((around[i] ?? []).length % 2 === 1) return;
    const shape = new Outline(points);
    polygons.forEach((hole, j) => {
      const others = around[j] ?? [];
      if (others.includes(points) && others.length === (around[i] ?? []).length + 1) shape.holes.push(new Path(hole));
    });
    shapes.push(shape);
  });
  return new ExtrudeGeometry(shapes, { depth: height, bevelEnabled: false, steps: 1 });
}

/** The parts of a mesh that have a name, all for null; `offset` moves the mesh where its middle is to be the origin. */
export function submesh(parts: readonly MeshPart[], wanted: Submesh | null): { parts: readonly MeshPart[]; offset: Vector3 } {
  const offset = new Vector3();
  if (wanted === null) return { parts, offset };
  const found = parts.filter(({ names }) => names?.includes(wanted.name));
  if (found.length === 0) throw new Error(`the mesh has no part '${wanted.name}'`);
  if (wanted.center) {
    const box = new Box3();
    for (const { geometry } of found) {
      geometry.computeBoundingBox();
      if (geometry.boundingBox) box.union(geometry.boundingBox);
    }
    box.getCenter(offset).negate();
  }
  return { parts: found, offset };
}

/**
 * A ground whose heights are the grey values of an image.
 *
 * @param size x, y, z of the ground, the offset of its middle, and the edge length that a texture covers, m.
 */
export async function terrain(url: string, size: readonly number[]): Promise<BufferGeometry> {
  const image = new Image();
  image.src = url;
  await image.decode();
  const [width, height] = [Math.min(image.naturalWidth, MOST_HEIGHTS), Math.min(image.naturalHeight, MOST_HEIGHTS)];
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d");
  if (!context) throw new Error("the image of the heights cannot be read");
  context.drawImage(image, 0, 0, width, height);
  return ground(context.getImageData(0, 0, width, height).data, width, height, size);
}

/** `terrain`, of the image's pixels r g b a, the upper row first: it is the one with the greatest y. */
export function ground(pixels: ArrayLike<number>, width: number, height: number, size: readonly number[]): BufferGeometry {
  const [x = 1, y = 1, z = 1, dx = 0, dy = 0, dz = 0, tile = 1] = size;
  const geometry = new PlaneGeometry(x, y, Math.max(1, width - 1), Math.max(1, height - 1));
  const positions = geometry.getAttribute("position");
  const uvs = geometry.getAttribute("uv");
  const repeats = tile > 0 ? [x / tile, y / tile] : [1, 1];
  for (let i = 0; i < positions.count; i++) {
    positions.setZ(i, ((pixels[4 * i] ?? 0) / 255) * z);
    uvs.setXY(i, uvs.getX(i) * (repeats[0] ?? 1), uvs.getY(i) * (repeats[1] ?? 1));
  }
  geometry.translate(dx, dy, dz);
  geometry.computeVertexNormals();
  return geometry;
}

function contains(polygon: readonly Vector2[], point: Vector2 | undefined): boolean {
  if (!point || ShapeUtils.area([...polygon]) === 0) return false;
  let inside = false;
  polygon.forEach((a, i) => {
    const b = polygon[(i + 1) % polygon.length] ?? a;
    if (a.y > point.y !== b.y > point.y && point.x < ((b.x - a.x) * (point.y - a.y)) / (b.y - a.y) + a.x) inside = !inside;
  });
  return inside;
}
